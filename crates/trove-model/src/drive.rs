//! A recorded drive, whatever dataset it came from.

use glam::{DVec2, DVec3, Vec3};

use crate::{Bounds, Camera, Cuboid, Ego, Kind, LaneMap, Lens, MapProjection, Pose, RigLidar, Trajectory, World};

/// One recorded scene: where the vehicle went, what its cameras saw, and who was there.
#[derive(Clone, Debug, PartialEq)]
pub struct Drive {
    /// The dataset's name of it (`scene-0103`).
    pub id: String,
    /// The dataset (`nuscenes`).
    pub dataset: String,
    /// Whether anybody drove it.
    pub origin: DriveOrigin,
    /// The dataset's name of the place (`boston-seaport`); empty where unknown.
    pub place: String,
    /// From latitude and longitude to World.
    pub projection: MapProjection,
    /// Whether World lies on the earth as [`Drive::projection`] says; otherwise that is only whereabouts it was recorded,
    /// enough for sun, season and customs, and no street map is laid on the drive.
    pub is_georeferenced: bool,
    /// Cameras in the order of their names.
    pub rig: Vec<RigCamera>,
    /// LiDARs of the vehicle, as far as the recording tells where they are.
    pub lidars: Vec<RigLidar>,
    /// The recording vehicle's own body.
    pub ego_body: EgoBody,
    /// Annotated moments in the order of time.
    pub keyframes: Vec<Keyframe>,
    /// The vehicle between the keyframes too; empty where the recording knows no more than they do.
    pub path: Trajectory<World, Ego>,
    /// What the LiDAR saw between the keyframes, in the order of time.
    pub sweeps: Vec<Sweep>,
    /// Objects followed over time; [`ObjectBox::track`] is an index into it.
    pub tracks: Vec<Track>,
    /// The dataset's own map.
    pub lane_map: Option<LaneMap>,
    /// Licence of what came out of the dataset, with its name (`CC BY-NC-SA 4.0`).
    pub licence: String,
}

/// How a drive came about.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum DriveOrigin {
    /// Somebody drove and recorded it.
    Recorded,
    /// Its keyframes were put onto a street map's roads.
    MadeUp,
}

/// A camera of the vehicle.
#[derive(Clone, Debug, PartialEq)]
pub struct RigCamera {
    /// The dataset's name of it (`CAM_FRONT`).
    pub name: String,
    /// Intrinsics.
    pub lens: Lens,
    /// Mounting.
    pub ego_from_camera: Pose<Ego, Camera>,
}

/// The recording vehicle's own box, which no dataset annotates.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EgoBody {
    /// Centre of the box in Ego, metres.
    pub centre_ego: DVec3,
    /// Length, width, height.
    pub size_m: DVec3,
}

/// An annotated moment.
#[derive(Clone, Debug, PartialEq)]
pub struct Keyframe {
    /// Time of the annotation, nanoseconds since 1970 UTC.
    pub time_ns: i64,
    /// The dataset's name of it.
    pub token: String,
    /// Vehicle at that time.
    pub world_from_ego: Pose<World, Ego>,
    /// What the cameras took for it: one entry a camera of the rig, at most, in the rig's order.
    pub exposures: Vec<Exposure>,
    /// Annotated objects.
    pub boxes: Vec<ObjectBox>,
    /// The LiDAR's points, where the recording is at hand.
    pub lidar: Option<LidarSweep>,
}

/// One picture's own time and poses; cameras do not fire together.
#[derive(Clone, Debug, PartialEq)]
pub struct Exposure {
    /// Index into [`Drive::rig`].
    pub camera: usize,
    /// Time of the picture, nanoseconds since 1970 UTC.
    pub time_ns: i64,
    /// Vehicle at that time.
    pub world_from_ego: Pose<World, Ego>,
    /// Intrinsics of this picture (a dataset may calibrate anew between logs).
    pub lens: Lens,
    /// Mounting at that time.
    pub ego_from_camera: Pose<Ego, Camera>,
    /// The dataset's name of the picture; `None` where none was taken.
    pub token: Option<String>,
    /// The recorded picture's path below the dataset's root; `None` where it is not at hand or lies inside another file.
    pub file: Option<String>,
}

impl Exposure {
    /// Pose of the camera.
    pub fn world_from_camera(&self) -> Pose<World, Camera> {
        self.world_from_ego * self.ego_from_camera
    }
}

/// One annotated object at one moment.
#[derive(Clone, Debug, PartialEq)]
pub struct ObjectBox {
    /// Index into [`Drive::tracks`].
    pub track: usize,
    /// What it is.
    pub kind: Kind,
    /// The dataset's own category.
    pub category: String,
    /// The dataset's name of this annotation.
    pub token: String,
    /// Box at the keyframe's time; x forward.
    pub cuboid: Cuboid,
    /// Velocity in World; `None` where it cannot be told.
    pub velocity_mps: Option<DVec3>,
    /// Whether the annotator calls it parked; `None` where that is not told.
    pub is_parked: Option<bool>,
    /// The dataset's attributes.
    pub attributes: Vec<String>,
    /// LiDAR points in the box; `None` where unknown.
    pub lidar_points: Option<u32>,
    /// Visible share by the annotator's judgement, 0 to 1, the middle of the dataset's bin; `None` where unknown.
    pub visibility: Option<f32>,
}

