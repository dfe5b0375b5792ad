//! Feet that stand stay where they stand: each is put down in one place for as long as it is on the ground, legs follow, and
//! the body carries what both feet have in common.

use std::f64::consts::PI;
use std::sync::Arc;

use glam::{DAffine2, DAffine3, DVec2, DVec3, Vec3};
use trove_model::{Mesh, Posture};

use super::legs::{FootMove, Legs, bend_points, bones};
use super::pose::ActorPose;

/// So many of a foot's lowest points say how it moves, of those that are no higher than this above the lowest, metres.
const POINTS: usize = 12;
const SOLE_M: f64 = 0.05;
/// Someone who stands takes a step where a foot is off by more than this, metres …
const SHUFFLES_M: f64 = 0.16;
/// … and someone on the way where a step would have to reach farther than this beyond the usual.
const STRIDES_M: f64 = 0.5;
/// What a turn of a foot by a radian counts for, metres: about the length of a foot.
const FOOT_M: f64 = 0.25;
/// How long such a step takes, seconds, and how high it is, metres.
const STEP_S: f64 = 0.35;
const STEP_UP_M: f64 = 0.06;
/// A foot that swings clears the ground by this more than in its posture, metres: between two phases it would scuff.
const CLEARS_M: f64 = 0.02;
/// No body leaves its box by more than this, metres, nor is turned farther in it, radians.
const BODY_M: f64 = 0.2;
const BODY_RAD: f64 = 0.3;
/// A leg is as long as its bones, and clothes give a little.
const GIVES: f64 = 1.04;

/// A foot at a moment, World, as the posture has it.
struct Natural {
    /// The middle of the foot.
    middle: DVec3,
    /// All of its points.
    points: Vec<DVec3>,
}

/// How a foot is put elsewhere at a moment, World.
#[derive(Clone, Copy, Debug, Default)]
struct Put {
    shift: DVec2,
    turn_rad: f64,
    up_m: f64,
}

/// Puts the feet of someone who is seen at moments, at seconds, each of which `stands` as told; says how far a foot that should
/// stand slides at most, metres, since no leg reaches farther.
pub(super) fn plant(
    poses: &mut [(usize, ActorPose)],
    times_s: &[f64],
    stands: &[[bool; 2]],
    legs: &Legs,
    meshes: &[Arc<Mesh>],
) -> f64 {
    let mut slides_m: f64 = 0.0;
    let mut first = 0;
    let runs: Vec<usize> = poses.chunk_by(|(a, _), (b, _)| *b == a + 1).map(<[_]>::len).collect();
    for length in runs {
        let run = first..first + length;
        first += length;
        let natural: Vec<[Natural; 2]> =
            poses[run.clone()].iter().map(|(_, pose)| natural(pose, legs, meshes)).collect();
        let standing: Vec<bool> =
            poses[run.clone()].iter().map(|(_, pose)| pose.posture == Some(Posture::Standing)).collect();
        let course = Steps {
            natural: &natural,
            times_s: &times_s[run.clone()],
            stands: &stands[run.clone()],
            standing: &standing,
        };
        let puts = course.puts();
        let mut before = [0.0; 2];
        for (i, (_, pose)) in poses[run].iter_mut().enumerate() {
            let lacks_m = step(pose, &natural[i], [puts[0][i], puts[1][i]]);
            for side in 0..2 {
                if course.stands[i][side] && puts[side][i].up_m == 0.0 {
                    slides_m = slides_m.max((lacks_m[side] - before[side]).abs());
                }
            }
            before = lacks_m;
        }
    }
    slides_m
}

/// Where the feet of a pose are.
fn natural(pose: &ActorPose, legs: &Legs, meshes: &[Arc<Mesh>]) -> [Natural; 2] {
    let from = &meshes[pose.posed.mesh].positions;
    let to = pose.posed.towards.map(|(other, share)| (&meshes[other].positions, share));
    let point = |vertex: &u32| {
        let i = *vertex as usize;
        let p = to.map_or(from[i], |(to, share)| from[i].lerp(to[i], share));
        pose.world_from_mesh.transform_point3(p.as_dvec3())
    };
    [0, 1].map(|side| {
        let points: Vec<DVec3> = legs.feet[side].iter().map(point).collect();
        Natural { middle: points.iter().sum::<DVec3>() / points.len() as f64, points }
    })
}

/// Someone's moments without a gap.
struct Steps<'a> {
    natural: &'a [[Natural; 2]],
    times_s: &'a [f64],
    stands: &'a [[bool; 2]],
    /// Whether it is no phase of a gait.
    standing: &'a [bool],
}

