//! Pictures of sprigs, cut out by alpha: each species' own leaves, with ribs and veins.
//!
//! The pictures are grey: a slot's paints are the leaves' colour. Leaves of deciduous plants differ in alpha, so that a
//! higher cut-off makes them fall one by one, until twigs are left.

use glam::{Vec2, Vec3, vec2, vec3};
use serde::Deserialize;
use trove_model::{Material, Random, Seed};

use crate::surfaces::{Canvas, Texel, step};

/// The form of a leaf.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize)]
#[serde(rename_all = "snake_case")]
pub(super) enum Outline {
    /// Widest at the height that makes `sin(π·t^e)` largest; e = 1 is the middle, less is nearer to the foot.
    Oval(f32),
    /// Widest at the foot, straight to the tip: poplar, birch.
    Triangle,
    /// Round bays along both sides: oak.
    Wavy,
    /// Five points: the depth of the bays, 0 to 1: plane less, maple more.
    Palmate(f32),
}

/// How leaves sit on a sprig.
#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub(super) enum Sprig {
    /// Single leaves along forking twigs.
    Leaves {
        outline: Outline,
        /// As shares of the card's side.
        length: f32,
        width: f32,
        /// On each twig.
        count: usize,
    },
    /// Two rows of small leaflets on each of several stalks.
    Feathered,
    /// Short needles on all sides of flat sprays: spruce.
    Needles,
    /// Tufts of long needles at the twigs' ends: pine.
    Tufts,
    /// Sprays of scales: cypress.
    Scales,
    /// One feather of a palm, its rib up the middle.
    Feather,
    /// One fan of a palm.
    Fan,
    /// One broad leaf with a strong rib: heliconia, canna.
    Paddle,
    /// Narrow leaves from one point: grasses, lilies.
    Blades,
    /// Flower heads on stalks over leaves.
    Flowers,
}

/// Share of the light that a leaf does not swallow that comes out on its other side; nearly half at green, where they swallow least
/// (Jacquemoud and Baret, *PROSPECT: A model of leaf optical properties spectra*, 1990).
const TRANSLUCENCY: f32 = 0.46;
/// What leaves have in the picture on average.
const GREY: f32 = 0.6;
/// Alpha of the first leaf to fall and of the last one; twigs have 1.
const FALLS: [f32; 2] = [0.6, 0.92];
/// The cut-offs of a full crown, of one that has lost a part of its leaves, and of a bare one.
pub(super) const FULL: f32 = 0.5;
pub(super) const THINNED: f32 = 0.72;
pub(super) const BARE: f32 = 0.96;

/// The base colour of leaves that reflect `color` (linear) to the side that light comes from.
pub(super) fn paint(color: Vec3) -> Vec3 {
    (color / (GREY * (1.0 - TRANSLUCENCY))).min(Vec3::ONE)
}

/// The leaves' material, to be painted with [`paint`]; `size_px` is a side of its picture.
pub(super) fn material(name: &str, sprig: Sprig, size_px: u32, seed: u64) -> Material {
    let away = Texel { alpha: 0.0, ..Texel::new(Vec3::splat(GREY * 0.8), 0.55) };
    let mut canvas = Canvas::new([size_px; 2], [1.0, 1.0], |_| away);
    let mut pen = Pen { canvas: &mut canvas, random: Seed(seed).child("sprig").random() };
    pen.sprig(sprig);
    Material {
        base_color_map: Some(canvas.color(name)),
        alpha_cutoff: FULL,
        translucency: TRANSLUCENCY,
        // Waxy (PROSPECT's index of refraction is 1.4 to 1.5 for visible light), but bent: gleams are spread widely.
        ior: 1.45,
        ..Material::plain(name, Vec3::ONE, 0.6)
    }
}

