//! Cranks of bicycles, found by their shape below a rider's feet: they turn with the wheels, pedals stay level, and legs follow.

use std::f32::consts::TAU;

use glam::{Mat3, Quat, Vec2, Vec3};
use trove_model::{Keypoints, Mesh};

use super::legs::{bones, nearest, put_knees_and_ankles, side_shares};

/// Turns of the rear wheel a turn of the cranks: the middle of a city bicycle's gears.
pub(super) const GEAR: f64 = 2.5;
/// Pedals are no larger than this, nor as high as cranks, metres …
const PEDAL_M: f32 = 0.15;
const FLAT_M: f32 = 0.07;
/// … nor farther from the ankle above, along and upwards.
const BELOW_M: [f32; 2] = [0.2, 0.25];
/// Lengths of cranks, metres.
const CRANKS_M: std::ops::RangeInclusive<f32> = 0.08..=0.25;
/// What is so near to an axle or to a pedal's hangs on it, metres.
const NEAR_M: f32 = 0.03;
/// Half a pedal, metres.
const HALF_M: f32 = 0.08;
/// Chain wheels: their radii, and how thick they are at most, metres.
const CHAIN_WHEEL_M: std::ops::RangeInclusive<f32> = 0.04..=0.15;
const THIN_M: f32 = 0.02;
/// Clothes are no farther from the joint that they surround, metres, and are there in so many of eight directions.
const CLOTHES_M: f32 = 0.15;
const SURROUNDS: usize = 7;
/// From where to where along the thigh the trunk goes over into it, and along the leg the thigh into the shank, in bones.
const HIP: [f32; 2] = [-0.1, 0.3];
const KNEE: [f32; 2] = [0.88, 1.12];

/// The cranks of a bicycle and the legs that turn them.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Pedals {
    /// Middle of the cranks' axle, x and z in the mesh's metres.
    axle: Vec2,
    /// From there to the left and the right pedal.
    cranks: [Vec2; 2],
    /// What turns.
    turning: Vec<u32>,
    /// The left and the right pedal with the foot on it.
    level: [Vec<u32>; 2],
    legs: Vec<Part>,
    /// Hips, knees and ankles.
    bones: [[Vec3; 3]; 2],
}

/// A vertex of what is worn on legs.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Part {
    vertex: u32,
    /// How much it hangs on the left and on the right leg.
    sides: [f32; 2],
    /// How much of that on the thigh and the shank, and how much of these on the shank.
    leg: f32,
    shank: f32,
}

/// A leg as it turns a crank.
struct Turned {
    hip: Vec3,
    thigh: Mat3,
    knees: [Vec3; 2],
    shank: Mat3,
    ankle: Vec3,
}

