//! The rig on other vehicles of the scene.

use glam::DVec3;
use trove_model::{
    Camera, Cuboid, Drive, Ego, Kind, ObjectBox, Outcome, Pose, Report, RigCamera, Shot, Viewpoint, World,
};

use super::motion;
use super::settings::{ViewSettings, shot_seed};
use crate::place::Seeds;
use crate::place::{next, previous};
use crate::site::{Site, track_id};

/// Cameras keep this far from everything but their carrier, metres.
const CAMERA_CLEARANCE_M: f64 = 0.3;
/// A vehicle with so much room around it is preferred, metres.
const ROOM_M: f64 = 2.0;
/// A vehicle faster than this moves.
const MOVING_MPS: f64 = 0.5;
/// The rig is lifted in such steps, and at most so many, until its cameras stand clear.
const LIFT_STEP_M: f64 = 0.25;
const LIFT_STEPS: u32 = 10;

/// What stands in a camera's way at one moment.
struct Obstacles<'a> {
    site: &'a Site,
    /// Boxes of all recorded objects, with their tracks, and of the recording vehicle.
    boxes: Vec<(Option<usize>, Cuboid)>,
}

/// The rig on up to `views.other_vehicles` vehicles: moving ones and those with room around them first.
pub(super) fn shots(
    drive: &Drive,
    site: &Site,
    keyframe: usize,
    views: &ViewSettings,
    seeds: &Seeds,
    report: &Report,
) -> Vec<Shot> {
    if views.other_vehicles == 0 {
        return Vec::new();
    }
    let moment = &drive.keyframes[keyframe];
    let obstacles = Obstacles::at(drive, site, keyframe);

    // Every vehicle gets a rank, and a draw among those of its rank.
    let mut random = seeds.rigs.child("views").child("carriers").nth(keyframe as u64).random();
    let mut candidates: Vec<(u32, u64, &ObjectBox, Cuboid)> = Vec::new();
    for vehicle in moment.boxes.iter().filter(|b| can_carry(b.kind)) {
        let draw = random.bits();
        let Some(cuboid) = site.placed(vehicle.track, keyframe) else { continue };
        let moving = vehicle.velocity_mps.is_some_and(|v| v.length() > MOVING_MPS);
        let roomy = obstacles.is_roomy(vehicle.track, &cuboid);
        candidates.push((2 * u32::from(!roomy) + u32::from(!moving), draw, vehicle, cuboid));
    }
    candidates.sort_by_key(|(rank, draw, ..)| (*rank, *draw));

    let mut shots = Vec::new();
    let mut carriers = 0;
    for (_, _, vehicle, cuboid) in candidates {
        if carriers == views.other_vehicles {
            break;
        }
        let Some(lift_m) = obstacles.clear_lift_m(drive, views, vehicle.track, &cuboid) else {
            report.note(Outcome::Dropped, "vehicle whose rig would be inside other geometry", &vehicle.token);
            continue;
        };
        carriers += 1;
        let carrier = Carrier { track: vehicle.track, number: carriers, lift_m };
        shots.extend(carrier.shots(drive, site, keyframe, views, seeds));
    }
    if carriers < views.other_vehicles {
        let example = format!("{} keyframe {keyframe}: {carriers} of {}", drive.id, views.other_vehicles);
        report.note(Outcome::Warned, "fewer vehicles than asked for can carry the rig", example);
    }
    shots
}

/// A vehicle that carries the rig.
struct Carrier {
    track: usize,
    /// From 1, in the order in which they were chosen.
    number: usize,
    /// How far its rig is lifted to stand clear.
    lift_m: f64,
}

impl Carrier {
    fn shots(&self, drive: &Drive, site: &Site, keyframe: usize, views: &ViewSettings, seeds: &Seeds) -> Vec<Shot> {
        let moment = &drive.keyframes[keyframe];
        let world_from_rig = |k: Option<usize>| Some(world_from_rig(drive, &site.placed(self.track, k?)?, self.lift_m));
        let Some(now) = world_from_rig(Some(keyframe)) else { return Vec::new() };
        let neighbours = [previous(drive, keyframe), next(drive, keyframe)];
        let [before, after] = neighbours.map(world_from_rig);
        let beside = |k: Option<usize>, mounted: Pose<Ego, Camera>| {
            motion::at_keyframe(
                moment.time_ns,
                world_from_rig(k).zip(k).map(|(rig, k)| (rig * mounted, drive.keyframes[k].time_ns)),
            )
        };
        let cameras = drive.rig.iter().enumerate().filter(|(_, c)| views.wants(&c.name));
        let mounted = |camera: &RigCamera| views.mounted(&camera.ego_from_camera);
        cameras
            .map(|(index, camera)| {
                let view = format!("v{}.{}", self.number, camera.name);
                Shot {
                    viewpoint: Viewpoint::OtherVehicle { number: self.number, camera: index },
                    lens: views.lens(&camera.name, &camera.lens),
                    world_from_camera: now * mounted(camera),
                    world_from_camera_previous: before.map(|rig| rig * mounted(camera)),
                    world_from_camera_next: after.map(|rig| rig * mounted(camera)),
                    beside: neighbours.map(|k| beside(k, mounted(camera))),
                    time_ns: moment.time_ns,
                    shutter: views.shutter(),
                    spp: views.spp,
                    noise: views.noise,
                    film: views.film,
                    seed: shot_seed(seeds, keyframe, &view),
                    carrier: Some(track_id(self.track)),
                    view,
                }
            })
            .collect()
    }
}

