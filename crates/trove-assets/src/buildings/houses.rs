//! Where people live and shop.

use glam::{Vec2, Vec3, vec2, vec3};
use trove_model::{Asset, Material, Surface};

use super::site::{Site, rectangle};

const BRICK: Vec3 = vec3(0.2, 0.115, 0.08);
const STONE: Vec3 = vec3(0.36, 0.34, 0.3);

fn chimney(site: &mut Site, brick: u16, foot: Vec3, height_m: f32) {
    let clay = site.plain(Material::plain("chimney pot", vec3(0.28, 0.12, 0.07), 0.8));
    site.block(brick, foot + Vec3::Z * height_m / 2.0, vec3(0.7, 1.1, height_m));
    site.block(brick, foot + Vec3::Z * (height_m + 0.05), vec3(0.82, 1.22, 0.12));
    for y in [-0.3, 0.3] {
        let pot = crate::shape::Shape::cylinder(0.11, 0.4, 12);
        site.add(clay, pot.moved(foot + vec3(0.0, y, height_m + 0.1)));
    }
}

/// Four brick houses under one pitched roof.
pub(super) fn row(surfaces: &[Surface]) -> Asset {
    let mut site = Site::new(surfaces);
    let size = vec2(23.2, 8.7);
    let outline = rectangle(size);
    let brick = site.plain(Material::plain("brick", BRICK, 0.9));
    let stone = site.plain(Material::plain("stone", STONE, 0.85));
    site.walls(&outline, 0.0..3.4, &["ground-floor/entrances"]);
    site.walls(&outline, 3.4..9.6, &["facade/brick-row"]);
    site.band(stone, &outline, 3.34..3.5, 0.06, 0.0);
    site.band(stone, &outline, 9.42..9.6, 0.14, 0.0);
    site.pitched_roof("roof-tiles/dark", brick, size, 9.6, 3.0, 0.0);
    for i in 0..5 {
        let x = -size.x / 2.0 + 0.4 + (size.x - 0.8) * i as f32 / 4.0;
        chimney(&mut site, brick, vec3(x, 0.0, 11.6), 2.2);
    }
    // Steps and a hood at every door, gutter and downpipes.
    let dark = site.plain(Material::plain("gutter", Vec3::splat(0.04), 0.5));
    for i in [0.0, 2.0, 4.0, 6.0] {
        let x = -size.x / 2.0 + 2.9 * (i + 0.5);
        site.block(stone, vec3(x, -size.y / 2.0 - 0.3, 0.08), vec3(1.4, 0.6, 0.16));
        site.block(stone, vec3(x, -size.y / 2.0 - 0.25, 2.98), vec3(1.5, 0.5, 0.1));
    }
    for y in [-1.0, 1.0] {
        site.block(dark, vec3(0.0, y * (size.y / 2.0 + 0.42), 9.32), vec3(size.x + 0.3, 0.12, 0.1));
        for x in [-0.25, 0.25] {
            site.block(dark, vec3(x * size.x, y * (size.y / 2.0 + 0.05), 4.7), vec3(0.09, 0.09, 9.3));
        }
    }
    site.asset("building/row-houses").tagged(["house", "row"])
}

/// A plastered house with a hipped roof and a porch.
pub(super) fn detached(surfaces: &[Surface]) -> Asset {
    let mut site = Site::new(surfaces);
    let size = vec2(12.0, 9.0);
    let outline = rectangle(size);
    let white = site.plain(Material::plain("white wood", Vec3::splat(0.58), 0.6));
    let brick = site.plain(Material::plain("brick", BRICK, 0.9));
    let stone = site.plain(Material::plain("stone", STONE, 0.85));
    site.blank_walls(stone, &rectangle(size + 0.06), 0.0..0.45);
    site.walls(&outline, 0.0..6.4, &["facade/plaster-shutters"]);
    site.band(white, &outline, 6.2..6.4, 0.12, 0.0);
    site.pitched_roof("roof-tiles/red", white, size, 6.4, 2.9, 4.2);
    chimney(&mut site, brick, vec3(2.2, 0.8, 7.6), 2.6);
    // The porch covers the bay with the door.
    let door = site.plain(Material::plain("front door", vec3(0.03, 0.08, 0.06), 0.4));
    let front = -size.y / 2.0;
    site.block(door, vec3(1.5, front - 0.03, 1.45), vec3(1.9, 0.08, 2.6));
    site.block(white, vec3(1.5, front - 0.02, 2.82), vec3(2.2, 0.1, 0.14));
    site.block(stone, vec3(1.5, front - 0.75, 0.1), vec3(3.0, 1.5, 0.2));
    site.block(white, vec3(1.5, front - 0.75, 3.0), vec3(3.2, 1.7, 0.18));
    for x in [0.2, 2.8] {
        site.block(white, vec3(x, front - 1.4, 1.55), vec3(0.18, 0.18, 2.75));
    }
    site.asset("building/detached-house").tagged(["house", "detached"])
}

