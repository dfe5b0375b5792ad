//! In which posture people are seen at every keyframe: who walks is in the phase to which the way so far has led.

use glam::{DQuat, DVec2, DVec3};
use trove_model::{Asset, Class, Cuboid, Drive, Kind, Pose, Posture, Seed};

use super::cycle::Cycle;
use super::shown::Shown;
use crate::between::Moments;

/// Slower than this is standing, m/s: annotators' hands tremble.
const WALKS_MPS: f64 = 0.35;
/// Faster than this is running, m/s (people change over at about 2 m/s: Hreljac 1993, Human Movement Science).
const RUNS_MPS: f64 = 2.2;
/// A box lower than this is of someone who sits, metres; children are a kind of their own.
const SITS_M: f64 = 1.3;
/// A box longer than this share of its height is of someone who takes a step, where nothing else tells.
const STRIDE_SHARE: f64 = 0.5;

/// Who walks looks along the way where that is no farther from the annotated heading, radians; from twice as far on it is no
/// walking ahead.
const LOOKS_AHEAD_RAD: f64 = 0.6;
/// A way of less does not say whither it leads, metres.
const LEAST_STEP_M: f64 = 0.01;
/// Who gets on farther to the side than ahead by this goes sideways, which no phase of walking shows.
const ASIDE: f64 = 1.5;

/// In the middle between two steps, where the standing foot is below the body and the other beside it: so one sets out, and so
/// one comes to stand.
const MIDSTANCE: f64 = 0.25;
/// So much of a step more is no step of its own.
const SPARED_STEP: f64 = 0.3;
/// How long it takes to set out from standing, and to come to stand, seconds (Breniere and Do 1986, Journal of Biomechanics:
/// 0.4 to 0.6 from standing to the first step).
const SETS_OUT_S: f64 = 0.4;

/// What someone does, whatever the phase.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Mode {
    Standing,
    Walking,
    Running,
    Sitting,
}

impl Mode {
    fn of(asset: &Asset) -> Option<Self> {
        Some(match asset.figure.as_ref()?.posture {
            Posture::Standing => Self::Standing,
            Posture::Walking { .. } => Self::Walking,
            Posture::Running { .. } => Self::Running,
            Posture::Sitting => Self::Sitting,
        })
    }

    /// Whether it gets on.
    fn goes(self) -> bool {
        matches!(self, Self::Walking | Self::Running)
    }

    /// Whether an asset may stand for someone in this mode: all that are no figures may.
    pub(super) fn allows(self, asset: &Asset) -> bool {
        Self::of(asset).is_none_or(|mode| mode == self)
    }
}

/// A track's course as far as postures need it.
pub(super) struct Gait {
    /// For each of its boxes.
    modes: Vec<Mode>,
    /// Since the first keyframe, for each of its boxes.
    times_s: Vec<f64>,
    /// Way along its own heading since the first box, metres, for each of its boxes.
    way_m: Vec<f64>,
    /// How far its way is to the left of its heading, radians, for each of its boxes: 0 for who goes sideways or backwards.
    turns_rad: Vec<f64>,
    /// Only the box itself tells the posture, so whose fits it best stays.
    by_size: bool,
    /// Whether the boxes are so dense that phases are wanted as they are, not as the nearest of the library's.
    flows: bool,
}