/// An object over time.
#[derive(Clone, Debug, PartialEq)]
pub struct Track {
    /// The dataset's name of it.
    pub token: String,
    /// What it is.
    pub kind: Kind,
    /// Its boxes as (index of the keyframe, box), in the order of time.
    pub boxes: Vec<(usize, Cuboid)>,
}

impl Track {
    /// The box at a keyframe; `None` where it was not annotated then.
    pub fn at(&self, keyframe: usize) -> Option<Cuboid> {
        self.boxes.iter().find(|(k, _)| *k == keyframe).map(|(_, cuboid)| *cuboid)
    }
}

/// What a LiDAR point lies on, where the dataset says.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[allow(missing_docs)] // the names are the definition
pub enum LidarClass {
    Road,
    Sidewalk,
    Terrain,
    Vegetation,
    /// Building or other structure.
    Manmade,
    /// Annotated objects, noise, and what is not known.
    Other,
}

/// Points of one LiDAR revolution.
#[derive(Clone, Debug, PartialEq)]
pub struct LidarSweep {
    /// Where the sensor was, World.
    pub origin_world: DVec3,
    /// Points in World, metres.
    pub points_world: Vec<Vec3>,
    /// One entry a point; empty where the dataset has no labels.
    pub classes: Vec<LidarClass>,
}

/// One LiDAR revolution that no keyframe has.
#[derive(Clone, Debug, PartialEq)]
pub struct Sweep {
    /// Time of it, nanoseconds since 1970 UTC.
    pub time_ns: i64,
    /// Its points.
    pub lidar: LidarSweep,
}

impl LidarSweep {
    /// Height angle of the highest beam, radians over the horizon: only one point in a hundred is above it; a quarter turn
    /// where there are no points.
    pub fn highest_beam_rad(&self) -> f64 {
        let mut heights: Vec<f64> = self.points_world.iter().map(|p| self.height_rad(p.as_dvec3())).collect();
        heights.retain(|h| h.is_finite());
        heights.sort_by(f64::total_cmp);
        heights.get(heights.len() * 99 / 100).copied().unwrap_or(std::f64::consts::FRAC_PI_2)
    }

    /// Height angle of a point of World as the sensor sees it, radians over the horizon.
    pub fn height_rad(&self, point: DVec3) -> f64 {
        let ray = point - self.origin_world;
        (ray.z / ray.length().max(1e-6)).asin()
    }

    /// Moves sensor and points.
    pub fn move_by(&mut self, moved: &Pose<World, World>) {
        self.origin_world = moved.point(self.origin_world);
        self.points_world.iter_mut().for_each(|p| *p = moved.point(p.as_dvec3()).as_vec3());
    }
}

impl Drive {
    /// Rectangle around the driven path, the annotated objects and the LiDAR points nearer than `reach_m` to the
    /// path; `None` for a drive without keyframes.
    pub fn bounds(&self, reach_m: f64) -> Option<Bounds> {
        let path = self.keyframes.iter().map(|k| k.world_from_ego.translation.truncate());
        let boxes =
            self.keyframes.iter().flat_map(|k| &k.boxes).map(|b| b.cuboid.world_from_body.translation.truncate());
        let points = self.keyframes.iter().filter_map(|k| k.lidar.as_ref()).flat_map(move |sweep| {
            let origin = sweep.origin_world.truncate();
            let near = move |p: &glam::DVec2| p.distance(origin) < reach_m;
            sweep.points_world.iter().map(|p| p.as_dvec3().truncate()).filter(near)
        });
        Bounds::around(path.chain(boxes).chain(points))
    }

    /// The vehicle at a time, nanoseconds since 1970 UTC: on its path, else between the keyframes, and at the first or last
    /// beyond them; `None` for a drive without keyframes.
    pub fn world_from_ego_at(&self, time_ns: i64) -> Option<Pose<World, Ego>> {
        self.path.at(time_ns).or_else(|| {
            let next = self.keyframes.partition_point(|k| k.time_ns <= time_ns);
            let (before, after) = (next.checked_sub(1).and_then(|i| self.keyframes.get(i)), self.keyframes.get(next));
            let (Some(a), Some(b)) = (before, after) else { return before.or(after).map(|k| k.world_from_ego) };
            let share = time_ns.saturating_sub(a.time_ns) as f64 / b.time_ns.saturating_sub(a.time_ns) as f64;
            Some(a.world_from_ego.interpolate(&b.world_from_ego, share))
        })
    }

