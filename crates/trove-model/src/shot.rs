//! One picture to take.

use glam::{DVec2, DVec3};

use crate::{Camera, Ego, InstanceId, LabelSettings, Lens, Pose, Seed, Sensor, SensorRay, World};

/// How bright the picture becomes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ExposureRule {
    /// Metered, plus a correction in stops.
    Auto {
        /// Stops; positive is brighter.
        compensation_ev: f64,
    },
    /// Radiance is multiplied by 2 to this power.
    Fixed {
        /// Stops.
        ev: f64,
    },
}

impl ExposureRule {
    /// Adds stops to it.
    pub fn brighten(&mut self, more_ev: f64) {
        match self {
            Self::Auto { compensation_ev: ev } | Self::Fixed { ev } => *ev += more_ev,
        }
    }
}

/// Which light becomes white.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum WhiteBalance {
    /// That of the picture, as far as a camera's automatic goes.
    Auto,
    /// Daylight (D65): colours stay as they are.
    Daylight,
}

/// What becomes of the light behind the lens.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Film {
    /// Brightness.
    pub exposure: ExposureRule,
    /// Colour.
    pub white_balance: WhiteBalance,
    /// How much steeper than the light itself brightness runs around a grey card, more than 0; it flattens to both ends.
    pub contrast: f64,
    /// Faults of lens, sensor and encoding; `None` for a perfect one.
    pub sensor: Option<SensorModel>,
}

impl Film {
    /// The contrast of cars' cameras, fitted to photographs of four datasets, each counted alike: nuScenes, KITTI, CamVid and
    /// IDD-Lite. Their darkest fiftieth is shown below 0.03 to 0.12 of white, a quarter of them below 0.15 to 0.28, the
    /// brightest tenth above 0.72 to 0.90; nuScenes' have the least contrast.
    pub const CONTRAST: f64 = 1.4;
}

impl Default for Film {
    fn default() -> Self {
        let exposure = ExposureRule::Auto { compensation_ev: 0.0 };
        Self { exposure, white_balance: WhiteBalance::Auto, contrast: Self::CONTRAST, sensor: None }
    }
}

/// What a real camera adds to a picture; labels know nothing of it. Pixels are the picture's own.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SensorModel {
    /// Electrons that a pixel holds at white; shot noise is that of counting them. More than 0.
    pub full_well_e: f64,
    /// Standard deviation of what reading adds, electrons.
    pub read_noise_e: f64,
    /// Share of the light that is lost in the corners, 0 to less than 1.
    pub vignetting: f64,
    /// Standard deviation of the lens's and the pixel's blur, pixels.
    pub blur_px: f64,
    /// How much farther out red lies than green in the corners, and green than blue, pixels.
    pub chromatic_aberration_px: f64,
    /// Share of the light that the lens scatters all over the picture, 0 to less than 1: halos around lamps.
    pub glare: f64,
    /// Quality of the JPEG that the picture passes through on its way to a file, 1 to 100; `None` for none.
    pub jpeg_quality: Option<u8>,
}

impl SensorModel {
    /// A car's camera by day: a 1/1.8″ CMOS sensor with pixels of 4.5 µm and a fixed lens (data sheets of such sensors give
    /// 8 to 12 thousand electrons and 5 to 25 electrons of noise, and lenses scatter 1 to 3 %).
    pub const AUTOMOTIVE: Self = Self {
        full_well_e: 8400.0,
        read_noise_e: 12.0,
        vignetting: 0.2,
        blur_px: 0.5,
        chromatic_aberration_px: 0.4,
        glare: 0.02,
        jpeg_quality: Some(90),
    };
}

/// Drops of water on the glass before a lens; labels know nothing of them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LensDrops {
    /// Share of the glass that they cover, more than 0 and at most [`LensDrops::MOST`].
    pub share: f64,
    /// Where they are: pictures with the same seed see the same ones.
    pub seed: Seed,
}

