//! Facades painted by their rules: a wall, and in every bay and storey its openings, no two alike.

use glam::{Vec2, Vec3, vec2, vec3};
use trove_model::{FacadeDesign, Filling, Interior, Opening, Random, Seed};

use super::canvas::{Canvas, Texel};
use super::noise::{hash, step};
use super::opening::{Window, slab, streaks, window};
use super::wall::{Finish, Grid, weather};

/// A facade's rules with the wall that they cut.
#[derive(Clone, Debug)]
pub(super) struct Style {
    pub(super) grid: Grid,
    pub(super) finish: Finish,
    pub(super) color: Vec3,
    /// How much rain and soot show, 0 to 1.
    pub(super) worn: f32,
    pub(super) design: FacadeDesign,
}

impl Style {
    /// The rules, with the wall named.
    pub(super) fn rules(&self) -> FacadeDesign {
        let wall_tint = self.color / self.finish.color();
        FacadeDesign { wall: self.finish.tags()[0].into(), wall_tint, ..self.design.clone() }
    }

    /// The flat texture.
    pub(super) fn paint(&self, seed: u32) -> Canvas {
        let (grid, design) = (self.grid, &self.design);
        let mut canvas = self.finish.paint(grid, self.color, seed);
        weather(&mut canvas, self.worn, seed);
        for (i, corner) in grid.corners() {
            let mut random = Seed(u64::from(seed)).child("cell").nth(i).random();
            let (bay, storey) = (i as usize % grid.cells[0] as usize, i as usize / grid.cells[0] as usize);
            bands(&mut canvas, corner, grid.cell_m, design);
            for opening in design.openings(bay, storey) {
                self.opening(&mut canvas, corner + opening.low_m, opening, &mut random);
            }
            if design.arcade_m > 0.0 {
                shade_of_an_arcade(&mut canvas, corner, grid.cell_m);
            }
        }
        canvas
    }

    fn opening(&self, canvas: &mut Canvas, low: Vec2, opening: &Opening, random: &mut Random) {
        let (design, size) = (&self.design, opening.size_m);
        let high = low + size;
        let [wide, out] = design.surround_m;
        if wide > 0.0 {
            slab(canvas, low - vec2(wide, 0.0), high + wide, design.trim, out, 5);
        }
        match opening.filling {
            Filling::Window | Filling::GlassDoor => window(canvas, low, &make(design, opening), random),
            Filling::Door => door(canvas, low, size, DOORS[random.index(DOORS.len())], design.recess_m),
            Filling::Roller => roller(canvas, low, size, random.range(0.85, 1.15) as f32),
        }
        if opening.filling == Filling::Window {
            let [thick, out] = design.sill_m;
            if thick > 0.0 {
                slab(canvas, low - vec2(0.08, thick), vec2(high.x + 0.08, low.y), design.trim, out, 3);
                streaks(canvas, low - vec2(0.08, thick), size.x + 0.16, opening.low_m.y.max(0.3) - thick, random);
            }
            if let Some(color) = design.shutters {
                let closed = random.chance(0.15);
                for x in if closed { [0.0, size.x / 2.0] } else { [-size.x / 2.0 - 0.04, size.x + 0.04] } {
                    louvres(canvas, low + vec2(x, 0.0), vec2(size.x / 2.0, size.y), color);
                }
            }
        }
        let [thick, out] = design.lintel_m;
        if thick > 0.0 {
            let low = vec2(low.x - 0.12, high.y + wide);
            slab(canvas, low, vec2(high.x + 0.12, low.y + thick), design.trim, out, 4);
        }
        self.fixtures(canvas, low, opening, random);
    }

    fn fixtures(&self, canvas: &mut Canvas, low: Vec2, opening: &Opening, random: &mut Random) {
        let (fixtures, size) = (&self.design.fixtures, opening.size_m);
        let mut has = |share: f32| share > 0.0 && random.chance(f64::from(share));
        if opening.is_french() && has(fixtures.balconies.max(fixtures.glass_balconies)) {
            let low = low - vec2(0.15, 0.0);
            canvas.rect(low, low + vec2(size.x + 0.3, 1.0), |p, texel| {
                if p.y > 0.94 || (p.x / 0.12).fract() < 0.2 {
                    *texel = Texel { height_m: 0.05, ..Texel::new(Vec3::splat(0.06), 0.5) };
                }
            });
        }
        if has(fixtures.cages) {
            canvas.rect(low, low + size, |p, texel| {
                if (p.x / 0.13).fract() < 0.14 || (p.y / 0.5).fract() < 0.05 {
                    *texel = Texel { height_m: 0.2, ..Texel::new(Vec3::splat(0.4), 0.4) };
                }
            });
        }
        if has(fixtures.conditioners) {
            condenser(canvas, low + vec2(0.05, -0.72));
        }
        if opening.is_shop(self.design.interior) && has(fixtures.signs) {
            let color = [vec3(0.3, 0.03, 0.03), vec3(0.03, 0.1, 0.22), vec3(0.03, 0.14, 0.07), vec3(0.4, 0.26, 0.03)];
            let low = low + vec2(-0.1, size.y + 0.15);
            slab(canvas, low, low + vec2(size.x + 0.2, 0.6), color[random.index(4)], 0.1, 1);
        }
    }
}

