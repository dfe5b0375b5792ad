use glam::{DVec3, Vec3};
use trove_model::{
    Asset, AssetLibrary, Body, Drive, Ego, Figure, Instance, Keypoints, Kind, Mesh, Origin, Pose, Posture, Report,
    Scene, Trajectory, World,
};

use super::*;
use crate::{BuildSettings, Site, Traffic, build_at, testing};

fn dense(drive: &Drive, rate_hz: f64) -> Timeline {
    between(drive.clone(), rate_hz, &Report::default())
}

#[test]
fn keyframes_stay_what_they_are_and_moments_lie_evenly_between_them() {
    let drive = testing::drive();
    for (rate_hz, parts) in [(10.0, 5), (9.0, 5), (2.0, 1), (0.3, 1), (30.0, 15)] {
        let timeline = dense(&drive, rate_hz);
        let moments = timeline.moments();
        assert_eq!(moments.drive.keyframes.len(), 9 * parts + 1, "{rate_hz}");
        for (m, moment) in moments.drive.keyframes.iter().enumerate() {
            assert_eq!(moments.keyframe(m), m.is_multiple_of(parts).then_some(m / parts));
            let Some(k) = moments.keyframe(m) else {
                assert!(moment.token.is_empty() && moment.boxes.iter().all(|b| b.token.is_empty()));
                continue;
            };
            assert_eq!((moments.of_keyframe(k), moment), (m, &drive.keyframes[k]));
        }
        let apart: Vec<i64> = moments.drive.keyframes.windows(2).map(|w| w[1].time_ns - w[0].time_ns).collect();
        assert!(apart.iter().all(|ns| (ns - 500_000_000 / parts as i64).abs() <= 1), "{apart:?}");
        for (track, recorded) in moments.drive.tracks.iter().zip(&drive.tracks) {
            assert_eq!(track.boxes.len(), 9 * parts + 1);
            for (k, cuboid) in &recorded.boxes {
                assert_eq!(track.at(k * parts), Some(*cuboid));
            }
        }
    }
    assert!(!dense(&drive, 0.0).moments().are_between());
}

#[test]
fn everybody_is_halfway_halfway_and_cameras_keep_their_lead() {
    let mut drive = testing::drive();
    for k in &mut drive.keyframes {
        for exposure in &mut k.exposures {
            exposure.time_ns -= 20_000_000;
            exposure.world_from_ego.translation.x -= 0.2;
        }
    }
    let timeline = dense(&drive, 4.0);
    let moment = &timeline.moments().drive.keyframes[3];
    assert!((moment.world_from_ego.translation - DVec3::X * 7.5).length() < 1e-9);
    for (object, [x, mps]) in moment.boxes.iter().zip([[20.0, 0.0], [22.5, 10.0], [54.0, -8.0], [30.9, 1.2]]) {
        assert!((object.cuboid.world_from_body.translation.x - x).abs() < 1e-9, "{object:?}");
        assert_eq!(object.velocity_mps, Some(DVec3::X * mps));
    }
    for exposure in &moment.exposures {
        assert_eq!(exposure.time_ns, moment.time_ns - 20_000_000);
        assert!((exposure.world_from_ego.translation.x - 7.3).abs() < 1e-9, "{exposure:?}");
        assert_eq!((&exposure.token, &exposure.file), (&None, &None));
    }
}

#[test]
fn the_recorded_path_leads_and_the_keyframes_hold_it() {
    let mut drive = testing::drive();
    let start_ns = drive.keyframes[0].time_ns;
    // The path swerves between keyframes, and lies half a metre aside and 10 cm high of where the keyframes are.
    let swerve = |time_s: f64| 0.3 * (std::f64::consts::TAU * time_s).sin().powi(2);
    let on_path = |i: i64| {
        let time_s = i as f64 * 0.05;
        (
            start_ns + i * 50_000_000,
            Pose::<World, Ego>::from_yaw(0.0, DVec3::new(10.0 * time_s, 0.5 + swerve(time_s), 0.1)),
        )
    };
    drive.path = Trajectory::new((0..=90).map(on_path).collect()).0;
    let timeline = dense(&drive, 20.0);
    for (m, moment) in timeline.moments().drive.keyframes.iter().enumerate() {
        let time_s = m as f64 * 0.05;
        let expected = DVec3::new(10.0 * time_s, swerve(time_s), 0.0);
        let found = moment.world_from_ego.translation;
        assert!(found.distance(expected) < 1e-6, "{time_s} s: {found} {expected}");
    }
}

