//! Buildings whose shapes plans do not tell.

use glam::{vec2, vec3};
use trove_model::{Asset, Material, Surface};

use super::repeat::repeat;
use super::roof::Pitched;
use super::site::{Site, rectangle};

/// A shed with loading doors in front and a low gable.
pub(super) fn warehouse(surfaces: &[Surface]) -> Asset {
    let mut site = Site::new(surfaces);
    let size = vec2(45.0, 24.0);
    let half = size / 2.0;
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
    let mut asset = site.asset("building/warehouse").tagged(["warehouse"]);
    asset.repeats[0] = repeat(&asset.mesh, 0, 9.0, [-half.x, half.x], -half.x);
    asset
}

/// A low gabled roof of ribbed sheets with rooflights.
fn roof_sheets(site: &mut Site, roof: u16, gable: u16, size: glam::Vec2, z_m: f32, rise_m: f32) {
    let sheets = site.surface("sheet roof");
    let middle = glam::Vec3::Z * z_m;
    site.pitched_roof(&Pitched { slots: [sheets, gable], middle, size, rise_m, hip_m: 0.0, across: false });
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
    let (paving, gravel) = (site.surface("paving/slabs"), site.surface("flat-roof/gravel"));
    site.flat_roof(&outline, top, 0.9, paving, metal);
    let back: Vec<_> = outline.iter().map(|p| *p * vec2(0.84, 0.8)).collect();
    site.walls(&back, top..top + 3.1, &["facade/mixed-use"]);
    site.band(metal, &back, top + 3.0..top + 3.3, 0.5, 0.0);
    site.flat_roof(&back, top + 3.1, 0.3, gravel, metal);
    site.roof_plant(half * 0.7, top + 3.1);
    for storey in 0..4 {
        let floor = 4.2 + 3.1 * storey as f32 + 0.3;
        for bay in [0, 1, 4, 5] {
            let x = -half.x + 3.4 * bay as f32;
            let low = if bay % 4 < 2 { 0.3 } else { 1.2 };
            site.balcony([vec2(x + low, -half.y), vec2(x + low + 1.9, -half.y)], floor, 1.2, slab);
        }
    }
    let mut asset = site.asset("building/mixed-use-corner").tagged(["shops", "mixed"]);
    asset.repeats[0] = repeat(&asset.mesh, 0, 3.4, [-half.x, half.x], -half.x);
    asset.repeats[2] = repeat(&asset.mesh, 2, 3.1, [4.2, top], 4.2);
    asset
}
