//! Whether two drives are the same, and where they differ.
//!
//! Names that are the dataset's own (ids, tokens, categories) are not compared. Readers choose World's origin themselves,
//! so positions are compared from the first keyframe's vehicle, and that vehicle's place on earth by itself.

use std::collections::BTreeMap;

use glam::{DVec2, DVec3};
use trove_model::{Cuboid, Drive, Exposure, Frame, Keyframe, Lens, LidarSweep, ObjectBox, Pose};

use crate::canonical;

/// How far apart things may be that are the same.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Tolerances {
    pub(crate) position_m: f64,
    pub(crate) rotation_rad: f64,
    pub(crate) size_m: f64,
    pub(crate) velocity_mps: f64,
    pub(crate) time_ns: i64,
    pub(crate) pixel: f64,
    /// Points are float32, and some datasets' ranges are of fewer bits still.
    pub(crate) point_m: f64,
}

/// A millimetre and a millionth of a radian.
pub(crate) const TIGHT: Tolerances = Tolerances {
    position_m: 1e-3,
    rotation_rad: 1e-6,
    size_m: 1e-3,
    velocity_mps: 2e-3,
    time_ns: 1000,
    pixel: 1e-3,
    point_m: 1e-3,
};

/// What differs, each with its place; nothing where the drives are the same.
pub(crate) fn differences(expected: &Drive, found: &Drive, within: &Tolerances) -> Vec<String> {
    let mut told = Vec::new();
    let mut say = |what: String| told.push(what);
    if expected.is_georeferenced != found.is_georeferenced {
        say(format!("georeferenced: expected {}, found {}", expected.is_georeferenced, found.is_georeferenced));
    }
    let names = |drive: &Drive| drive.rig.iter().map(|c| c.name.clone()).collect::<Vec<_>>();
    if names(expected) != names(found) {
        say(format!("cameras: expected {:?}, found {:?}", names(expected), names(found)));
    }
    if (expected.keyframes.len(), expected.tracks.len()) != (found.keyframes.len(), found.tracks.len()) {
        let counts = |drive: &Drive| format!("{} keyframes and {} tracks", drive.keyframes.len(), drive.tracks.len());
        say(format!("expected {}, found {}", counts(expected), counts(found)));
    }
    let (Some(first), Some(found_first)) = (expected.keyframes.first(), found.keyframes.first()) else { return told };
    let origins = [first, found_first].map(|k| k.world_from_ego.translation);
    if expected.is_georeferenced && found.is_georeferenced {
        let (lat_deg, lon_deg) = found.projection.geo_from_world(origins[1].truncate());
        let apart_m = expected.projection.world_from_geo(lat_deg, lon_deg).distance(origins[0].truncate());
        if apart_m > within.position_m {
            say(format!("place on earth: {apart_m:.4} m off, at {lat_deg}, {lon_deg}"));
        }
    }
    let mut between = Comparison { within, origins, place: "between keyframes".into(), told: &mut told };
    between.paths(expected, found);
    for (a, b) in expected.sweeps.iter().zip(&found.sweeps) {
        between.times(a.time_ns, b.time_ns);
        between.sweeps(Some(&a.lidar), Some(&b.lidar));
    }
    if expected.sweeps.len() != found.sweeps.len() {
        between.say(&format!("expected {} sweeps, found {}", expected.sweeps.len(), found.sweeps.len()));
    }
    let mut same_tracks = BTreeMap::new();
    for (k, (a, b)) in expected.keyframes.iter().zip(&found.keyframes).enumerate() {
        let mut comparison = Comparison { within, origins, place: format!("keyframe {k}"), told: &mut told };
        comparison.keyframes(a, b, &names(expected), &names(found));
        for (a, b) in comparison.boxes(&a.boxes, &b.boxes) {
            if *same_tracks.entry(a.track).or_insert(b.track) != b.track {
                told.push(format!("keyframe {k}: '{}' changes from one track to another", a.category));
            }
        }
    }
    for (&a, &b) in &same_tracks {
        let (Some(a), Some(b)) = (expected.tracks.get(a), found.tracks.get(b)) else { continue };
        let at = |track: &trove_model::Track| track.boxes.iter().map(|(k, _)| *k).collect::<Vec<_>>();
        if a.kind != b.kind || at(a) != at(b) {
            let (found_kind, found_at) = (b.kind, at(b));
            told.push(format!(
                "track {}: expected {:?} at {:?}, found {found_kind:?} at {found_at:?}",
                a.token,
                a.kind,
                at(a)
            ));
        }
    }
    told
}

