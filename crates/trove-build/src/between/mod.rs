//! Moments between the keyframes of a drive: where its vehicle, its cameras and everybody else are then.

mod course;
mod ego;
mod moments;
mod parked;
mod sight;
#[cfg(test)]
mod tests;
mod times;
mod tracks;

use trove_model::{Cuboid, Drive, Keyframe, ObjectBox, Report, Track};

pub(crate) use course::is_tremor;
use ego::EgoWay;
pub use moments::{Moments, Timeline};
use sight::tell_who_comes_and_goes;
pub(crate) use times::MAX_STEP_NS;
use times::{When, times};
use tracks::boxes_between;

/// A drive with moments between its keyframes, about so many a second: the time between two keyframes is divided evenly, so
/// that every keyframe stays a moment, with its poses and boxes. Where keyframes are more than two seconds apart, and for a
/// rate of 0, there are none between them.
///
/// At any rate parked vehicles, whose boxes wander, stand in one place for as long as they are parked, which is reported.
///
/// The vehicle follows its recorded path where there is one. It and other vehicles roll along their headings, so that their
/// rear axles slip sideways by at most a few centimetres (what their annotated boxes ask for beyond that is reported), and
/// whatever stands at two keyframes stands between them. An object is there from its first keyframe to its last.
pub fn between(mut recorded: Drive, rate_hz: f64, report: &Report) -> Timeline {
    parked::settle(&mut recorded, report);
    if rate_hz <= 0.0 {
        return Timeline::of_keyframes(recorded);
    }
    let times = times(&recorded.keyframes, rate_hz);
    let ego = EgoWay::new(&recorded);
    let mut tracks: Vec<Track> = recorded.tracks.iter().map(|t| Track { boxes: Vec::new(), ..t.clone() }).collect();
    let tracked: Vec<Vec<Option<Cuboid>>> =
        recorded.tracks.iter().map(|track| boxes_between(track, &recorded.keyframes, &times, report)).collect();
    let mut keyframes = Vec::with_capacity(times.len());
    for (moment, when) in times.iter().enumerate() {
        let now = &recorded.keyframes[when.keyframe];
        let keyframe = if when.share == 0.0 {
            without_lidar(now)
        } else {
            let next = &recorded.keyframes[when.keyframe + 1];
            Keyframe {
                time_ns: when.time_ns,
                token: String::new(),
                world_from_ego: ego.at_moment(now, next, when),
                exposures: ego.exposures(now, next, when),
                boxes: object_boxes(now, next, when, |track| tracked.get(track)?[moment]),
                lidar: None,
            }
        };
        for (track, cuboids) in tracks.iter_mut().zip(&tracked) {
            track.boxes.extend(cuboids[moment].map(|cuboid| (moment, cuboid)));
        }
        keyframes.push(keyframe);
    }
    tell_who_comes_and_goes(&recorded, report);
    let indices = times.iter().map(|when| (when.share == 0.0).then_some(when.keyframe)).collect();
    let drive = Drive { keyframes, tracks, ..without_points(&recorded) };
    Timeline::new(recorded, drive, indices)
}

/// What is annotated between two keyframes: whoever is there at both.
fn object_boxes(
    now: &Keyframe,
    next: &Keyframe,
    when: &When,
    cuboid: impl Fn(usize) -> Option<Cuboid>,
) -> Vec<ObjectBox> {
    let there = |before: &ObjectBox| {
        let after = next.boxes.iter().find(|b| b.track == before.track)?;
        let nearer = if when.share < 0.5 { before } else { after };
        Some(ObjectBox {
            track: before.track,
            kind: before.kind,
            category: before.category.clone(),
            token: String::new(),
            cuboid: cuboid(before.track)?,
            velocity_mps: before.velocity_mps.zip(after.velocity_mps).map(|(a, b)| a.lerp(b, when.share)),
            is_parked: nearer.is_parked,
            attributes: nearer.attributes.clone(),
            lidar_points: None,
            visibility: None,
        })
    };
    now.boxes.iter().filter_map(there).collect()
}

/// A keyframe but for its LiDAR's points, which are many.
fn without_lidar(keyframe: &Keyframe) -> Keyframe {
    let Keyframe { time_ns, token, world_from_ego, exposures, boxes, lidar: _ } = keyframe;
    Keyframe {
        time_ns: *time_ns,
        token: token.clone(),
        world_from_ego: *world_from_ego,
        exposures: exposures.clone(),
        boxes: boxes.clone(),
        lidar: None,
    }
}

/// A drive but for its keyframes, its tracks and all that its LiDAR saw.
fn without_points(drive: &Drive) -> Drive {
    Drive {
        id: drive.id.clone(),
        dataset: drive.dataset.clone(),
        origin: drive.origin,
        place: drive.place.clone(),
        projection: drive.projection,
        is_georeferenced: drive.is_georeferenced,
        rig: drive.rig.clone(),
        lidars: drive.lidars.clone(),
        ego_body: drive.ego_body,
        keyframes: Vec::new(),
        path: drive.path.clone(),
        sweeps: Vec::new(),
        tracks: Vec::new(),
        lane_map: None,
        licence: drive.licence.clone(),
    }
}
