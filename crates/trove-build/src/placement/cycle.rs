//! The phases of someone's walking or running, and what lies between them.

use glam::{DVec2, DVec3, Vec3};
use trove_model::{Asset, KEYPOINTS, Posture};

use super::shown::Shown;

/// What of a standing foot is no higher than this above its lowest point touches the ground, metres.
const ON_GROUND_M: f32 = 0.012;
/// No point of a foot is farther from its ankle, along and across, metres.
const FOOT_M: [f32; 2] = [0.3, 0.08];
/// Index of the left ankle's keypoint, before the right one's.
const LEFT_ANKLE: usize = KEYPOINTS.len() - 2;
/// Share of the cycle for which a foot stands: of walking, which is more than half, and of running.
const STANDS: [f64; 2] = [0.62, 0.36];
/// So many points of a sole say how it stands.
const FEWEST_POINTS: usize = 8;
/// No sole is farther than this from where the way leads it between two phases, metres.
const FARTHEST_M: f64 = 0.4;

/// A phase that is so little past the end of the contact is its end.
const AT_END: f64 = 0.01;

/// The phases that the library has of one person's gait, in their order.
pub(super) struct Cycle<'a> {
    phases: Vec<Phase<'a>>,
    /// How far the cycle goes, metres.
    pub(super) stride_m: f64,
    /// For how long a foot stands, as a share of it.
    stands: f64,
}

#[derive(Clone, Copy)]
enum Foot {
    Left,
    Right,
}

struct Phase<'a> {
    /// 0 to below 1.
    at: f64,
    asset: &'a Asset,
    /// How far the mesh is moved, in its own axes, so that feet stand still from phase to phase as the person goes on: each
    /// is centred in its own box.
    shift_m: DVec3,
}

impl<'a> Cycle<'a> {
    /// `None` without phases.
    pub(super) fn new(assets: impl Iterator<Item = &'a Asset>) -> Option<Self> {
        let phase = |asset: &'a Asset| match asset.figure.as_ref()?.posture {
            Posture::Walking { phase, stride_m } => Some((f64::from(phase), f64::from(stride_m), STANDS[0], asset)),
            Posture::Running { phase, stride_m } => Some((f64::from(phase), f64::from(stride_m), STANDS[1], asset)),
            Posture::Standing | Posture::Sitting => None,
        };
        let mut found: Vec<_> = assets.filter_map(phase).collect();
        found.sort_by(|a, b| a.0.total_cmp(&b.0));
        let &(_, stride_m, stands, _) = found.first()?;
        let phases = found.into_iter().map(|(at, _, _, asset)| Phase { at, asset, shift_m: DVec3::ZERO });
        Some(Self { phases: phases.collect(), stride_m: stride_m.max(0.1), stands })
    }

    /// Moves the phases so that feet on the ground stay where they are from one to the next.
    pub(super) fn planted(mut self) -> Self {
        let count = self.phases.len();
        let mut steps: Vec<Option<DVec2>> = Vec::with_capacity(count);
        for (i, phase) in self.phases.iter().enumerate() {
            let next = &self.phases[(i + 1) % count];
            let passes = (next.at - phase.at).rem_euclid(1.0);
            let way_m = passes * self.stride_m;
            let (foot, since) = standing(phase.at);
            let stands = since + passes <= self.stands;
            let moved = stands.then(|| sole_moved(phase.asset, next.asset, foot)).flatten();
            // The sole should go back as far as the person goes on.
            let step = moved.map(|moved| -DVec2::X * way_m - moved);
            steps.push(step.filter(|step| step.length() < FARTHEST_M));
        }
        // What is not known, as in flight, closes the cycle; or each step gives way a little.
        let off = steps.iter().flatten().sum::<DVec2>();
        let unknown = steps.iter().filter(|step| step.is_none()).count();
        let closing = -off / if unknown == 0 { count } else { unknown } as f64;
        let mut shift = DVec2::ZERO;
        for (phase, step) in self.phases.iter_mut().zip(&steps) {
            // Each is as low as its lowest point, which may be a toe that is lifted.
            let (foot, since) = standing(phase.at);
            let sole = Sole::of(phase.asset, foot).filter(|_| since <= self.stands);
            phase.shift_m = shift.extend(sole.map_or(0.0, |sole| -f64::from(sole.low_m)));
            shift += match step {
                Some(step) if unknown == 0 => *step + closing,
                Some(step) => *step,
                None => closing,
            };
        }
        let middle = self.phases.iter().map(|phase| phase.shift_m.truncate()).sum::<DVec2>() / count as f64;
        self.phases.iter_mut().for_each(|phase| phase.shift_m -= middle.extend(0.0));
        self
    }

    /// The phase that is nearest to one.
    pub(super) fn nearest(&self, phase: f64) -> &'a Asset {
        self.nearest_phase(phase).asset
    }

    fn nearest_phase(&self, wanted: f64) -> &Phase<'a> {
        let off = |phase: &Phase| {
            let past = (wanted - phase.at).rem_euclid(1.0);
            past.min(1.0 - past)
        };
        self.phases.iter().min_by(|a, b| off(a).total_cmp(&off(b))).unwrap_or(&self.phases[0])
    }

    /// Someone who stands and has got so far, 0 to 1, on the way to the phase nearest to one: the foot that swings in it has
    /// left the ground.
    pub(super) fn set_out(&self, standing: &'a Asset, phase: f64, share: f64) -> Shown<'a> {
        let to = self.nearest_phase(phase);
        let shown = Shown::between((standing, DVec3::ZERO), (to.asset, to.shift_m), share);
        Shown { stands: if shown.towards.is_some() { self.stand_at(to.at) } else { [true; 2] }, ..shown }
    }

    /// Which feet stand at a phase: up to the library's last one in which they do.
    fn stand_at(&self, phase: f64) -> [bool; 2] {
        let standing = self.phases.iter().map(|phase| phase.at).filter(|at| *at <= self.stands + AT_END);
        let end = standing.fold(0.0, f64::max);
        [phase, phase + 0.5].map(|phase| phase.rem_euclid(1.0) <= end)
    }

    /// What lies between the phases before and after one: a foot on the ground is as far back in each as the way has led on,
    /// and so it is between them.
    pub(super) fn between(&self, phase: f64) -> Shown<'a> {
        let wanted = phase.rem_euclid(1.0);
        let next = self.phases.partition_point(|phase| phase.at <= wanted) % self.phases.len();
        let before = &self.phases[(next + self.phases.len() - 1) % self.phases.len()];
        let after = &self.phases[next];
        let whole = (after.at - before.at).rem_euclid(1.0);
        let share = if whole > 0.0 { (wanted - before.at).rem_euclid(1.0) / whole } else { 0.0 };
        let shown = Shown::between((before.asset, before.shift_m), (after.asset, after.shift_m), share);
        Shown { stands: self.stand_at(wanted), ..shown }
    }
}

