//! Legs of people: what of a mesh hangs on them, and how it follows feet that are put elsewhere.

use glam::{Vec2, Vec3};
use trove_model::{KEYPOINTS, Keypoints, Mesh};

/// Indices of the left hip, knee and ankle among the points of a person, each before the right one's.
const LEFT_HIP: usize = KEYPOINTS.len() - 6;
const LEFT_KNEE: usize = KEYPOINTS.len() - 4;
const LEFT_ANKLE: usize = KEYPOINTS.len() - 2;
/// Shorter legs are none, metres.
const SHORTEST_M: f32 = 0.2;
/// What is nearer than this to the bones follows them, and what is farther than that does not, metres: clothes do, hands and
/// bags do not. Toes are as far from the ankle as that, and nothing else is down there.
const FOLLOWS_M: [f32; 2] = [0.17, 0.28];
const BELOW_BAGS: f32 = 1.6;
/// Along the leg, in bones from the hip, what is beyond is the foot.
const FOOT: f32 = 1.85;
/// What hangs on one leg alone by so much is that one's.
const OWN: f32 = 0.95;

/// A person's legs.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Legs {
    parts: Vec<Part>,
    /// Vertices of the left and of the right foot.
    pub(super) feet: [Vec<u32>; 2],
}

/// A vertex that hangs on a leg.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Part {
    vertex: u32,
    /// How much it hangs on the left and on the right leg.
    sides: [f32; 2],
    /// Where along the leg, in bones from the hip, 0 to 2.
    along: f32,
}

/// How a foot is put elsewhere in the axes of a mesh, where its leg then is, metres.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct FootMove {
    /// The middle of the foot, about which it turns.
    pub about: Vec3,
    /// How far that goes.
    pub shift: Vec3,
    /// How far it turns to the left.
    pub turn_rad: f32,
    /// From the hip to the ankle, over the square of its length.
    pub down: Vec3,
}

impl Legs {
    /// Of a person whose legs are best told apart with feet apart; `None` for a mesh without legs.
    pub(super) fn new(mesh: &Mesh, keypoints: &Keypoints<Vec3>) -> Option<Self> {
        let bones = [0, 1].map(|side| bones(keypoints, side));
        if bones.iter().any(|[hip, knee, ankle]| hip.distance(*knee).min(knee.distance(*ankle)) < SHORTEST_M / 2.0) {
            return None;
        }
        let part = |(vertex, p): (u32, &Vec3)| {
            let shares = side_shares(&bones, *p);
            let near = bones.map(|bones| nearest(&bones, *p));
            let follows = |(off_m, along): (f32, f32)| {
                let far = (off_m - FOLLOWS_M[0]) / (FOLLOWS_M[1] - FOLLOWS_M[0]);
                if along > BELOW_BAGS { 1.0 } else { 1.0 - far.clamp(0.0, 1.0) }
            };
            let sides = [0, 1].map(|side: usize| shares[side] * follows(near[side]));
            let along = shares[0] * near[0].1 + shares[1] * near[1].1;
            (along > 0.0 && sides != [0.0; 2]).then_some(Part { vertex, sides, along })
        };
        let parts: Vec<Part> = (0..).zip(&mesh.positions).filter_map(part).collect();
        let foot = |side: usize| -> Vec<u32> {
            parts.iter().filter(|p| p.sides[side] > OWN && p.along > FOOT).map(|p| p.vertex).collect()
        };
        let feet = [foot(0), foot(1)];
        feet.iter().all(|foot| !foot.is_empty()).then_some(Self { parts, feet })
    }

    /// Puts the feet of a mesh elsewhere; the legs follow.
    pub(super) fn bend(&self, mesh: &mut Mesh, moves: &[FootMove; 2]) {
        let turns = moves.map(|foot| Vec2::from_angle(foot.turn_rad));
        for &Part { vertex, sides, along } in &self.parts {
            let Some(position) = mesh.positions.get_mut(vertex as usize) else { continue };
            let from = *position;
            let mut normal = mesh.normals.get(vertex as usize).copied();
            for side in 0..2 {
                let FootMove { about, shift, down, turn_rad } = moves[side];
                let off = (from - about).truncate();
                let twist = (turns[side].rotate(off) - off) * twists(along);
                *position += (shift * swings(along) + twist.extend(0.0)) * sides[side];
                // What is sheared along the leg is turned, and what is twisted.
                normal = normal.map(|n| {
                    let sheared = n - down * (shift.dot(n) * sides[side] / (1.0 + down.dot(shift) * sides[side]));
                    let turned = Vec2::from_angle(turn_rad * twists(along) * sides[side]).rotate(sheared.truncate());
                    turned.extend(sheared.z).try_normalize().unwrap_or(n)
                });
            }
            if let (Some(own), Some(normal)) = (mesh.normals.get_mut(vertex as usize), normal) {
                *own = normal;
            }
        }
    }
}

/// How much of a foot's shift a place along the leg makes: all in all the leg swings about the hip.
fn swings(along: f32) -> f32 {
    (along / FOOT).min(1.0)
}

/// Likewise of its turn: feet turn with the shank.
fn twists(along: f32) -> f32 {
    ((along - 1.0) / (FOOT - 1.0)).clamp(0.0, 1.0)
}

/// Hip, knee and ankle of a side, 0 the left one.
pub(super) fn bones<T: Copy>(keypoints: &Keypoints<T>, side: usize) -> [T; 3] {
    [LEFT_HIP, LEFT_KNEE, LEFT_ANKLE].map(|joint| keypoints[joint + side])
}

/// Moves knees and ankles as feet move.
pub(super) fn bend_points(keypoints: &mut Keypoints<Vec3>, moves: &[FootMove; 2]) {
    let moved = [0, 1].map(|side: usize| {
        let FootMove { about, shift, turn_rad, .. } = moves[side];
        let [_, knee, ankle] = bones(keypoints, side);
        let off = (ankle - about).truncate();
        let twist = (Vec2::from_angle(turn_rad).rotate(off) - off).extend(0.0);
        [knee + shift * swings(1.0), ankle + shift + twist]
    });
    put_knees_and_ankles(keypoints, moved);
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