impl Gait {
    /// `alone_mps` is the speed of someone of whom there is one box alone; where it is not known, a long box walks.
    pub(super) fn new(
        drive: &Drive,
        boxes: &[(usize, Cuboid)],
        size_m: DVec3,
        kind: Kind,
        alone_mps: Option<f64>,
    ) -> Self {
        let times_s = times_s(Moments::of_keyframes(drive), boxes);
        let mut way_m = vec![0.0; boxes.len()];
        let mut speeds_mps: Vec<f64> = vec![alone_mps.unwrap_or(0.0); boxes.len()];
        let by_size = boxes.len() == 1 && alone_mps.is_none() && kind.class() == Class::Human;
        for i in 1..boxes.len() {
            let (ahead_m, far_m) = step_m(&boxes[i - 1].1, &boxes[i].1);
            way_m[i] = way_m[i - 1] + ahead_m;
            let goes_aside = far_m.powi(2) > (1.0 + ASIDE.powi(2)) * ahead_m.powi(2);
            let gets_on_m = if goes_aside { 0.0 } else { far_m };
            let speed_mps = gets_on_m / (times_s[i] - times_s[i - 1]).max(1e-3);
            speeds_mps[i] = speed_mps;
            // The first has no step before it, and someone who sets out already does.
            if i == 1 {
                speeds_mps[0] = speed_mps;
            }
        }
        let mode = |&speed_mps: &f64| match speed_mps {
            _ if kind == Kind::Adult && size_m.z < SITS_M => Mode::Sitting,
            _ if by_size && size_m.x > STRIDE_SHARE * size_m.z => Mode::Walking,
            v if v < WALKS_MPS => Mode::Standing,
            v if v < RUNS_MPS => Mode::Walking,
            _ => Mode::Running,
        };
        let turns_rad = vec![0.0; boxes.len()];
        Self { modes: speeds_mps.iter().map(mode).collect(), times_s, way_m, turns_rad, by_size, flows: false }
    }

    /// The same at all moments, of which the track's boxes there are: who walks to a keyframe walks up to it.
    pub(super) fn at_moments(
        &self,
        moments: Moments,
        boxes: &[(usize, Cuboid)],
        at_moments: &[(usize, Cuboid)],
    ) -> Self {
        let mut modes = Vec::with_capacity(at_moments.len());
        let mut way_m = Vec::with_capacity(at_moments.len());
        let turns_rad = turns_rad(at_moments);
        let starts: Vec<usize> = boxes.iter().map(|(k, _)| moments.of_keyframe(*k)).collect();
        for (i, (moment, now)) in at_moments.iter().enumerate() {
            let next = starts.partition_point(|start| start < moment).min(self.modes.len().saturating_sub(1));
            modes.push(self.modes.get(next).copied().unwrap_or(Mode::Standing));
            let before = i.checked_sub(1).map(|i| (way_m[i], faced(&at_moments[i].1, turns_rad[i])));
            let now = faced(now, turns_rad[i]);
            way_m.push(before.map_or(0.0, |(way_m, before): (f64, _)| way_m + step_m(&before, &now).0));
        }
        let times_s = times_s(moments, at_moments);
        Self { modes, times_s, way_m, turns_rad, by_size: self.by_size, flows: true }
    }

    /// Whether it is ever on its way.
    pub(super) fn moves(&self) -> bool {
        self.modes.iter().any(|mode| mode.goes())
    }

    /// What it does at most keyframes.
    pub(super) fn main_mode(&self) -> Mode {
        let all = [Mode::Standing, Mode::Walking, Mode::Running, Mode::Sitting];
        let count = |mode: &Mode| self.modes.iter().filter(|m| *m == mode).count();
        all.into_iter().rev().max_by_key(count).unwrap_or(Mode::Standing)
    }

