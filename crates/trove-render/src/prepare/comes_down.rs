//! What comes down in a scene, and who bears snow.

use trove_model::{Class, Form, Instance, Light, Snow, State};
use trove_trace::{Bears, SnowLeft};

pub(super) fn bears(instance: &Instance) -> Bears {
    match (instance.class, &instance.object) {
        (Class::Road | Class::Sidewalk | Class::Ground, None) => Bears::Ground,
        (Class::Human | Class::CycleRider | Class::MotorcycleRider, _) => Bears::Share(0.0),
        (_, Some(object)) if object.kind.is_vehicle() && !object.states.contains(&State::Parked) => Bears::Driven,
        _ => Bears::Share(1.0),
    }
}

/// What comes down in the open.
pub(crate) struct ComesDown {
    snow: Option<Snow>,
    rain_mm_h: f32,
    moment_s: f32,
}

impl ComesDown {
    pub(super) fn new(light: &Light) -> Self {
        let rain = light.falling.filter(|falling| falling.form == Form::Rain);
        let rain_mm_h = rain.map_or(0.0, |rain| rain.rate_mm_h as f32);
        Self { snow: light.snow.clone(), rain_mm_h, moment_s: light.moment_s as f32 }
    }

    pub(super) fn has_snow(&self) -> bool {
        self.snow.is_some()
    }

    /// To be read.
    pub(crate) fn view(&self) -> trove_trace::ComesDown<'_> {
        let Self { snow, rain_mm_h, moment_s } = self;
        let left = snow.as_ref().and_then(|snow| snow.left.as_ref()).map(|left| SnowLeft {
            origin: left.origin.as_vec2(),
            cell_m: left.cell_m as f32,
            size: [left.shares.width, left.shares.height],
            shares: &left.shares.data,
        });
        let snow = snow.as_ref().map(|snow| snow.cover as f32);
        trove_trace::ComesDown { snow, left, rain_mm_h: *rain_mm_h, moment_s: *moment_s }
    }
}
