//! Which pictures are taken, through which lens, and how they are exposed.

use std::collections::BTreeMap;

use glam::{DQuat, DVec3};
use trove_model::{
    Camera, Distortion, Ego, Exposure, Film, LabelSettings, Lens, LensDrops, Pose, Seed, Shutter, World,
};

use crate::place::Seeds;

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
    /// As in [`Shot::noise`](trove_model::Shot::noise).
    pub noise: f32,
    /// As in [`Shot::cache`](trove_model::Shot::cache).
    pub cache: bool,
    /// Lenses in place of the recorded ones, by the camera's name; [`ALL_CAMERAS`] is for those that are not named.
    pub lenses: BTreeMap<String, LensChange>,
    /// Time for which a row of the sensor is exposed, seconds.
    pub exposure_s: f64,
    /// From the first row's exposure to the last one's, seconds.
    pub readout_s: f64,
    /// Share of the glass before every lens that drops cover; 0 is dry.
    pub drops: f64,
    /// From light to picture.
    pub film: Film,
    /// Which labels pictures get.
    pub labels: LabelSettings,
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
    pub(super) fn wants(&self, camera: &str) -> bool {
        self.rig.as_ref().is_none_or(|names| names.iter().any(|n| n == camera))
    }

    /// Where a camera sits that is mounted somewhere.
    pub(super) fn mounted(&self, ego_from_camera: &Pose<Ego, Camera>) -> Pose<Ego, Camera> {
        let turned = ego_from_camera.rotation * DQuat::from_rotation_x(self.pitch_rad);
        Pose::new(turned, ego_from_camera.translation + DVec3::Z * self.lift_m)
    }

    /// The pose of the camera that took a picture.
    pub(super) fn world_from_camera(&self, exposure: &Exposure) -> Pose<World, Camera> {
        exposure.world_from_ego * self.mounted(&exposure.ego_from_camera)
    }

    pub(super) fn lens(&self, camera: &str, recorded: &Lens) -> Lens {
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

    pub(super) fn shutter(&self) -> Shutter {
        Shutter { exposure_s: self.exposure_s, readout_s: self.readout_s }
    }

    /// A view's drops stay where they are from keyframe to keyframe.
    pub(super) fn drops(&self, seeds: &Seeds, view: &str) -> Option<LensDrops> {
        let seed = seeds.noise.child("views").child("drops").child(view);
        (self.drops > 0.0).then_some(LensDrops { share: self.drops, seed })
    }
}

pub(super) fn shot_seed(seeds: &Seeds, keyframe: usize, view: &str) -> Seed {
    seeds.noise.child("views").child("shot").nth(keyframe as u64).child(view)
}