/// A foot on the ground: the moments, and what leaves it where it was at the first of them.
struct Contact {
    first: usize,
    holds: Vec<DAffine2>,
}

impl Steps<'_> {
    /// Where each foot is put at each moment.
    fn puts(&self) -> [Vec<Put>; 2] {
        let count = self.natural.len();
        let mut contacts: [Vec<Contact>; 2] = Default::default();
        let mut open: [Option<Contact>; 2] = [None, None];
        // Until when a step is taken that the posture has none of.
        let mut lifted = [f64::NEG_INFINITY; 2];
        let mut steps: [Vec<usize>; 2] = Default::default();
        for i in 0..count {
            for side in 0..2 {
                let stands = self.stands[i][side] && self.times_s[i] >= lifted[side];
                if !stands {
                    contacts[side].extend(open[side].take());
                    continue;
                }
                let Some(contact) = &mut open[side] else {
                    open[side] = Some(Contact { first: i, holds: vec![DAffine2::IDENTITY] });
                    continue;
                };
                let moved = moved(&self.natural[i - 1][side], &self.natural[i][side]);
                let hold = contact.holds[contact.holds.len() - 1] * moved.inverse();
                let middle = self.natural[i][side].middle.truncate();
                let off_m = hold.transform_point2(middle).distance(middle) + angle_rad(&hold).abs() * FOOT_M;
                contact.holds.push(hold);
                let steps_on =
                    if self.standing[i] { off_m > SHUFFLES_M && open[1 - side].is_some() } else { off_m > STRIDES_M };
                if steps_on {
                    contacts[side].extend(open[side].take());
                    lifted[side] = self.times_s[i] + STEP_S;
                    steps[side].push(i);
                }
            }
        }
        for side in 0..2 {
            contacts[side].extend(open[side].take());
        }
        [0, 1].map(|side| self.between(side, &contacts[side], &steps[side]))
    }

    /// Contacts, each in the middle of where the posture has the foot meanwhile, and the ways between them; `steps` are the last
    /// moments before steps that the posture has none of.
    fn between(&self, side: usize, contacts: &[Contact], steps: &[usize]) -> Vec<Put> {
        let mut known: Vec<Option<Put>> = vec![None; self.natural.len()];
        for Contact { first, holds } in contacts {
            let middle = |k: usize| self.natural[first + k][side].middle.truncate();
            let count = holds.len() as f64;
            let held =
                holds.iter().enumerate().map(|(k, hold)| hold.transform_point2(middle(k))).sum::<DVec2>() / count;
            let natural = (0..holds.len()).map(middle).sum::<DVec2>() / count;
            let turn_rad = holds.iter().map(angle_rad).sum::<f64>() / count;
            let centred = DAffine2::from_translation(natural)
                * DAffine2::from_angle(-turn_rad)
                * DAffine2::from_translation(-held);
            for (k, hold) in holds.iter().enumerate() {
                let hold = centred * *hold;
                let shift = hold.transform_point2(middle(k)) - middle(k);
                known[first + k] = Some(Put { shift, turn_rad: angle_rad(&hold), up_m: 0.0 });
            }
        }
        let at: Vec<usize> = (0..known.len()).filter(|i| known[*i].is_some()).collect();
        let put = |i: usize| {
            let next = at.partition_point(|j| *j <= i);
            let (before, after) = (next.checked_sub(1).map(|k| at[k]), at.get(next).copied());
            match (before, after) {
                (Some(a), _) if a == i => known[a].unwrap_or_default(),
                (Some(a), Some(b)) => {
                    let (from, to) = (known[a].unwrap_or_default(), known[b].unwrap_or_default());
                    let share = (self.times_s[i] - self.times_s[a]) / (self.times_s[b] - self.times_s[a]);
                    let eased = share * share * (3.0 - 2.0 * share);
                    let high_m = if steps.contains(&a) { STEP_UP_M } else { CLEARS_M };
                    Put {
                        shift: from.shift.lerp(to.shift, eased),
                        turn_rad: from.turn_rad + (to.turn_rad - from.turn_rad) * eased,
                        up_m: high_m * (share * PI).sin().sqrt(),
                    }
                }
                (Some(only), None) | (None, Some(only)) => known[only].unwrap_or_default(),
                (None, None) => Put::default(),
            }
        };
        (0..known.len()).map(put).collect()
    }
}

