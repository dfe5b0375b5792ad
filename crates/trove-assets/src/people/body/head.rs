//! Faces, eyes and hair. Places are those of the body's own shape, in metres.

use std::f32::consts::{PI, TAU};

use glam::{Vec2, Vec3, vec2, vec3};
use serde::Deserialize;
use trove_model::Material;

use super::pattern::Pattern;
use super::wearer::{Piece, Wearer, normals};
use crate::shape::Shape;
use crate::surfaces::{Canvas, Noise, Texel, step};

/// What the map of the face covers: away from the middle, and up from below the chin.
const MAP_M: [f32; 2] = [0.22, 0.26];
const MAP_FROM_M: f32 = 0.6;
/// From this height on it is the skull.
const SKULL_M: f32 = 0.74;

/// How hair is worn.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "snake_case")]
pub(super) enum HairCut {
    /// Cropped, with the crown bare.
    Receding,
    Cropped,
    Short,
    /// To the jaw.
    Bob,
    /// To below the shoulders.
    Long,
    Bun,
    Tail,
    Afro,
    /// None to be seen.
    Covered,
}

/// How far from the middle of the face a point is, along the skin to the back of the head.
fn across(p: Vec3) -> f32 {
    let y = p.y.abs();
    let behind = ((0.03 - p.x) / 0.03).clamp(0.0, 1.0);
    y + 0.8 * (0.125 - p.x).max(0.0) + 2.0 * (0.078 - y).max(0.0) * behind
}

/// Height above the hairline.
fn above_hairline(across: f32, z: f32) -> f32 {
    const LINE: [Vec2; 12] = [
        vec2(0.0, 0.808),
        vec2(0.04, 0.802),
        vec2(0.06, 0.786),
        vec2(0.08, 0.762),
        vec2(0.095, 0.735),
        vec2(0.108, 0.706),
        vec2(0.114, 0.70),
        vec2(0.119, 0.748),
        vec2(0.158, 0.748),
        vec2(0.166, 0.70),
        vec2(0.178, 0.668),
        vec2(0.2, 0.655),
    ];
    let next = LINE.iter().position(|p| p.x >= across);
    let line = match next {
        Some(0) => LINE[0].y,
        Some(i) => {
            let (a, b) = (LINE[i - 1], LINE[i]);
            a.y + (b.y - a.y) * (across - a.x) / (b.x - a.x)
        }
        None => LINE[LINE.len() - 1].y,
    };
    z - line
}

fn above_hair_of(cut: HairCut, across: f32, z: f32) -> f32 {
    let above = above_hairline(across, z);
    if cut == HairCut::Receding { above.min((0.79 - z) + (across - 0.1) * 0.3) } else { above }
}

/// Where on the map of the face a point of the skin is.
pub(super) fn uv(p: Vec3) -> Vec2 {
    vec2(across(p) / MAP_M[0], (p.z - MAP_FROM_M) / MAP_M[1]).clamp(Vec2::splat(0.004), Vec2::splat(0.996))
}

/// How a face is painted.
#[derive(Clone, Copy, Debug)]
pub(super) struct Face<'a> {
    pub(super) name: &'a str,
    pub(super) brows: f32,
    pub(super) lips: Vec3,
    /// 0 shaven, 1 a full beard.
    pub(super) beard: f32,
    pub(super) wrinkles: f32,
    /// How much of the scalp's hair shows through.
    pub(super) hair: HairCut,
}