impl Pedals {
    /// Of someone who rides, as a mesh whose parts are told and x of which is forward; `None` where there are no pedals below
    /// the feet.
    pub(super) fn new(mesh: &Mesh, parts: &[Vec<u32>], keypoints: &Keypoints<Vec3>) -> Option<Self> {
        let at = |i: &u32| mesh.positions[*i as usize];
        let flat = |p: Vec3| Vec2::new(p.x, p.z);
        let bounds = |part: &[u32]| {
            part.iter().map(at).fold((Vec3::INFINITY, Vec3::NEG_INFINITY), |(a, b), p| (a.min(p), b.max(p)))
        };
        let bones = [0, 1].map(|side| bones(keypoints, side));
        let pedal = |[_, _, ankle]: [Vec3; 3]| {
            let is_below = |(low, high): &(Vec3, Vec3)| {
                let off = (*low + *high) / 2.0 - ankle;
                (*high - *low).max_element() < PEDAL_M
                    && (*high - *low).z < FLAT_M
                    && off.x.abs() < BELOW_M[0]
                    && (-BELOW_M[1]..0.0).contains(&off.z)
                    && off.y.abs() < HALF_M
            };
            let found = parts.iter().map(|part| bounds(part)).filter(is_below);
            let volume = |(low, high): &(Vec3, Vec3)| (*high - *low).element_product();
            found.max_by(|a, b| volume(a).total_cmp(&volume(b))).map(|(low, high)| (low + high) / 2.0)
        };
        let pedals = [pedal(bones[0])?, pedal(bones[1])?];
        let axle = (flat(pedals[0]) + flat(pedals[1])) / 2.0;
        let cranks = pedals.map(|pedal| flat(pedal) - axle);
        let length_m = cranks[0].length();
        if !CRANKS_M.contains(&length_m) {
            return None;
        }
        let (mut turning, mut level, mut legs) = (Vec::new(), [Vec::new(), Vec::new()], Vec::new());
        for part in parts {
            let (low, high) = bounds(part);
            let all = |near: &dyn Fn(Vec3) -> bool| part.iter().map(at).all(near);
            let any = |near: &dyn Fn(Vec3) -> bool| part.iter().map(at).any(near);
            let about_axle = |p: Vec3| flat(p).distance(axle) < length_m + NEAR_M;
            let side = usize::from(low.y + high.y < 0.0);
            let near_pedal = |p: Vec3| flat(p).distance(flat(pedals[side])) < NEAR_M;
            let is_crank = all(&about_axle) && any(&|p| flat(p).distance(axle) < NEAR_M) && any(&near_pedal);
            let radius_m = (high - low).x / 2.0;
            let is_chain_wheel = flat(low + high).distance(2.0 * axle) < NEAR_M / 2.0
                && CHAIN_WHEEL_M.contains(&radius_m)
                && (high - low).y < THIN_M;
            let is_on_pedal = |p: Vec3| flat(p).distance(flat(pedals[side])) < HALF_M && p.y.abs() > NEAR_M;
            let worn = |side: usize| {
                let [_, knee, ankle] = bones[side];
                let axis = ankle - knee;
                [(knee, axis), (ankle, Vec3::Z)].map(|(joint, axis)| surrounds(part.iter().map(at), joint, axis))
            };
            let [left, right] = [worn(0), worn(1)];
            if left[0] || right[0] {
                legs.extend(part.iter().map(|i| Part::new(*i, at(i), &bones)));
            } else if left[1] || right[1] {
                level[usize::from(right[1])].extend(part);
            } else if is_crank || is_chain_wheel {
                turning.extend(part);
            } else if all(&is_on_pedal) {
                level[side].extend(part);
            }
        }
        (!turning.is_empty() && !legs.is_empty()).then_some(Self { axle, cranks, turning, level, legs, bones })
    }

    /// Turns the cranks of a mesh so far forward, radians.
    pub(super) fn turn(&self, mesh: &mut Mesh, turn_rad: f64) {
        let turn = forward(turn_rad);
        for &i in &self.turning {
            let position = &mut mesh.positions[i as usize];
            let off = turn.rotate(Vec2::new(position.x, position.z) - self.axle);
            (position.x, position.z) = (self.axle.x + off.x, self.axle.y + off.y);
            if let Some(normal) = mesh.normals.get_mut(i as usize) {
                let turned = turn.rotate(Vec2::new(normal.x, normal.z));
                (normal.x, normal.z) = (turned.x, turned.y);
            }
        }
        for (side, level) in self.level.iter().enumerate() {
            let shift = self.shift(side, turn_rad);
            level.iter().for_each(|i| mesh.positions[*i as usize] += shift);
        }
        let turned = [0, 1].map(|side| self.leg(side, turn_rad));
        for Part { vertex, sides, leg, shank } in &self.legs {
            let from = mesh.positions[*vertex as usize];
            let mut moved = Vec3::ZERO;
            let mut turn = Mat3::ZERO;
            for (side, share) in sides.iter().enumerate() {
                let Turned { hip, thigh, knees, shank: below, .. } = &turned[side];
                let (upper, lower) = (*hip + *thigh * (from - *hip), knees[1] + *below * (from - knees[0]));
                moved += (upper.lerp(lower, *shank) - from) * *leg * *share;
                let blend = *thigh * (1.0 - shank) + *below * *shank;
                turn += (blend * *leg + Mat3::IDENTITY * (1.0 - leg)) * *share;
            }
            mesh.positions[*vertex as usize] = from + moved;
            if let Some(normal) = mesh.normals.get_mut(*vertex as usize) {
                *normal = (turn * *normal).try_normalize().unwrap_or(*normal);
            }
        }
    }

    /// Moves knees and ankles likewise.
    pub(super) fn turn_points(&self, keypoints: &mut Keypoints<Vec3>, turn_rad: f64) {
        let turned = [0, 1].map(|side| self.leg(side, turn_rad));
        put_knees_and_ankles(keypoints, turned.map(|leg| [leg.knees[1], leg.ankle]));
    }

    /// How far a pedal and the foot on it go.
    fn shift(&self, side: usize, turn_rad: f64) -> Vec3 {
        let crank = self.cranks[side];
        let off = forward(turn_rad).rotate(crank) - crank;
        Vec3::new(off.x, 0.0, off.y)
    }

