//! Windows, doors and what surrounds them.

use glam::{Vec2, Vec3, vec2, vec3};
use trove_model::{Interior, Random};

use super::canvas::{Canvas, Texel};
use super::noise::{hash, step};

/// Roughness of window glass.
const GLASS: f32 = 0.04;

/// A window's make.
#[derive(Clone, Copy, Debug)]
pub(super) struct Window {
    pub(super) size_m: Vec2,
    /// Panes across and up.
    pub(super) panes: [u32; 2],
    pub(super) frame: Vec3,
    /// Width of the outer frame.
    pub(super) frame_m: f32,
    /// Width of the bars between panes.
    pub(super) bar_m: f32,
    /// How deep the glass lies behind the wall.
    pub(super) recess_m: f32,
    /// What the glass tints things behind it.
    pub(super) glass: Vec3,
    pub(super) interior: Interior,
}

/// Fills a rectangle with one colour, standing out by `out_m`, with a shadow under it.
pub(super) fn slab(canvas: &mut Canvas, low: Vec2, high: Vec2, color: Vec3, out_m: f32, seed: u32) {
    canvas.rect(low, high, |p, texel| {
        let grain = hash((p.x * 90.0) as i32, (p.y * 90.0) as i32, seed) - 0.5;
        let base = Texel::new(color * (1.0 + 0.07 * grain), 0.85);
        *texel = Texel { height_m: out_m, ..base };
    });
    let depth = (out_m * 0.9).min(0.12);
    if depth > 0.0 {
        canvas.rect(vec2(low.x, low.y - depth), vec2(high.x, low.y), |p, texel| {
            texel.albedo *= 0.5 + 0.5 * step(depth, 0.0, p.y);
        });
    }
}

/// Dirt that runs down from a sill.
pub(super) fn streaks(canvas: &mut Canvas, top: Vec2, width_m: f32, length_m: f32, random: &mut Random) {
    let (seed, strength) = (random.bits() as u32, random.range(0.1, 0.45) as f32);
    canvas.rect(vec2(top.x, top.y - length_m), vec2(top.x + width_m, top.y), |p, texel| {
        let down = 1.0 - p.y / length_m;
        let column = 0.6 * hash((p.x * 22.0) as i32, 0, seed) + 0.4 * hash((p.x * 60.0) as i32, 1, seed);
        let ends = step(0.25, 0.05, (p.x / width_m).min(1.0 - p.x / width_m));
        let fall = step(0.3 + 0.7 * column, 0.0, down);
        texel.albedo *= 1.0 - strength * fall * (0.4 * column + 0.6 * ends);
    });
}

/// A window with its low left corner at a point.
pub(super) fn window(canvas: &mut Canvas, low: Vec2, make: &Window, random: &mut Random) {
    let view = View::draw(make, random);
    let size = make.size_m;
    let panes = vec2(make.panes[0] as f32, make.panes[1] as f32);
    canvas.rect(low, low + size, |p, texel| {
        let frame = p.min(size - p).min_element();
        let inner = (p - make.frame_m) / (size - 2.0 * make.frame_m) * panes;
        let pane = inner.floor();
        let within = (inner - pane) * (size - 2.0 * make.frame_m) / panes;
        let pane_size = (size - 2.0 * make.frame_m) / panes;
        let bar = within.min(pane_size - within).min_element();
        // The reveal's shadow, which no relief can throw.
        let shade = 0.45 + 0.55 * step(0.0, make.recess_m * 1.2 + 0.01, size.y - p.y);
        if frame < make.frame_m || bar < make.bar_m / 2.0 {
            *texel = Texel::new(make.frame * shade, 0.55);
            texel.height_m = -make.recess_m + 0.03;
        } else {
            *texel = Texel::new(view.at(p / size) * make.glass * shade, GLASS);
            let tilt = vec2(hash(pane.x as i32, pane.y as i32, view.seed), hash(7, pane.y as i32, view.seed)) - 0.5;
            texel.height_m = -make.recess_m + 0.014 * tilt.dot(within - pane_size / 2.0);
        }
    });
}

