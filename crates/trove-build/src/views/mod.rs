//! Where the pictures are taken from.

mod carriers;
mod settings;

use trove_model::{Drive, Outcome, Report, Shot, Viewpoint};

pub use settings::{ALL_CAMERAS, LensChange, PictureSize, ViewSettings};

use crate::place::Seeds;
use crate::place::{next, previous};
use crate::site::Site;
use settings::shot_seed;

/// A clone of every recorded camera at its own time and pose, then the rig on other vehicles.
pub fn shots(
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
        let times_ns = neighbours.map(|n| n.map(|(_, time_ns)| time_ns));
        let view = format!("ego.{}", camera.name);
        shots.push(Shot {
            lens: views.lens(&camera.name, &exposure.lens),
            world_from_camera,
            world_from_camera_previous: before,
            world_from_camera_next: after,
            time_ns: exposure.time_ns,
            shutter: views.shutter(exposure.time_ns, times_ns),
            spp: views.spp,
            noise: views.noise,
            film: views.film,
            seed: shot_seed(seeds, keyframe, &view),
            carrier: Some(site.ego_id(drive)),
            viewpoint: Viewpoint::Recording { camera: exposure.camera },
            view,
        });
    }
    shots.extend(carriers::shots(drive, site, keyframe, views, seeds, report));
    shots
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing;
    use crate::{BuildSettings, LightChoice, OnDisagreement, build};
    use trove_model::Seed;

    fn site() -> Site {
        let weather = crate::Weather::default();
        let settings = BuildSettings {
            seeds: Seed(1).into(),
            top_k: 1,
            traffic: crate::Traffic::default(),
            light: LightChoice::default(),
            weather,
            on_disagreement: OnDisagreement::default(),
            locale: testing::locale("SG"),
            borders: None,
        };
        build(&testing::drive(), None, &testing::library(), &settings, &Report::default()).unwrap()
    }

    fn taken(site: &Site, keyframe: usize, seed: u64) -> Vec<Shot> {
        let size = PictureSize::Scaled(0.5);
        let views = ViewSettings { other_vehicles: 2, size, spp: 1, ..ViewSettings::default() };
        shots(&testing::drive(), site, keyframe, &views, &Seed(seed).into(), &Report::default())
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
    fn the_seed_chooses_the_carriers_and_they_change_over_time() {
        let site = site();
        let carriers = |k, seed| taken(&site, k, seed).iter().map(|s| s.carrier).collect::<Vec<_>>();
        assert_eq!(carriers(4, 1), carriers(4, 1));
        let first = carriers(0, 1);
        assert!((1..10).any(|k| carriers(k, 1) != first));
    }
}