impl Face<'_> {
    /// Skin that knows the face; its base colour is the skin's lightest.
    pub(super) fn material(&self) -> Material {
        let spots = Noise::new(Vec2::from_array(MAP_M), 0.012, 71);
        let fine = Noise::new(Vec2::from_array(MAP_M), 0.004, 72);
        let canvas = Canvas::new([192, 224], MAP_M, |p| self.texel(p.x, p.y + MAP_FROM_M, spots.fbm(p, 3), fine.at(p)));
        Material {
            base_color_map: Some(canvas.color(&format!("face-{}", self.name))),
            subsurface: 0.6,
            ..Material::plain("skin", Vec3::splat(0.4), 0.47)
        }
    }

    fn texel(&self, a: f32, z: f32, spots: f32, fine: f32) -> Texel {
        let mut c = Vec3::ONE * (0.93 + 0.05 * spots);
        let mut times = |by: Vec3, share: f32| c *= Vec3::ONE.lerp(by, share.clamp(0.0, 1.0));
        let near = |x: f32, y: f32, rx: f32, ry: f32| {
            let d = vec2((a - x) / rx, (z - y) / ry).length();
            1.0 - step(0.6, 1.3, d)
        };
        // Blood in cheeks, nose, ears; shade in the sockets of the eyes.
        times(vec3(1.0, 0.84, 0.82), near(0.045, 0.695, 0.022, 0.018) * 0.8);
        times(vec3(1.0, 0.82, 0.8), near(0.0, 0.692, 0.014, 0.014) * 0.8);
        times(vec3(1.0, 0.82, 0.8), near(0.137, 0.71, 0.014, 0.03) * 0.7);
        times(vec3(0.74, 0.64, 0.62), near(0.031, 0.731, 0.021, 0.012) * 0.75);
        times(vec3(0.8, 0.74, 0.74), near(0.028, 0.713, 0.017, 0.004) * (0.35 + 0.5 * self.wrinkles));
        // Lids: a dark line above, a fainter one below.
        let lid = |height: f32| 0.7285 + height * (1.0 - ((a - 0.0315) / 0.0175).powi(2)).max(0.0);
        let within = step(0.0135, 0.016, a) * (1.0 - step(0.047, 0.0495, a));
        times(Vec3::splat(0.12), within * (1.0 - step(0.001, 0.0026, (z - lid(0.0062)).abs())));
        times(vec3(0.5, 0.4, 0.4), 0.7 * within * (1.0 - step(0.0006, 0.0018, (z - lid(-0.0058)).abs())));
        // Brows.
        let rise = 0.7478 + 0.0045 * ((a - 0.012) / 0.04 * PI * 0.8).sin();
        let thick = 0.0042 * self.brows * (1.0 - ((a - 0.025) / 0.034).powi(2)).max(0.0).sqrt();
        let hairs = 0.75 + 0.35 * fine;
        let brow = (1.0 - step(0.5, 1.15, (z - rise).abs() / thick.max(1e-5))) * step(0.008, 0.013, a);
        times(vec3(0.16, 0.12, 0.1), brow * 0.85 * hairs);
        // Nostrils, the fold beside them, the mouth.
        times(vec3(0.3, 0.2, 0.2), near(0.0075, 0.6825, 0.0045, 0.003) * 0.8);
        let fold = (a - (0.017 + (0.69 - z) * 0.42)).abs();
        let along_fold = step(0.648, 0.655, z) * (1.0 - step(0.683, 0.693, z));
        times(Vec3::splat(0.72), along_fold * (1.0 - step(0.0, 0.003, fold)) * (0.2 + 0.8 * self.wrinkles));
        let wide = (1.0 - (a / 0.0245).powi(2)).max(0.0);
        let upper = 0.6615 + 0.0085 * wide.sqrt() * (1.0 - 0.22 * (1.0 - step(0.0, 0.006, a)));
        let lower = 0.6600 - 0.0125 * wide.powf(0.7);
        let lips = step(0.0, 0.0016, upper - z) * step(0.0, 0.0022, z - lower) * step(0.0, 0.15, wide);
        times(self.lips, lips);
        times(vec3(0.35, 0.2, 0.2), step(0.0, 0.2, wide) * (1.0 - step(0.0004, 0.0017, (z - 0.6612).abs())));
        times(Vec3::splat(0.88), near(0.0, 0.6435, 0.013, 0.003) * 0.6);
        // Lines of age.
        let lines =
            (((z - 0.77) * 520.0).sin() * 0.5 + 0.5).powi(6) * step(0.762, 0.77, z) * (1.0 - step(0.79, 0.798, z));
        times(Vec3::splat(0.8), lines * self.wrinkles * (1.0 - step(0.03, 0.05, a)));
        times(Vec3::splat(0.85), self.wrinkles * 0.5 * (0.5 + spots));
        // Beard: jaw, chin, above the lip; none on the lips.
        let jaw = 1.0 - step(0.0, 0.012, z - (0.654 + 0.55 * (a - 0.03).max(0.0)));
        let lip = step(0.672, 0.675, z) * (1.0 - step(0.678, 0.684, z)) * (1.0 - step(0.02, 0.028, a));
        let beard = jaw.max(lip) * (1.0 - step(0.1, 0.118, a)) * (1.0 - lips) * step(0.603, 0.612, z);
        let stubble = vec3(0.62, 0.63, 0.66).lerp(vec3(0.1, 0.08, 0.07), step(0.3, 0.9, self.beard));
        times(stubble, beard * step(0.0, 0.25, self.beard) * (0.8 + 0.3 * fine));
        // Hair that is short at its edge.
        if self.hair != HairCut::Covered {
            let edge = above_hair_of(self.hair, a, z) + 0.003 * fine;
            times(vec3(0.2, 0.16, 0.14), step(-0.004, 0.012, edge) * 0.9);
        }
        Texel::new(c.clamp(Vec3::ZERO, Vec3::ONE), 0.5)
    }
}