fn can_carry(kind: Kind) -> bool {
    matches!(kind, Kind::Car | Kind::PoliceCar | Kind::Ambulance | Kind::Truck | Kind::Bus | Kind::ArticulatedBus)
}

/// Where the rig's own vehicle would be, were its front where the carrier's is and its roof not below the carrier's.
///
/// The origin of the recording vehicle is the middle of its rear axle on the ground; it keeps its distance from the
/// front bumper, so the cameras look over the carrier's front as they do over their own.
fn world_from_rig(drive: &Drive, carrier: &Cuboid, lift_m: f64) -> Pose<World, Ego> {
    let own = drive.ego_body;
    let front_of_axle_m = own.centre_ego.x + own.size_m.x / 2.0;
    let own_roof_m = own.centre_ego.z + own.size_m.z / 2.0;
    let above_roof_m = (carrier.size_m.z - own_roof_m).max(0.0);
    let origin_body =
        DVec3::new(carrier.size_m.x / 2.0 - front_of_axle_m, 0.0, -carrier.size_m.z / 2.0 + above_roof_m + lift_m);
    Pose::new(carrier.world_from_body.rotation, carrier.world_from_body.point(origin_body))
}

impl<'a> Obstacles<'a> {
    fn at(drive: &Drive, site: &'a Site, keyframe: usize) -> Self {
        let moment = &drive.keyframes[keyframe];
        let placed = |track: usize| site.placed(track, keyframe);
        let mut boxes: Vec<(Option<usize>, Cuboid)> =
            moment.boxes.iter().filter_map(|b| Some((Some(b.track), placed(b.track)?))).collect();
        boxes.extend(placed(drive.tracks.len()).map(|ego| (None, ego)));
        Self { site, boxes }
    }

    fn others(&self, track: usize) -> impl Iterator<Item = &Cuboid> {
        self.boxes.iter().filter(move |(t, _)| *t != Some(track)).map(|(_, c)| c)
    }

    /// Whether nothing else is within [`ROOM_M`] of a vehicle.
    fn is_roomy(&self, track: usize, vehicle: &Cuboid) -> bool {
        let room = vehicle.grown(ROOM_M);
        let in_room = |other: &Cuboid| {
            other.corners_world().iter().any(|&c| room.contains(c))
                || room.corners_world().iter().any(|&c| other.contains(c))
                || room.contains(other.world_from_body.translation)
        };
        !self.others(track).any(in_room)
    }

    /// How far the rig must be lifted for all its cameras to stand clear; `None` where that is too far.
    fn clear_lift_m(&self, drive: &Drive, views: &ViewSettings, track: usize, vehicle: &Cuboid) -> Option<f64> {
        (0..=LIFT_STEPS).map(|step| f64::from(step) * LIFT_STEP_M).find(|&lift_m| {
            let world_from_rig = world_from_rig(drive, vehicle, lift_m);
            drive.rig.iter().all(|c| {
                let eye_ego = views.mounted(&c.ego_from_camera).translation;
                self.is_clear(track, world_from_rig.point(eye_ego))
            })
        })
    }

    fn is_clear(&self, track: usize, camera_world: DVec3) -> bool {
        let touches = |c: &Cuboid| c.grown(CAMERA_CLEARANCE_M).contains(camera_world);
        let ground = camera_world.truncate();
        let in_building =
            |p: &trove_model::Polygon| p.contains(ground) || p.edge_distance_m(ground) < CAMERA_CLEARANCE_M;
        !self.others(track).any(touches)
            && !self.site.fixed_boxes().any(touches)
            && !self.site.footprints().iter().any(in_building)
    }
}
