//! What speaks for a model looking one way.

use glam::Vec2;

/// Something that speaks for a direction, seen from above in the file's axes turned upright: its length says how much.
#[derive(Clone, Debug)]
pub(super) struct Evidence {
    pub(super) towards: Vec2,
    /// It speaks for the opposite direction too.
    pub(super) either: bool,
    pub(super) reason: &'static str,
}

impl Evidence {
    pub(super) fn score(&self, direction: Vec2) -> f32 {
        let score = self.towards.dot(direction);
        if self.either { score.abs() } else { score }
    }
}
