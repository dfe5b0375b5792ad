//! What looks at a scene along rays, and what rays bring back.

use glam::DVec3;

use crate::{Class, InstanceId};

/// A ray of a sensor.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SensorRay {
    /// Where it starts, World, metres.
    pub origin: DVec3,
    /// Where it goes, World, unit.
    pub direction: DVec3,
    /// When it leaves, seconds after the moment to which the scene belongs. Things move for [`SensorRay::MOVING_S`] before and
    /// after that moment, and stand beyond.
    pub time_s: f64,
}

impl SensorRay {
    /// How long things move before and after the moment of a scene, seconds.
    pub const MOVING_S: f64 = 0.05;

    /// In a direction of any length; `None` where it has none or a number is not finite.
    pub fn new(origin: DVec3, direction: DVec3, time_s: f64) -> Option<Self> {
        let direction = direction.try_normalize()?;
        (origin.is_finite() && time_s.is_finite()).then_some(Self { origin, direction, time_s })
    }
}

/// What looks at a scene: a camera ([`crate::Shot`]) along one ray a pixel, a [`Scan`] along rays of its own.
pub trait Sensor: Sync {
    /// How many rays it has.
    fn ray_count(&self) -> usize;

    /// A ray, by its index; `None` where a camera's lens shows nothing.
    fn ray(&self, index: usize) -> Option<SensorRay>;

    /// The object that carries it, through which its rays pass; `None` for none.
    fn carrier(&self) -> Option<InstanceId>;
}

/// What a scanner sends out around the moment of a scene: origins, directions and times.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Scan {
    /// In the order in which their returns come back.
    pub rays: Vec<SensorRay>,
    /// The object that carries it, through which its rays pass; `None` for none.
    pub carrier: Option<InstanceId>,
}

impl Sensor for Scan {
    fn ray_count(&self) -> usize {
        self.rays.len()
    }

    fn ray(&self, index: usize) -> Option<SensorRay> {
        self.rays.get(index).copied()
    }

    fn carrier(&self) -> Option<InstanceId> {
        self.carrier
    }
}

/// What the rays of a sensor meet first.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Points {
    /// One a ray, in the rays' order; `None` where a ray meets nothing.
    pub returns: Vec<Option<Return>>,
}

/// Where a ray meets a surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Return {
    /// From the ray's origin, metres.
    pub range_m: f64,
    /// What it is.
    pub class: Class,
    /// The object; 0 for stuff.
    pub instance: InstanceId,
    /// Unit normal of the surface's triangle, World, on the side from which the ray comes.
    pub normal: DVec3,
    /// Rec. 709 luminance of the surface's linear base colour, 0 to 1: of the texture as it is, without weather, and no
    /// measure of what a laser's wavelength would bring back.
    pub base_color_luminance: f32,
}
