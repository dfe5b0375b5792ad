//! The rig on other vehicles of the scene: who carries it, and for how long.

use std::collections::BTreeMap;
use std::ops::Range;

use glam::DVec3;
use trove_model::{Camera, Cuboid, Drive, Ego, Kind, Outcome, Pose, Report, RigCamera, Shot, Viewpoint, World};

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

/// A vehicle's time as a carrier of the rig, without a break.
#[derive(Clone, Debug)]
pub(super) struct Stay {
    /// From 1, in the order in which stays begin; no other stay has it.
    number: usize,
    track: usize,
    keyframes: Range<usize>,
    /// How far its rig is lifted to stand clear all the while.
    lift_m: f64,
}

/// Who carries the rig over the whole drive: at each keyframe up to `views.other_vehicles`. Who carries it does so as long
/// as it is there; where one has left, one follows that is there long, moves and has room around it.
pub(super) fn stays(drive: &Drive, site: &Site, views: &ViewSettings, seeds: &Seeds, report: &Report) -> Vec<Stay> {
    if views.other_vehicles == 0 {
        return Vec::new();
    }
    let moments: Vec<Obstacles> = (0..drive.keyframes.len()).map(|k| Obstacles::at(drive, site, k)).collect();
    let run = |track: usize, from: usize| {
        let follows = |&k: &usize| next(drive, k) == Some(k + 1) && can_carry_at(drive, site, track, k + 1);
        from..(from..).find(|k| !follows(k)).map_or(from, |last| last + 1)
    };
    let worth = worth(drive, site, &moments);
    // The seed chooses among those that are about as good.
    let drawn = |track: usize| seeds.rigs.child("views").child("carriers").nth(track as u64).random().range(0.5, 1.0);
    let mut stays: Vec<Stay> = Vec::new();
    // Where a vehicle's rig found no clear place: as long as it stands there it is not asked again.
    let mut blocked: BTreeMap<usize, Cuboid> = BTreeMap::new();
    for (keyframe, moment) in drive.keyframes.iter().enumerate() {
        let carries = |stays: &[Stay], track: Option<usize>| {
            let there = |s: &&Stay| s.keyframes.contains(&keyframe) && track.is_none_or(|track| s.track == track);
            stays.iter().filter(there).count()
        };
        let free = moment
            .boxes
            .iter()
            .map(|b| b.track)
            .filter(|&track| can_carry_at(drive, site, track, keyframe) && carries(&stays, Some(track)) == 0);
        let mut candidates: Vec<(f64, usize)> = free
            .map(|track| {
                let worth: u32 = run(track, keyframe).filter_map(|k| worth.get(&(track, k))).sum();
                (f64::from(worth) * drawn(track), track)
            })
            .collect();
        candidates.sort_by(|a, b| b.0.total_cmp(&a.0).then(a.1.cmp(&b.1)));
        for (_, track) in candidates {
            if carries(&stays, None) == views.other_vehicles {
                break;
            }
            let Some(here) = site.placed(track, keyframe).filter(|here| blocked.get(&track) != Some(here)) else {
                continue;
            };
            match clear_run(drive, site, views, &moments, track, run(track, keyframe)) {
                Some((keyframes, lift_m)) => stays.push(Stay { number: stays.len() + 1, track, keyframes, lift_m }),
                None => {
                    if !blocked.contains_key(&track) {
                        let what = "vehicle whose rig would be inside other geometry";
                        report.note(Outcome::Dropped, what, &drive.tracks[track].token);
                    }
                    blocked.insert(track, here);
                }
            }
        }
    }
    stays
}

/// The shots of the rig on all who carry it at a keyframe.
pub(super) fn shots(
    drive: &Drive,
    site: &Site,
    keyframe: usize,
    views: &ViewSettings,
    stays: &[Stay],
    seeds: &Seeds,
    report: &Report,
) -> Vec<Shot> {
    let there: Vec<&Stay> = stays.iter().filter(|stay| stay.keyframes.contains(&keyframe)).collect();
    if there.len() < views.other_vehicles {
        let example = format!("{} keyframe {keyframe}: {} of {}", drive.id, there.len(), views.other_vehicles);
        report.note(Outcome::Warned, "fewer vehicles than asked for can carry the rig", example);
    }
    there.into_iter().flat_map(|stay| stay.shots(drive, site, keyframe, views, seeds)).collect()
}