impl Outline {
    /// How far inside its edge a point lies, in lengths of the leaf, negative outside; `t` runs from the foot (0) to the
    /// tip (1), `s` across, and `width` is in lengths too.
    fn inside(self, t: f32, s: f32, width: f32) -> f32 {
        let across = s.abs();
        let round = |e: f32| (std::f32::consts::PI * t.clamp(0.0, 1.0).powf(e)).sin().max(0.0).powf(0.8);
        match self {
            Self::Oval(e) => width / 2.0 * round(e) - across,
            Self::Triangle => {
                let teeth = 1.0 + 0.1 * (t * 55.0).sin();
                width * 0.56 * (t / 0.16).clamp(0.0, 1.0).sqrt() * (1.0 - t).max(0.0).powf(0.85) * teeth - across
            }
            Self::Wavy => {
                let bays = 0.72 + 0.28 * (t * 27.0 + s.signum()).sin();
                width / 2.0 * round(1.15) * bays.max(0.35) - across
            }
            Self::Palmate(depth) => {
                let v = vec2(t - 0.34, s / width);
                let angle = v.y.atan2(v.x).abs();
                let lobe = |at: f32, long: f32| long * (1.0 - depth * 1.3 * (angle - at).abs());
                let teeth = 0.03 * (angle * 17.0).sin();
                let edge = lobe(0.0, 0.64).max(lobe(0.95, 0.58)).max(lobe(1.9, 0.45)).max(0.3 - 0.1 * depth);
                edge + teeth - v.length()
            }
        }
    }
}

struct Pen<'a> {
    canvas: &'a mut Canvas,
    random: Random,
}

/// One leaf: from its foot along a direction.
#[derive(Clone, Copy)]
struct Leaf {
    foot: Vec2,
    along: Vec2,
    length: f32,
    width: f32,
    outline: Outline,
}

