//! What vehicles are made of.

use glam::{Vec3, vec3};
use serde::Deserialize;
use trove_model::{Material, Role};

use super::coverings::{BOARDS, CANVAS, GRAVEL, PANEL, SLATS};
use crate::shape::Model;

/// The slots of a vehicle of any kind; those that nothing is made of go when the asset is finished.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Slots {
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
    /// Dark glass of rear windows.
    pub(crate) privacy: u16,
    /// Clear cover of a head lamp.
    pub(crate) lens: u16,
    /// What a head lamp is lined with.
    pub(crate) bowl: u16,
    /// Light guides of the daytime lamps.
    pub(crate) strip: u16,
    /// Clear red cover of a tail lamp.
    pub(crate) red_glass: u16,
    /// Light guides of the tail lamps.
    pub(crate) bright: u16,
    /// Roof lining.
    pub(crate) lining: u16,
    pub(crate) seat: u16,
    pub(crate) disc: u16,
    pub(crate) skin: u16,
    pub(crate) cloth: u16,
    pub(crate) hair: u16,
    /// Frame rails, axles, springs.
    pub(crate) frame: u16,
    /// Galvanised and worn steel.
    pub(crate) steel: u16,
    /// Aluminium planks and tanks.
    pub(crate) alu: u16,
    /// Clear covers of lorries' lamps.
    pub(crate) clear_lens: u16,
    /// White plastic: reversing lamps, stickers.
    pub(crate) white: u16,
    /// Mirrors' glass.
    pub(crate) mirror: u16,
    /// Cloth of the seats of lorries, buses and machines.
    pub(crate) seat_cloth: u16,
    /// Poles to hold on to, marks of danger.
    pub(crate) yellow: u16,
    /// The second paint on large panels with seams and rivets; uvs in metres.
    pub(crate) panel: u16,
    /// The second paint on canvas; uvs in metres.
    pub(crate) canvas: u16,
    /// Boards of a floor; uvs in metres.
    pub(crate) boards: u16,
    /// Slats across: shutters, radiators; uvs in metres.
    pub(crate) slats: u16,
    /// Gravel, sand; uvs in metres.
    pub(crate) gravel: u16,
    pub(crate) tail: u16,
}

/// What one draws the colours of a vehicle from, linear RGB, a colour as often as it is common: `[paint.NAME]`.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Paint {
    pub(crate) colors: Vec<[f32; 3]>,
    /// How metallic it is, 0 to 1.
    #[serde(default)]
    pub(crate) flakes: f32,
    /// Whether a colour is as common as it is among the cars of the place.
    #[serde(default)]
    pub(crate) by_region: bool,
}

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

/// Seats' cloth.
const SEATS: [Vec3; 4] =
    [vec3(0.03, 0.05, 0.13), vec3(0.05, 0.05, 0.055), vec3(0.12, 0.02, 0.025), vec3(0.03, 0.07, 0.06)];
/// Sand, grey gravel, earth, crushed stone.
const HEAPS: [Vec3; 4] = [vec3(0.62, 0.5, 0.34), vec3(0.5, 0.49, 0.47), vec3(0.28, 0.2, 0.13), vec3(0.62, 0.6, 0.57)];