#[test]
fn who_comes_and_goes_is_there_from_the_first_keyframe_to_the_last_and_told_where_seen() {
    let mut drive = testing::drive();
    // The car ahead is seen from keyframe 2 to 4 and from 6 on: by the front camera.
    let is_there = |k: usize| (2..5).contains(&k) || k > 5;
    drive.tracks[1].boxes.retain(|(k, _)| is_there(*k));
    for (k, keyframe) in drive.keyframes.iter_mut().enumerate() {
        keyframe.boxes.retain(|b| b.track != 1 || is_there(k));
    }
    let report = Report::default();
    let timeline = between(drive, 10.0, &report);
    for (m, moment) in timeline.moments().drive.keyframes.iter().enumerate() {
        let expected = (10..=20).contains(&m) || m >= 30;
        assert_eq!(moment.boxes.iter().any(|b| b.track == 1), expected, "{m}");
        assert_eq!(timeline.moments().drive.tracks[1].at(m).is_some(), expected, "{m}");
    }
    let entries = report.entries();
    let told = |what: &str| entries.iter().find(|e| e.what.contains(what)).map(|e| (e.count, e.examples.join("; ")));
    let (appears, examples) = told("appears").unwrap();
    assert_eq!((appears, told("is gone").unwrap().0), (2, 1));
    assert!(examples.contains("ahead (car) at keyframe 2") && examples.contains("keyframe 6, 15 m away"), "{examples}");
}

#[test]
fn only_what_lies_between_chosen_neighbours_is_chosen() {
    let timeline = dense(&testing::drive(), 4.0);
    let chosen = |keyframes: &[usize]| timeline.moments().chosen(keyframes);
    assert_eq!(chosen(&[0, 1, 3, 8, 9]), [0, 1, 2, 6, 16, 17, 18]);
    assert_eq!(chosen(&[5]), [10]);
    let recorded = Timeline::of_keyframes(testing::drive());
    assert_eq!(recorded.moments().chosen(&[0, 1, 5]), [0, 1, 5]);
}

#[test]
fn keyframes_far_apart_have_nothing_between_them() {
    let mut drive = testing::drive();
    for (k, keyframe) in drive.keyframes.iter_mut().enumerate().skip(5) {
        keyframe.time_ns += 2_000_000_000 + k as i64;
    }
    assert_eq!(dense(&drive, 10.0).moments().drive.keyframes.len(), 4 * 5 + 4 * 5 + 2);
}

fn site(drive: &Drive, moments: Moments, library: &AssetLibrary, density: f64) -> Site {
    let traffic = Traffic { density, ..Traffic::default() };
    let settings = BuildSettings { top_k: 3, traffic, ..testing::settings() };
    build_at(drive, moments, None, library, &settings, &Report::default()).unwrap()
}