    /// A leg of two bones between the hip, which rests on the saddle, and the ankle above the pedal.
    fn leg(&self, side: usize, turn_rad: f64) -> Turned {
        let [hip, knee, ankle] = self.bones[side];
        let to = ankle + self.shift(side, turn_rad);
        let (upper_m, lower_m) = (hip.distance(knee), knee.distance(ankle));
        let reach = to - hip;
        let far_m = reach.length().clamp((upper_m - lower_m).abs() + 1e-3, (upper_m + lower_m) * 0.9999);
        let along = reach.normalize_or(Vec3::NEG_Z);
        let share_m = (upper_m.powi(2) - lower_m.powi(2) + far_m.powi(2)) / (2.0 * far_m);
        // The knee bends as it does at rest: forward and a little outward.
        let bends = (knee - hip).reject_from_normalized((ankle - hip).normalize_or(Vec3::NEG_Z)) + Vec3::X * 0.01;
        let bends = bends.reject_from_normalized(along).normalize_or(Vec3::X);
        let to_knee = hip + along * share_m + bends * (upper_m.powi(2) - share_m.powi(2)).max(0.0).sqrt();
        let turn = |from: Vec3, to: Vec3| {
            Mat3::from_quat(Quat::from_rotation_arc(from.normalize_or(Vec3::NEG_Z), to.normalize_or(Vec3::NEG_Z)))
        };
        let (thigh, shank) = (turn(knee - hip, to_knee - hip), turn(ankle - knee, to - to_knee));
        Turned { hip, thigh, knees: [knee, to_knee], shank, ankle: to }
    }
}

impl Part {
    fn new(vertex: u32, p: Vec3, bones: &[[Vec3; 3]; 2]) -> Self {
        let sides = side_shares(bones, p);
        let side = usize::from(sides[1] > sides[0]);
        let [hip, knee, _] = bones[side];
        let thigh = knee - hip;
        let from_hip = (p - hip).dot(thigh) / thigh.length_squared();
        let along = nearest(&bones[side], p).1;
        Self { vertex, sides, leg: eased(from_hip, HIP), shank: eased(along, KNEE) }
    }
}

/// Turns about y from z to x: the upper side goes forward.
fn forward(turn_rad: f64) -> Vec2 {
    Vec2::from_angle(-turn_rad.rem_euclid(std::f64::consts::TAU) as f32)
}

/// From 0 to 1 between two values.
fn eased(value: f32, [from, to]: [f32; 2]) -> f32 {
    let share = ((value - from) / (to - from)).clamp(0.0, 1.0);
    share * share * (3.0 - 2.0 * share)
}

/// Whether points lie all around a joint.
fn surrounds(points: impl Iterator<Item = Vec3>, joint: Vec3, axis: Vec3) -> bool {
    let axis = axis.normalize_or(Vec3::Z);
    let across = axis.any_orthonormal_vector();
    let other = axis.cross(across);
    let mut seen = [false; 8];
    for off in points.map(|p| p - joint).filter(|off| off.length() < CLOTHES_M) {
        let turn = off.dot(other).atan2(off.dot(across)) / TAU + 0.5;
        seen[(turn * 8.0) as usize % 8] = true;
    }
    seen.iter().filter(|seen| **seen).count() >= SURROUNDS
}

#[cfg(test)]
mod tests {
    use super::super::wheels::parts;
    use super::*;

    /// A tube along points, each with a ring of eight about it.
    fn tube(mesh: &mut Mesh, path: &[Vec3], radius_m: f32) -> Vec<usize> {
        let first = mesh.positions.len();
        for (k, p) in path.iter().enumerate() {
            let axis = (path[(k + 1).min(path.len() - 1)] - path[k.saturating_sub(1)]).normalize();
            let across = axis.any_orthonormal_vector();
            for i in 0..8 {
                let off = Quat::from_axis_angle(axis, TAU * i as f32 / 8.0) * across;
                mesh.positions.push(*p + off * radius_m);
                mesh.normals.push(off);
            }
        }
        for k in 1..path.len() as u32 {
            for i in 0..8 {
                let at = |ring: u32, i: u32| first as u32 + 8 * ring + i % 8;
                mesh.triangles
                    .extend([[at(k - 1, i), at(k, i), at(k - 1, i + 1)], [at(k, i), at(k, i + 1), at(k - 1, i + 1)]]);
            }
        }
        (first..mesh.positions.len()).collect()
    }

    fn middle(mesh: &Mesh, part: &[usize]) -> Vec3 {
        part.iter().map(|i| mesh.positions[*i]).sum::<Vec3>() / part.len() as f32
    }

