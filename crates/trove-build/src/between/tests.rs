use glam::DVec3;
use trove_model::{Drive, Ego, Pose, Report, Trajectory, World};

use super::*;
use crate::testing;

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