#[test]
fn the_place_and_who_is_there_at_keyframes_are_the_same_with_moments_between() {
    let (drive, library) = (testing::drive(), testing::library());
    let alone = site(&drive, Moments::of_keyframes(&drive), &library, 2.0);
    let timeline = dense(&drive, 10.0);
    let moments = timeline.moments();
    let among = site(&drive, moments, &library, 2.0);
    let look = |i: &Instance| (i.id, i.mesh, i.materials.clone(), i.world_from_mesh, i.object.clone());
    for k in 0..10 {
        let [a, b] = [alone.scene(&drive, k), among.scene(moments.drive, moments.of_keyframe(k))];
        assert_eq!(a.instances.len(), b.instances.len());
        for (a, b) in a.instances.iter().zip(&b.instances) {
            assert_eq!(look(a), look(b), "at {k}");
        }
    }
    // Who was added moves on evenly between keyframes.
    let scenes: Vec<Scene> = (0..46).map(|m| among.scene(moments.drive, m)).collect();
    let is_added = |i: &&Instance| i.object.as_ref().is_some_and(|o| o.origin == Origin::Added);
    let mut seen = 0;
    for (i, scene) in scenes.iter().enumerate() {
        for added in scene.instances.iter().filter(is_added) {
            let Some(next) = added.next else { continue };
            let object = added.object.as_ref().unwrap();
            let moved_m = next.world_from_mesh.translation.distance(added.world_from_mesh.translation);
            let expected_m = object.velocity_mps.unwrap().length() * 0.1;
            assert!((moved_m - expected_m).abs() < 0.02, "{i}: {moved_m} {expected_m}");
            seen += 1;
        }
    }
    assert!(seen > 45, "{seen}");
}

/// How far a cycle of the tests' walker goes, and the share of it in which a foot stands, metres.
const STRIDE_M: f32 = 1.4;
const STANDS: f32 = 0.625;

/// A walker whose soles are the first sixteen points, left and right by turns: on the ground each goes back as the walker
/// goes on. As library's are, it is centred in its own box.
fn walker(phase: f32) -> Asset {
    let sole = |phase: f32, y: f32| {
        let swing = (phase - STANDS).max(0.0) / (1.0 - STANDS);
        let back_m = if swing > 0.0 { STRIDE_M * STANDS * (1.0 - swing) } else { STRIDE_M * phase };
        Vec3::new(0.4 - back_m, y, 0.3 * swing * (1.0 - swing))
    };
    let soles = [sole(phase, 0.1), sole((phase + 0.5).fract(), -0.1)];
    let mut positions: Vec<Vec3> = (0..8).flat_map(|i| soles.map(|sole| sole + Vec3::X * 0.01 * i as f32)).collect();
    positions.extend([Vec3::new(-0.5, -0.3, 0.2), Vec3::new(0.5, 0.3, 0.2), Vec3::new(0.0, 0.0, 1.75)]);
    let off_centre = Vec3::X * 0.06 * (phase * 17.0).sin();
    positions.iter_mut().for_each(|p| *p += off_centre);
    let asset = testing::asset("walker", Kind::Adult, [1.0, 0.6, 1.75]);
    let figure = Figure { person: "walker".into(), posture: Posture::Walking { phase, stride_m: STRIDE_M } };
    let keypoints = Some(joints(&positions));
    let mesh = Mesh { positions, triangles: vec![[16, 17, 18], [0, 1, 18]], ..Mesh::default() };
    Asset { id: format!("walker/{phase}"), figure: Some(figure), mesh: mesh.into(), keypoints, ..asset }
}

/// The same on both feet.
fn stander() -> Asset {
    let walks = walker(0.0);
    let mut positions = walks.mesh.positions.clone();
    for (i, p) in positions[..16].iter_mut().enumerate() {
        *p = Vec3::new(-0.05 + 0.01 * (i / 2) as f32, if i % 2 == 0 { 0.12 } else { -0.12 }, 0.0);
    }
    let keypoints = Some(joints(&positions));
    let figure = Figure { person: "walker".into(), posture: Posture::Standing };
    let mesh = Mesh { positions, ..Mesh::clone(&walks.mesh) };
    Asset { id: "walker/stands".into(), figure: Some(figure), mesh: mesh.into(), keypoints, ..walks }
}

