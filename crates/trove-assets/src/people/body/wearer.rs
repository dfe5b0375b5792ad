//! Someone at rest, and pieces of surface on them: skin, and cloth that hangs off it.

use glam::{Vec2, Vec3, vec3};
use trove_model::{HumanBody, Seed};

use super::pattern::{self, Pattern, Weights};
use super::skeleton::Skeleton;
use crate::surfaces::{hash, step};

/// A surface of someone at rest with what moves it.
#[derive(Clone, Debug, Default)]
pub(super) struct Piece {
    pub(super) positions: Vec<Vec3>,
    pub(super) weights: Vec<Weights>,
    pub(super) uvs: Vec<Vec2>,
    pub(super) tints: Vec<Vec3>,
    pub(super) triangles: Vec<[u32; 3]>,
    pub(super) slot: u16,
    /// Where each vertex lies in the body's own shape.
    pub(super) spots: Vec<Vec3>,
}

/// How cloth hangs.
#[derive(Clone, Copy, Debug)]
pub(super) struct Cut {
    /// How far it stands off the skin.
    pub(super) ease_m: f32,
    /// Least radii of a sleeve at shoulder, elbow and wrist.
    pub(super) sleeve_m: [f32; 3],
    /// Least radii of a leg at hip, knee and ankle.
    pub(super) leg_m: [f32; 3],
    /// 0 to 1: how straight it hangs down from chest and belly.
    pub(super) drape: f32,
    /// Depth of its folds.
    pub(super) folds_m: f32,
}

/// Someone in their own shape, at rest.
#[derive(Clone, Debug)]
pub(super) struct Wearer<'a> {
    pub(super) body: &'a HumanBody,
    pub(super) positions: Vec<Vec3>,
    pub(super) skeleton: Skeleton,
    /// Size against the body's own shape.
    pub(super) scale: f32,
    seed: Seed,
    /// Of each joint whether it is an arm's and a leg's.
    limbs: Vec<[f32; 2]>,
}

impl<'a> Wearer<'a> {
    pub(super) fn new(body: &'a HumanBody, positions: Vec<Vec3>, seed: Seed) -> Self {
        let skeleton = Skeleton::new(body, &positions);
        let base = Skeleton::new(body, &body.positions);
        let trunk = |s: &Skeleton| s.joints[s.find("head")].z - s.floor_m;
        let limbs = body.joints.iter().map(|j| {
            let is = |names: &[&str]| f32::from(u8::from(names.iter().any(|n| j.name.starts_with(n))));
            let hand = is(&["hand", "index", "middle", "ring", "pinky", "thumb"]);
            [is(&["upperarm", "lowerarm"]).max(hand), is(&["thigh", "calf", "foot", "ball"])]
        });
        let limbs = limbs.collect();
        Self { body, scale: trunk(&skeleton) / trunk(&base), positions, skeleton, seed, limbs }
    }

    /// A pattern right on the skin.
    pub(super) fn piece(&self, pattern: &Pattern, slot: u16) -> Piece {
        let n = pattern.spots.len();
        Piece {
            positions: pattern.spots.iter().map(|s| pattern::at(s, &self.positions)).collect(),
            weights: pattern.spots.iter().map(|s| pattern::weights_at(s, self.body)).collect(),
            uvs: vec![Vec2::ZERO; n],
            tints: vec![Vec3::ONE; n],
            triangles: pattern.triangles.clone(),
            slot,
            spots: pattern.spots.iter().map(|s| pattern::at(s, &self.body.positions)).collect(),
        }
    }

    /// A pattern as cloth, its open edges turned in to the skin.
    pub(super) fn cloth(&self, pattern: &Pattern, cut: &Cut, slot: u16) -> Piece {
        let mut piece = self.piece(pattern, slot);
        let skin = piece.positions.clone();
        self.hang(&mut piece, cut);
        piece.turn_in(pattern, &skin);
        piece
    }