/// What each vehicle is worth as a carrier at each keyframe, by track and keyframe: 1 for being there, 1 more where it moves,
/// 2 more where it has room around it.
fn worth(drive: &Drive, site: &Site, moments: &[Obstacles]) -> BTreeMap<(usize, usize), u32> {
    let mut worth = BTreeMap::new();
    for (k, (keyframe, obstacles)) in drive.keyframes.iter().zip(moments).enumerate() {
        for vehicle in keyframe.boxes.iter().filter(|b| can_carry(b.kind)) {
            let Some(cuboid) = site.placed(vehicle.track, k) else { continue };
            let moves = vehicle.velocity_mps.is_some_and(|v| v.length() > MOVING_MPS);
            let is_roomy = obstacles.is_roomy(vehicle.track, &cuboid);
            worth.insert((vehicle.track, k), 1 + u32::from(moves) + 2 * u32::from(is_roomy));
        }
    }
    worth
}

/// The part of a run, from its start, in which a vehicle's rig stands clear by one lift: the longest, and of lifts that do
/// as well the lowest; `None` where none is clear at the start.
fn clear_run(
    drive: &Drive,
    site: &Site,
    views: &ViewSettings,
    moments: &[Obstacles],
    track: usize,
    run: Range<usize>,
) -> Option<(Range<usize>, f64)> {
    let mut best = (run.start, 0.0);
    for step in 0..=LIFT_STEPS {
        let lift_m = f64::from(step) * LIFT_STEP_M;
        let is_clear = |&k: &usize| {
            site.placed(track, k).is_some_and(|vehicle| moments[k].is_clear_of(drive, views, track, &vehicle, lift_m))
        };
        let end = run.start + run.clone().take_while(is_clear).count();
        if end > best.0 {
            best = (end, lift_m);
        }
        if end == run.end {
            break;
        }
    }
    let (end, lift_m) = best;
    (end > run.start).then_some((run.start..end, lift_m))
}

impl Stay {
    fn shots(&self, drive: &Drive, site: &Site, keyframe: usize, views: &ViewSettings, seeds: &Seeds) -> Vec<Shot> {
        let moment = &drive.keyframes[keyframe];
        let world_from_rig = |k: Option<usize>| Some(world_from_rig(drive, &site.placed(self.track, k?)?, self.lift_m));
        let Some(now) = world_from_rig(Some(keyframe)) else { return Vec::new() };
        let neighbours = [previous(drive, keyframe), next(drive, keyframe)];
        // Flow leads to pictures that there are.
        let [before, after] = neighbours.map(|k| world_from_rig(k.filter(|k| self.keyframes.contains(k))));
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
                    world_from_ego: Some(now),
                    world_from_camera: now * mounted(camera),
                    world_from_camera_previous: before.map(|rig| rig * mounted(camera)),
                    world_from_camera_next: after.map(|rig| rig * mounted(camera)),
                    beside: neighbours.map(|k| beside(k, mounted(camera))),
                    time_ns: moment.time_ns,
                    shutter: views.shutter(),
                    spp: views.spp,
                    noise: views.noise,
                    cache: views.cache,
                    drops: views.drops(seeds, &view),
                    film: views.film,
                    labels: views.labels.clone(),
                    seed: shot_seed(seeds, keyframe, &view),
                    carrier: Some(track_id(self.track)),
                    view,
                }
            })
            .collect()
    }
}

/// Whether a track is there at a keyframe as a vehicle that can carry the rig.
fn can_carry_at(drive: &Drive, site: &Site, track: usize, keyframe: usize) -> bool {
    let is_annotated = drive.keyframes[keyframe].boxes.iter().any(|b| b.track == track && can_carry(b.kind));
    is_annotated && site.placed(track, keyframe).is_some()
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

    /// Whether all cameras of a vehicle's rig stand clear.
    fn is_clear_of(&self, drive: &Drive, views: &ViewSettings, track: usize, vehicle: &Cuboid, lift_m: f64) -> bool {
        let world_from_rig = world_from_rig(drive, vehicle, lift_m);
        drive.rig.iter().all(|c| {
            let eye_ego = views.mounted(&c.ego_from_camera).translation;
            self.is_clear(track, world_from_rig.point(eye_ego))
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