impl Pen<'_> {
    fn range(&mut self, low: f32, high: f32) -> f32 {
        self.random.range(f64::from(low), f64::from(high)) as f32
    }

    fn twig(&mut self, from: Vec2, to: Vec2, width: f32) {
        let along = to - from;
        let (low, high) = (from.min(to) - width, from.max(to) + width);
        self.canvas.rect(low.max(Vec2::ZERO), high.min(Vec2::ONE), |p, texel| {
            let q = p + low.max(Vec2::ZERO) - from;
            let t = (q.dot(along) / along.length_squared()).clamp(0.0, 1.0);
            if q.distance(along * t) < width * (1.0 - 0.5 * t) {
                *texel = Texel::new(vec3(0.34, 0.3, 0.3), 0.8);
            }
        });
    }

    fn leaf(&mut self, leaf: Leaf) {
        let shade = self.range(0.68, 1.32);
        let hue = self.range(-0.12, 0.12);
        let alpha = self.range(FALLS[0], FALLS[1]);
        self.blade(leaf, Vec3::splat(GREY) * shade * vec3(1.0 + hue, 1.0, 1.0 - hue), alpha);
    }

    fn blade(&mut self, leaf: Leaf, color: Vec3, alpha: f32) {
        let Leaf { foot, along, length, width, outline } = leaf;
        let tip = foot + along * length;
        let margin =
            Vec2::splat(width / 2.0 + 0.02 + if let Outline::Palmate(_) = outline { 0.25 * length } else { 0.0 });
        // A picture repeats: what would stick out of it is left away.
        let low = (foot.min(tip) - margin).max(Vec2::ZERO);
        let high = (foot.max(tip) + margin).min(Vec2::ONE);
        self.canvas.rect(low, high, |p, texel| {
            let q = p + low - foot;
            let (t, s) = (q.dot(along) / length, along.perp_dot(q) / length);
            let inside = outline.inside(t, s, width / length);
            if inside <= 0.0 || !(-0.2..=1.0).contains(&t) {
                // It shades what lies behind it.
                if inside > -0.07 && (-0.05..=1.05).contains(&t) && texel.alpha > 0.0 {
                    texel.albedo *= 1.0 - 0.35 * step(-0.07, 0.0, inside);
                }
                return;
            }
            let rib = step(0.035, 0.012, s.abs());
            let veins = 0.5 + 0.5 * ((t - 0.75 * s.abs()) * 46.0).sin();
            // Its halves are folded a little, its edge is thinner.
            let side = if s > 0.0 { 0.88 } else { 1.08 };
            let tone =
                side * (0.86 + 0.22 * t) * (1.0 + 0.28 * rib + 0.09 * veins) * (1.0 - 0.12 * step(0.05, 0.0, inside));
            *texel = Texel { alpha, ..Texel::new(color * tone, 0.5) };
        });
    }

    fn sprig(&mut self, sprig: Sprig) {
        match sprig {
            Sprig::Leaves { outline, length, width, count } => self.leaves(outline, [length, width], count),
            Sprig::Feathered => self.feathered(),
            Sprig::Needles => self.needles(),
            Sprig::Tufts => self.tufts(),
            Sprig::Scales => self.scales(),
            Sprig::Feather => self.feather(),
            Sprig::Fan => self.fan(),
            Sprig::Paddle => self.paddle(),
            Sprig::Blades => self.blades(),
            Sprig::Flowers => self.flowers(),
        }
    }

    /// A twig that forks, leaves alternately on both sides.
    fn leaves(&mut self, outline: Outline, [length, width]: [f32; 2], count: usize) {
        let foot = vec2(0.5, 0.0);
        for (turn, reach) in [(-0.78, 0.58), (0.75, 0.6), (-0.4, 0.8), (0.42, 0.78), (-0.1, 0.84), (0.14, 0.9)] {
            let along = up(turn);
            let tip = foot + along * (reach - 0.5 * length);
            self.twig(foot, tip, 0.007);
            for i in 0..count {
                let t = 0.2 + 0.8 * (i as f32 + self.range(0.0, 0.6)) / count as f32;
                let side = if i % 2 == 0 { 1.0 } else { -1.0 };
                let turn = if i + 1 == count { 0.0 } else { side * self.range(0.5, 1.35) };
                let size = length * self.range(0.75, 1.12);
                let out = Vec2::from_angle(turn).rotate(along);
                let at = foot + (tip - foot) * t.min(1.0);
                let stalk = out * size * 0.12;
                self.twig(at, at + stalk, 0.003);
                self.leaf(Leaf { foot: at + stalk, along: out, length: size, width: size * width, outline });
            }
        }
    }

    fn feathered(&mut self) {
        let foot = vec2(0.5, 0.0);
        for i in 0..9 {
            let turn = -1.0 + 2.0 * (i * 4 % 9) as f32 / 8.0 + self.range(-0.1, 0.1);
            let along = up(turn);
            let reach = self.range(0.62, 0.93) * (1.0 - 0.25 * turn.abs());
            let start = foot + along * 0.04;
            self.twig(start, start + along * reach, 0.004);
            for k in 3..17 {
                let at = start + along * reach * k as f32 / 17.0;
                for side in [1.0, -1.0] {
                    let out = Vec2::from_angle(side * self.range(0.85, 1.2)).rotate(along);
                    let length = self.range(0.06, 0.085);
                    self.leaf(Leaf {
                        foot: at,
                        along: out,
                        length,
                        width: length * 0.46,
                        outline: Outline::Oval(0.95),
                    });
                }
            }
        }
    }

    fn needle(&mut self, foot: Vec2, along: Vec2, length: f32, width: f32) {
        let color = Vec3::splat(GREY) * self.range(0.6, 1.35);
        self.blade(Leaf { foot, along, length, width, outline: Outline::Oval(0.6) }, color, 1.0);
    }

    fn needles(&mut self) {
        let foot = vec2(0.5, 0.0);
        for turn in [-0.85f32, 0.85, -0.55, 0.55, -0.25, 0.25, 0.0] {
            let along = up(turn);
            let reach = 0.92 - 0.32 * turn.abs();
            self.twig(foot, foot + along * reach, 0.008);
            for k in 0..64 {
                let at = foot + along * reach * (0.08 + 0.92 * k as f32 / 64.0);
                let side = if k % 2 == 0 { 1.0 } else { -1.0 };
                let out = Vec2::from_angle(side * self.range(0.3, 1.1)).rotate(along);
                let length = self.range(0.06, 0.1);
                self.needle(at, out, length, 0.012);
            }
        }
    }

    fn tufts(&mut self) {
        let foot = vec2(0.5, 0.0);
        for (turn, reach) in [(-0.7, 0.42), (0.72, 0.45), (-0.3, 0.55), (0.33, 0.6), (0.0, 0.42), (0.02, 0.7)] {
            let along = up(turn);
            let tip = foot + along * reach;
            self.twig(foot, tip, 0.009);
            for _ in 0..60 {
                let at = foot.lerp(tip, self.range(0.45, 1.0));
                let out = Vec2::from_angle(self.range(-1.25, 1.25)).rotate(along);
                let length = self.range(0.17, 0.27);
                self.needle(at, out, length, 0.009);
            }
        }
    }

    fn scales(&mut self) {
        let foot = vec2(0.5, 0.0);
        for turn in [-0.6f32, 0.6, -0.35, 0.35, -0.12, 0.12] {
            let along = up(turn);
            let reach = 0.95 - 0.3 * turn.abs();
            self.twig(foot, foot + along * reach, 0.01);
            for k in 1..20 {
                let t = k as f32 / 20.0;
                let side = if k % 2 == 0 { 1.0 } else { -1.0 };
                let out = Vec2::from_angle(side * self.range(0.35, 0.7)).rotate(along);
                let length = self.range(0.09, 0.2) * (1.2 - t);
                let at = foot + along * reach * t;
                for j in 0..5 {
                    let turned = Vec2::from_angle(self.range(-0.5, 0.5)).rotate(out);
                    self.needle(at + out * length * 0.2 * j as f32, turned, 0.07, 0.024);
                }
            }
        }
    }

    fn feather(&mut self) {
        for k in 0..44 {
            let t = k as f32 / 44.0;
            for side in [1.0, -1.0] {
                let at = vec2(0.5, 0.03 + 0.93 * t);
                let along = up(-side * (1.2 - 0.55 * t) + self.range(-0.07, 0.07));
                let length = 0.5 * (1.0 - 0.7 * t * t) * (0.5 + 0.5 * (t * 6.0).min(1.0)) * self.range(0.88, 1.06);
                let color = Vec3::splat(GREY) * self.range(0.75, 1.25);
                self.blade(Leaf { foot: at, along, length, width: 0.021, outline: Outline::Oval(0.6) }, color, 1.0);
            }
        }
        self.twig(vec2(0.5, 0.0), vec2(0.5, 0.98), 0.012);
    }

    fn fan(&mut self) {
        let hub = vec2(0.5, 0.33);
        self.twig(vec2(0.5, 0.0), hub, 0.014);
        for k in 0..46 {
            let turn = -2.1 + 4.2 * k as f32 / 45.0;
            let length = self.range(0.52, 0.62) * (1.0 - 0.2 * (turn / 2.1).powi(2));
            let color = Vec3::splat(GREY) * if k % 2 == 0 { 0.8 } else { 1.15 } * self.range(0.9, 1.1);
            self.blade(
                Leaf { foot: hub, along: up(turn), length, width: 0.05, outline: Outline::Oval(1.1) },
                color,
                1.0,
            );
        }
    }

    fn paddle(&mut self) {
        let color = Vec3::splat(GREY);
        let leaf =
            Leaf { foot: vec2(0.5, 0.12), along: Vec2::Y, length: 0.87, width: 0.42, outline: Outline::Oval(0.9) };
        self.blade(leaf, color, 1.0);
        self.twig(vec2(0.5, 0.0), vec2(0.5, 0.2), 0.02);
        // The wind tears it along its veins.
        for _ in 0..7 {
            let (t, side) = (self.range(0.3, 0.85), if self.random.chance(0.5) { 1.0 } else { -1.0 });
            let from = vec2(0.5 + side * self.range(0.08, 0.16), t);
            let along = vec2(side * 0.8, 0.6).normalize();
            self.canvas.rect(from - 0.2, from + 0.2, |p, texel| {
                let q = p - 0.2;
                let (along, off) = (q.dot(along), along.perp_dot(q));
                if along > 0.0 && off.abs() < 0.02 * along {
                    texel.alpha = 0.0;
                }
            });
        }
    }

    fn blades(&mut self) {
        for i in 0..34 {
            let turn = -0.8 + 1.6 * (i * 13 % 34) as f32 / 33.0;
            let length = self.range(0.6, 0.97) * (1.0 - 0.25 * turn.abs());
            let foot = vec2(0.5 + 0.16 * turn + self.range(-0.05, 0.05), 0.0);
            let width = self.range(0.016, 0.032);
            self.leaf(Leaf { foot, along: up(-turn * 0.8), length, width, outline: Outline::Oval(0.7) });
        }
    }

    fn flowers(&mut self) {
        // Heads are pale, so that paints colour them; the foot of the picture is leaves for the stalks.
        for i in 0..16 {
            let x = 0.1 + 0.8 * (i * 7 % 16) as f32 / 15.0;
            let (foot, head) = (vec2(0.3 + 0.4 * x, 0.0), vec2(x, self.range(0.55, 0.88)));
            self.twig(foot, head, 0.006);
            for k in 0..7 {
                let along = up(std::f32::consts::TAU * k as f32 / 7.0 + self.range(-0.2, 0.2));
                let color = Vec3::splat(0.85) * self.range(0.8, 1.1);
                let length = self.range(0.05, 0.075);
                let leaf = Leaf { foot: head, along, length, width: length * 0.7, outline: Outline::Oval(1.2) };
                self.blade(leaf, color, FALLS[1]);
            }
        }
    }
}

/// A direction turned to the left from straight up.
fn up(turn: f32) -> Vec2 {
    Vec2::from_angle(std::f32::consts::FRAC_PI_2 + turn)
}