struct Comparison<'a> {
    within: &'a Tolerances,
    /// The first keyframe's vehicle in both Worlds.
    origins: [DVec3; 2],
    place: String,
    told: &'a mut Vec<String>,
}

impl Comparison<'_> {
    fn say(&mut self, what: &str) {
        self.told.push(format!("{}: {what}", self.place));
    }

    fn keyframes(&mut self, a: &Keyframe, b: &Keyframe, names: &[String], found_names: &[String]) {
        self.times(a.time_ns, b.time_ns);
        self.world_poses("vehicle", &a.world_from_ego, &b.world_from_ego);
        for exposure in &a.exposures {
            let name = &names[exposure.camera];
            match b.exposures.iter().find(|e| found_names.get(e.camera) == Some(name)) {
                Some(found) => self.exposures(name, exposure, found),
                None => self.say(&format!("{name}: no picture")),
            }
        }
        if b.exposures.len() > a.exposures.len() {
            self.say(&format!("expected {} pictures, found {}", a.exposures.len(), b.exposures.len()));
        }
        self.sweeps(a.lidar.as_ref(), b.lidar.as_ref());
    }

    /// A path may have more poses, such as those of pictures.
    fn paths(&mut self, a: &Drive, b: &Drive) {
        if a.path.moments().is_empty() != b.path.moments().is_empty() {
            let counts = [a, b].map(|drive| drive.path.moments().len());
            self.say(&format!("path: expected {} poses, found {}", counts[0], counts[1]));
            return;
        }
        for (time_ns, pose) in a.path.moments() {
            match b.path.at(*time_ns) {
                Some(found) => self.world_poses("path", pose, &found),
                None => self.say(&format!("path: nothing {} ns after the start", time_ns - canonical::START_NS)),
            }
        }
    }

    fn sweeps(&mut self, a: Option<&LidarSweep>, b: Option<&LidarSweep>) {
        match (a, b) {
            (Some(a), Some(b)) if a.points_world.len() == b.points_world.len() => {
                let offset = self.origins[1] - self.origins[0];
                let apart_m = |(a, b): (&glam::Vec3, &glam::Vec3)| (b.as_dvec3() - a.as_dvec3() - offset).length();
                let farthest_m = a.points_world.iter().zip(&b.points_world).map(apart_m).fold(0.0, f64::max);
                let origin_m = (b.origin_world - a.origin_world - offset).length();
                if farthest_m.max(origin_m) > self.within.point_m {
                    self.say(&format!("LiDAR: points up to {farthest_m:.4} m off, sensor {origin_m:.4} m"));
                }
            }
            (None, None) => {}
            (a, b) => {
                let count = |s: Option<&LidarSweep>| s.map(|s| s.points_world.len());
                self.say(&format!("LiDAR points: expected {:?}, found {:?}", count(a), count(b)));
            }
        }
    }

    fn times(&mut self, a: i64, b: i64) {
        if (a - b).abs() > self.within.time_ns {
            self.say(&format!("time: {} ns off", b - a));
        }
    }

    fn exposures(&mut self, name: &str, a: &Exposure, b: &Exposure) {
        let place = self.place.clone();
        self.place = format!("{place}: {name}");
        self.times(a.time_ns, b.time_ns);
        self.world_poses("vehicle", &a.world_from_ego, &b.world_from_ego);
        self.poses("mounting", &a.ego_from_camera, &b.ego_from_camera, DVec3::ZERO);
        self.lenses(&a.lens, &b.lens);
        self.place = place;
    }

    /// Lenses that take every pixel to the same direction.
    fn lenses(&mut self, a: &Lens, b: &Lens) {
        let size = |lens: &Lens| (lens.width_px, lens.height_px);
        if size(a) != size(b) {
            return self.say(&format!("picture: expected {:?}, found {:?}", size(a), size(b)));
        }
        let whole = DVec2::new(f64::from(a.width_px), f64::from(a.height_px));
        for share in [[0.02, 0.03], [0.5, 0.5], [0.98, 0.1], [0.1, 0.9], [0.8, 0.97]].map(DVec2::from_array) {
            let pixel = share * whole;
            let back = a.unproject(pixel).and_then(|direction| b.project(direction));
            if !back.is_some_and(|back| back.distance(pixel) < self.within.pixel) {
                return self.say(&format!("lens: {pixel} falls on {back:?}"));
            }
        }
    }

    fn world_poses<S: Frame>(&mut self, what: &str, a: &Pose<trove_model::World, S>, b: &Pose<trove_model::World, S>) {
        self.poses(what, a, b, self.origins[1] - self.origins[0]);
    }

    fn poses<D: Frame, S: Frame>(&mut self, what: &str, a: &Pose<D, S>, b: &Pose<D, S>, offset: DVec3) {
        let apart_m = (b.translation - a.translation - offset).length();
        // The angle of a small rotation, which `angle_between` loses to rounding.
        let apart_rad = 2.0 * (a.rotation.conjugate() * b.rotation).xyz().length().min(1.0).asin();
        if apart_m > self.within.position_m || apart_rad > self.within.rotation_rad {
            self.say(&format!("{what}: {apart_m:.5} m and {apart_rad:.2e} rad off"));
        }
    }

    /// The boxes of a keyframe that are the same by their places.
    fn boxes<'b>(&mut self, a: &'b [ObjectBox], b: &'b [ObjectBox]) -> Vec<(&'b ObjectBox, &'b ObjectBox)> {
        let offset = self.origins[1] - self.origins[0];
        let centre = |object: &ObjectBox| object.cuboid.world_from_body.translation;
        if a.len() != b.len() {
            self.say(&format!("expected {} boxes, found {}", a.len(), b.len()));
        }
        let mut pairs = Vec::new();
        for object in a {
            let apart_m = |other: &&ObjectBox| centre(other).distance(centre(object) + offset);
            let nearest = b.iter().min_by(|x, y| apart_m(x).total_cmp(&apart_m(y)));
            let Some(found) = nearest else { continue };
            let place = std::mem::take(&mut self.place);
            self.place = format!("{place}: {}", object.category);
            self.cuboids(&object.cuboid, &found.cuboid);
            if object.kind != found.kind {
                self.say(&format!("expected {:?}, found {:?}", object.kind, found.kind));
            }
            let apart_mps = object.velocity_mps.map(|v| found.velocity_mps.map(|found| found.distance(v)));
            if apart_mps.is_some_and(|apart| apart.is_none_or(|apart| apart > self.within.velocity_mps)) {
                self.say(&format!("velocity: expected {:?}, found {:?}", object.velocity_mps, found.velocity_mps));
            }
            self.place = place;
            pairs.push((object, found));
        }
        pairs
    }

    fn cuboids(&mut self, a: &Cuboid, b: &Cuboid) {
        self.world_poses("box", &a.world_from_body, &b.world_from_body);
        if (a.size_m - b.size_m).abs().max_element() > self.within.size_m {
            self.say(&format!("size: expected {}, found {}", a.size_m, b.size_m));
        }
    }
}