    /// For each box what of the chosen one's person is in the right posture, which is the chosen one where the library has
    /// no such posture; `scale` is how much longer than the asset's the person's steps are.
    pub(super) fn postures<'a>(
        &self,
        chosen: &'a Asset,
        library: impl Iterator<Item = &'a Asset>,
        scale: f64,
        seed: Seed,
    ) -> Vec<Shown<'a>> {
        let Some(figure) = &chosen.figure else { return vec![chosen.into(); self.modes.len()] };
        let is_same = |asset: &&'a Asset| asset.figure.as_ref().is_some_and(|f| f.person == figure.person);
        let postures: Vec<&'a Asset> = library.filter(is_same).filter(|a| shows_the_same(a, chosen)).collect();
        let of_mode = |mode: Mode| postures.iter().copied().filter(move |a| Mode::of(a) == Some(mode));
        let still: Vec<Vec<&Asset>> = [Mode::Standing, Mode::Sitting].map(|mode| of_mode(mode).collect()).to_vec();
        let drawn = |from: &[&'a Asset]| seed.child("posture").random().pick(from).copied();
        let planted = |cycle: Cycle<'a>| if self.flows { cycle.planted() } else { cycle };
        let cycles = [Mode::Walking, Mode::Running].map(|mode| Cycle::new(of_mode(mode)).map(planted));
        let cycle = |i: usize| match self.modes[i] {
            Mode::Walking => cycles[0].as_ref(),
            Mode::Running => cycles[1].as_ref(),
            Mode::Standing | Mode::Sitting => None,
        };
        let phases = self.phases(|i| cycle(i).map(|cycle| cycle.stride_m * scale), seed);
        let posture = |i: usize| {
            let mode = self.modes[i];
            // Who was chosen in this mode stays as chosen.
            let stays = Mode::of(chosen) == Some(mode);
            let found = match (mode, cycle(i)) {
                _ if self.by_size && stays => Some(chosen.into()),
                (_, Some(cycle)) if self.flows => {
                    Some(Shown { turn_rad: self.turns_rad[i], ..cycle.between(phases[i]) })
                }
                (_, Some(cycle)) => Some(Shown { turn_rad: self.turns_rad[i], ..cycle.nearest(phases[i]).into() }),
                (Mode::Standing, None) => {
                    let standing = if stays { Some(chosen) } else { drawn(&still[0]) };
                    standing.map(|standing| match self.sets_out(i).filter(|_| self.flows) {
                        Some((walks, share)) => cycle(walks).map_or(standing.into(), |cycle| {
                            let turn_rad = self.turns_rad[walks] * share;
                            let midstance = MIDSTANCE + (2.0 * (phases[walks] - MIDSTANCE)).round() / 2.0;
                            Shown { turn_rad, ..cycle.set_out(standing, midstance, share) }
                        }),
                        None => standing.into(),
                    })
                }
                (Mode::Sitting, None) if !stays => drawn(&still[1]).map(Shown::from),
                _ => None,
            };
            found.unwrap_or(chosen.into())
        };
        (0..self.modes.len()).map(posture).collect()
    }

    /// The phase of each box of someone on the way, whose cycle is so long there, metres; 0 for others. One sets out in the
    /// middle between two steps, and comes to stand in another: steps are longer or shorter for that.
    fn phases(&self, stride_m: impl Fn(usize) -> Option<f64>, seed: Seed) -> Vec<f64> {
        let start = seed.child("phase").random().unit();
        let half = if start < 0.5 { 0.0 } else { 0.5 };
        let stands = |i: Option<usize>| i.is_some_and(|i| self.modes.get(i) == Some(&Mode::Standing));
        let mut phases = vec![0.0; self.modes.len()];
        let mut first = 0;
        for run in self.modes.chunk_by(|a, b| a.goes() == b.goes()) {
            let end = first + run.len();
            if run[0].goes() {
                for i in first..end {
                    let before = i.checked_sub(1);
                    let passed =
                        before.zip(stride_m(i)).map_or(0.0, |(j, stride)| (self.way_m[i] - self.way_m[j]) / stride);
                    phases[i] = passed + if i > first { phases[i - 1] } else { 0.0 };
                }
                let whole = phases[end - 1];
                let steps = (2.0 * whole.abs() - SPARED_STEP).ceil().max(1.0) / 2.0;
                let (from, longer) = match (stands(first.checked_sub(1)), stands(Some(end))) {
                    (true, true) => (MIDSTANCE + half, if whole == 0.0 { 0.0 } else { steps / whole.abs() }),
                    (true, false) => (MIDSTANCE + half, 1.0),
                    (false, true) => (MIDSTANCE + half - whole, 1.0),
                    (false, false) => (start, 1.0),
                };
                phases[first..end].iter_mut().for_each(|phase| *phase = from + *phase * longer);
            }
            first = end;
        }
        phases
    }

    /// For a box of someone who stands and is about to set out, or has just come to stand: which box's posture that leads to
    /// or comes from, and how near it is, 0 to 1.
    fn sets_out(&self, i: usize) -> Option<(usize, f64)> {
        let moves = |j: &usize| self.modes[*j] != Mode::Standing;
        let before = (0..i).rev().find(moves).filter(|j| self.modes[*j].goes());
        let after = (i + 1..self.modes.len()).find(moves).filter(|j| self.modes[*j].goes());
        // The box before the first step is where it sets out.
        let (from, to) = (before.map(|j| self.times_s[j]), after.map(|j| self.times_s[j - 1]));
        let stands_s = from.zip(to).map_or(f64::INFINITY, |(from, to)| to - from);
        let takes_s = SETS_OUT_S.min(stands_s / 2.0).max(1e-3);
        let near = |way: Option<usize>, time_s: Option<f64>| {
            let share = 1.0 - (time_s? - self.times_s[i]).abs() / takes_s;
            Some((way?, share)).filter(|(_, share)| *share > 0.0)
        };
        let (walks, share) = near(before, from).or_else(|| near(after, to))?;
        Some((walks, share * share * (3.0 - 2.0 * share)))
    }
}