    /// Laid in another World, whose z axis is this one's: everything recorded, and the dataset's own map, turned by
    /// `turn_rad` counter-clockwise about the origin and then shifted in plane.
    pub fn moved(mut self, turn_rad: f64, shift_m: DVec2) -> Self {
        let moved = Pose::<World, World>::from_yaw(turn_rad, shift_m.extend(0.0));
        for keyframe in &mut self.keyframes {
            keyframe.world_from_ego = moved * keyframe.world_from_ego;
            for exposure in &mut keyframe.exposures {
                exposure.world_from_ego = moved * exposure.world_from_ego;
            }
            for object in &mut keyframe.boxes {
                object.cuboid.world_from_body = moved * object.cuboid.world_from_body;
                object.velocity_mps = object.velocity_mps.map(|velocity| moved.vector(velocity));
            }
            if let Some(sweep) = &mut keyframe.lidar {
                sweep.move_by(&moved);
            }
        }
        self.path = self.path.map(|_, pose| moved * *pose);
        self.sweeps.iter_mut().for_each(|sweep| sweep.lidar.move_by(&moved));
        for (_, cuboid) in self.tracks.iter_mut().flat_map(|track| &mut track.boxes) {
            cuboid.world_from_body = moved * cuboid.world_from_body;
        }
        if let Some(map) = &mut self.lane_map {
            map.move_points(|p| moved.point(p.extend(0.0)).truncate());
        }
        self
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Polygon;

    #[test]
    fn everything_of_a_moved_drive_keeps_its_place_from_the_vehicle() {
        let pose = Pose::from_yaw(0.3, DVec3::new(4.0, 5.0, 1.0));
        let cuboid = Cuboid { world_from_body: Pose::from_yaw(1.0, DVec3::new(9.0, 2.0, 1.5)), size_m: DVec3::ONE };
        let lens = Lens {
            width_px: 10,
            height_px: 10,
            fx_px: 10.0,
            fy_px: 10.0,
            cx_px: 5.0,
            cy_px: 5.0,
            distortion: crate::Distortion::None,
        };
        let object = ObjectBox {
            track: 0,
            kind: Kind::Car,
            category: String::new(),
            token: String::new(),
            cuboid,
            velocity_mps: Some(DVec3::X),
            is_parked: None,
            attributes: Vec::new(),
            lidar_points: None,
            visibility: None,
        };
        let exposure = Exposure {
            camera: 0,
            time_ns: 0,
            world_from_ego: pose,
            lens,
            ego_from_camera: Pose::IDENTITY,
            token: None,
            file: None,
        };
        let sweep = LidarSweep {
            origin_world: DVec3::new(4.0, 5.0, 2.7),
            points_world: vec![Vec3::new(7.0, 8.0, 0.0)],
            classes: Vec::new(),
        };
        let keyframe = Keyframe {
            time_ns: 0,
            token: String::new(),
            world_from_ego: pose,
            exposures: vec![exposure],
            boxes: vec![object],
            lidar: Some(sweep.clone()),
        };
        let corners = [[6.0, 6.0], [9.0, 6.0], [9.0, 9.0]].map(DVec2::from_array).to_vec();
        let drive = Drive {
            id: String::new(),
            dataset: String::new(),
            origin: DriveOrigin::Recorded,
            place: String::new(),
            projection: MapProjection::spherical(0.0, 0.0, DVec2::ZERO),
            is_georeferenced: false,
            rig: Vec::new(),
            lidars: Vec::new(),
            ego_body: EgoBody { centre_ego: DVec3::ZERO, size_m: DVec3::ONE },
            keyframes: vec![keyframe],
            path: Trajectory::new(vec![(0, pose)]).0,
            sweeps: vec![Sweep { time_ns: 0, lidar: sweep }],
            tracks: vec![Track { token: String::new(), kind: Kind::Car, boxes: vec![(0, cuboid)] }],
            lane_map: Some(LaneMap { drivable: vec![Polygon::simple(corners)], ..LaneMap::default() }),
            licence: String::new(),
        };
        let seen = |drive: &Drive| {
            let keyframe = &drive.keyframes[0];
            let ego = keyframe.world_from_ego.inverse();
            let (object, sweep) = (&keyframe.boxes[0], keyframe.lidar.as_ref().unwrap());
            let corner = drive.lane_map.as_ref().unwrap().drivable[0].exterior[0];
            vec![
                ego.point(object.cuboid.world_from_body.point(DVec3::X)),
                ego.vector(object.velocity_mps.unwrap()),
                ego.point(drive.tracks[0].boxes[0].1.world_from_body.translation),
                ego.point(sweep.origin_world),
                ego.point(sweep.points_world[0].as_dvec3()),
                ego.point(keyframe.exposures[0].world_from_ego.point(DVec3::X)),
                ego.point(corner.extend(0.0)),
                ego.point(drive.path.at(0).unwrap().point(DVec3::X)),
                ego.point(drive.sweeps[0].lidar.points_world[0].as_dvec3()),
            ]
        };
        assert_eq!(drive.world_from_ego_at(0), Some(pose));
        assert_eq!(drive.world_from_ego_at(-9), Some(pose), "at the first keyframe");
        let before = seen(&drive);
        let moved = drive.moved(1.2, DVec2::new(-30.0, 7.0));
        for (a, b) in before.iter().zip(seen(&moved)) {
            assert!(a.distance(b) < 1e-5, "{a} {b}");
        }
        assert!((moved.keyframes[0].world_from_ego.yaw_rad() - 1.5).abs() < 1e-12);
    }
}