    /// Moves a piece on the skin to where its cloth is.
    fn hang(&self, piece: &mut Piece, cut: &Cut) {
        let normals = normals(&piece.positions, &piece.triangles);
        let chain = |names: [&str; 3], side| names.map(|n| self.skeleton.at(n, side));
        let arms = [0, 1].map(|side| chain(["upperarm", "lowerarm", "hand"], side));
        let legs = [0, 1].map(|side| chain(["thigh", "calf", "foot"], side));
        let mut arm_shares = Vec::with_capacity(normals.len());
        for (i, &normal) in normals.iter().enumerate() {
            // It lies closer about the neck.
            let close =
                1.0 - 0.6 * step(0.5, 0.56, piece.spots[i].z) * (1.0 - step(0.09, 0.15, piece.spots[i].y.abs()));
            let mut p = piece.positions[i] + normal * cut.ease_m * close * self.scale;
            let side = usize::from(piece.spots[i].y < 0.0);
            let share = |limb: usize| -> f32 {
                piece.weights[i].iter().map(|&(j, weight)| self.limbs[usize::from(j)][limb] * weight).sum()
            };
            arm_shares.push(share(0));
            for (chain, radii, share) in [(arms[side], cut.sleeve_m, share(0)), (legs[side], cut.leg_m, share(1))] {
                let (axis, along) = nearest(&chain, p);
                let (k, t) = if along < 1.0 { (0, along) } else { (1, along - 1.0) };
                let least = (radii[k] + (radii[k + 1] - radii[k]) * t) * self.scale;
                let off = p - axis;
                let wide = axis + off * (least / off.length().max(1e-3)).max(1.0);
                p = p.lerp(wide, (share * 1.4 - 0.4).clamp(0.0, 1.0));
                // Sleeves and legs crease where they bend.
                let crease = (-((along - 1.0) * 5.0).powi(2)).exp() + 0.7 * (-((along - 1.95) * 8.0).powi(2)).exp();
                let wave = (along * 34.0 + 2.0 * self.noise(piece.spots[i] * 6.0, 1)).sin();
                p += off.normalize_or_zero() * crease * wave * cut.folds_m * 0.8 * share.clamp(0.0, 1.0);
            }
            let q = piece.spots[i];
            let fold = self.noise(q * vec3(11.0, 11.0, 4.5), 2) + 0.6 * self.noise(q * vec3(20.0, 20.0, 9.0), 3);
            piece.positions[i] = p + normal * (fold * 0.8 * cut.folds_m);
        }
        if cut.drape > 0.0 {
            self.drape(piece, &arm_shares, cut.drape);
        }
    }

    /// Lets cloth of the trunk hang down from what stands out above it.
    fn drape(&self, piece: &mut Piece, arm_shares: &[f32], drape: f32) {
        const BINS: usize = 32;
        let middle = (self.skeleton.at("thigh", 0) + self.skeleton.at("thigh", 1)) / 2.0 + Vec3::X * 0.01;
        let armpit = self.skeleton.at("upperarm", 0).z - 0.1 * self.scale;
        let mut order: Vec<usize> =
            (0..piece.positions.len()).filter(|&i| arm_shares[i] < 0.35 && piece.positions[i].z < armpit).collect();
        order.sort_by(|&a, &b| piece.positions[b].z.total_cmp(&piece.positions[a].z).then(a.cmp(&b)));
        let mut widest = [(0.0f32, armpit); BINS];
        for i in order {
            let p = piece.positions[i];
            let off = (p - middle).truncate();
            let r = off.length();
            let bin = (off.y.atan2(off.x) / std::f32::consts::TAU + 0.5) * BINS as f32;
            // Cloth comes in again slowly below what holds it out.
            let hung = |bin: usize| widest[bin % BINS].0 - 0.12 * (widest[bin % BINS].1 - p.z);
            let (low, t) = (bin.floor() as usize, bin.fract());
            let wide = (hung(low + BINS - 1) * (1.0 - t) + hung(low) * 1.0 + hung(low + 1) * t) / 2.0;
            let wide = r + (wide.min(hung(low)) - r).max(0.0) * drape;
            let moved = middle.truncate() + off * (wide / r.max(1e-3));
            piece.positions[i] = moved.extend(p.z);
            let here = &mut widest[low % BINS];
            if r >= here.0 - 0.12 * (here.1 - p.z) {
                *here = (r, p.z);
            }
        }
    }