/// Hips, knees and ankles above soles; the rest is a head.
fn joints(positions: &[Vec3]) -> Keypoints<Vec3> {
    let side = |i: usize| (i + 1) % 2;
    let ankle = |i: usize| positions[side(i)] + Vec3::new(0.05, 0.0, 0.08);
    let hip = |i: usize| Vec3::new(0.0, if side(i) == 0 { 0.1 } else { -0.1 }, 0.9);
    std::array::from_fn(|i| match i {
        11 | 12 => hip(i),
        13 | 14 => (hip(i) + ankle(i)) / 2.0 + Vec3::X * 0.1,
        15 | 16 => ankle(i),
        _ => Vec3::Z * 1.65,
    })
}

/// How far each sole moves over the ground from each moment to the next, left and right by turns, metres; `None` where it is
/// lifted. And how far the body is from its box.
fn soles_m(drive: &Drive, library: &AssetLibrary, rate_hz: f64) -> (Vec<Option<f64>>, f64) {
    let timeline = dense(drive, rate_hz);
    let moments = timeline.moments();
    let site = site(drive, moments, library, 1.0);
    let mut off_m: f64 = 0.0;
    // In World, and as high as in the mesh.
    let mut soles = |scene: &Scene| -> [(DVec3, f32); 2] {
        let walker = scene.instances.iter().find(|i| i.object.as_ref().is_some_and(|o| o.kind == Kind::Adult)).unwrap();
        let mesh = &scene.meshes[walker.mesh];
        let place = walker.object.as_ref().unwrap().cuboid.world_from_body.translation;
        off_m = off_m.max(place.truncate().distance(walker.world_from_mesh.translation.truncate()));
        let point = |p: Vec3| (walker.world_from_mesh.transform_point3(p.as_dvec3()), p.z);
        [0, 1].map(|side| point(mesh.positions[side]))
    };
    let all: Vec<[(DVec3, f32); 2]> =
        (0..moments.drive.keyframes.len()).map(|m| soles(&site.scene(moments.drive, m))).collect();
    let step = |pair: &[[(DVec3, f32); 2]], side: usize| {
        let [(a, a_m), (b, b_m)] = [pair[0][side], pair[1][side]];
        (a_m.max(b_m) <= 1e-4).then(|| a.truncate().distance(b.truncate()))
    };
    (all.windows(2).flat_map(|pair| [0, 1].map(|side| step(pair, side))).collect(), off_m)
}

fn walkers() -> AssetLibrary {
    let mut library = testing::library();
    library.assets.retain(|asset| asset.kind != Kind::Adult);
    library.assets.extend((0..8).map(|i| walker(i as f32 / 8.0)).chain([stander()]));
    library.assets.sort_by(|a, b| a.id.cmp(&b.id));
    library
}

#[test]
fn a_foot_on_the_ground_stays_there_from_moment_to_moment() {
    let mut drive = testing::drive();
    // It walks unevenly, and is longer than the library's walker.
    for (k, cuboid) in &mut drive.tracks[3].boxes {
        cuboid.world_from_body.translation.x = 30.0 + 0.7 * *k as f64 + 0.15 * (*k as f64).sin();
        cuboid.size_m.x = 1.08;
        drive.keyframes[*k].boxes[3].cuboid = *cuboid;
    }
    let (soles, _) = soles_m(&drive, &walkers(), 30.0);
    let (planted, lifted) = (soles.iter().flatten().count(), soles.iter().filter(|sole| sole.is_none()).count());
    let most_m = soles.into_iter().flatten().fold(0.0, f64::max);
    assert!(planted > 100 && lifted > 60, "{planted} {lifted}");
    assert!(most_m < 0.005, "{most_m}");
}

