//! Lamps that people switch on in the dark.

use glam::{Vec3, vec3};
use trove_model::{Environment, Light, Material, Role};

use crate::assembly::Actor;
use crate::assembly::Stock;

/// Lamps go on when the sun is this high, sine: street lamps do a quarter of an hour before sunset.
const LAMPS_ON_BELOW: f64 = 0.04;
/// Photographed skies that give a level surface less than this are those of the night; day's give about π.
const DARK_IRRADIANCE: f32 = 0.5;
/// Signals are dimmed in the dark.
const DIMMED: f32 = 0.15;

/// Radiance of lamps, in the light's scale, where 1 is 32,000 cd/m²: a street lamp's lens of
/// 0.1 m² that gives 10,000 lm, the walls of a room (60 cd/m²), a headlamp's beam spread over its lens, tail lamps of 5 cd.
const STREET: [(Role, Vec3); 3] = [
    (Role::StreetLamp, vec3(1.4, 0.95, 0.5)),
    (Role::WallLamp, vec3(0.14, 0.1, 0.06)),
    (Role::LitRoom, vec3(0.0024, 0.0018, 0.0011)),
];
const VEHICLE: [(Role, Vec3); 2] = [(Role::Headlamp, vec3(0.5, 0.47, 0.4)), (Role::TailLamp, vec3(0.03, 0.001, 0.001))];

/// Switches street lamps and lights in rooms on, and the lamps of the vehicles that move during the recording, if it is dark.
pub(crate) fn switch_on<'a>(light: &Light, stock: &mut Stock, actors: impl Iterator<Item = &'a mut Actor>) {
    if !is_dark(&light.environment) {
        return;
    }
    for material in &mut stock.materials {
        material.emission = glow(&STREET, material).unwrap_or(material.emission * DIMMED);
    }
    for actor in actors.filter(|actor| actor.moves()) {
        for index in &mut actor.materials {
            let material = &stock.materials[*index];
            if let Some(emission) = glow(&VEHICLE, material) {
                let lit = Material { emission, ..material.clone() };
                *index = stock.material(&lit);
            }
        }
    }
}

fn glow(lamps: &[(Role, Vec3)], material: &Material) -> Option<Vec3> {
    lamps.iter().find(|(role, _)| material.role == Some(*role)).map(|(_, emission)| *emission)
}

fn is_dark(environment: &Environment) -> bool {
    match environment {
        Environment::Sky(sky) => sky.to_sun.z < LAMPS_ON_BELOW,
        Environment::Map(map) => {
            let (width, rows) = (map.width as usize, map.height as usize / 2);
            let level = |y: usize| {
                let row = &map.rgb[y * width..(y + 1) * width];
                let mean = row.iter().flatten().sum::<f32>() / (3 * width) as f32;
                // ∫ cos sin over a row's zenith angles, all around.
                let sin_squared = |y: usize| (std::f32::consts::FRAC_PI_2 * y as f32 / rows as f32).sin().powi(2);
                mean * std::f32::consts::PI * (sin_squared(y + 1) - sin_squared(y))
            };
            (0..rows).map(level).sum::<f32>() < DARK_IRRADIANCE
        }
    }
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use glam::DVec3;
    use trove_model::{EnvironmentMap, PhysicalSky};

    use super::*;

    /// Emission of a street lamp and of a signal under a sky.
    fn shining(environment: Environment) -> [Vec3; 2] {
        let mut stock = Stock::default();
        stock.material(&Material { role: Some(Role::StreetLamp), ..Material::default() });
        stock.material(&Material { emission: Vec3::X, ..Material::default() });
        switch_on(&Light::clear(environment), &mut stock, std::iter::empty());
        [stock.materials[0].emission, stock.materials[1].emission]
    }

    #[test]
    fn street_lamps_shine_in_the_dark_and_signals_are_dimmed_then() {
        let sky = |z: f64| {
            let to_sun = DVec3::new(1.0, 0.0, z).normalize();
            let [turbidity, ground_albedo, cloud_cover] = [3.0, 0.2, 0.3];
            Environment::Sky(PhysicalSky { to_sun, turbidity, ground_albedo, cloud_cover, cloud_seed: 1 })
        };
        let map = |radiance: f32| {
            let rgb = vec![[radiance; 3]; 32];
            Environment::Map(Arc::new(EnvironmentMap { name: String::new(), width: 8, height: 4, rgb }))
        };
        for dark in [sky(-0.2), sky(0.0), map(0.1)] {
            assert_eq!(shining(dark), [STREET[0].1, Vec3::X * DIMMED]);
        }
        for bright in [sky(0.5), map(0.6)] {
            assert_eq!(shining(bright), [Vec3::ZERO, Vec3::X]);
        }
    }
}
