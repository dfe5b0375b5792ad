//! Pictures of sprigs, cut out by alpha, and of bark.

use glam::{Vec2, Vec3, vec2, vec3};
use trove_model::{Material, Random, Seed};

use crate::surfaces::{Canvas, Noise, Texel, step};

/// How leaves sit on a sprig.
#[derive(Clone, Copy, Debug)]
pub(super) enum Sprig {
    /// Single leaves along forking twigs.
    Broad,
    /// Two rows of small leaflets on each of several stalks.
    Feathered,
    /// Needles all around twigs.
    Needles,
    /// Long leaves from one point.
    Blades,
    /// One palm leaf, its rib up the middle.
    Frond,
}

/// Share of the light that a leaf does not swallow that comes out on its other side; about 0.4 over the visible range
/// (Jacquemoud and Baret, *PROSPECT: A model of leaf optical properties spectra*, 1990).
const TRANSLUCENCY: f32 = 0.4;

/// The leaves' material: `green` is what they reflect, as much again comes through from behind as is usual.
pub(super) fn material(name: &str, sprig: Sprig, green: Vec3, seed: u64) -> Material {
    let canvas = picture(sprig, green / (1.0 - TRANSLUCENCY), seed);
    Material {
        base_color_map: Some(canvas.color(name)),
        alpha_cutoff: 0.5,
        translucency: TRANSLUCENCY,
        // Leaves in their thousands gleam little: each is bent, and most are dull or dusty.
        ior: 1.35,
        ..Material::plain(name, Vec3::ONE, 0.7)
    }
}

/// A square with the sprig's foot in the middle of its lower edge; sides are of length 1.
fn picture(sprig: Sprig, green: Vec3, seed: u64) -> Canvas {
    // What is cut away is green too, so that filtered edges do not darken.
    let away = Texel { alpha: 0.0, ..Texel::new(green * 0.8, 0.55) };
    let mut canvas = Canvas::new([256, 256], [1.0, 1.0], |_| away);
    let mut pen = Pen { canvas: &mut canvas, green, random: Seed(seed).child("sprig").random() };
    match sprig {
        Sprig::Broad => pen.broad(),
        Sprig::Feathered => pen.feathered(),
        Sprig::Needles => pen.needles(),
        Sprig::Blades => pen.blades(),
        Sprig::Frond => pen.frond(),
    }
    canvas
}

struct Pen<'a> {
    canvas: &'a mut Canvas,
    green: Vec3,
    random: Random,
}