/// How a foot on the ground moves from one moment to the next over it, by its lowest points.
fn moved(from: &Natural, to: &Natural) -> DAffine2 {
    let low_m = |foot: &Natural| foot.points.iter().map(|p| p.z).fold(f64::INFINITY, f64::min);
    let lows_m = [low_m(from), low_m(to)];
    let ends = from.points.iter().zip(&to.points);
    let mut ends: Vec<(f64, DVec2, DVec2)> =
        ends.map(|(a, b)| ((a.z - lows_m[0]).max(b.z - lows_m[1]), a.truncate(), b.truncate())).collect();
    ends.sort_by(|a, b| a.0.total_cmp(&b.0));
    ends.truncate(ends.partition_point(|(up_m, ..)| *up_m <= SOLE_M).clamp(1, POINTS));
    let count = ends.len() as f64;
    let middles = ends.iter().fold([DVec2::ZERO; 2], |[a, b], end| [a + end.1 / count, b + end.2 / count]);
    let sums = ends.iter().fold(DVec2::ZERO, |sum, (_, a, b)| {
        let (a, b) = (*a - middles[0], *b - middles[1]);
        sum + DVec2::new(a.dot(b), a.perp_dot(b))
    });
    let turn_rad = if sums.length() > 0.0 { sums.to_angle() } else { 0.0 };
    DAffine2::from_translation(middles[1]) * DAffine2::from_angle(turn_rad) * DAffine2::from_translation(-middles[0])
}

fn angle_rad(affine: &DAffine2) -> f64 {
    affine.matrix2.x_axis.to_angle()
}

/// Puts the feet of a pose elsewhere: what both have in common moves the body, the rest bends the legs. Says how far each foot
/// is from where it should be, metres, since no leg reaches farther.
fn step(pose: &mut ActorPose, natural: &[Natural; 2], puts: [Put; 2]) -> [f64; 2] {
    let common = ((puts[0].shift + puts[1].shift) / 2.0).clamp_length_max(BODY_M);
    let turn_rad = ((puts[0].turn_rad + puts[1].turn_rad) / 2.0).clamp(-BODY_RAD, BODY_RAD);
    let about = (natural[0].middle + natural[1].middle) / 2.0;
    let about = about.with_z(0.0);
    let world_from_before = DAffine3::from_translation(about + common.extend(0.0))
        * DAffine3::from_rotation_z(turn_rad)
        * DAffine3::from_translation(-about);
    pose.world_from_mesh = world_from_before * pose.world_from_mesh;
    if let Some(points) = &mut pose.keypoints_world {
        points.iter_mut().for_each(|p| *p = world_from_before.transform_point3(*p));
    }
    let mesh_from_world = pose.world_from_mesh.inverse();
    let Some(mut points) =
        pose.keypoints_world.map(|points| points.map(|p| mesh_from_world.transform_point3(p).as_vec3()))
    else {
        return [0.0; 2];
    };
    let mut lacks_m = [0.0; 2];
    let mut moves = [FootMove::default(); 2];
    for side in 0..2 {
        let at = world_from_before.transform_point3(natural[side].middle);
        let wanted = natural[side].middle + puts[side].shift.extend(puts[side].up_m);
        let shift = mesh_from_world.transform_vector3(wanted - at);
        let [hip, knee, ankle] = bones(&points, side).map(Vec3::as_dvec3);
        let leg = ankle - hip;
        let longest_m = ((knee - hip).length() + (ankle - knee).length()) * GIVES;
        let share = reached(leg, shift, longest_m.max(leg.length()));
        lacks_m[side] = (wanted - at).length() * (1.0 - share);
        moves[side] = FootMove {
            about: mesh_from_world.transform_point3(at).as_vec3(),
            shift: (shift * share).as_vec3(),
            turn_rad: (puts[side].turn_rad - turn_rad) as f32,
            down: (leg / leg.length_squared()).as_vec3(),
        };
    }
    bend_points(&mut points, &moves);
    pose.keypoints_world = Some(points.map(|p| pose.world_from_mesh.transform_point3(p.as_dvec3())));
    pose.bend.feet = moves;
    lacks_m
}

/// The share of a shift after which a leg is no longer than told.
fn reached(leg: DVec3, shift: DVec3, longest_m: f64) -> f64 {
    if (leg + shift).length() <= longest_m {
        return 1.0;
    }
    let (a, b, c) = (shift.length_squared(), leg.dot(shift), leg.length_squared() - longest_m * longest_m);
    ((-b + (b * b - a * c).max(0.0).sqrt()) / a).clamp(0.0, 1.0)
}