#[test]
fn feet_stay_over_turns_and_stops_and_where_a_box_jumps() {
    let mut drive = testing::drive();
    // Round a bend, to a stop on which it turns, on in another direction, where one box is off by a quarter of a metre.
    let mut at = DVec3::new(30.0, -8.0, 0.9);
    for (k, cuboid) in &mut drive.tracks[3].boxes {
        let yaw_rad = match *k {
            ..=3 => 0.45 * *k as f64,
            4..=6 => 1.35 + 0.4 * (*k as f64 - 3.0),
            _ => 2.55,
        };
        at += DVec3::new(yaw_rad.cos(), yaw_rad.sin(), 0.0) * if (4..=6).contains(k) { 0.05 } else { 0.65 };
        let jump = if *k == 8 { DVec3::new(0.15, 0.2, 0.0) } else { DVec3::ZERO };
        cuboid.world_from_body = Pose::from_yaw(yaw_rad, at + jump);
        drive.keyframes[*k].boxes[3].cuboid = *cuboid;
    }
    for rate_hz in [10.0, 30.0] {
        let (soles, off_m) = soles_m(&drive, &walkers(), rate_hz);
        let planted = soles.iter().flatten().count();
        let most_m = soles.iter().flatten().copied().fold(0.0, f64::max);
        assert!(planted as f64 > 4.0 * rate_hz && planted < soles.len(), "{rate_hz} Hz: {planted} of {}", soles.len());
        assert!(most_m < 0.02, "{rate_hz} Hz: {most_m}");
        assert!(off_m < 0.3, "{rate_hz} Hz: the body is {off_m} m from its box");
    }
}

/// The made-up drive with the boxes of the parked car somewhere at each keyframe, as the annotator calls it there.
fn parked(at: impl Fn(usize) -> (DVec3, f64, Option<bool>)) -> Drive {
    let mut drive = testing::drive();
    for (k, cuboid) in &mut drive.tracks[0].boxes {
        let (off, yaw_rad, is_parked) = at(*k);
        cuboid.world_from_body = Pose::from_yaw(yaw_rad, DVec3::new(20.0, 6.0, 0.8) + off);
        let object = &mut drive.keyframes[*k].boxes[0];
        (object.cuboid, object.is_parked, object.velocity_mps) = (*cuboid, is_parked, Some(DVec3::X));
    }
    drive
}

#[test]
fn a_parked_car_stands_in_the_middle_of_its_boxes_and_what_drives_off_does_not() {
    let wander = |k: usize| (DVec3::new(0.05 * k as f64 - 0.2, 0.0, 0.02 * k as f64), 0.01 * (k % 3) as f64);
    let middle: Pose<World, Body> = Pose::from_yaw(0.01, DVec3::new(20.05, 6.0, 0.9));
    for told in [Some(true), None] {
        let report = Report::default();
        let drive = parked(|k| (wander(k).0, wander(k).1, told));
        for rate_hz in [0.0, 10.0] {
            let timeline = between(drive.clone(), rate_hz, &report);
            for keyframe in &timeline.moments().drive.keyframes {
                let object = &keyframe.boxes[0];
                assert!(object.cuboid.world_from_body.translation.distance(middle.translation) < 1e-9);
                assert!(object.cuboid.world_from_body.rotation.angle_between(middle.rotation) < 1e-9);
                assert_eq!(object.velocity_mps, Some(DVec3::ZERO));
            }
        }
        assert!(report.entries()[0].examples[0].contains("parked (car), 0.25 m"), "{:?}", report.entries());
    }
    // It stands at the lights, or moves off, or its boxes are of a car that moves: as annotated.
    for (told, step_m) in [(Some(false), 0.05), (Some(true), 0.5), (None, 0.1)] {
        let drive = parked(|k| (DVec3::X * step_m * k as f64, 0.0, told));
        assert_eq!(dense(&drive, 0.0).recorded, drive);
    }
    // Parked until the sixth keyframe.
    let leaves = parked(|k| match k {
        2 => (wander(k).0, 0.0, None),
        0..6 => (wander(k).0, 0.0, Some(true)),
        _ => (DVec3::X * (k - 5) as f64, 0.0, Some(false)),
    });
    let settled = dense(&leaves, 0.0).recorded;
    let at = |drive: &Drive, k: usize| drive.tracks[0].boxes[k].1.world_from_body.translation;
    assert!((0..6).all(|k| at(&settled, k) == at(&settled, 0)) && at(&settled, 0).x == 20.0 - 0.2 + 0.15);
    assert!((6..10).all(|k| at(&settled, k) == at(&leaves, k)));
}
