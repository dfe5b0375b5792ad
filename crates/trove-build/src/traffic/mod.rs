//! Fewer road users than were recorded, or more: made up, they are cast, placed and labelled as recorded ones are.

mod motion;
mod parking;
mod room;
mod shares;
#[cfg(test)]
mod tests;
mod ways;

use std::collections::BTreeSet;
use std::ops::Range;

use trove_model::{Class, Cuboid, Drive, DriveOrigin, Kind, Outcome, Report, Seed, Track, TrafficMix};

use crate::assembly::Assembly;
use crate::between::Moments;
use crate::place::{Place, next, previous};
use crate::surroundings::Clearance;
use crate::surroundings::Surroundings;
use motion::Motion;
use parking::Streets;
use room::Room;
use shares::Shares;
use ways::Ways;

/// How many road users there are.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Traffic {
    /// Road users against the recorded number, or, where the place is made up, against what is usual there; 1 leaves them
    /// as they are.
    pub density: f64,
    /// Cyclists among those who are added, against what is usual at the place.
    pub cyclists: f64,
}

impl Default for Traffic {
    fn default() -> Self {
        Self { density: 1.0, cyclists: 1.0 }
    }
}

/// Where nobody was recorded so many are usual at each standpoint, beside those who are parked.
const USUAL: usize = 32;
/// On so many metres of kerb at most one vehicle is parked.
const PARKED_M: usize = 4;
/// Places that are looked at for someone before the place counts as full.
const TRIES: usize = 40;
/// Someone whom nobody recorded.
pub(crate) struct RoadUser {
    /// Whose token is of no dataset: it tells road users of one place apart.
    pub track: Track,
    /// The same with boxes at all moments, where these are not the keyframes.
    pub at_moments: Option<Track>,
    /// Along its own heading, always the same.
    pub speed_mps: f64,
}

/// Whether traffic is made of it: vehicles, people, animals.
fn is_road_user(kind: Kind) -> bool {
    kind.is_vehicle() || kind.class() == Class::Human || kind == Kind::Animal
}

/// The recorded tracks that are left out where `density` is below 1: each road user by a draw of its own, so that a lower
/// density leaves out the same ones and more.
pub(crate) fn absent(drive: &Drive, density: f64, seed: Seed, report: &Report) -> BTreeSet<usize> {
    let leaves = |track: &Track| is_road_user(track.kind) && !seed.child(&track.token).random().chance(density);
    let tracks = drive.tracks.iter().enumerate().filter(|(_, track)| density < 1.0 && leaves(track));
    tracks
        .map(|(i, track)| {
            let example = format!("{} ({})", track.token, track.kind.name());
            report.note(Outcome::Dropped, "recorded road user left out for less traffic", example);
            i
        })
        .collect()
}

/// How many road users are added, but for those parked by habit.
fn wanted(drive: &Drive, density: f64) -> usize {
    let recorded = drive.tracks.iter().filter(|track| is_road_user(track.kind)).count();
    let standpoints = || (0..drive.keyframes.len()).filter(|&k| previous(drive, k).is_none()).count();
    let usual = if recorded > 0 { recorded } else { USUAL * standpoints() };
    let more = if is_made_up(drive) { density } else { (density - 1.0).max(0.0) };
    (more * usual as f64).round() as usize
}

/// The most road users that are added.
pub(crate) fn most_added(around: &Surroundings, density: f64) -> usize {
    let drive = around.place.drive;
    let kerbs_m: usize = around.kerbs.runs.iter().map(Vec::len).sum();
    let parked = if is_made_up(drive) && density > 0.0 { kerbs_m / PARKED_M } else { 0 };
    wanted(drive, density) + parked
}

fn is_made_up(drive: &Drive) -> bool {
    drive.origin == DriveOrigin::MadeUp
}

