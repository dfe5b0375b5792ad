//! Joints at rest and posed, and the skin that follows them by dual quaternions (Kavan and others 2008).

use std::collections::BTreeMap;

use glam::{Quat, Vec3, Vec4};
use trove_model::HumanBody;

use super::pattern::Weights;

/// Someone's joints at rest.
#[derive(Clone, Debug)]
pub(super) struct Skeleton {
    pub(super) joints: Vec<Vec3>,
    /// Height of the bare soles.
    pub(super) floor_m: f32,
    parents: Vec<Option<usize>>,
    names: BTreeMap<String, usize>,
}

/// How each joint stands: turned from rest, and where it is.
#[derive(Clone, Debug)]
pub(super) struct Posed {
    pub(super) turns: Vec<Quat>,
    pub(super) places: Vec<Vec3>,
    rest: Vec<Vec3>,
}

impl Skeleton {
    pub(super) fn new(body: &HumanBody, positions: &[Vec3]) -> Self {
        let middle =
            |around: &[u32]| around.iter().map(|&v| positions[v as usize]).sum::<Vec3>() / around.len().max(1) as f32;
        let soles = body.groups.get("body").into_iter().flatten().flatten().map(|&v| positions[v as usize].z);
        Self {
            floor_m: soles.fold(f32::INFINITY, f32::min),
            joints: body.joints.iter().map(|j| middle(&j.around)).collect(),
            parents: body.joints.iter().map(|j| j.parent).collect(),
            names: body.joints.iter().enumerate().map(|(i, j)| (j.name.clone(), i)).collect(),
        }
    }

    /// Index of a joint by its name without the side; the root where there is none.
    pub(super) fn find(&self, name: &str) -> usize {
        self.names.get(name).copied().unwrap_or(0)
    }

    /// Index of a joint of the left (0) or right (1) side.
    pub(super) fn side(&self, name: &str, side: usize) -> usize {
        self.find(&format!("{name}_{}", ["l", "r"][side]))
    }

    pub(super) fn at(&self, name: &str, side: usize) -> Vec3 {
        self.joints[self.side(name, side)]
    }

    /// At rest, to be posed from the root on.
    pub(super) fn rest(&self) -> Posed {
        Posed { turns: vec![Quat::IDENTITY; self.joints.len()], places: self.joints.clone(), rest: self.joints.clone() }
    }

    /// Sets a joint's turn (in the axes of the whole), and lets all below follow stiffly.
    pub(super) fn turn(&self, posed: &mut Posed, joint: usize, turn: Quat) {
        let by = turn * posed.turns[joint].inverse();
        posed.turns[joint] = turn.normalize();
        let mut moved = vec![false; self.joints.len()];
        moved[joint] = true;
        for (j, parent) in self.parents.iter().enumerate() {
            if let Some(p) = *parent
                && moved[p]
            {
                moved[j] = true;
                posed.turns[j] = (by * posed.turns[j]).normalize();
                posed.places[j] = posed.places[p] + posed.turns[p] * (self.joints[j] - self.joints[p]);
            }
        }
    }
}

impl Posed {
    /// Everything moved.
    pub(super) fn shift(&mut self, by: Vec3) {
        self.places.iter_mut().for_each(|p| *p += by);
    }

    /// Points at rest under several joints' pull.
    pub(super) fn skin(&self, points: &[Vec3], weights: &[Weights]) -> Vec<Vec3> {
        // Of each joint the rotation, and the dual part that holds the shift.
        let duals: Vec<(Vec4, Vec4)> = (0..self.turns.len())
            .map(|j| {
                let q = self.turns[j];
                let shift = self.places[j] - q * self.rest[j];
                let dual = Quat::from_xyzw(shift.x, shift.y, shift.z, 0.0) * q * 0.5;
                (Vec4::from(q), Vec4::from(dual))
            })
            .collect();
        points
            .iter()
            .zip(weights)
            .map(|(&p, weights)| {
                let first = duals[usize::from(weights[0].0)].0;
                let (mut real, mut dual) = (Vec4::ZERO, Vec4::ZERO);
                for &(j, weight) in weights {
                    let (r, d) = duals[usize::from(j)];
                    let weight = if r.dot(first) < 0.0 { -weight } else { weight };
                    real += r * weight;
                    dual += d * weight;
                }
                let length = real.length();
                let (real, dual) = (real / length, dual / length);
                let (turn, d) = (Quat::from_vec4(real), dual.truncate());
                let r = real.truncate();
                turn * p + 2.0 * (d * real.w - r * dual.w + r.cross(d))
            })
            .collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::vec3;
    use trove_model::BodyJoint;

    #[test]
    fn what_hangs_on_one_joint_turns_stiffly_and_what_hangs_on_two_keeps_its_distance() {
        let joint = |name: &str, parent, v| BodyJoint { name: name.into(), parent, around: vec![v] };
        let positions = vec![Vec3::ZERO, vec3(0.0, 0.0, 1.0)];
        let joints = vec![joint("a", None, 0), joint("b", Some(0), 1)];
        let body = HumanBody { positions: positions.clone(), joints, ..HumanBody::default() };
        let skeleton = Skeleton::new(&body, &positions);
        let mut posed = skeleton.rest();
        skeleton.turn(&mut posed, 1, Quat::from_rotation_y(1.2));
        let end = vec3(0.1, 0.0, 2.0);
        let one = [(1, 1.0), (0, 0.0), (0, 0.0), (0, 0.0)];
        let half = [(1, 0.5), (0, 0.5), (0, 0.0), (0, 0.0)];
        let moved = posed.skin(&[end, vec3(0.3, 0.0, 1.0)], &[one, half]);
        let stiff = posed.places[1] + posed.turns[1] * (end - positions[1]);
        assert!((moved[0] - stiff).length() < 1e-5);
        assert!(((moved[1] - positions[1]).length() - 0.3).abs() < 1e-5);
        skeleton.turn(&mut posed, 0, Quat::from_rotation_z(0.5));
        assert!((posed.places[1] - positions[1]).length() < 1e-5);
    }
}