/// The foot that stands at a phase, and for how much of the cycle it has done so.
fn standing(phase: f64) -> (Foot, f64) {
    if phase < 0.5 { (Foot::Left, phase) } else { (Foot::Right, phase - 0.5) }
}

/// How far the sole of the foot that stands moves from one phase to another, of which it stands in both; `None` where that
/// cannot be told.
fn sole_moved(from: &Asset, to: &Asset, foot: Foot) -> Option<DVec2> {
    let [low, after] = [from, to].map(|asset| Sole::of(asset, foot));
    let (low, after) = (low?, after?);
    let ends = from.mesh.positions.iter().zip(&to.mesh.positions);
    let stands = ends.filter(|(a, b)| low.has(a) && after.has(b));
    let moved: Vec<DVec3> = stands.map(|(a, b)| b.as_dvec3() - a.as_dvec3()).collect();
    let middle = |axis: usize| {
        let mut ways: Vec<f64> = moved.iter().map(|way| way[axis]).collect();
        ways.sort_by(f64::total_cmp);
        ways.get(ways.len() / 2).copied()
    };
    (moved.len() >= FEWEST_POINTS).then(|| Some(DVec2::new(middle(0)?, middle(1)?))).flatten()
}

/// What of a foot touches the ground.
struct Sole {
    ankle: Vec3,
    low_m: f32,
}

impl Sole {
    fn of(asset: &Asset, foot: Foot) -> Option<Self> {
        let ankle = asset.keypoints?[match foot {
            Foot::Left => LEFT_ANKLE,
            Foot::Right => LEFT_ANKLE + 1,
        }];
        let whole = Self { ankle, low_m: f32::NEG_INFINITY };
        let of_foot = asset.mesh.positions.iter().filter(|p| whole.is_near(p));
        let low_m = of_foot.map(|p| p.z).min_by(f32::total_cmp)?;
        Some(Self { ankle, low_m })
    }

    fn is_near(&self, point: &Vec3) -> bool {
        let off = (point - self.ankle).abs();
        off.x < FOOT_M[0] && off.y < FOOT_M[1] && point.z < self.ankle.z
    }

    fn has(&self, point: &Vec3) -> bool {
        self.is_near(point) && point.z < self.low_m + ON_GROUND_M
    }
}