impl Slots {
    /// Adds the slots to a model; `flakes` is how metallic the first paint is, 0 to 1.
    pub(crate) fn new(model: &mut Model, paints: &[Vec3], flakes: f32, second: &[Vec3]) -> Self {
        let paint_of = |name: &str, paints: &[Vec3], flakes: f32| Material {
            coat: 1.0,
            flakes,
            dirt: 0.15,
            // The lacquer's surface is the paint's only one.
            ior: 1.0,
            ..Material::plain(name, paints.first().copied().unwrap_or(Vec3::splat(0.7)), 0.4)
        };
        let metal = |name: &str, grey: f32, roughness: f32| Material {
            metalness: 1.0,
            dirt: 0.5,
            ..Material::plain(name, Vec3::splat(grey), roughness)
        };
        let worn = |name: &str, grey: f32, roughness: f32, metalness: f32| Material {
            metalness,
            dirt: 0.8,
            ..Material::plain(name, Vec3::splat(grey), roughness)
        };
        let base = second.first().copied().unwrap_or(Vec3::splat(0.7));
        let over = |material: &Material| Material { base_color: base, dirt: 0.75, ..material.clone() };
        let lens = |name: &str, color: Vec3| Material { coat: 1.0, ..Material::plain(name, color, 0.25) };
        let glass = |name: &str, tint: Vec3, transmission: f32| Material {
            transmission,
            dirt: 0.1,
            ..Material::plain(name, tint, 0.02)
        };
        let lining =
            |name: &str| Material { metalness: 0.75, coat: 1.0, ..Material::plain(name, vec3(0.75, 0.78, 0.8), 0.15) };
        let rims = [0.55, 0.5, 0.45, 0.3, 0.09, 0.03].map(Vec3::splat);
        let seats = [0.016, 0.02, 0.03, 0.05, 0.09].map(Vec3::splat);
        let seats = [&seats[..], &[vec3(0.2, 0.15, 0.1), vec3(0.12, 0.1, 0.085), vec3(0.1, 0.04, 0.02)]].concat();
        let skins = [vec3(0.45, 0.28, 0.2), vec3(0.36, 0.21, 0.14), vec3(0.22, 0.12, 0.075), vec3(0.08, 0.042, 0.027)];
        let clothes = [
            vec3(0.03, 0.032, 0.04),
            Vec3::splat(0.5),
            vec3(0.04, 0.07, 0.16),
            Vec3::splat(0.12),
            vec3(0.2, 0.03, 0.03),
            vec3(0.1, 0.12, 0.08),
        ];
        let hairs = [vec3(0.01, 0.008, 0.007), vec3(0.04, 0.022, 0.012), vec3(0.2, 0.13, 0.06), Vec3::splat(0.25)];
        let cloth = |name: &str, sheen: f32, color: Vec3| Material { sheen, ..Material::plain(name, color, 0.85) };
        let rim = model.slot(metal("alloy", 0.55, 0.3), &rims);
        let seat = model.slot(cloth("seat", 0.3, seats[0]), &seats);
        let cloth_slot = model.slot(cloth("clothes", 0.5, clothes[0]), &clothes);
        let skin = model.slot(Material { subsurface: 0.5, ..Material::plain("skin", skins[0], 0.55) }, &skins);
        let hair = model.slot(Material::plain("hair", hairs[0], 0.6), &hairs);
        let mut slot = |material| model.slot(material, &[]);
        Self {
            rim,
            seat,
            skin,
            hair,
            cloth: cloth_slot,
            trim: slot(Material { dirt: 0.5, ..Material::plain("black plastic", Vec3::splat(0.018), 0.5) }),
            glass: slot(glass("window glass", vec3(0.74, 0.79, 0.77), 0.94)),
            privacy: slot(glass("dark glass", vec3(0.3, 0.32, 0.32), 0.94)),
            lens: slot(glass("lamp glass", vec3(0.95, 0.96, 0.96), 0.96)),
            bowl: slot(Material { metalness: 0.6, ..Material::plain("lamp lining", vec3(0.1, 0.1, 0.105), 0.25) }),
            strip: slot(Material { coat: 1.0, ..Material::plain("light guide", vec3(0.85, 0.87, 0.9), 0.3) }),
            red_glass: slot(glass("red lamp glass", vec3(0.62, 0.03, 0.03), 0.94)),
            bright: slot(lens("bright red lens", vec3(0.62, 0.02, 0.02))),
            lining: slot(Material::plain("roof lining", vec3(0.3, 0.29, 0.27), 0.9)),
            disc: slot(metal("brake disc", 0.34, 0.35)),
            rubber: slot(Material { dirt: 0.25, ..Material::plain("tyre", Vec3::splat(0.018), 0.75) }),
            chrome: slot(metal("chrome", 0.7, 0.1)),
            lamp: slot(Material { role: Some(Role::Headlamp), ..lining("lamp") }),
            red: slot(Material { role: Some(Role::TailLamp), ..lens("red lens", vec3(0.26, 0.006, 0.008)) }),
            amber: slot(lens("amber lens", vec3(0.6, 0.2, 0.01))),
            interior: slot(Material::plain("interior", vec3(0.035, 0.035, 0.037), 0.8)),
            plate: slot(Material::plain("number plate", vec3(0.72, 0.72, 0.7), 0.45)),
            cargo: slot(Material::plain("cardboard", vec3(0.36, 0.25, 0.15), 0.85)),
            seam: slot(Material::plain("seam", Vec3::splat(0.006), 0.9)),
            paint: model.slot(paint_of("paint", paints, flakes), paints),
            second: model.slot(paint_of("second paint", second, 0.0), second),
            frame: model.slot(worn("frame paint", 0.03, 0.6, 0.0), &[]),
            steel: model.slot(worn("steel", 0.34, 0.45, 1.0), &[]),
            alu: model.slot(worn("aluminium", 0.6, 0.38, 1.0), &[]),
            clear_lens: model
                .slot(Material { transmission: 0.95, ..Material::plain("clear lens", Vec3::splat(0.93), 0.03) }, &[]),
            white: model.slot(Material::plain("white plastic", vec3(0.68, 0.68, 0.66), 0.35), &[]),
            mirror: model.slot(Material { metalness: 1.0, ..Material::plain("mirror", Vec3::splat(0.85), 0.03) }, &[]),
            seat_cloth: model.slot(Material { sheen: 0.4, ..Material::plain("seat cloth", SEATS[0], 0.9) }, &SEATS),
            yellow: model.slot(Material { dirt: 0.4, ..Material::plain("yellow", vec3(0.62, 0.36, 0.015), 0.4) }, &[]),
            panel: model.slot(over(&PANEL), second),
            canvas: model.slot(over(&CANVAS), second),
            boards: model.slot(Material { dirt: 0.6, ..BOARDS.clone() }, &[]),
            slats: model.slot(Material { metalness: 1.0, dirt: 0.6, ..SLATS.clone() }, &[]),
            gravel: model.slot(GRAVEL.clone(), &HEAPS),
            tail: model.slot(Material { role: Some(Role::TailLamp), ..lining("tail lamp") }, &[]),
        }
    }
}
