//! Points of the face and the joints of someone in a posture.

use glam::Vec3;
use trove_model::Keypoints;

use super::skeleton::Posed;
use super::wearer::Wearer;

impl Wearer<'_> {
    /// Where they are in a posture: joints are the rig's, and the face's points hang on the head.
    pub(super) fn keypoints(&self, posed: &Posed) -> Keypoints<Vec3> {
        let joint = |name: &str| [0, 1].map(|side| posed.places[self.skeleton.side(name, side)]);
        let head = self.skeleton.find("head");
        let face = |p: Vec3| posed.places[head] + posed.turns[head] * (p - self.skeleton.joints[head]);
        let pairs = [
            ["helper-l-eye", "helper-r-eye"].map(|group| face(self.foremost(group, |p| p.x))),
            [1.0, -1.0].map(|side| face(self.foremost("body", |p| if is_beside_eyes(p) { side * p.y } else { 0.0 }))),
            joint("upperarm"),
            joint("lowerarm"),
            joint("hand"),
            joint("thigh"),
            joint("calf"),
            joint("foot"),
        ];
        let nose = face(self.foremost("body", |p| if is_below_eyes(p) { p.x } else { 0.0 }));
        std::array::from_fn(|i| if i == 0 { nose } else { pairs.as_flattened()[i - 1] })
    }

    /// The vertex of a group, at rest, that lies farthest in a direction in the body's own shape.
    fn foremost(&self, group: &str, along: impl Fn(Vec3) -> f32) -> Vec3 {
        let vertices = self.body.groups.get(group).into_iter().flatten().flatten().map(|&v| v as usize);
        let reach = |v: &usize| along(self.body.positions[*v]);
        vertices.max_by(|a, b| reach(a).total_cmp(&reach(b))).map_or(Vec3::ZERO, |v| self.positions[v])
    }
}

/// Where ears stand out, in the body's own shape, whose eyes are 0.73 m above its origin.
fn is_beside_eyes(p: Vec3) -> bool {
    (0.66..0.78).contains(&p.z) && p.y.abs() < 0.15
}

/// Where the nose stands out, likewise.
fn is_below_eyes(p: Vec3) -> bool {
    (0.66..0.73).contains(&p.z) && p.y.abs() < 0.02
}
