//! Riders and what they ride, which the dataset annotates by two boxes: one object here.

use std::collections::BTreeMap;

use glam::DVec3;
use trove_model::{Body, Cuboid, Keyframe, ObjectBox, Outcome, Pose, Report, Track, World};

use super::kinds::mount_of_rider;

/// A rider's centre lies no farther than this from that of what is ridden, in the plane, metres.
const SEATED_M: f64 = 0.8;

/// Gives each mount that somebody rides most of the time the rider's kind and a box around both, and takes the rider's
/// boxes on it away. A rider whose mount has no box stays, and stands for both.
pub(super) fn seat(keyframes: &mut [Keyframe], tracks: &mut [Track], report: &Report) {
    // Who is seen on what, how often.
    let mut seen = BTreeMap::<(usize, usize), usize>::new();
    for keyframe in keyframes.iter() {
        for rider in &keyframe.boxes {
            let Some(mount) = mount_of_rider(&rider.category) else { continue };
            let apart_m = |other: &&ObjectBox| flat_distance_m(&rider.cuboid, &other.cuboid);
            let mounts = keyframe.boxes.iter().filter(|b| b.category == mount);
            if let Some(under) =
                mounts.min_by(|a, b| apart_m(a).total_cmp(&apart_m(b))).filter(|b| apart_m(b) < SEATED_M)
            {
                *seen.entry((rider.track, under.track)).or_default() += 1;
            }
        }
    }
    // The most frequent pairs first; each rides one thing, and is the only one on it.
    let mut pairs: Vec<_> = seen.into_iter().collect();
    pairs.sort_by_key(|(pair, count)| (usize::MAX - count, *pair));
    let (mut ridden, mut riding) = (BTreeMap::new(), BTreeMap::new());
    for ((rider, mount), count) in pairs {
        let boxes = tracks[rider].boxes.len().min(tracks[mount].boxes.len());
        if 2 * count >= boxes && !ridden.contains_key(&mount) && !riding.contains_key(&rider) {
            ridden.insert(mount, rider);
            riding.insert(rider, mount);
            report.note(Outcome::Substituted, "Argoverse 2 rider and mount, by one object", &tracks[mount].token);
        }
    }
    for (&mount, &rider) in &ridden {
        join(keyframes, tracks, mount, rider);
    }
}

fn flat_distance_m(a: &Cuboid, b: &Cuboid) -> f64 {
    (a.world_from_body.translation - b.world_from_body.translation).truncate().length()
}

/// Where both have a box the mount's grows; where only one has, that one stands for both.
fn join(keyframes: &mut [Keyframe], tracks: &mut [Track], mount: usize, rider: usize) {
    let kind = tracks[rider].kind;
    let mut alone = Vec::new();
    for (k, on) in std::mem::take(&mut tracks[rider].boxes) {
        let boxes = &mut keyframes[k].boxes;
        match tracks[mount].boxes.iter_mut().find(|(at, _)| *at == k) {
            Some((_, under)) => {
                *under = around(under, &on);
                boxes.retain(|b| b.track != rider);
                boxes.iter_mut().filter(|b| b.track == mount).for_each(|b| b.cuboid = *under);
            }
            None => {
                alone.push((k, on));
                boxes.iter_mut().filter(|b| b.track == rider).for_each(|b| b.track = mount);
            }
        }
    }
    tracks[mount].boxes.extend(alone);
    tracks[mount].boxes.sort_by_key(|(k, _)| *k);
    tracks[mount].kind = kind;
    keyframes.iter_mut().flat_map(|k| &mut k.boxes).filter(|b| b.track == mount).for_each(|b| b.kind = kind);
}

/// A mount's box made so high and wide that the rider's, as far as it stands upright, is in it.
fn around(mount: &Cuboid, rider: &Cuboid) -> Cuboid {
    let pose: Pose<World, Body> = mount.world_from_body;
    let seated = pose.inverse().point(rider.world_from_body.translation);
    let half = rider.size_m / 2.0;
    let low = (-mount.size_m.z / 2.0).min(seated.z - half.z);
    let high = (mount.size_m.z / 2.0).max(seated.z + half.z);
    let width = mount.size_m.y.max(rider.size_m.x.min(rider.size_m.y));
    let size_m = DVec3::new(mount.size_m.x, width, high - low);
    let centre = pose.point(DVec3::new(0.0, 0.0, (low + high) / 2.0));
    Cuboid { world_from_body: Pose::new(pose.rotation, centre), size_m }
}

