//! Large buildings.

use glam::{Vec3, vec2, vec3};
use trove_model::{Asset, Material, Surface};

use super::site::{Site, rectangle};

/// A slab block of flats on a ground floor of columns.
pub(super) fn slab(surfaces: &[Surface]) -> Asset {
    let mut site = Site::new(surfaces);
    let size = vec2(57.6, 12.8);
    let outline = rectangle(size);
    let concrete = site.surface("concrete/plain");
    let top = 4.0 + 11.0 * 2.8;
    site.walls(&outline, 0.0..4.0, &["ground-floor/arcade"]);
    site.walls(&outline, 4.0..top, &["facade/slab-block"]);
    site.band(concrete, &outline, 3.8..4.05, 0.3, 0.0);
    site.flat_roof(&outline, top, 1.0, "flat-roof/bitumen", concrete);
    for x in [-0.32, 0.32] {
        // Lift shafts and stairs stand out of the front and over the roof.
        let white = site.plain(Material::plain("painted wall", vec3(0.5, 0.49, 0.45), 0.85));
        let accent = site.plain(Material::plain("painted accent", vec3(0.2, 0.3, 0.36), 0.8));
        site.block(white, vec3(x * size.x, -size.y / 2.0 - 0.9, (top + 3.4) / 2.0), vec3(5.6, 2.2, top + 3.4));
        site.block(accent, vec3(x * size.x, -size.y / 2.0 - 2.02, (top + 2.4) / 2.0), vec3(1.2, 0.08, top + 2.4));
        site.block(white, vec3(x * size.x, 0.0, top + 1.7), vec3(7.0, 6.0, 3.4));
    }
    // Slabs over every floor throw shadows along the front.
    for storey in 1..=11 {
        let z = 4.0 + 2.8 * storey as f32;
        site.block(concrete, vec3(0.0, -size.y / 2.0 - 0.3, z - 0.06), vec3(size.x, 0.6, 0.12));
        site.block(concrete, vec3(0.0, size.y / 2.0 + 0.2, z - 0.06), vec3(size.x, 0.4, 0.12));
    }
    site.roof_plant(size / 2.0 * 0.5, top);
    site.asset("building/slab-block").tagged(["apartments", "slab"])
}

/// A glass tower on a lobby, with a plant storey behind louvres.
pub(super) fn tower(surfaces: &[Surface]) -> Asset {
    let mut site = Site::new(surfaces);
    let size = vec2(36.0, 30.0);
    let outline = rectangle(size);
    let metal = site.plain(Material::plain("fascia", vec3(0.3, 0.31, 0.32), 0.4));
    let dark = site.plain(Material::plain("louvres", Vec3::splat(0.07), 0.6));
    let top = 4.5 + 15.0 * 3.8;
    site.walls(&rectangle(size - 1.2), 0.0..4.5, &["ground-floor/lobby"]);
    let soffit = crate::shape::Shape::flat(&outline).inside_out();
    site.add(metal, soffit.moved(Vec3::Z * 4.5));
    site.walls(&outline, 4.5..top, &["facade/glass-blue"]);
    site.band(metal, &outline, 4.45..4.75, 0.12, 0.0);
    site.flat_roof(&outline, top, 1.2, "flat-roof/gravel", metal);
    let crown = rectangle(size - 5.0);
    site.blank_walls(dark, &crown, top..top + 4.0);
    for i in 0..13 {
        site.band(metal, &crown, top + 0.2 + 0.3 * i as f32..top + 0.28 + 0.3 * i as f32, 0.12, 0.0);
    }
    site.add(metal, crate::shape::Shape::flat(&crown).moved(Vec3::Z * (top + 3.6)));
    // Columns in front of the lobby, a canopy.
    let stone = site.surface("concrete/plain");
    for i in 0..7 {
        for y in [-1.0, 1.0] {
            let x = -size.x / 2.0 + 0.4 + (size.x - 0.8) * i as f32 / 6.0;
            site.block(stone, vec3(x, y * (size.y / 2.0 - 0.35), 2.25), vec3(0.6, 0.6, 4.5));
        }
    }
    site.canopy(metal, vec3(0.0, -size.y / 2.0 - 1.4, 3.6), vec3(9.0, 3.4, 0.2));
    site.asset("building/office-tower").tagged(["office", "tower"])
}