/// Five storeys of brick with balconies and a parapet.
pub(super) fn apartments(surfaces: &[Surface]) -> Asset {
    let mut site = Site::new(surfaces);
    let size = vec2(34.8, 14.5);
    let outline = rectangle(size);
    let stone = site.plain(Material::plain("stone", STONE, 0.85));
    let slab = site.surface("concrete/plain");
    site.walls(&outline, 0.0..3.4, &["ground-floor/entrances"]);
    site.walls(&outline, 3.4..15.8, &["facade/brick-row"]);
    site.band(stone, &outline, 3.3..3.5, 0.08, 0.0);
    site.band(stone, &outline, 15.5..15.8, 0.22, 0.0);
    site.flat_roof(&outline, 15.8, 0.8, "flat-roof/bitumen", stone);
    site.roof_plant(size / 2.0, 15.8);
    for storey in 1..5 {
        let floor = 0.3 + 3.1 * storey as f32;
        for bay in [1, 4, 7, 10] {
            let x = -size.x / 2.0 + 2.9 * bay as f32;
            let wall = [vec2(x + 0.2, -size.y / 2.0), vec2(x + 2.7, -size.y / 2.0)];
            site.balcony(wall, floor + 0.55, 1.3, slab);
            site.balcony(wall.map(|p| -p), floor + 0.55, 1.3, slab);
        }
    }
    let dark = site.plain(Material::plain("canopy", Vec3::splat(0.06), 0.4));
    site.canopy(dark, vec3(0.0, -size.y / 2.0 - 0.9, 2.85), vec3(4.0, 1.8, 0.14));
    site.asset("building/brick-apartments").tagged(["apartments", "brick"])
}

/// A two-storey row of shops with a cornice and a parapet.
pub(super) fn shops(surfaces: &[Surface]) -> Asset {
    let mut site = Site::new(surfaces);
    let size = vec2(24.0, 13.5);
    let outline = rectangle(size);
    let stone = site.plain(Material::plain("stone", STONE, 0.85));
    site.walls(&outline, 0.0..4.2, &["ground-floor/shops"]);
    site.walls(&outline, 4.2..7.8, &["facade/victorian"]);
    site.band(stone, &outline, 4.05..4.3, 0.2, 0.0);
    site.band(stone, &outline, 7.6..7.8, 0.25, 0.0);
    site.band(stone, &outline, 7.8..7.95, 0.35, 0.0);
    site.flat_roof(&outline, 7.9, 0.9, "flat-roof/gravel", stone);
    site.roof_plant(size / 2.0, 7.9);
    // Awnings of cloth over two of the shops.
    let colors = [vec3(0.3, 0.05, 0.04), vec3(0.04, 0.13, 0.09), vec3(0.5, 0.47, 0.4)];
    for (i, bay) in [0, 2, 5].into_iter().enumerate() {
        let name = format!("awning {i}");
        let cloth = site.plain(Material { translucency: 0.2, ..Material::plain(&name, colors[i], 0.9) });
        let x = -size.x / 2.0 + 4.0 * bay as f32;
        site.add(cloth, awning(vec2(x + 0.2, x + 3.8), -size.y / 2.0));
    }
    site.asset("building/shops").tagged(["shops"])
}

/// Cloth that slopes from the wall, with a hem.
fn awning(x: Vec2, wall_y: f32) -> crate::shape::Shape {
    let row = |out: f32, z: f32| vec![vec3(x.x, wall_y - out, z), vec3(x.y, wall_y - out, z)];
    crate::shape::Shape::sheet(&[row(1.45, 2.35), row(1.45, 2.6), row(0.05, 3.05)])
}