/// Makes road users up, who meet nobody at any keyframe nor halfway between two; `assembly` has all that stands still.
pub(crate) fn added(
    around: &Surroundings,
    absent: &BTreeSet<usize>,
    clearance: &Clearance,
    assembly: &Assembly,
    moments: Moments,
    traffic: Traffic,
    seed: Seed,
) -> Vec<RoadUser> {
    let Place { drive, library, report, .. } = *around.place;
    let wanted = wanted(drive, traffic.density);
    let mut users: Vec<RoadUser> = Vec::new();
    if wanted == 0 {
        return users;
    }
    let mix = around.place.locale.traffic;
    let ways = Ways::new(around);
    let mut room = Room::new(around, absent, clearance, assembly);
    let found = |motion: &Motion, visit: &room::Visit, number: usize, keyframe: usize| {
        let user = user(around, motion, visit, number);
        let at_moments = at_moments(around, motion, &user.track, keyframe, moments);
        RoadUser { at_moments, ..user }
    };
    // Vehicles are parked for as long as anybody looks, and leave those who move what room there is.
    let mix = if is_made_up(drive) {
        let shares = Shares::of(&mix, library, traffic.cyclists);
        let streets = Streets::new(around, traffic.density, ways.crossings());
        let always = 0..drive.keyframes.len();
        for motion in streets.parked(&shares, &mut seed.child("parked").random()) {
            let Some(visit) = room.visit(&motion, 0, &always) else { continue };
            room.take(&visit);
            users.push(found(&motion, &visit, users.len(), 0));
            report.note(Outcome::Guessed, "vehicle parked by the habit of the place", motion.kind.name());
        }
        TrafficMix { parked: 0.0, ..mix }
    } else {
        mix
    };
    let wanted = wanted + users.len();
    let shares = Shares::of(&mix, library, traffic.cyclists);
    // Some find no place, and some come together.
    for i in 0..2 * (wanted - users.len()) as u64 {
        let mut random = seed.nth(i).random();
        let keyframe = random.index(drive.keyframes.len());
        let Some(doing) = shares.draw(&mut random) else { break };
        let run = run(drive, keyframe);
        for _ in 0..TRIES {
            let group = ways.group(doing, keyframe, &shares, &mut random);
            let visits: Option<Vec<_>> = group.iter().map(|motion| room.visit(motion, keyframe, &run)).collect();
            let Some(visits) = visits.filter(|visits| !visits.is_empty()) else { continue };
            for (motion, visit) in group.iter().zip(visits) {
                if users.len() < wanted {
                    room.take(&visit);
                    users.push(found(motion, &visit, users.len(), keyframe));
                    report.note(Outcome::Guessed, "road user added for more traffic", doing);
                }
            }
            break;
        }
        if users.len() == wanted {
            break;
        }
    }
    if users.len() < wanted {
        let example = format!("{}: {} of {wanted}", drive.id, users.len());
        report.note(Outcome::Warned, "no room for all road users asked for", example);
    }
    users
}

/// Keyframes that lie so near in time to one another that who is seen in one is seen in all.
fn run(drive: &Drive, keyframe: usize) -> Range<usize> {
    let (mut first, mut last) = (keyframe, keyframe);
    while let Some(k) = previous(drive, first) {
        first = k;
    }
    while let Some(k) = next(drive, last) {
        last = k;
    }
    first..last + 1
}

/// The track of a visit, on the ground.
fn user(around: &Surroundings, motion: &Motion, visit: &room::Visit, number: usize) -> RoadUser {
    let boxes = visit.at_keyframes().map(|(k, outline)| (k, on_ground(around, motion, outline))).collect();
    let token = format!("added {number}");
    RoadUser { track: Track { token, kind: motion.kind, boxes }, at_moments: None, speed_mps: motion.speed_mps }
}

/// The same track with a box at every moment from its first keyframe to its last; `keyframe` is the one for which the motion
/// was drawn.
fn at_moments(
    around: &Surroundings,
    motion: &Motion,
    track: &Track,
    keyframe: usize,
    moments: Moments,
) -> Option<Track> {
    let (first, last) = (track.boxes.first()?.0, track.boxes.last()?.0);
    if !moments.are_between() {
        return None;
    }
    let start_ns = around.place.drive.keyframes[keyframe].time_ns;
    let visited = moments.of_keyframe(first)..=moments.of_keyframe(last);
    let times = visited.clone().map(|m| (moments.drive.keyframes[m].time_ns - start_ns) as f64 * 1e-9);
    let poses = motion.poses(times);
    let half_m = motion.size_m.truncate() / 2.0;
    let boxes = visited.zip(poses).filter_map(|(moment, pose)| {
        let [centre, along] = pose?;
        Some((moment, on_ground(around, motion, &room::Outline { centre, along, half_m })))
    });
    Some(Track { boxes: boxes.collect(), ..track.clone() })
}

fn on_ground(around: &Surroundings, motion: &Motion, outline: &room::Outline) -> Cuboid {
    Cuboid {
        world_from_body: outline.world_from_body(around.stand.surface_m(outline.centre) + motion.size_m.z / 2.0),
        size_m: motion.size_m,
    }
}
