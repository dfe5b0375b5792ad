//! The recording vehicle between keyframes, and its cameras.

use trove_model::{Drive, Ego, Exposure, Keyframe, Pose, Trajectory, World};

use super::course::{Course, Waypoint};
use super::times::{When, seconds};

/// Where the vehicle is at any time.
pub(super) struct EgoWay<'a> {
    path: &'a Trajectory<World, Ego>,
    start_ns: i64,
    course: Option<Course>,
}

impl<'a> EgoWay<'a> {
    pub(super) fn new(drive: &'a Drive) -> Self {
        let start_ns = drive.keyframes.first().map_or(0, |k| k.time_ns);
        let waypoint = |k: &Keyframe| Waypoint {
            time_s: seconds(k.time_ns, start_ns),
            rotation: k.world_from_ego.rotation,
            position: k.world_from_ego.translation,
        };
        let points: Vec<Waypoint> = drive.keyframes.iter().map(waypoint).collect();
        // The origin of Ego is the middle of the rear axle.
        let course = (!points.is_empty()).then(|| Course::new(points, Some(0.0)));
        Self { path: &drive.path, start_ns, course }
    }

    /// The vehicle at a moment between two keyframes.
    pub(super) fn at_moment(&self, now: &Keyframe, next: &Keyframe, when: &When) -> Pose<World, Ego> {
        self.at(when.time_ns, [(now.time_ns, now.world_from_ego), (next.time_ns, next.world_from_ego)])
    }

    /// The pictures of a moment between two keyframes by the cameras that took one at both, each so long before or after the
    /// moment as before or after the keyframes.
    pub(super) fn exposures(&self, now: &Keyframe, next: &Keyframe, when: &When) -> Vec<Exposure> {
        let taken = |a: &Exposure| {
            let b = next.exposures.iter().find(|b| b.camera == a.camera)?;
            let lead = |e: &Exposure, k: &Keyframe| (e.time_ns - k.time_ns) as f64;
            let lead_ns = lead(a, now) + (lead(b, next) - lead(a, now)) * when.share;
            let time_ns = when.time_ns + lead_ns.round() as i64;
            Some(Exposure {
                camera: a.camera,
                time_ns,
                world_from_ego: self.at(time_ns, [(a.time_ns, a.world_from_ego), (b.time_ns, b.world_from_ego)]),
                lens: if when.share < 0.5 { a.lens } else { b.lens },
                ego_from_camera: a.ego_from_camera.interpolate(&b.ego_from_camera, when.share),
                token: None,
                file: None,
            })
        };
        now.exposures.iter().filter_map(taken).collect()
    }

    /// The vehicle at a time between two at which its pose is known: as its recorded path has it, or else on its way from
    /// keyframe to keyframe, corrected so that it is where it is known to be at both.
    fn at(&self, time_ns: i64, known: [(i64, Pose<World, Ego>); 2]) -> Pose<World, Ego> {
        let [(from_ns, from), (to_ns, to)] = known;
        let on_path = [from_ns, time_ns, to_ns].map(|time_ns| self.path.at(time_ns));
        let [a, now, b] = match on_path {
            [Some(a), Some(now), Some(b)] => [a, now, b],
            _ => [from_ns, time_ns, to_ns].map(|time_ns| self.on_course(time_ns).unwrap_or(from)),
        };
        let share = seconds(time_ns, from_ns) / seconds(to_ns, from_ns).max(1e-9);
        (from * a.inverse() * now).interpolate(&(to * b.inverse() * now), share.clamp(0.0, 1.0))
    }

    fn on_course(&self, time_ns: i64) -> Option<Pose<World, Ego>> {
        let (rotation, position) = self.course.as_ref()?.at(seconds(time_ns, self.start_ns));
        Some(Pose::new(rotation, position))
    }
}