/// A change to the canonical drive is told in these words.
fn check(change: impl FnOnce(&mut Drive), expect: &str) {
    let mut changed = canonical::drive();
    change(&mut changed);
    let told = differences(&canonical::drive(), &changed, &TIGHT);
    assert!(told.iter().any(|line| line.contains(expect)), "expected '{expect}' in {told:#?}");
}

#[test]
fn the_canonical_drive_is_itself_and_no_other() {
    let drive = canonical::drive();
    assert_eq!(differences(&drive, &drive, &TIGHT), [""; 0]);
    let mut moved = canonical::drive();
    let east = DVec3::new(7.0, 0.0, 3.0);
    moved.projection.anchor_m -= DVec2::new(7.0, 0.0);
    for keyframe in &mut moved.keyframes {
        keyframe.world_from_ego.translation += east;
        keyframe.exposures.iter_mut().for_each(|e| e.world_from_ego.translation += east);
        keyframe.boxes.iter_mut().for_each(|b| b.cuboid.world_from_body.translation += east);
        if let Some(sweep) = &mut keyframe.lidar {
            sweep.origin_world += east;
            sweep.points_world.iter_mut().for_each(|p| *p += east.as_vec3());
        }
    }
    moved.path = moved.path.map(|_, pose| Pose::new(pose.rotation, pose.translation + east));
    for sweep in moved.sweeps.iter_mut().map(|sweep| &mut sweep.lidar) {
        sweep.origin_world += east;
        sweep.points_world.iter_mut().for_each(|p| *p += east.as_vec3());
    }
    assert_eq!(differences(&drive, &moved, &TIGHT), [""; 0], "another origin of World");
    check(|d| d.is_georeferenced = false, "georeferenced");
    check(|d| d.projection.origin_lat_deg += 1e-7, "place on earth: 0.0111 m");
    check(|d| d.keyframes[3].time_ns += 2000, "keyframe 3: time: 2000 ns");
    check(|d| d.keyframes[3].world_from_ego.translation.z += 0.002, "keyframe 3: vehicle: 0.00200 m");
    check(|d| d.keyframes[1].exposures[1].lens.cx_px += 0.5, "keyframe 1: CAM_LEFT: lens");
    check(|d| d.keyframes[1].exposures[1].lens.distortion = trove_model::Distortion::None, "CAM_LEFT: lens");
    check(|d| drop(d.keyframes[1].exposures.pop()), "CAM_LEFT: no picture");
    check(
        |d| {
            let turn = glam::DQuat::from_rotation_x(2e-6);
            d.keyframes[1].exposures[0].ego_from_camera.rotation *= turn;
        },
        "CAM_FRONT: mounting: 0.00000 m and 2.00e-6 rad",
    );
    check(|d| d.keyframes[2].boxes[0].cuboid.size_m.x += 0.002, "car: size");
    check(|d| d.keyframes[2].boxes[0].velocity_mps = None, "car: velocity");
    check(|d| d.keyframes[2].boxes[0].kind = trove_model::Kind::Truck, "car: expected Car, found Truck");
    check(|d| drop(d.keyframes[2].boxes.pop()), "expected 4 boxes, found 3");
    check(|d| d.keyframes[2].boxes[0].track = 1, "'car' changes from one track to another");
    check(|d| d.tracks[0].boxes.truncate(5), "track track-0");
    check(|d| d.keyframes[2].lidar.as_mut().unwrap().points_world[7].x += 0.01, "LiDAR: points up to 0.01");
    check(|d| d.path = d.path.clone().later(1_000_000), "path: 0.00801 m");
    check(|d| d.path = trove_model::Trajectory::default(), "path: expected 51 poses, found 0");
    check(|d| d.sweeps.clear(), "expected 1 sweeps, found 0");
    check(
        |d| d.sweeps[0].lidar.origin_world.z += 0.01,
        "between keyframes: LiDAR: points up to 0.0000 m off, sensor 0.01",
    );
    check(|d| d.keyframes[2].lidar = None, "LiDAR points: expected Some(360), found None");
}