impl Wearer<'_> {
    /// Skin, with the face's map.
    pub(super) fn skin(&self, pattern: &Pattern, slot: u16) -> Piece {
        let mut piece = self.piece(pattern, slot);
        piece.uvs = piece.spots.iter().map(|&p| uv(p)).collect();
        piece
    }

    /// Maps points of the body's own head onto this one's.
    pub(super) fn head_fit(&self) -> impl Fn(Vec3) -> Vec3 + use<> {
        let skull = self.body.positions.iter().enumerate().filter(|(i, p)| *i < 13_380 && p.z > SKULL_M);
        let (mut own, mut base) = ((Vec3::MAX, Vec3::MIN), (Vec3::MAX, Vec3::MIN));
        for (i, &p) in skull {
            let q = self.positions[i];
            (own, base) = ((own.0.min(q), own.1.max(q)), (base.0.min(p), base.1.max(p)));
        }
        let scale = (own.1 - own.0) / (base.1 - base.0).max(Vec3::splat(1e-3));
        move |p| own.0 + (p - base.0) * scale
    }

    /// Both eyes.
    pub(super) fn eyes(&self, iris: Vec3, slot: u16) -> Vec<Piece> {
        let head = self.skeleton.find("head");
        ["helper-l-eye", "helper-r-eye"]
            .iter()
            .filter_map(|name| {
                let vertices = self.body.groups.get(*name)?.iter().flatten();
                let (low, high) = vertices.fold((Vec3::MAX, Vec3::MIN), |(low, high), &v| {
                    let p = self.positions[v as usize];
                    (low.min(p), high.max(p))
                });
                let (middle, radius) = ((low + high) / 2.0, (high.y - low.y) / 2.0);
                // Pupil, iris, white: rings about the line of sight, colours that meet without a gradient.
                let rings = [(0.0, 0), (0.16, 0), (0.16, 1), (0.46, 1), (0.46, 2), (0.95, 2), (1.6, 2)];
                let colours = [Vec3::splat(0.015), iris, Vec3::splat(0.75)];
                let mut shape = Shape::default();
                let mut tints = Vec::new();
                for &(angle, colour) in &rings {
                    for k in 0..9 {
                        let around = TAU * k as f32 / 9.0;
                        let (s, c) = f32::sin_cos(angle);
                        shape.positions.push(middle + vec3(c, s * around.cos(), s * around.sin()) * radius);
                        tints.push(colours[colour]);
                    }
                }
                for (i, pair) in rings.windows(2).enumerate() {
                    let (a, b) = (9 * i as u32, 9 * (i as u32 + 1));
                    for k in (0..9).filter(|_| pair[0].0 != pair[1].0) {
                        let n = (k + 1) % 9;
                        shape.triangles.push([a + k, b + k, b + n]);
                        if i > 0 {
                            shape.triangles.push([a + k, b + n, a + n]);
                        }
                    }
                }
                shape.uvs = vec![Vec2::ZERO; shape.positions.len()];
                Some(Piece { tints, ..Piece::stiff(shape, head, slot) })
            })
            .collect()
    }

    /// Hair as shells over the scalp, and what hangs from it.
    pub(super) fn hair(&self, cut: HairCut, scalp: &Pattern, slot: u16) -> Vec<Piece> {
        let thick = match cut {
            HairCut::Covered => return Vec::new(),
            HairCut::Receding => 0.006,
            HairCut::Cropped => 0.007,
            HairCut::Bun | HairCut::Tail => 0.011,
            HairCut::Short => 0.02,
            HairCut::Bob | HairCut::Long => 0.02,
            HairCut::Afro => 0.055,
        } * self.scale;
        // Its edge is where the strands of its map end.
        let pattern = scalp.cut(self.body, |p| above_hair_of(cut, across(p), p.z) + 0.008);
        let mut shell = self.piece(&pattern, slot);
        let out = normals(&shell.positions, &shell.triangles);
        for (i, out) in out.iter().enumerate() {
            let p = shell.spots[i];
            let above = above_hair_of(cut, across(p), p.z);
            let clump = self.noise(p * vec3(26.0, 26.0, 14.0), 11) + 0.5 * self.noise(p * 60.0, 12);
            let top = if cut == HairCut::Short { 0.55 + 0.45 * step(0.76, 0.82, p.z) } else { 1.0 };
            let lift = 0.0025 + thick * top * step(-0.002, 0.03, above) * (1.0 + 0.22 * clump);
            shell.positions[i] += *out * lift;
            shell.tints[i] = Vec3::splat(0.85 + 0.3 * clump);
            shell.uvs[i] = vec2((across(p) * 5.0).copysign(p.y), ((above + 0.008) / 0.06).clamp(0.01, 0.96));
        }
        let mut pieces = vec![shell];
        match cut {
            HairCut::Long => pieces.push(self.curtain(0.5, slot)),
            HairCut::Bob => pieces.push(self.curtain(0.625, slot)),
            HairCut::Bun | HairCut::Tail => {
                let fit = self.head_fit();
                let head = self.skeleton.find("head");
                let ball =
                    Shape::ellipsoid(vec3(0.035, 0.038, 0.036) * self.scale, 10).moved(fit(vec3(-0.055, 0.0, 0.775)));
                let tail = [
                    (-0.05, 0.76, 0.016),
                    (-0.085, 0.75, 0.024),
                    (-0.1, 0.7, 0.027),
                    (-0.09, 0.63, 0.024),
                    (-0.085, 0.57, 0.012),
                ];
                let rings: Vec<Vec<Vec3>> = tail
                    .iter()
                    .map(|&(x, z, r)| {
                        let ring = (0..8).map(|k| TAU * k as f32 / 8.0);
                        ring.map(|t| fit(vec3(x + r * t.cos(), -r * t.sin(), z))).collect()
                    })
                    .collect();
                let shape = if cut == HairCut::Bun { ball } else { Shape::loft(&rings) };
                pieces.push(Piece::stiff(shape, head, slot));
            }
            _ => {}
        }
        pieces
    }

    /// Hair from the crown down to a height, around the back from cheek to cheek.
    fn curtain(&self, to_m: f32, slot: u16) -> Piece {
        const ACROSS: usize = 15;
        let fit = self.head_fit();
        let rows = 7;
        let rings: Vec<Vec<Vec3>> = (0..=rows)
            .map(|i| {
                let t = i as f32 / rows as f32;
                let z = 0.775 + (to_m - 0.775) * t;
                // The curtain follows the skull, closes in at the nape and lies on the shoulders.
                let back = 0.108 - 0.012 * (t * PI).sin() + 0.02 * t * step(0.62, 0.5, z);
                let side = 0.093 + 0.012 * t;
                let half = 2.18 - 0.75 * t * t;
                let point = |k: usize, inner: f32| {
                    let b = half * (2.0 * k as f32 / (ACROSS - 1) as f32 - 1.0);
                    let strand =
                        0.004 * self.noise(vec3(b * 6.0, t * 1.5, 0.0), 13) + 0.003 * (b * 17.0 + t * 2.0).sin();
                    let (r, s) = (back + strand - inner, side + strand - inner);
                    fit(vec3(0.047 - b.cos() * r, b.sin() * s, z))
                };
                let outer = (0..ACROSS).map(|k| point(k, 0.0));
                outer.chain((0..ACROSS).rev().map(|k| point(k, 0.014 - 0.006 * t))).collect()
            })
            .collect();
        let shape = Shape::loft(&rings);
        let (head, chest) = (self.skeleton.find("head"), self.skeleton.find("spine_03"));
        let (high, low) = (fit(Vec3::Z * 0.66).z, fit(Vec3::Z * 0.56).z);
        let mut piece = Piece::stiff(shape, head, slot);
        for (weights, p) in piece.weights.iter_mut().zip(&piece.positions) {
            let share = step(low, high, p.z);
            *weights = [(head as u16, share), (chest as u16, 1.0 - share), (0, 0.0), (0, 0.0)];
        }
        let end = fit(Vec3::Z * to_m).z - 0.01;
        for (uv, p) in piece.uvs.iter_mut().zip(&piece.positions) {
            *uv = vec2((p.y * 5.0) + p.x * 4.0, ((p.z - end) / 0.09).clamp(0.02, 0.96));
        }
        piece
    }

    /// A cloth about head and neck that leaves the face free, lifted off the head.
    pub(super) fn headscarf(&self, skin: &Pattern, lift_m: f32, slot: u16) -> Piece {
        let pattern = skin.cut(self.body, |p| {
            let oval = vec2(across(p) / 0.068, (p.z - 0.712) / 0.098).length() - 1.0;
            (oval * 0.06).min(p.z - 0.56)
        });
        let mut piece = self.piece(&pattern, slot);
        let skin = piece.positions.clone();
        // Ears lie flat under it, and every vertex goes towards the middle of its neighbours.
        let fit = self.head_fit();
        let is_ear = |q: Vec3| q.y.abs() > 0.0745 && q.x < 0.1 && (0.66..0.77).contains(&q.z);
        let flat = |q: Vec3| fit(vec3(q.x, 0.0745f32.copysign(q.y), q.z));
        let mut soft: Vec<Vec3> =
            skin.iter().zip(&piece.spots).map(|(&p, &q)| if is_ear(q) { flat(q) } else { p }).collect();
        for _ in 0..6 {
            let mut sums = vec![(Vec3::ZERO, 0.0f32); soft.len()];
            for t in &piece.triangles {
                for k in 0..3 {
                    let (i, j) = (t[k] as usize, t[(k + 1) % 3] as usize);
                    sums[i] = (sums[i].0 + soft[j], sums[i].1 + 1.0);
                    sums[j] = (sums[j].0 + soft[i], sums[j].1 + 1.0);
                }
            }
            soft.iter_mut().zip(sums).for_each(|(p, (sum, count))| *p = p.lerp(sum / count.max(1.0), 0.6));
        }
        let out = normals(&soft, &piece.triangles);
        for i in 0..soft.len() {
            let q = piece.spots[i];
            let below = 1.0 - step(0.6, 0.68, q.z);
            let fold = self.noise(vec3(q.x * 14.0, q.y * 14.0, q.z * 30.0), 21);
            let lift = 0.008 + (lift_m - 0.008) * (1.0 - below) + 0.005 * fold;
            let wanted = soft[i] + out[i] * lift * self.scale;
            // It never goes below the skin.
            let under = (skin[i] + out[i] * 0.006 - wanted).dot(out[i]).max(0.0);
            piece.positions[i] = if is_ear(q) { wanted } else { wanted + out[i] * under };
        }
        piece.turn_in(&pattern, &skin);
        piece
    }
}