/// Whether two postures show the same body, clothes and things held, vertex by vertex: nobody lets go of a bag between two
/// keyframes, and flow follows every point.
fn shows_the_same(a: &Asset, b: &Asset) -> bool {
    fn materials(asset: &Asset) -> impl Iterator<Item = &str> {
        asset.slots.iter().map(|slot| slot.material.name.as_str())
    }
    a.mesh.triangles == b.mesh.triangles && a.mesh.slots == b.mesh.slots && materials(a).eq(materials(b))
}

/// When boxes are, seconds.
fn times_s(moments: Moments, boxes: &[(usize, Cuboid)]) -> Vec<f64> {
    boxes.iter().map(|(k, _)| moments.time_s(*k)).collect()
}

/// How far the way through boxes leads to the left of the heading of each.
fn turns_rad(boxes: &[(usize, Cuboid)]) -> Vec<f64> {
    let place = |i: usize| boxes[i].1.world_from_body.translation.truncate();
    let mut turns_rad: Vec<f64> = Vec::with_capacity(boxes.len());
    for (i, (_, cuboid)) in boxes.iter().enumerate() {
        let way = place((i + 1).min(boxes.len() - 1)) - place(i.saturating_sub(1));
        let turn_rad = DVec2::from_angle(cuboid.world_from_body.yaw_rad()).angle_to(way);
        let off = (turn_rad.abs() - LOOKS_AHEAD_RAD).max(0.0) / LOOKS_AHEAD_RAD;
        turns_rad.push(match i.checked_sub(1) {
            _ if way.length() > LEAST_STEP_M => turn_rad * (1.0 - off).max(0.0),
            Some(before) => turns_rad[before],
            None => 0.0,
        });
    }
    turns_rad
}

/// A box turned to the left on its spot.
fn faced(cuboid: &Cuboid, turn_rad: f64) -> Cuboid {
    let Cuboid { world_from_body, size_m } = cuboid;
    let rotation = DQuat::from_rotation_z(turn_rad) * world_from_body.rotation;
    Cuboid { world_from_body: Pose::new(rotation, world_from_body.translation), size_m: *size_m }
}