/// A shed with loading doors in front and a low gable.
pub(super) fn warehouse(surfaces: &[Surface]) -> Asset {
    let mut site = Site::new(surfaces);
    let size = vec2(45.0, 24.0);
    let outline = rectangle(size);
    let sheet = site.plain(Material::plain("sheet metal", vec3(0.34, 0.36, 0.37), 0.45));
    let trim = site.plain(Material::plain("trim", vec3(0.05, 0.1, 0.17), 0.4));
    site.walls(&outline, 0.0..5.0, &["ground-floor/loading", "facade/warehouse-metal"]);
    site.walls(&outline, 5.0..9.0, &["facade/warehouse-metal"]);
    site.band(trim, &outline, 8.75..9.05, 0.12, 0.0);
    let roof = site.plain(Material::plain("sheet roof", vec3(0.3, 0.31, 0.32), 0.5));
    roof_sheets(&mut site, roof, sheet, size, 9.0, 2.2);
    for i in [0.0, 1.0, 3.0, 4.0, 5.0, 7.0, 8.0, 9.0] {
        let x = -size.x / 2.0 + 4.5 * (i + 0.5);
        site.block(trim, vec3(x, -size.y / 2.0 - 0.7, 4.3), vec3(4.0, 1.4, 0.12));
    }
    for i in 0..4 {
        let x = -size.x * 0.36 + size.x * 0.24 * i as f32;
        let vent = crate::shape::Shape::cylinder(0.45, 1.0, 16);
        site.add(sheet, vent.moved(vec3(x, 0.0, 10.9)));
    }
    site.asset("building/warehouse").tagged(["warehouse"])
}

/// A low gabled roof of ribbed sheets with rooflights.
fn roof_sheets(site: &mut Site, roof: u16, gable: u16, size: glam::Vec2, z_m: f32, rise_m: f32) {
    site.pitched_roof("sheet roof", gable, size, z_m, rise_m, 0.0);
    let pitch = (rise_m / (size.y / 2.0)).atan();
    let length = (size.y / 2.0 + 0.4).hypot(rise_m) - 0.4;
    let light = site.plain(Material::plain("rooflight", vec3(0.5, 0.53, 0.52), 0.25));
    for side in [-1.0f32, 1.0] {
        let turn = glam::Quat::from_rotation_x(-pitch * side);
        let middle = vec3(0.0, side * size.y / 4.0, z_m + rise_m / 2.0);
        for i in 0..45 {
            let x = -size.x / 2.0 + 0.5 + i as f32;
            let slot = if i % 9 == 4 { light } else { roof };
            let wide = if i % 9 == 4 { 0.9 } else { 0.09 };
            let rib = crate::shape::Shape::block(vec3(wide, length, 0.08));
            site.add(slot, rib.turned(turn).moved(middle + vec3(x, 0.0, 0.02)));
        }
    }
}

