//! Where the pictures are taken from.

mod carriers;
mod motion;
mod settings;

use trove_model::{Drive, Outcome, Report, Shot, Viewpoint};

pub use settings::{ALL_CAMERAS, LensChange, PictureSize, ViewSettings};

use crate::place::Seeds;
use crate::place::{next, previous};
use crate::site::Site;
use carriers::Stay;
use settings::shot_seed;

/// Who photographs a drive, and how: the same for all of its keyframes.
#[derive(Clone, Debug)]
pub struct ViewPlan {
    settings: ViewSettings,
    seeds: Seeds,
    carriers: Vec<Stay>,
}

impl ViewPlan {
    /// Chooses the other vehicles that carry the rig.
    pub fn new(drive: &Drive, site: &Site, settings: ViewSettings, seeds: Seeds, report: &Report) -> Self {
        let carriers = carriers::stays(drive, site, &settings, &seeds, report);
        Self { settings, seeds, carriers }
    }

    /// A clone of every recorded camera at its own time and pose, then the rig on other vehicles.
    pub fn shots(&self, drive: &Drive, site: &Site, keyframe: usize, report: &Report) -> Vec<Shot> {
        let Self { settings, seeds, carriers } = self;
        let mut shots = recorded(drive, site, keyframe, settings, seeds, report);
        if keyframe < drive.keyframes.len() {
            shots.extend(carriers::shots(drive, site, keyframe, settings, carriers, seeds, report));
        }
        shots
    }
}