    /// Smooth noise about −1 to 1, with features of 1.
    pub(super) fn noise(&self, p: Vec3, layer: u32) -> f32 {
        let seed = (self.seed.0 as u32).wrapping_add(layer.wrapping_mul(977));
        let (cell, f) = (p.floor(), p - p.floor());
        let w = f * f * (3.0 - 2.0 * f);
        let corner = |x: f32, y: f32, z: f32| {
            let c = cell + vec3(x, y, z);
            hash(c.x as i32 + 57 * c.z as i32, c.y as i32, seed)
        };
        let mix = |a: f32, b: f32, t: f32| a + (b - a) * t;
        let face = |z: f32| {
            let low = mix(corner(0.0, 0.0, z), corner(1.0, 0.0, z), w.x);
            mix(low, mix(corner(0.0, 1.0, z), corner(1.0, 1.0, z), w.x), w.y)
        };
        2.0 * mix(face(0.0), face(1.0), w.z) - 1.0
    }

    /// A band along points of the body's own shape, `width_m` wide, that lies on what is worn.
    pub(super) fn strap(&self, path: &[Vec3], worn: &[&Piece], width_m: f32, slot: u16) -> Piece {
        let mut row = Vec::new();
        for pair in path.windows(2) {
            let steps = (pair[0].distance(pair[1]) / 0.035).ceil().max(1.0) as usize;
            row.extend((0..steps).map(|k| pair[0].lerp(pair[1], k as f32 / steps as f32)));
        }
        row.extend(path.last());
        let normals: Vec<Vec<Vec3>> = worn.iter().map(|w| normals(&w.positions, &w.triangles)).collect();
        let vertices = || worn.iter().zip(&normals).flat_map(|(w, n)| (0..n.len()).map(move |i| (*w, n[i], i)));
        let mut piece = Piece { slot, ..Piece::default() };
        for (i, &p) in row.iter().enumerate() {
            // The three nearest vertices say where the cloth is.
            let mut near: Vec<(f32, (&Piece, Vec3, usize))> =
                vertices().map(|v| (v.0.spots[v.2].distance_squared(p), v)).collect();
            near.sort_by(|a, b| a.0.total_cmp(&b.0));
            near.truncate(3);
            let (mut place, mut outward, mut sum) = (Vec3::ZERO, Vec3::ZERO, 0.0);
            for (distance, (w, n, v)) in &near {
                let share = 1.0 / (distance + 1e-4);
                place += (w.positions[*v] + (p - w.spots[*v]) * self.scale) * share;
                outward += *n * share;
                sum += share;
            }
            let Some((_, (nearest, _, v))) = near.first() else { continue };
            let (place, outward) = (place / sum, outward.normalize_or(Vec3::X));
            let along = (row[(i + 1).min(row.len() - 1)] - row[i.saturating_sub(1)]).normalize_or(Vec3::Z);
            let across = outward.cross(along).normalize_or(Vec3::Y);
            for (side, lift) in [(-0.5, -0.012), (-0.5, 0.011), (0.5, 0.011), (0.5, -0.012)] {
                piece.positions.push(place + across * side * width_m + outward * lift);
                piece.weights.push(nearest.weights[*v]);
                piece.uvs.push(Vec2::ZERO);
                piece.tints.push(Vec3::ONE);
                piece.spots.push(p);
            }
        }
        for base in (4..piece.positions.len() as u32).step_by(4) {
            for k in 0..3 {
                let (a, b) = (base - 4 + k, base + k);
                piece.triangles.extend([[a, b + 1, a + 1], [a, b, b + 1]]);
            }
        }
        piece
    }
}

