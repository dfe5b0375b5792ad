//! Where the pictures are taken from.

mod carriers;

use std::collections::BTreeMap;

use glam::{DQuat, DVec3};
use trove_model::{
    Camera, Distortion, Drive, Ego, Exposure, Film, Lens, Outcome, Pose, Report, Seed, Shot, Shutter, World,
};

use crate::place::Seeds;
use crate::place::{next, previous};
use crate::site::Site;

/// Which pictures are taken of a keyframe.
#[derive(Clone, Debug, Default)]
pub struct ViewSettings {
    /// Names of cameras; `None` is all.
    pub rig: Option<Vec<String>>,
    /// How many vehicles of the scene carry the rig too.
    pub other_vehicles: usize,
    /// How large pictures are.
    pub size: PictureSize,
    /// How far the rig is above its recorded place, metres.
    pub lift_m: f64,
    /// How far up from its recorded view every camera looks, about its own horizontal axis, radians.
    pub pitch_rad: f64,
    /// Samples a pixel, or the most of them.
    pub spp: u32,
    /// As in [`Shot::noise`].
    pub noise: f32,
    /// Lenses in place of the recorded ones, by the camera's name; [`ALL_CAMERAS`] is for those that are not named.
    pub lenses: BTreeMap<String, LensChange>,
    /// Time for which a row of the sensor is exposed, seconds.
    pub exposure_s: f64,
    /// From the first row's exposure to the last one's, seconds.
    pub readout_s: f64,
    /// From light to picture.
    pub film: Film,
}

/// How large pictures are.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum PictureSize {
    /// So many times the recorded one.
    Scaled(f64),
    /// Width and height in pixels, of the picture's middle: see [`Lens::cropped`].
    Cropped([u32; 2]),
}

impl Default for PictureSize {
    fn default() -> Self {
        Self::Scaled(1.0)
    }
}

/// The name under which [`ViewSettings::lenses`] holds the lens of all cameras without one of their own.
pub const ALL_CAMERAS: &str = "all";

/// Another lens before a recorded camera's sensor; size and principal point stay.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LensChange {
    /// Focal length along x and y in pixels of the recording; `None` leaves it.
    pub focal_px: Option<f64>,
    /// Distortion.
    pub distortion: Distortion,
}

impl ViewSettings {
    fn wants(&self, camera: &str) -> bool {
        self.rig.as_ref().is_none_or(|names| names.iter().any(|n| n == camera))
    }

    /// Where a camera sits that is mounted somewhere.
    fn mounted(&self, ego_from_camera: &Pose<Ego, Camera>) -> Pose<Ego, Camera> {
        let turned = ego_from_camera.rotation * DQuat::from_rotation_x(self.pitch_rad);
        Pose::new(turned, ego_from_camera.translation + DVec3::Z * self.lift_m)
    }

    /// The pose of the camera that took a picture.
    fn world_from_camera(&self, exposure: &Exposure) -> Pose<World, Camera> {
        exposure.world_from_ego * self.mounted(&exposure.ego_from_camera)
    }

    fn lens(&self, camera: &str, recorded: &Lens) -> Lens {
        let mut lens = *recorded;
        if let Some(change) = self.lenses.get(camera).or_else(|| self.lenses.get(ALL_CAMERAS)) {
            lens.distortion = change.distortion;
            (lens.fx_px, lens.fy_px) = change.focal_px.map_or((lens.fx_px, lens.fy_px), |f| (f, f));
        }
        match self.size {
            PictureSize::Scaled(1.0) => lens,
            PictureSize::Scaled(scale) => lens.scaled(scale),
            PictureSize::Cropped([width_px, height_px]) => lens.cropped(width_px, height_px),
        }
    }

    /// `neighbours_ns` are the times of the previous and the next keyframe's picture.
    fn shutter(&self, time_ns: i64, neighbours_ns: [Option<i64>; 2]) -> Shutter {
        let [since_previous_s, until_next_s] = neighbours_ns.map(|other_ns| {
            let apart_ns = other_ns.map_or(0, |other_ns| other_ns.abs_diff(time_ns));
            // Without a neighbour, or with one at the same time, there is no motion to scale.
            if apart_ns == 0 { f64::INFINITY } else { apart_ns as f64 * 1e-9 }
        });
        Shutter { exposure_s: self.exposure_s, readout_s: self.readout_s, since_previous_s, until_next_s }
    }
}

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
            view,
        });
    }
    shots.extend(carriers::shots(drive, site, keyframe, views, seeds, report));
    shots
}

fn shot_seed(seeds: &Seeds, keyframe: usize, view: &str) -> Seed {
    seeds.noise.child("views").child("shot").nth(keyframe as u64).child(view)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing;
    use crate::{BuildSettings, LightChoice, OnDisagreement, build};

    fn site() -> Site {
        let weather = crate::Weather::default();
        let settings = BuildSettings {
            seeds: Seed(1).into(),
            top_k: 1,
            traffic: crate::Traffic::default(),
            light: LightChoice::default(),
            weather,
            on_disagreement: OnDisagreement::default(),
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
            let others: Vec<&Shot> = shots.iter().filter(|s| s.view.starts_with('v')).collect();
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