    #[test]
    fn cranks_turn_pedals_stay_level_and_feet_stay_on_them() {
        let (axle, crank_m) = (Vec3::new(0.4, 0.0, 0.28), 0.17);
        let mut mesh = Mesh::default();
        let mut keypoints = [Vec3::ZERO; 17];
        let (mut cranks, mut pedals, mut shoes, mut cuffs) = (vec![], vec![], vec![], vec![]);
        for (side, sign) in [1.0f32, -1.0].into_iter().enumerate() {
            let pedal = axle + Vec3::new(0.3, 0.0, -0.954) * sign * crank_m + Vec3::Y * 0.13 * sign;
            let ankle = pedal + Vec3::new(-0.09, 0.0, 0.1);
            let hip = Vec3::new(0.15, 0.09 * sign, 0.98);
            let bones_m = 0.45f32;
            let half = hip.distance(ankle) / 2.0;
            let forward = (hip - ankle).cross(Vec3::Y).normalize();
            let forward = if forward.x > 0.0 { forward } else { -forward };
            let knee = (hip + ankle) / 2.0 + forward * (bones_m.powi(2) - half.powi(2)).sqrt();
            cranks.push(tube(&mut mesh, &[axle + Vec3::Y * 0.06 * sign, pedal - Vec3::Y * 0.055 * sign], 0.012));
            pedals.push(tube(&mut mesh, &[pedal - Vec3::Y * 0.04, pedal + Vec3::Y * 0.04], 0.03));
            let toes = ankle + Vec3::new(0.2, 0.0, -0.05);
            shoes.push(tube(&mut mesh, &[ankle + Vec3::Z * 0.03, ankle - Vec3::Z * 0.04, toes], 0.045));
            let trousers: Vec<Vec3> = [(hip, knee), (knee, ankle)]
                .into_iter()
                .flat_map(|(a, b)| (0..8).map(move |i| a.lerp(b, i as f32 / 8.0)))
                .chain([ankle])
                .collect();
            cuffs.push(tube(&mut mesh, &trousers, 0.06)[16 * 8..].to_vec());
            [11, 13, 15].into_iter().zip([hip, knee, ankle]).for_each(|(i, p)| keypoints[i + side] = p);
        }
        // A frame that stays.
        let frame = tube(&mut mesh, &[axle + Vec3::X * 0.3, Vec3::new(0.15, 0.0, 0.9)], 0.02);
        let found = Pedals::new(&mesh, &parts(&mesh), &keypoints).unwrap();
        assert_eq!(found.turning.len(), 32);
        assert_eq!(found.level.each_ref().map(Vec::len), [16 + 24; 2]);
        for turn_rad in [0.4, 1.7, 3.0, 4.6, 6.0, -2.0] {
            let mut turned = mesh.clone();
            found.turn(&mut turned, turn_rad);
            let mut points = keypoints;
            found.turn_points(&mut points, turn_rad);
            assert!(frame.iter().all(|i| turned.positions[*i] == mesh.positions[*i]));
            for side in 0..2 {
                let off = |mesh: &Mesh, part: &[usize]| {
                    let off = middle(mesh, part) - axle;
                    Vec2::new(off.x, off.z)
                };
                // Forward: what is on top goes to the front.
                let is_rad = off(&turned, &pedals[side]).angle_to(off(&mesh, &pedals[side]));
                assert!((is_rad - turn_rad as f32).sin().abs() < 1e-4 && (is_rad - turn_rad as f32).cos() > 0.0);
                let crank_rad = off(&turned, &cranks[side]).angle_to(off(&mesh, &cranks[side]));
                assert!((crank_rad - is_rad).abs() < 1e-4);
                let goes = middle(&turned, &pedals[side]) - middle(&mesh, &pedals[side]);
                for i in pedals[side].iter().chain(&shoes[side]) {
                    assert!((turned.positions[*i] - mesh.positions[*i]).distance(goes) < 1e-5);
                }
                let [hip, knee, ankle] = bones(&points, side);
                let lengths_m = [hip.distance(knee), knee.distance(ankle)];
                assert!(lengths_m.iter().all(|m| (m - 0.45).abs() < 1e-3), "{turn_rad}: {lengths_m:?}");
                assert!(knee.x > hip.x.min(ankle.x), "{turn_rad}: the knee bends forward");
                assert!(middle(&turned, &cuffs[side]).distance(ankle) < 0.01, "{turn_rad}: cuffs follow");
            }
        }
    }
}
