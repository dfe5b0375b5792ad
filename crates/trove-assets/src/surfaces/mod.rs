//! Textures that tile, for everything that is built in place.

mod canvas;
mod facade;
mod ground;
mod ground_floor;
mod noise;
mod opening;
mod paving;
mod road;
mod roof;
#[cfg(test)]
mod tests;
mod wall;

use glam::{Vec3, vec2, vec3};
use rayon::prelude::*;
use trove_model::{Surface, SurfaceKind, Tiling};

pub(crate) use canvas::{Canvas, Texel};
pub(crate) use noise::{Noise, hash, step};
pub(crate) use paving::concrete;

use facade::Facade;
use road::{Cover, Wear};

/// How a surface is painted.
enum Paint {
    Plain(Box<dyn Fn() -> Canvas + Send + Sync>),
    Storeys(Box<dyn Fn() -> Facade + Send + Sync>),
}

type Recipe = (&'static str, SurfaceKind, Paint);

fn plain(id: &'static str, kind: SurfaceKind, paint: impl Fn() -> Canvas + Send + Sync + 'static) -> Recipe {
    (id, kind, Paint::Plain(Box::new(paint)))
}

fn storeys(id: &'static str, kind: SurfaceKind, paint: impl Fn() -> Facade + Send + Sync + 'static) -> Recipe {
    (id, kind, Paint::Storeys(Box::new(paint)))
}

/// Every surface, in no particular order.
pub(crate) fn surfaces() -> Vec<Surface> {
    ground_recipes().into_iter().chain(building_recipes()).collect::<Vec<_>>().par_iter().map(surface).collect()
}

fn surface((id, kind, paint): &Recipe) -> Surface {
    let (canvas, cells) = match paint {
        Paint::Plain(paint) => (paint(), [1, 1]),
        Paint::Storeys(paint) => {
            let (canvas, grid) = paint();
            (canvas, grid.cells)
        }
    };
    let mut material = canvas.material(id, 2);
    material.dirt = dirt(*kind);
    // What has no joints, windows or patches that would be cut.
    if ["asphalt/new", "asphalt/worn", "paving/asphalt-walk", "paving/mosaic", "concrete/", "grass/", "soil/", "gravel/", "flat-roof/gravel"]
        .iter()
        .any(|name| id.starts_with(name))
    {
        material.tiling = Tiling::Stochastic;
    }
    if matches!(kind, SurfaceKind::MarkingWhite | SurfaceKind::MarkingYellow) {
        material.alpha_cutoff = 0.5;
    }
    if *kind == SurfaceKind::Water {
        material.ior = 1.33;
    }
    Surface { id: (*id).into(), kind: *kind, material, size_m: canvas.size_m.to_array(), cells }
}

/// How much of what weather and wheels bring stays on a surface.
fn dirt(kind: SurfaceKind) -> f32 {
    match kind {
        SurfaceKind::Asphalt | SurfaceKind::MarkingWhite | SurfaceKind::MarkingYellow | SurfaceKind::RoadCover => 0.7,
        SurfaceKind::Paving | SurfaceKind::Kerb | SurfaceKind::Concrete | SurfaceKind::FlatRoof => 0.6,
        SurfaceKind::Facade | SurfaceKind::FacadeGroundFloor => 0.5,
        SurfaceKind::Grass | SurfaceKind::Soil | SurfaceKind::Gravel | SurfaceKind::RoofTiles => 0.4,
        SurfaceKind::Water => 0.0,
    }
}

/// Roads, paths and land.
fn ground_recipes() -> Vec<Recipe> {
    use SurfaceKind::*;
    // Asphalt that has greyed over the years reflects 15 to 20 %, after its first year about 11 %.
    let worn = Wear { binder: 0.185, stone: 0.28, stone_m: 0.014, worn: 0.6, cracks: 0.2, seed: 2 };
    let new = Wear { binder: 0.095, stone: 0.16, worn: 0.2, cracks: 0.0, seed: 1, ..worn };
    let walk = Wear { binder: 0.15, stone: 0.22, stone_m: 0.009, worn: 0.4, cracks: 0.3, seed: 3 };
    let green = vec3(0.075, 0.115, 0.028);
    let straw = vec3(0.2, 0.165, 0.075);
    vec![
        plain("asphalt/new", Asphalt, move || road::asphalt(new)),
        plain("asphalt/worn", Asphalt, move || road::asphalt(worn)),
        plain("marking/white", MarkingWhite, || road::marking(vec3(0.74, 0.74, 0.71), 11)),
        plain("marking/yellow", MarkingYellow, || road::marking(vec3(0.62, 0.36, 0.04), 12)),
        plain("cover/round", RoadCover, || road::cover(Cover::Round, [0.68, 0.68], 13)),
        plain("cover/square", RoadCover, || road::cover(Cover::Square, [0.9, 0.6], 14)),
        plain("cover/grating", RoadCover, || road::cover(Cover::Grating, [0.5, 0.4], 15)),
        plain("paving/slabs", Paving, || paving::slabs(vec3(0.31, 0.3, 0.28), vec2(0.6, 0.6), 21)),
        plain("paving/bricks", Paving, || paving::bricks(vec3(0.24, 0.13, 0.095), 22)),
        plain("paving/herringbone", Paving, || paving::herringbone(vec3(0.25, 0.19, 0.155), 23)),
        plain("paving/concrete", Paving, || paving::flags(vec3(0.33, 0.32, 0.295), 24)),
        plain("paving/setts", Paving, || road::setts(vec3(0.2, 0.195, 0.19), 25)),
        plain("paving/mosaic", Paving, || road::mosaic(vec3(0.21, 0.205, 0.2), 26)),
        plain("paving/asphalt-walk", Paving, move || road::asphalt(walk)),
        plain("kerb/concrete", Kerb, || paving::kerb(vec3(0.3, 0.29, 0.27), false, 31)),
        plain("kerb/granite", Kerb, || paving::kerb(vec3(0.25, 0.245, 0.24), false, 34)),
        plain("kerb/black-white", Kerb, || paving::kerb(vec3(0.3, 0.29, 0.27), true, 32)),
        plain("concrete/plain", Concrete, || paving::concrete(vec3(0.31, 0.3, 0.28), [4.0, 4.0], 0.0, 33)),
        plain("grass/lawn", Grass, move || ground::grass(green, straw, 0.12, 41)),
        plain("grass/worn", Grass, move || ground::grass(vec3(0.098, 0.117, 0.044), straw, 0.42, 42)),
        plain("soil/earth", Soil, || ground::soil(43)),
        plain("gravel/grey", Gravel, || ground::gravel(vec3(0.3, 0.29, 0.27), 0.05, 44)),
        plain("water/still", Water, ground::water),
        plain("flat-roof/bitumen", FlatRoof, || roof::bitumen(51)),
        plain("flat-roof/gravel", FlatRoof, || ground::gravel(vec3(0.36, 0.34, 0.31), 0.04, 52)),
        plain("roof-tiles/red", RoofTiles, || roof::tiles(vec3(0.27, 0.105, 0.06), 53)),
        plain("roof-tiles/dark", RoofTiles, || roof::tiles(vec3(0.085, 0.08, 0.08), 54)),
    ]
}

/// Upper storeys and ground floors.
fn building_recipes() -> Vec<Recipe> {
    use SurfaceKind::{Facade, FacadeGroundFloor};
    let brown = vec3(0.22, 0.125, 0.085);
    let blue = || facade::curtain_wall(vec3(0.55, 0.8, 1.0), vec3(0.06, 0.085, 0.11), Vec3::splat(0.24), 105);
    let green = || facade::curtain_wall(vec3(0.76, 0.88, 0.84), vec3(0.08, 0.092, 0.088), Vec3::splat(0.1), 106);
    let cream = || facade::plaster_shutters(vec3(0.5, 0.42, 0.29), vec3(0.05, 0.1, 0.075), 103);
    vec![
        storeys("facade/brick-row", Facade, move || facade::brick_row(brown, 101)),
        storeys("facade/brick-mill", Facade, || facade::brick_mill(102)),
        storeys("facade/plaster-shutters", Facade, cream),
        storeys("facade/victorian", Facade, || facade::victorian(104)),
        storeys("facade/glass-blue", Facade, blue),
        storeys("facade/glass-green", Facade, green),
        storeys("facade/office-ribbon", Facade, || facade::ribbon(107)),
        storeys("facade/slab-block", Facade, || facade::slab_block(vec3(0.2, 0.3, 0.36), 108)),
        storeys("facade/hotel-grid", Facade, || facade::hotel(vec3(0.5, 0.49, 0.47), 109)),
        storeys("facade/warehouse-metal", Facade, || facade::warehouse(vec3(0.36, 0.38, 0.39), 110)),
        storeys("facade/mixed-use", Facade, || facade::mixed_use(111)),
        storeys("facade/white-panel", Facade, || facade::panel(vec3(0.6, 0.6, 0.59), 0.45, 112)),
        storeys("facade/metal-panel", Facade, || facade::panel(vec3(0.22, 0.235, 0.26), 0.4, 113)),
        storeys("ground-floor/shops", FacadeGroundFloor, || ground_floor::shops(121)),
        storeys("ground-floor/entrances", FacadeGroundFloor, move || ground_floor::entrances(brown, 122)),
        storeys("ground-floor/loading", FacadeGroundFloor, || ground_floor::loading(123)),
        storeys("ground-floor/arcade", FacadeGroundFloor, || ground_floor::arcade(124)),
        storeys("ground-floor/lobby", FacadeGroundFloor, || ground_floor::lobby(125)),
    ]
}