/// The recorded cameras' shots.
fn recorded(
    drive: &Drive,
    site: &Site,
    keyframe: usize,
    views: &ViewSettings,
    seeds: &Seeds,
    report: &Report,
) -> Vec<Shot> {
    let Some(moment) = drive.keyframes.get(keyframe) else {
        let example = format!("{} keyframe {keyframe}", drive.id);
        report.note(Outcome::Dropped, "view of a keyframe that the drive does not have", example);
        return Vec::new();
    };
    let mut shots = Vec::new();
    for exposure in &moment.exposures {
        let Some(camera) = drive.rig.get(exposure.camera).filter(|c| views.wants(&c.name)) else { continue };
        let world_from_camera = views.world_from_camera(exposure);
        if !world_from_camera.is_finite() {
            report.note(Outcome::Dropped, "view whose pose is not finite", format!("{keyframe} {}", camera.name));
            continue;
        }
        let at = |k: Option<usize>| {
            let other = drive.keyframes[k?].exposures.iter().find(|e| e.camera == exposure.camera)?;
            Some((views.world_from_camera(other), other.time_ns)).filter(|(pose, _)| pose.is_finite())
        };
        let neighbours = [at(previous(drive, keyframe)), at(next(drive, keyframe))];
        let [before, after] = neighbours.map(|n| n.map(|(pose, _)| pose));
        let beside = neighbours.map(|n| motion::at_keyframe(exposure.time_ns, n));
        let view = format!("ego.{}", camera.name);
        shots.push(Shot {
            lens: views.lens(&camera.name, &exposure.lens),
            world_from_ego: Some(exposure.world_from_ego),
            world_from_camera,
            world_from_camera_previous: before,
            world_from_camera_next: after,
            beside: motion::on_path(&drive.path, exposure.time_ns, world_from_camera, beside),
            time_ns: exposure.time_ns,
            shutter: views.shutter(),
            spp: views.spp,
            noise: views.noise,
            cache: views.cache,
            drops: views.drops(seeds, &view),
            film: views.film,
            labels: views.labels.clone(),
            seed: shot_seed(seeds, keyframe, &view),
            carrier: Some(site.ego_id(drive)),
            viewpoint: Viewpoint::Recording { camera: exposure.camera },
            view,
        });
    }
    shots
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::{BTreeMap, BTreeSet};

    use crate::build;
    use crate::testing;
    use glam::DVec3;
    use trove_model::{LensDrops, Pose, Seed, Trajectory};

    fn site() -> Site {
        build_site(&testing::drive())
    }

    fn build_site(drive: &Drive) -> Site {
        build(drive, None, &testing::library(), &testing::settings(), &Report::default()).unwrap()
    }

    fn taken(site: &Site, keyframe: usize, seed: u64) -> Vec<Shot> {
        let size = PictureSize::Scaled(0.5);
        let views = ViewSettings { other_vehicles: 2, size, spp: 1, ..ViewSettings::default() };
        let (drive, report) = (testing::drive(), Report::default());
        ViewPlan::new(&drive, site, views, Seed(seed).into(), &report).shots(&drive, site, keyframe, &report)
    }

    #[test]
    fn every_recorded_camera_is_cloned_with_its_neighbours_in_time() {
        let drive = testing::drive();
        let shots = taken(&site(), 0, 1);
        let front = shots.iter().find(|s| s.view == "ego.CAM_FRONT").unwrap();
        assert_eq!(front.world_from_camera, drive.keyframes[0].exposures[1].world_from_camera());
        assert_eq!(front.world_from_camera_previous, None);
        assert_eq!(front.world_from_camera_next, Some(drive.keyframes[1].exposures[1].world_from_camera()));
        assert_eq!((front.lens.width_px, front.lens.fx_px), (80, 63.0));
        assert_eq!(front.carrier, Some(trove_model::InstanceId(5)));
    }

    #[test]
    fn drops_stay_on_a_camera_s_glass_and_every_camera_has_its_own() {
        let (drive, site, report) = (testing::drive(), site(), Report::default());
        let drops = |share: f64, keyframe: usize, seed: u64| -> BTreeMap<String, Option<LensDrops>> {
            let views = ViewSettings { drops: share, spp: 1, ..ViewSettings::default() };
            let shots = ViewPlan::new(&drive, &site, views, Seed(seed).into(), &report);
            shots.shots(&drive, &site, keyframe, &report).into_iter().map(|s| (s.view, s.drops)).collect()
        };
        let first = drops(0.2, 0, 1);
        let seeds: BTreeSet<u64> = first.values().map(|drops| drops.unwrap().seed.0).collect();
        assert!(first.len() > 1 && seeds.len() == first.len(), "{first:?}");
        for (view, drops) in drops(0.2, 1, 1) {
            assert!(first.get(&view).is_none_or(|before| *before == drops), "{view}");
        }
        assert_ne!(first, drops(0.2, 0, 2));
        assert!(drops(0.0, 0, 1).values().all(Option::is_none));
    }

    #[test]
    fn a_camera_moves_as_the_vehicle_s_path_says_and_else_as_between_keyframes() {
        let (mut drive, site) = (testing::drive(), site());
        let front = |drive: &Drive| {
            let views = ViewSettings { size: PictureSize::Scaled(0.5), spp: 1, ..ViewSettings::default() };
            let report = Report::default();
            let shots = ViewPlan::new(drive, &site, views, Seed(1).into(), &report).shots(drive, &site, 1, &report);
            shots.into_iter().find(|s| s.view == "ego.CAM_FRONT").unwrap()
        };
        let shot = front(&drive);
        let [before, after] = shot.beside.map(|beside| beside.unwrap());
        assert_eq!(Some(before.world_from_camera), shot.world_from_camera_previous);
        assert_eq!(Some(after.world_from_camera), shot.world_from_camera_next);
        assert_eq!(after.apart_s, 0.5);
        // It brakes: 20 m/s before the picture, 10 m/s after it, and turns to the left all the time.
        let pose = |time_s: f64| {
            let east = if time_s < 0.0 { 20.0 * time_s } else { 10.0 * time_s };
            Pose::from_yaw(0.3 * time_s, DVec3::new(east, 3.0, 0.0))
        };
        let at = |i: i64| (shot.time_ns + i * 50_000_000, pose(i as f64 * 0.05));
        drive.path = Trajectory::new((-3..4).map(at).collect()).0;
        let shot = front(&drive);
        let now = pose(0.0).inverse() * shot.world_from_camera;
        for time_s in [-0.1, -0.02, 0.01, 0.1] {
            let (found, expected) = (shot.world_from_camera_at(time_s), pose(time_s) * now);
            assert!(found.translation.distance(expected.translation) < 2e-3, "{time_s}: {found:?} {expected:?}");
            assert!(found.rotation.angle_between(expected.rotation) < 1e-6);
        }
        assert_eq!(shot.world_from_camera_previous, front(&testing::drive()).world_from_camera_previous, "flow");
    }

    #[test]
    fn other_vehicles_carry_the_rig_clear_of_all_geometry() {
        let (drive, site) = (testing::drive(), site());
        for keyframe in 0..10 {
            let shots = taken(&site, keyframe, 3);
            let is_other = |s: &&Shot| matches!(s.viewpoint, Viewpoint::OtherVehicle { .. });
            let others: Vec<&Shot> = shots.iter().filter(is_other).collect();
            assert_eq!(others.len(), 4);
            for shot in others {
                for annotated in &drive.keyframes[keyframe].boxes {
                    let carries = shot.carrier == Some(trove_model::InstanceId(annotated.track as u32 + 1));
                    let grown = annotated.cuboid.grown(if carries { 0.0 } else { 0.25 });
                    let roof = annotated.cuboid.world_from_body.translation.z + annotated.cuboid.size_m.z / 2.0;
                    let position = shot.world_from_camera.translation;
                    assert!(!grown.contains(position) || (carries && roof - position.z < 0.2), "{}", shot.view);
                }
            }
        }
    }

    #[test]
    fn the_seed_chooses_the_carriers() {
        let site = site();
        let carriers = |seed| taken(&site, 4, seed).iter().map(|s| s.carrier).collect::<Vec<_>>();
        assert_eq!(carriers(1), carriers(1));
        assert!((2..20).any(|seed| carriers(seed) != carriers(1)));
    }

    #[test]
    fn a_view_is_one_vehicle_without_a_break_and_flow_leads_to_its_next_picture() {
        // Of three vehicles one leaves in the middle and another comes late; two carry the rig.
        let mut drive = testing::drive();
        let is_there = |track: usize, k: usize| match track {
            0 => k < 4,
            1 => k != 6,
            2 => k > 2,
            _ => true,
        };
        for (track, of) in drive.tracks.iter_mut().enumerate() {
            of.boxes.retain(|(k, _)| is_there(track, *k));
        }
        for (k, keyframe) in drive.keyframes.iter_mut().enumerate() {
            keyframe.boxes.retain(|b| is_there(b.track, k));
        }
        let site = build_site(&drive);
        for seed in 0..6 {
            let report = Report::default();
            let views = ViewSettings { other_vehicles: 2, spp: 1, ..ViewSettings::default() };
            let plan = ViewPlan::new(&drive, &site, views, Seed(seed).into(), &report);
            let at = |k: usize| -> BTreeMap<String, Shot> {
                let shots = plan.shots(&drive, &site, k, &report).into_iter();
                shots.filter(|s| !s.view.starts_with("ego.")).map(|s| (s.view.clone(), s)).collect()
            };
            let all: Vec<_> = (0..10).map(at).collect();
            let mut vehicles: BTreeMap<&str, Vec<(usize, Option<trove_model::InstanceId>)>> = BTreeMap::new();
            for (k, shots) in all.iter().enumerate() {
                let there = (0..3).filter(|track| is_there(*track, k)).count();
                assert_eq!(shots.len(), 2 * there.min(2), "two cameras on each at {k}");
                for (view, shot) in shots {
                    vehicles.entry(view).or_default().push((k, shot.carrier));
                    let pose = |k: Option<usize>| Some(all.get(k?)?.get(view)?.world_from_camera);
                    assert_eq!(shot.world_from_camera_next, pose(Some(k + 1)), "{view} at {k}");
                    assert_eq!(shot.world_from_camera_previous, pose(k.checked_sub(1)), "{view} at {k}");
                    let mounted = shot.world_from_ego.unwrap().inverse() * shot.world_from_camera;
                    let Viewpoint::OtherVehicle { camera, .. } = shot.viewpoint else { panic!("{view}") };
                    let recorded = drive.rig[camera].ego_from_camera;
                    assert!(mounted.translation.distance(recorded.translation) < 1e-9, "{view} at {k}");
                }
            }
            for (view, seen) in &vehicles {
                assert!(seen.windows(2).all(|w| w[1] == (w[0].0 + 1, w[0].1)), "{view}: {seen:?}");
            }
        }
    }
}