impl Pen<'_> {
    fn range(&mut self, low: f32, high: f32) -> f32 {
        self.random.range(f64::from(low), f64::from(high)) as f32
    }

    fn twig(&mut self, from: Vec2, to: Vec2, width: f32) {
        let along = to - from;
        let (low, high) = (from.min(to) - width, from.max(to) + width);
        self.canvas.rect(low, high, |p, texel| {
            let q = p + low - from;
            let t = (q.dot(along) / along.length_squared()).clamp(0.0, 1.0);
            if q.distance(along * t) < width * (1.0 - 0.5 * t) {
                *texel = Texel::new(vec3(0.09, 0.07, 0.035), 0.8);
            }
        });
    }

    /// A leaf from its foot along a direction; `pointed` moves its widest place to the foot.
    fn leaf(&mut self, foot: Vec2, along: Vec2, length: f32, width: f32, pointed: f32) {
        let shade = self.range(0.7, 1.35);
        let hue = self.range(-0.14, 0.14);
        let color = self.green * shade * vec3(1.0 + hue, 1.0, 1.0 - hue);
        let tip = foot + along * length;
        let margin = Vec2::splat(width / 2.0);
        let (low, high) = (foot.min(tip) - margin, foot.max(tip) + margin);
        // A picture repeats: what would stick out of it is left away.
        let (low, high) = (low.max(Vec2::ZERO), high.min(Vec2::ONE));
        self.canvas.rect(low, high, |p, texel| {
            let q = p + low - foot;
            let (t, off) = (q.dot(along) / length, along.perp_dot(q));
            if !(0.0..=1.0).contains(&t) {
                return;
            }
            let half = width / 2.0 * (std::f32::consts::PI * t.powf(pointed)).sin().max(0.0).powf(0.8);
            if off.abs() < half {
                let rib = step(0.06 * width, 0.02 * width, off.abs());
                let side = if off > 0.0 { 0.9 } else { 1.08 };
                *texel = Texel::new(color * side * (0.85 + 0.25 * t) * (1.0 + 0.3 * rib), 0.5);
            }
        });
    }

    fn broad(&mut self) {
        let foot = vec2(0.5, 0.0);
        for (turn, length) in [(-0.62, 0.66), (0.6, 0.68), (-0.22, 0.86), (0.2, 0.9), (0.0, 0.8)] {
            let along = Vec2::from_angle(std::f32::consts::FRAC_PI_2 + turn);
            let tip = foot + along * length * 0.8;
            self.twig(foot, tip, 0.007);
            for i in 0..7 {
                let t = 0.22 + 0.78 * i as f32 / 6.0;
                let side = if i % 2 == 0 { 1.0 } else { -1.0 };
                let turn = if i == 6 { 0.0 } else { side * self.range(0.5, 1.2) };
                let size = self.range(0.13, 0.2);
                let out = Vec2::from_angle(turn).rotate(along);
                self.leaf(foot + (tip - foot) * t, out, size, size * 0.56, 0.85);
            }
        }
    }

    fn feathered(&mut self) {
        let foot = vec2(0.5, 0.0);
        for i in 0..8 {
            let turn = -1.0 + 2.0 * i as f32 / 7.0 + self.range(-0.1, 0.1);
            let along = Vec2::from_angle(std::f32::consts::FRAC_PI_2 + turn);
            let length = self.range(0.62, 0.93) * (1.0 - 0.25 * turn.abs());
            let start = foot + along * 0.04;
            self.twig(start, start + along * length, 0.004);
            for k in 3..15 {
                let at = start + along * length * k as f32 / 15.0;
                for side in [1.0, -1.0] {
                    let out = Vec2::from_angle(side * self.range(0.85, 1.2)).rotate(along);
                    let size = self.range(0.06, 0.085);
                    self.leaf(at, out, size, size * 0.48, 0.95);
                }
            }
        }
    }

    fn needles(&mut self) {
        let foot = vec2(0.5, 0.0);
        for turn in [-0.75f32, 0.75, -0.4, 0.4, 0.0] {
            let along = Vec2::from_angle(std::f32::consts::FRAC_PI_2 + turn);
            let length = 0.92 - 0.3 * turn.abs();
            self.twig(foot, foot + along * length, 0.008);
            for k in 0..70 {
                let at = foot + along * length * (0.1 + 0.9 * k as f32 / 70.0);
                let side = if k % 2 == 0 { 1.0 } else { -1.0 };
                let out = Vec2::from_angle(side * self.range(0.3, 1.0)).rotate(along);
                let size = self.range(0.09, 0.14);
                self.leaf(at, out, size, 0.014, 0.6);
            }
        }
    }

    fn blades(&mut self) {
        for i in 0..17 {
            let turn = -1.15 + 2.3 * (i * 7 % 17) as f32 / 16.0;
            let along = Vec2::from_angle(std::f32::consts::FRAC_PI_2 + turn);
            let length = self.range(0.7, 0.97) * (1.0 - 0.3 * turn.abs());
            let width = self.range(0.055, 0.085);
            self.leaf(vec2(0.5 + 0.04 * turn, 0.0), along, length, width, 0.75);
        }
    }

    fn frond(&mut self) {
        for k in 0..30 {
            let t = k as f32 / 30.0;
            for side in [1.0, -1.0] {
                let at = vec2(0.5, 0.03 + 0.93 * t);
                let along = Vec2::from_angle(std::f32::consts::FRAC_PI_2 - side * (1.15 - 0.5 * t));
                let length = 0.5 * (1.0 - 0.75 * t * t) * (0.55 + 0.45 * (t * 6.0).min(1.0)) * self.range(0.9, 1.08);
                self.leaf(at, along, length, 0.026, 0.6);
            }
        }
        self.twig(vec2(0.5, 0.0), vec2(0.5, 0.98), 0.014);
    }
}

/// Furrowed bark; the uvs of branches are metres.
pub(super) fn bark(name: &str, color: Vec3, seed: u32) -> Material {
    let size = vec2(0.5, 1.0);
    let ridges = Noise::stretched(size, vec2(0.05, 0.3), seed);
    let (grain, moss) = (Noise::new(size, 0.03, seed + 1), Noise::new(size, 0.3, seed + 2));
    let canvas = Canvas::new([128, 256], size.to_array(), |p| {
        let furrow = ridges.fbm(p, 3);
        let tone = 1.0 + 0.45 * furrow + 0.2 * grain.at(p);
        let mut texel = Texel::new(color * tone, 0.9);
        texel.tint(vec3(0.1, 0.105, 0.08), 0.5 * step(0.1, 0.6, moss.fbm(p, 3)));
        texel.height_m = 0.008 * furrow;
        texel
    });
    canvas.material(name, 1)
}