/// Removes tracks that have no boxes and numbers the others anew.
pub(super) fn without_empty(keyframes: &mut [Keyframe], tracks: Vec<Track>) -> Vec<Track> {
    let mut kept = Vec::with_capacity(tracks.len());
    let mut number = vec![0; tracks.len()];
    for (i, track) in tracks.into_iter().enumerate() {
        number[i] = kept.len();
        if !track.boxes.is_empty() {
            kept.push(track);
        }
    }
    keyframes.iter_mut().flat_map(|k| &mut k.boxes).for_each(|b| b.track = number[b.track]);
    kept
}

#[cfg(test)]
mod tests {
    use super::super::kinds::kind_of_category;
    use super::*;
    use trove_model::Kind;

    fn at(category: &str, track: usize, centre: DVec3, size_m: DVec3) -> ObjectBox {
        ObjectBox {
            track,
            kind: kind_of_category(category).unwrap(),
            category: category.into(),
            token: String::new(),
            cuboid: Cuboid { world_from_body: Pose::from_yaw(0.3, centre), size_m },
            velocity_mps: None,
            is_parked: None,
            attributes: Vec::new(),
            lidar_points: None,
            visibility: None,
        }
    }

    /// Three keyframes: a ridden bicycle whose rider is seen alone at the end, and one that leans on a wall.
    fn street() -> (Vec<Keyframe>, Vec<Track>) {
        let mut tracks: Vec<Track> = ["BICYCLE", "BICYCLE", "BICYCLIST"]
            .iter()
            .map(|c| Track { token: (*c).into(), kind: kind_of_category(c).unwrap(), boxes: Vec::new() })
            .collect();
        let bicycle = DVec3::new(1.8, 0.5, 1.0);
        let mut keyframes = Vec::new();
        for k in 0..3 {
            let x = 3.0 * k as f64;
            let mut boxes = vec![at("BICYCLE", 0, DVec3::new(40.0, 0.0, 0.5), bicycle)];
            if k < 2 {
                boxes.push(at("BICYCLE", 1, DVec3::new(x, 0.0, 0.5), bicycle));
            }
            boxes.push(at("BICYCLIST", 2, DVec3::new(x + 0.1, 0.0, 1.1), DVec3::new(0.7, 0.6, 1.4)));
            boxes.iter().for_each(|b| tracks[b.track].boxes.push((k, b.cuboid)));
            keyframes.push(Keyframe {
                time_ns: 0,
                token: String::new(),
                world_from_ego: Pose::IDENTITY,
                exposures: Vec::new(),
                boxes,
                lidar: None,
            });
        }
        (keyframes, tracks)
    }

    #[test]
    fn a_rider_and_a_bicycle_become_one_and_a_bicycle_at_a_wall_stays_empty() {
        let ((mut keyframes, mut tracks), report) = (street(), Report::default());
        seat(&mut keyframes, &mut tracks, &report);
        let tracks = without_empty(&mut keyframes, tracks);
        assert_eq!(tracks.iter().map(|t| t.kind).collect::<Vec<_>>(), [Kind::Bicycle, Kind::BicycleWithRider]);
        assert_eq!(tracks[1].boxes.iter().map(|(k, _)| *k).collect::<Vec<_>>(), [0, 1, 2]);
        assert!(keyframes.iter().all(|k| k.boxes.len() == 2 && k.boxes[1].track == 1));
        let both = keyframes[1].boxes[1].cuboid;
        assert!((both.size_m - DVec3::new(1.8, 0.6, 1.8)).length() < 1e-12);
        assert!((both.world_from_body.translation - DVec3::new(3.0, 0.0, 0.9)).length() < 1e-12);
        assert_eq!(tracks[1].at(1), Some(both));
        assert_eq!(report.entries()[0].count, 1);
    }
}