/// Flats over shops on a corner, its top storey set back.
pub(super) fn corner(surfaces: &[Surface]) -> Asset {
    let mut site = Site::new(surfaces);
    let size = vec2(27.2, 20.4);
    let half = size / 2.0;
    // The corner is cut off.
    let outline = vec![-half, vec2(half.x - 3.4, -half.y), vec2(half.x, -half.y + 3.4), half, vec2(-half.x, half.y)];
    let metal = site.plain(Material::plain("fascia", vec3(0.1, 0.1, 0.105), 0.45));
    let slab = site.surface("concrete/plain");
    let top = 4.2 + 4.0 * 3.1;
    site.walls(&outline, 0.0..4.2, &["ground-floor/shops"]);
    site.walls(&outline, 4.2..top, &["facade/mixed-use"]);
    site.band(metal, &outline, 4.0..4.3, 0.3, 0.0);
    site.flat_roof(&outline, top, 0.9, "paving/slabs", metal);
    let back: Vec<_> = outline.iter().map(|p| *p * vec2(0.84, 0.8)).collect();
    site.walls(&back, top..top + 3.1, &["facade/mixed-use"]);
    site.band(metal, &back, top + 3.0..top + 3.3, 0.5, 0.0);
    site.flat_roof(&back, top + 3.1, 0.3, "flat-roof/gravel", metal);
    site.roof_plant(half * 0.7, top + 3.1);
    for storey in 0..4 {
        let floor = 4.2 + 3.1 * storey as f32 + 0.3;
        for bay in [0, 1, 4, 5] {
            let x = -half.x + 3.4 * bay as f32;
            let low = if bay % 4 < 2 { 0.3 } else { 1.2 };
            site.balcony([vec2(x + low, -half.y), vec2(x + low + 1.9, -half.y)], floor, 1.2, slab);
        }
    }
    site.asset("building/mixed-use-corner").tagged(["shops", "mixed"])
}

/// An office of the sixties: ribbons of windows, a canopy.
pub(super) fn ribbon(surfaces: &[Surface]) -> Asset {
    let mut site = Site::new(surfaces);
    let size = vec2(39.0, 15.0);
    let outline = rectangle(size);
    let concrete = site.surface("concrete/plain");
    let top = 4.5 + 6.0 * 3.6;
    site.walls(&outline, 0.0..4.5, &["ground-floor/lobby"]);
    site.walls(&outline, 4.5..top, &["facade/office-ribbon"]);
    site.band(concrete, &outline, 4.3..4.6, 0.35, 0.0);
    site.flat_roof(&outline, top, 1.0, "flat-roof/bitumen", concrete);
    site.roof_plant(size / 2.0, top);
    for i in 0..=13 {
        // Fins between every bay, on both long sides.
        let x = -size.x / 2.0 + 3.0 * i as f32;
        for y in [-1.0, 1.0] {
            site.block(concrete, vec3(x, y * (size.y / 2.0 + 0.15), (top + 4.5) / 2.0), vec3(0.3, 0.3, top - 4.5));
        }
    }
    site.canopy(concrete, vec3(-6.0, -size.y / 2.0 - 1.5, 3.4), vec3(6.0, 3.0, 0.25));
    site.asset("building/office-ribbon").tagged(["office", "ribbon"])
}

/// A hotel: deep frames, a drive-up canopy, a sign on the roof.
pub(super) fn hotel(surfaces: &[Surface]) -> Asset {
    let mut site = Site::new(surfaces);
    let size = vec2(36.3, 16.5);
    let outline = rectangle(size);
    let white = site.plain(Material::plain("painted wall", vec3(0.5, 0.49, 0.47), 0.85));
    let top = 4.5 + 9.0 * 3.2;
    site.walls(&outline, 0.0..4.5, &["ground-floor/lobby"]);
    site.walls(&outline, 4.5..top, &["facade/hotel-grid"]);
    site.flat_roof(&outline, top, 1.1, "flat-roof/gravel", white);
    site.roof_plant(size / 2.0, top);
    // Frames stand out between rooms and floors of the long sides.
    for y in [-1.0, 1.0] {
        for i in 0..=11 {
            let x = -size.x / 2.0 + 3.3 * i as f32;
            site.block(white, vec3(x, y * (size.y / 2.0 + 0.2), (top + 4.5) / 2.0), vec3(0.4, 0.4, top - 4.5));
        }
        for storey in 0..=9 {
            let z = 4.5 + 3.2 * storey as f32;
            site.block(white, vec3(0.0, y * (size.y / 2.0 + 0.2), z), vec3(size.x + 0.4, 0.4, 0.36));
        }
    }
    let dark = site.plain(Material::plain("canopy", Vec3::splat(0.06), 0.4));
    site.canopy(dark, vec3(0.0, -size.y / 2.0 - 2.6, 3.9), vec3(11.0, 4.6, 0.3));
    site.asset("building/hotel").tagged(["hotel"])
}