/// What is seen through one window.
struct View {
    seed: u32,
    interior: Interior,
    /// Down to where (1 top, 0 bottom) the blind hangs.
    blind: f32,
    /// How far in from the sides the curtains reach.
    curtains: f32,
    cloth: Vec3,
    lit: bool,
}

impl View {
    fn draw(make: &Window, random: &mut Random) -> Self {
        let home = make.interior == Interior::Home;
        let blind = match make.interior {
            Interior::Home if random.chance(0.22) => 1.0 - random.unit() as f32 * random.unit() as f32 * 1.1,
            Interior::Office if random.chance(0.4) => 1.0 - (random.unit() * random.unit()) as f32 * 0.9,
            _ => 1.0,
        };
        let curtains = if home && random.chance(0.65) { random.range(0.08, 0.35) as f32 } else { 0.0 };
        let closed = home && random.chance(0.08);
        let cloths = [vec3(0.5, 0.48, 0.43), vec3(0.42, 0.36, 0.28), vec3(0.55, 0.55, 0.54), vec3(0.25, 0.28, 0.33)];
        Self {
            seed: random.bits() as u32,
            interior: make.interior,
            blind,
            curtains: if closed { 0.5 } else { curtains },
            cloth: cloths[random.index(cloths.len())],
            lit: random.chance(if make.interior == Interior::Bare { 0.0 } else { 0.12 }),
        }
    }

    /// Its colour at a place, both 0 to 1.
    fn at(&self, p: Vec2) -> Vec3 {
        let noise = |x: f32, y: f32| hash((p.x * x) as i32, (p.y * y) as i32, self.seed);
        let mut color = Vec3::splat(0.028 + 0.03 * (1.0 - p.y));
        // Dim shapes of a room: its back wall, a dark corner, furniture under the sill.
        let depth = step(0.35, 0.2, (p.x - 0.3 - 0.4 * noise(0.0, 0.0)).abs());
        let furniture = step(0.02, 0.0, p.y - 0.12 - 0.2 * noise(2.6, 0.0));
        color *= 0.6 + 0.7 * depth - 0.4 * furniture;
        if self.lit {
            color += vec3(0.16, 0.125, 0.08) * (0.4 + 0.6 * p.y);
        }
        match self.interior {
            Interior::Office => {
                let lamp = step(0.03, 0.02, (p.y - 0.86).abs()) * step(0.33, 0.3, ((p.x * 2.0).fract() - 0.5).abs());
                color += Vec3::splat(0.22) * lamp * if self.lit { 1.0 } else { 0.15 };
            }
            Interior::Shop => {
                // Shelves with things on them, a poster, a lit ceiling.
                let shelf = (p.y * 7.0).fract();
                let thing = hash((p.x * 26.0) as i32, (p.y * 7.0) as i32, self.seed);
                let goods = step(0.62, 0.6, p.y) * step(0.25 + 0.7 * thing, 0.2 + 0.7 * thing, shelf);
                let hue = vec3(thing, (thing * 7.3).fract(), (thing * 3.7).fract());
                color += goods * (Vec3::splat(0.02) + 0.11 * hue * hue) + vec3(0.07, 0.06, 0.045) * p.y;
                let poster = (p - vec2(0.15 + 0.5 * noise(0.0, 0.0), 0.55)).abs();
                if poster.x < 0.09 && poster.y < 0.2 {
                    color = vec3(0.35, 0.33, 0.3) * (0.35 + hash((p.x * 30.0) as i32, (p.y * 14.0) as i32, self.seed));
                }
            }
            Interior::Home | Interior::Bare => {}
        }
        let side = p.x.min(1.0 - p.x);
        if side < self.curtains {
            let fold = 0.75 + 0.25 * (p.x * 95.0 + 2.0 * noise(3.0, 1.0)).sin();
            color = self.cloth * fold * 0.62;
        }
        if p.y > self.blind {
            let slat = 0.8 + 0.2 * (p.y * 150.0).sin();
            color = vec3(0.33, 0.33, 0.31) * slat * 0.75;
        }
        color
    }
}