impl LensDrops {
    /// More do not find room beside each other.
    pub const MOST: f64 = 0.5;
}

/// When the sensor's rows see light. Of exposure and readout together things move for the middle 0.1 s and stand before
/// and after it; the camera moves all the time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Shutter {
    /// Time for which every row is exposed, seconds; 0 is an instant.
    pub exposure_s: f64,
    /// From the first row's exposure to the last one's, seconds; 0 is a global shutter.
    pub readout_s: f64,
}

impl Shutter {
    /// Everything at once.
    pub const INSTANT: Self = Self { exposure_s: 0.0, readout_s: 0.0 };

    /// Whether a picture is taken all at once.
    pub fn is_instant(&self) -> bool {
        self.exposure_s == 0.0 && self.readout_s == 0.0
    }

    /// Seconds after the exposure's middle at which a ray leaves: `row` is its place in the picture from top (0) to
    /// bottom (1), `within` its place in the row's exposure (0 to 1).
    pub fn time_s(&self, row: f64, within: f64) -> f64 {
        (row - 0.5) * self.readout_s + (within - 0.5) * self.exposure_s
    }
}

/// Whose camera takes a shot; cameras are indices into [`Drive::rig`](crate::Drive::rig).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Viewpoint {
    /// The recording vehicle's, where it took its own picture.
    Recording {
        /// Which one.
        camera: usize,
    },
    /// The same camera on another vehicle of the scene.
    OtherVehicle {
        /// Which vehicle, from 1.
        number: usize,
        /// Which camera.
        camera: usize,
    },
    /// One that no drive has.
    Free,
}

/// Where a shot's camera is some time before or after the exposure's middle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CameraBeside {
    /// That time, seconds, more than 0.
    pub apart_s: f64,
    /// Its pose then.
    pub world_from_camera: Pose<World, Camera>,
}

/// A camera at a moment.
#[derive(Clone, Debug, PartialEq)]
pub struct Shot {
    /// Name (`ego.CAM_FRONT`).
    pub view: String,
    /// Whose camera it is.
    pub viewpoint: Viewpoint,
    /// Intrinsics.
    pub lens: Lens,
    /// The vehicle that carries the camera, at the picture's time; `None` where the camera stands on its own.
    pub world_from_ego: Option<Pose<World, Ego>>,
    /// Pose.
    pub world_from_camera: Pose<World, Camera>,
    /// The same camera at the previous keyframe; `None` where there is none, and backward flow is not defined.
    pub world_from_camera_previous: Option<Pose<World, Camera>>,
    /// The same camera at the next keyframe; `None` where there is none, and forward flow is not defined.
    pub world_from_camera_next: Option<Pose<World, Camera>>,
    /// The camera shortly before, and shortly after: how it moves while light is gathered. Where both are missing it stands.
    pub beside: [Option<CameraBeside>; 2],
    /// Time of the exposure's middle, to which pose and labels belong, nanoseconds since 1970 UTC.
    pub time_ns: i64,
    /// When light is gathered for the picture around that time.
    pub shutter: Shutter,
    /// Samples a pixel; where `noise` is more than 0 the most that a pixel may get.
    pub spp: u32,
    /// Mean error, as a share of brightness, at which a few neighbouring pixels have had enough samples; 0: all get
    /// `spp`.
    pub noise: f32,
    /// Whether light that fog scatters again and again is read from a field around the camera and not followed: far less noise
    /// for some bias.
    pub cache: bool,
    /// Drops on the glass before the lens; `None` where it is dry.
    pub drops: Option<LensDrops>,
    /// From light to picture.
    pub film: Film,
    /// Source of all randomness in the picture.
    pub seed: Seed,
    /// The object that carries the camera: camera and label rays pass through it, its shadow and reflection stay.
    pub carrier: Option<InstanceId>,
    /// Which labels it gets.
    pub labels: LabelSettings,
}

