//! What vehicles are made of.

use glam::{Vec3, vec3};
use trove_model::Material;

use crate::shape::Model;

/// The slots of a vehicle.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Palette {
    pub(crate) paint: u16,
    pub(crate) trim: u16,
    pub(crate) glass: u16,
    pub(crate) rubber: u16,
    pub(crate) rim: u16,
    pub(crate) chrome: u16,
    pub(crate) lamp: u16,
    pub(crate) red: u16,
    pub(crate) amber: u16,
    pub(crate) interior: u16,
    pub(crate) plate: u16,
    pub(crate) seam: u16,
    /// A second paint (liveries, canvas, box bodies).
    pub(crate) second: u16,
    /// Cartons.
    pub(crate) cargo: u16,
}

/// What one draws from for passenger cars: about a third white, a fifth black, a third grey or silver, some blue and
/// red, as manufacturers' yearly colour reports have it.
pub(crate) const FLEET: [Vec3; 25] = {
    const WHITE: Vec3 = vec3(0.76, 0.76, 0.74);
    const PEARL: Vec3 = vec3(0.68, 0.68, 0.65);
    const BLACK: Vec3 = vec3(0.008, 0.008, 0.009);
    const GREY: Vec3 = vec3(0.09, 0.095, 0.1);
    const DARK_GREY: Vec3 = vec3(0.04, 0.042, 0.046);
    const SILVER: Vec3 = vec3(0.42, 0.43, 0.44);
    [
        WHITE,
        WHITE,
        WHITE,
        WHITE,
        PEARL,
        PEARL,
        PEARL,
        BLACK,
        BLACK,
        BLACK,
        BLACK,
        BLACK,
        GREY,
        GREY,
        DARK_GREY,
        DARK_GREY,
        SILVER,
        SILVER,
        SILVER,
        vec3(0.02, 0.055, 0.2),
        vec3(0.012, 0.025, 0.08),
        vec3(0.35, 0.012, 0.015),
        vec3(0.16, 0.008, 0.012),
        vec3(0.24, 0.2, 0.15),
        vec3(0.03, 0.07, 0.05),
    ]
};

/// Delivery vans and lorries: mostly white.
pub(crate) const COMMERCIAL: [Vec3; 8] = {
    const WHITE: Vec3 = vec3(0.74, 0.74, 0.72);
    [
        WHITE,
        WHITE,
        WHITE,
        WHITE,
        vec3(0.4, 0.41, 0.42),
        vec3(0.02, 0.07, 0.26),
        vec3(0.42, 0.03, 0.02),
        vec3(0.6, 0.36, 0.03),
    ]
};

impl Palette {
    /// Adds the slots to a model.
    pub(crate) fn new(model: &mut Model, paints: &[Vec3], second: &[Vec3]) -> Self {
        let paint_of = |name: &str, paints: &[Vec3]| Material {
            coat: 1.0,
            // Passenger cars are mostly metallic; what carries goods is not.
            flakes: if paints == FLEET { 0.5 } else { 0.0 },
            dirt: 0.5,
            ..Material::plain(name, paints.first().copied().unwrap_or(Vec3::splat(0.7)), 0.45)
        };
        let metal = |name: &str, grey: f32, roughness: f32| Material {
            metalness: 1.0,
            dirt: 0.5,
            ..Material::plain(name, Vec3::splat(grey), roughness)
        };
        let lens = |name: &str, color: Vec3| Material { coat: 1.0, ..Material::plain(name, color, 0.25) };
        let mut slot = |material| model.slot(material, &[]);
        Self {
            trim: slot(Material { dirt: 0.6, ..Material::plain("black plastic", Vec3::splat(0.022), 0.55) }),
            glass: slot(Material {
                transmission: 0.92,
                ..Material::plain("tinted glass", vec3(0.42, 0.47, 0.46), 0.02)
            }),
            rubber: slot(Material { dirt: 0.7, ..Material::plain("tyre", Vec3::splat(0.024), 0.85) }),
            rim: slot(metal("alloy", 0.55, 0.32)),
            chrome: slot(metal("chrome", 0.7, 0.12)),
            lamp: slot(Material { metalness: 0.75, coat: 1.0, ..Material::plain("lamp", vec3(0.75, 0.78, 0.8), 0.15) }),
            red: slot(lens("red lens", vec3(0.36, 0.008, 0.01))),
            amber: slot(lens("amber lens", vec3(0.6, 0.2, 0.01))),
            interior: slot(Material::plain("interior", vec3(0.035, 0.035, 0.037), 0.8)),
            plate: slot(Material::plain("number plate", vec3(0.72, 0.72, 0.7), 0.45)),
            cargo: slot(Material::plain("cardboard", vec3(0.36, 0.25, 0.15), 0.85)),
            seam: slot(Material::plain("seam", Vec3::splat(0.006), 0.9)),
            paint: model.slot(paint_of("paint", paints), paints),
            second: model.slot(paint_of("second paint", second), second),
        }
    }
}
