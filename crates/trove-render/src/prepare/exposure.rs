//! What comes down on surfaces: who bears snow, and what shelters from it and from rain.

use glam::{Vec2, Vec3, vec2};
use trove_model::{Class, Form, Instance, Light, Snow, SnowLeft, State};
use trove_trace::{Exposure, Surface, holds_snow};

use crate::accel::{Accel, Coherence};
use crate::ray::Ray;

/// What is left of snow on vehicles that are on their way.
const DRIVEN: f32 = 0.45;
/// What falls slants by so much here and there, as a tangent, and the width of what has one slant, metres: where it ends is
/// uneven.
const SLANT: f32 = 0.08;
const SLANT_WIDE_M: f32 = 0.15;
/// Nothing nearer shelters: surfaces are layers of paint and patches, millimetres apart, metres.
const LAYERS_M: f32 = 0.03;
/// Wheels and feet sway by so much: the edge of a track is no line, metres.
const SWAY_M: f32 = 0.15;

/// What snow an instance bears.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Bears {
    /// Where wheels and feet are.
    Ground,
    /// [`DRIVEN`] of what falls, which moves on with it.
    Driven,
    /// This share of what falls.
    Share(f32),
}

impl Bears {
    pub(super) fn new(instance: &Instance) -> Self {
        match (instance.class, &instance.object) {
            (Class::Road | Class::Sidewalk | Class::Ground, None) => Self::Ground,
            (Class::Human | Class::CycleRider | Class::MotorcycleRider, _) => Self::Share(0.0),
            (_, Some(object)) if object.kind.is_vehicle() && !object.states.contains(&State::Parked) => Self::Driven,
            _ => Self::Share(1.0),
        }
    }
}

/// What comes down in the open.
pub(super) struct ComesDown {
    pub(super) snow: Option<Snow>,
    rain_mm_h: f32,
    moment_s: f32,
}

impl ComesDown {
    pub(super) fn new(light: &Light) -> Self {
        let rain = light.falling.filter(|falling| falling.form == Form::Rain);
        let rain_mm_h = rain.map_or(0.0, |rain| rain.rate_mm_h as f32);
        Self { snow: light.snow.clone(), rain_mm_h, moment_s: light.moment_s as f32 }
    }
}

/// What comes down on a point of what bears so much snow, as a ray sees it.
pub(super) fn exposure(accel: &dyn Accel, what: &ComesDown, bears: Bears, surface: &Surface, ray: &Ray) -> Exposure {
    let bare = Exposure::BARE;
    if !holds_snow(surface.outward_z()) || bears == Bears::Share(0.0) {
        return bare;
    }
    let at = surface.point.truncate() / SLANT_WIDE_M;
    let slant = SLANT * Vec3::new(at.x.sin() * (1.7 * at.y).cos(), at.y.sin() * (1.3 * at.x).cos(), 0.0);
    let up = Vec3::Z + slant;
    let looking = Ray { t_min: LAYERS_M, for_shelter: true, ..ray.then(surface.leave(Vec3::Z), up) };
    let mut blocked = [false];
    accel.blocked(&[looking], Coherence::Incoherent, &mut blocked);
    if blocked[0] {
        return Exposure { is_open: false, ..bare };
    }
    let bare = Exposure { rain_mm_h: what.rain_mm_h, moment_s: what.moment_s, ..bare };
    let Some(snow) = &what.snow else { return bare };
    match (bears, &snow.left) {
        (Bears::Ground, Some(left)) => {
            let (left, left_grows) = around(left, surface.point.truncate());
            Exposure { snow: snow.cover as f32, left, left_grows, ..bare }
        }
        (Bears::Ground, None) => Exposure { snow: snow.cover as f32, ..bare },
        (Bears::Driven, _) => Exposure { snow: snow.cover as f32 * DRIVEN, moves: true, ..bare },
        (Bears::Share(share), _) => Exposure { snow: snow.cover as f32 * share, ..bare },
    }
}

/// The mean share that is left around a point, and how fast it grows along x and y.
fn around(left: &SnowLeft, at: Vec2) -> (f32, Vec2) {
    let [west, east] = [-SWAY_M, SWAY_M].map(|off_m| left.at(at + Vec2::X * off_m));
    let [south, north] = [-SWAY_M, SWAY_M].map(|off_m| left.at(at + Vec2::Y * off_m));
    ((west + east + south + north) / 4.0, vec2(east - west, north - south) / (2.0 * SWAY_M))
}