impl Shot {
    /// A picture taken in an instant, with one sample a pixel, by a camera that has no neighbouring keyframes and that
    /// nothing carries.
    pub fn new(view: &str, lens: Lens, world_from_camera: Pose<World, Camera>) -> Self {
        Self {
            view: view.into(),
            viewpoint: Viewpoint::Free,
            lens,
            world_from_ego: None,
            world_from_camera,
            world_from_camera_previous: None,
            world_from_camera_next: None,
            beside: [None; 2],
            time_ns: 0,
            shutter: Shutter::INSTANT,
            spp: 1,
            noise: 0.0,
            cache: false,
            drops: None,
            film: Film::default(),
            seed: Seed(0),
            carrier: None,
            labels: LabelSettings::default(),
        }
    }

    /// The ray of labels in a direction, unit, Camera: labels belong to the exposure's middle.
    pub fn label_ray(&self, direction_camera: DVec3) -> SensorRay {
        let direction = self.world_from_camera.vector(direction_camera);
        SensorRay { origin: self.world_from_camera.translation, direction, time_s: 0.0 }
    }

    /// The camera's pose `time_s` seconds after the exposure's middle: it moves evenly from where it is before, and to where
    /// it is after, and on from one where the other is missing.
    pub fn world_from_camera_at(&self, time_s: f64) -> Pose<World, Camera> {
        let [before, after] = self.beside;
        let (other, after_s) = match (before, after) {
            (Some(before), None) => (before, -before.apart_s),
            (Some(before), _) if time_s < 0.0 => (before, -before.apart_s),
            (_, Some(after)) => (after, after.apart_s),
            (None, None) => return self.world_from_camera,
        };
        self.world_from_camera.interpolate(&other.world_from_camera, time_s / after_s)
    }
}

/// One ray a pixel, row by row from the top: that of its labels.
impl Sensor for Shot {
    fn ray_count(&self) -> usize {
        self.lens.width_px as usize * self.lens.height_px as usize
    }

    fn ray(&self, index: usize) -> Option<SensorRay> {
        let width = self.lens.width_px as usize;
        let centre = DVec2::new((index % width) as f64 + 0.5, (index / width) as f64 + 0.5);
        self.lens.unproject(centre).map(|direction| self.label_ray(direction))
    }

    fn carrier(&self) -> Option<InstanceId> {
        self.carrier
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Distortion;

    #[test]
    fn a_camera_moves_evenly_and_on_where_one_side_is_missing() {
        let at = |yaw_rad: f64, x: f64| Pose::from_yaw(yaw_rad, DVec3::X * x);
        let lens = Lens {
            width_px: 1,
            height_px: 1,
            fx_px: 1.0,
            fy_px: 1.0,
            cx_px: 0.5,
            cy_px: 0.5,
            distortion: Distortion::None,
        };
        let beside = |pose| Some(CameraBeside { apart_s: 0.5, world_from_camera: pose });
        let mut shot = Shot {
            beside: [None, beside(at(0.4, 5.0))],
            shutter: Shutter { exposure_s: 0.01, readout_s: 0.03 },
            ..Shot::new("v", lens, at(0.0, 0.0))
        };
        assert_eq!(shot.shutter.time_s(0.5, 0.5), 0.0);
        assert!((shot.shutter.time_s(1.0, 1.0) - 0.02).abs() < 1e-12);
        for time_s in [-0.02, 0.02] {
            let pose = shot.world_from_camera_at(time_s);
            assert!((pose.translation.x - 10.0 * time_s).abs() < 1e-9 && (pose.yaw_rad() - 0.8 * time_s).abs() < 1e-5);
        }
        shot.beside[0] = beside(at(0.0, -1.0));
        assert!((shot.world_from_camera_at(-0.05).translation.x + 0.1).abs() < 1e-9);
        shot.beside[1] = None;
        assert!((shot.world_from_camera_at(0.05).translation.x - 0.1).abs() < 1e-9);
        shot.beside[0] = None;
        assert_eq!(shot.world_from_camera_at(0.05), shot.world_from_camera);
    }
}
