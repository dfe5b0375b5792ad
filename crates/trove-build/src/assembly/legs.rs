//! Legs of people: where their bones are, and what is near to them.

use glam::Vec3;
use trove_model::{KEYPOINTS, Keypoints};

/// Indices of the left hip, knee and ankle among the points of a person, each before the right one's.
const LEFT_HIP: usize = KEYPOINTS.len() - 6;
const LEFT_KNEE: usize = KEYPOINTS.len() - 4;
const LEFT_ANKLE: usize = KEYPOINTS.len() - 2;

/// Hip, knee and ankle of a side, 0 the left one.
pub(super) fn bones<T: Copy>(keypoints: &Keypoints<T>, side: usize) -> [T; 3] {
    [LEFT_HIP, LEFT_KNEE, LEFT_ANKLE].map(|joint| keypoints[joint + side])
}

/// Puts the knee and the ankle of each side elsewhere.
pub(super) fn put_knees_and_ankles(keypoints: &mut Keypoints<Vec3>, places: [[Vec3; 2]; 2]) {
    for (side, [knee, ankle]) in places.into_iter().enumerate() {
        (keypoints[LEFT_KNEE + side], keypoints[LEFT_ANKLE + side]) = (knee, ankle);
    }
}

/// How much a place hangs on the left and on the right leg.
pub(super) fn side_shares(bones: &[[Vec3; 3]; 2], p: Vec3) -> [f32; 2] {
    let [left_m, right_m] = [0, 1].map(|side: usize| nearest(&bones[side], p).0);
    let apart = (right_m - left_m) / (left_m + right_m).max(1e-6);
    let left = (0.5 + 2.0 * apart).clamp(0.0, 1.0);
    [left, 1.0 - left]
}

/// How far a place is from a chain of bones, metres, and where along them, in bones.
pub(super) fn nearest(bones: &[Vec3; 3], p: Vec3) -> (f32, f32) {
    let on = |k: usize| {
        let axis = bones[k + 1] - bones[k];
        let share = ((p - bones[k]).dot(axis) / axis.length_squared()).clamp(0.0, 1.0);
        (p.distance(bones[k] + axis * share), k as f32 + share)
    };
    let (thigh, shank) = (on(0), on(1));
    if thigh.0 <= shank.0 { thigh } else { shank }
}