impl Piece {
    /// Closes the gap between open edges and the skin: a strip from each edge to a little below it.
    pub(super) fn turn_in(&mut self, pattern: &Pattern, skin: &[Vec3]) {
        let edges = pattern.open_edges();
        let mut made = std::collections::BTreeMap::new();
        for v in edges.iter().flatten() {
            made.entry(*v).or_insert_with(|| {
                let i = *v as usize;
                let first = self.positions.len() as u32;
                let inward = (skin[i] - self.positions[i]).normalize_or_zero();
                for p in [self.positions[i], skin[i] + inward * 0.004] {
                    self.positions.push(p);
                    self.weights.push(self.weights[i]);
                    self.uvs.push(self.uvs[i]);
                    self.tints.push(self.tints[i]);
                    self.spots.push(self.spots[i]);
                }
                first
            });
        }
        for [a, b] in edges {
            let (a, b) = (made[&a], made[&b]);
            self.triangles.extend([[b, a, a + 1], [b, a + 1, b + 1]]);
        }
    }

    /// Moves the triangles whose middle is `inside`, a place in the body's own shape, to a piece in another slot.
    pub(super) fn divide(mut self, slot: u16, inside: impl Fn(Vec3) -> bool) -> [Self; 2] {
        let middle = |t: &[u32; 3]| t.iter().map(|&i| self.spots[i as usize]).sum::<Vec3>() / 3.0;
        let (chosen, rest) = self.triangles.iter().partition(|t| inside(middle(t)));
        let other = Self { triangles: chosen, slot, ..self.clone() };
        self.triangles = rest;
        [self, other].map(Self::without_unused_vertices)
    }

    fn without_unused_vertices(self) -> Self {
        let mut kept = Self { slot: self.slot, ..Self::default() };
        let mut place = std::collections::HashMap::new();
        for t in &self.triangles {
            let t = t.map(|i| {
                *place.entry(i).or_insert_with(|| {
                    let i = i as usize;
                    kept.positions.push(self.positions[i]);
                    kept.weights.push(self.weights[i]);
                    kept.uvs.push(self.uvs[i]);
                    kept.tints.push(self.tints[i]);
                    kept.spots.push(self.spots[i]);
                    kept.positions.len() as u32 - 1
                })
            });
            kept.triangles.push(t);
        }
        kept
    }

    /// Multiplies the colour where a point of the body's own shape says so.
    pub(super) fn tinted(mut self, tint: impl Fn(Vec3) -> Vec3) -> Self {
        self.tints.iter_mut().zip(&self.spots).for_each(|(t, &p)| *t *= tint(p));
        self
    }

    /// Every vertex put elsewhere.
    pub(super) fn moved(mut self, map: impl Fn(Vec3, Vec3) -> Vec3) -> Self {
        self.positions.iter_mut().zip(&self.spots).for_each(|(p, &spot)| *p = map(*p, spot));
        self
    }

    /// A form that hangs stiffly on a joint, or on two in shares.
    pub(super) fn stiff(shape: crate::shape::Shape, joint: usize, slot: u16) -> Self {
        let n = shape.positions.len();
        Self {
            weights: vec![[(joint as u16, 1.0), (0, 0.0), (0, 0.0), (0, 0.0)]; n],
            tints: vec![Vec3::ONE; n],
            spots: shape.positions.clone(),
            uvs: shape.uvs,
            positions: shape.positions,
            triangles: shape.triangles,
            slot,
        }
    }
}

/// Normals weighted with the faces' areas.
pub(super) fn normals(positions: &[Vec3], triangles: &[[u32; 3]]) -> Vec<Vec3> {
    let mut sums = vec![Vec3::ZERO; positions.len()];
    for t in triangles {
        let [a, b, c] = t.map(|i| positions[i as usize]);
        let face = (b - a).cross(c - a);
        t.iter().for_each(|&i| sums[i as usize] += face);
    }
    sums.into_iter().map(|n| n.normalize_or(Vec3::Z)).collect()
}

/// The nearest point of a chain of three points, and where along it that is, 0 to 2.
pub(super) fn nearest(chain: &[Vec3; 3], p: Vec3) -> (Vec3, f32) {
    let on = |k: usize| {
        let axis = chain[k + 1] - chain[k];
        let t = ((p - chain[k]).dot(axis) / axis.length_squared()).clamp(0.0, 1.0);
        (chain[k] + axis * t, k as f32 + t)
    };
    let (one, other) = (on(0), on(1));
    if one.0.distance_squared(p) <= other.0.distance_squared(p) { one } else { other }
}