/// How far a box is from another, metres: along that one's heading, and in all.
fn step_m(a: &Cuboid, b: &Cuboid) -> (f64, f64) {
    let (sin, cos) = a.world_from_body.yaw_rad().sin_cos();
    let moved = b.world_from_body.translation - a.world_from_body.translation;
    (moved.x * cos + moved.y * sin, moved.truncate().length())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing;
    use trove_model::{Figure, Mesh};

    const SIZE_M: DVec3 = DVec3::new(0.6, 0.6, 1.75);

    fn person(posture: Posture) -> Asset {
        let figure = Figure { person: "adult/a".into(), posture };
        Asset {
            id: format!("adult/a-{posture:?}"),
            figure: Some(figure),
            ..testing::asset("adult/a", Kind::Adult, [0.5, 0.5, 1.75])
        }
    }

    fn people() -> Vec<Asset> {
        let mut all: Vec<Asset> =
            (0..8).map(|i| person(Posture::Walking { phase: i as f32 / 8.0, stride_m: 1.4 })).collect();
        all.extend([person(Posture::Standing), person(Posture::Sitting)]);
        all
    }

    /// Boxes at every keyframe of the test's drive, so far apart.
    fn boxes(step_m: f64) -> Vec<(usize, Cuboid)> {
        let at = |k: usize| Pose::from_yaw(0.0, DVec3::X * step_m * k as f64);
        (0..10).map(|k| (k, Cuboid { world_from_body: at(k), size_m: SIZE_M })).collect()
    }

    fn phase(asset: &Asset) -> Option<f32> {
        match asset.figure.as_ref()?.posture {
            Posture::Walking { phase, .. } => Some(phase),
            _ => None,
        }
    }

    #[test]
    fn phases_follow_the_way_and_who_stands_stands() {
        let (drive, people) = (testing::drive(), people());
        let apart_s = (drive.keyframes[1].time_ns - drive.keyframes[0].time_ns) as f64 * 1e-9;
        // An eighth of a cycle a keyframe, at a walking speed for half-second keyframes.
        let gait = Gait::new(&drive, &boxes(1.4 * 5.0 / 8.0), SIZE_M, Kind::Adult, Some(0.0));
        assert_eq!(gait.main_mode(), Mode::Walking, "{apart_s}");
        let postures = gait.postures(&people[0], people.iter(), 1.0, Seed(1));
        let phases: Vec<f32> = postures.iter().map(|shown| phase(shown.asset).unwrap()).collect();
        for pair in phases.windows(2) {
            assert!(((pair[1] - pair[0]).rem_euclid(1.0) - 0.625).abs() < 1e-6, "{phases:?}");
        }
        let still = Gait::new(&drive, &boxes(0.01), SIZE_M, Kind::Adult, Some(0.0));
        assert_eq!(still.main_mode(), Mode::Standing);
        assert!(
            still.postures(&people[8], people.iter(), 1.0, Seed(1)).iter().all(|shown| shown.asset.id == people[8].id)
        );
    }

    #[test]
    fn nobody_lets_go_of_what_they_hold_between_two_keyframes() {
        let (drive, mut people) = (testing::drive(), people());
        let held = Mesh { triangles: vec![[0, 1, 2]], ..Mesh::clone(&people[0].mesh) };
        let mut with_bag = |i: usize| {
            let mut mesh = Mesh::clone(&people[i].mesh);
            mesh.append(&held, 0);
            people[i].mesh = mesh.into();
        };
        [0, 2, 4].into_iter().for_each(&mut with_bag);
        let gait = Gait::new(&drive, &boxes(1.4 * 5.0 / 8.0), SIZE_M, Kind::Adult, Some(0.0));
        for (chosen, expect) in [(0, [0.0, 0.25, 0.5].as_slice()), (1, &[0.125, 0.375, 0.625, 0.75, 0.875])] {
            let postures = gait.postures(&people[chosen], people.iter(), 1.0, Seed(1));
            let fits = |shown: &Shown| expect.contains(&phase(shown.asset).unwrap());
            assert!(postures.iter().all(fits), "{chosen}");
        }
    }

    #[test]
    fn a_single_box_walks_where_it_is_long_and_keeps_the_step_that_fits_it() {
        let (drive, people) = (testing::drive(), people());
        let new = |length_m, mps| Gait::new(&drive, &boxes(0.0)[..1], SIZE_M.with_x(length_m), Kind::Adult, mps);
        assert_eq!(new(0.6, None).main_mode(), Mode::Standing);
        assert_eq!(new(1.2, Some(0.0)).main_mode(), Mode::Standing);
        assert_eq!(new(0.6, Some(1.4)).main_mode(), Mode::Walking);
        let car = Gait::new(&drive, &boxes(0.0)[..1], DVec3::new(4.5, 1.8, 1.5), Kind::Car, None);
        assert!(!car.moves());
        let long = new(1.2, None);
        assert_eq!(long.main_mode(), Mode::Walking);
        for chosen in &people[..8] {
            assert_eq!(long.postures(chosen, people.iter(), 1.0, Seed(1))[0].asset.id, chosen.id);
        }
    }

    #[test]
    fn a_low_box_is_of_someone_who_sits_and_other_assets_have_no_posture() {
        let (drive, people) = (testing::drive(), people());
        let gait = Gait::new(&drive, &boxes(0.0), SIZE_M.with_z(1.2), Kind::Adult, Some(0.0));
        assert_eq!(gait.main_mode(), Mode::Sitting);
        assert!(Mode::Sitting.allows(&people[9]) && !Mode::Sitting.allows(&people[0]));
        let car = testing::asset("car/a", Kind::Car, [4.5, 1.8, 1.5]);
        assert!(Mode::Walking.allows(&car));
        assert!(gait.postures(&car, people.iter(), 1.0, Seed(1)).iter().all(|shown| shown.asset.id == "car/a"));
    }
}