/// Leaves of doors.
const DOORS: [Vec3; 4] =
    [vec3(0.02, 0.05, 0.12), vec3(0.2, 0.02, 0.02), vec3(0.02, 0.08, 0.04), vec3(0.14, 0.07, 0.03)];

fn make(design: &FacadeDesign, opening: &Opening) -> Window {
    Window {
        size_m: opening.size_m,
        panes: opening.panes,
        frame: design.frame,
        frame_m: design.frame_m,
        bar_m: design.bar_m,
        recess_m: design.recess_m.min(0.3),
        glass: design.glass,
        interior: if opening.is_shop(design.interior) { Interior::Shop } else { design.interior },
    }
}

/// Courses and piers of a cell.
fn bands(canvas: &mut Canvas, corner: Vec2, cell_m: Vec2, design: &FacadeDesign) {
    for course in &design.courses {
        let [low, high] = course.between_m;
        let (low, high) = (corner + vec2(0.0, low), corner + vec2(cell_m.x, high));
        if course.out_m > 0.0 {
            slab(canvas, low, high, course.color, course.out_m, 5);
        } else {
            canvas.rect(low, high, |_, texel| texel.tint(course.color, 0.9));
        }
    }
    let [wide, out] = design.pier_m;
    if wide > 0.0 {
        canvas.rect(corner - vec2(wide / 2.0, 0.0), corner + vec2(wide / 2.0, cell_m.y), |_, texel| {
            texel.height_m = texel.height_m.max(0.0) + out;
        });
        let shadow = corner + vec2(wide / 2.0, 0.0);
        canvas.rect(shadow, shadow + vec2(0.05, cell_m.y), |_, texel| texel.albedo *= 0.75);
    }
}

/// It is dark under the storey above, darkest at the top.
fn shade_of_an_arcade(canvas: &mut Canvas, corner: Vec2, cell_m: Vec2) {
    canvas.rect(corner + vec2(0.3, 0.0), corner + vec2(cell_m.x - 0.3, cell_m.y - 0.7), |p, texel| {
        texel.albedo *= 0.6 - 0.45 * step(0.3, 1.0, p.y / cell_m.y);
        texel.roughness = texel.roughness.max(0.2);
    });
}

/// A door of panels.
fn door(canvas: &mut Canvas, low: Vec2, size: Vec2, color: Vec3, recess_m: f32) {
    canvas.rect(low, low + size, |p, texel| {
        let q = vec2((p.x / size.x * 2.0).fract(), (p.y / size.y * 3.0).fract());
        let sunk = q.min(1.0 - q).min_element() > 0.18;
        let shade = 0.6 + 0.4 * step(0.0, 0.2, size.y - p.y);
        *texel = Texel::new(color * shade * if sunk { 0.88 } else { 1.0 }, 0.45);
        texel.height_m = if sunk { -0.015 } else { 0.0 } - recess_m;
    });
    let knob = low + vec2(size.x - 0.12, 1.0);
    canvas.rect(knob, knob + vec2(0.04, 0.25), |_, texel| *texel = Texel::new(Vec3::splat(0.5), 0.3));
}

/// A door of slats that rolls up.
fn roller(canvas: &mut Canvas, low: Vec2, size: Vec2, tone: f32) {
    canvas.rect(low, low + size, |p, texel| {
        let slat = (p.y / 0.11).fract();
        *texel = Texel::new(vec3(0.4, 0.4, 0.38) * tone * (0.75 + 0.3 * slat), 0.5);
        texel.albedo *= 0.6 + 0.4 * step(size.y, size.y - 0.35, p.y) - 0.2 * step(0.8, 0.0, p.y);
        texel.height_m = -0.1 + 0.015 * (slat * std::f32::consts::PI).sin();
    });
}

/// A leaf of a shutter.
fn louvres(canvas: &mut Canvas, low: Vec2, size: Vec2, color: Vec3) {
    canvas.rect(low - vec2(0.0, 0.05), low, |_, texel| texel.albedo *= 0.6);
    canvas.rect(low, low + size, |p, texel| {
        let rim = p.min(size - p).min_element() < 0.055;
        let slat = (p.y / 0.06).fract();
        *texel = Texel::new(color * if rim { 1.0 } else { 0.55 + 0.5 * slat }, 0.6);
        texel.height_m = if rim { 0.05 } else { 0.025 + 0.02 * slat };
    });
}

/// The outside half of an air conditioner.
fn condenser(canvas: &mut Canvas, low: Vec2) {
    canvas.rect(low, low + vec2(0.8, 0.56), |p, texel| {
        let radius = p.distance(vec2(0.3, 0.28));
        let grille = radius < 0.22;
        let ring = 0.6 + 0.4 * (radius * 160.0).sin();
        *texel = Texel::new(Vec3::splat(if grille { 0.1 * ring } else { 0.5 }), 0.6);
        texel.height_m = if grille { 0.24 } else { 0.28 };
        texel.albedo *= 0.95 + 0.1 * hash((p.x * 40.0) as i32, (p.y * 40.0) as i32, 7);
    });
}
