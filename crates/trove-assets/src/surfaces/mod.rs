//! Textures that tile, for everything that is built in place.

mod canvas;
mod cloth;
mod facade;
mod facade_plan;
mod ground;
mod inside;
mod masonry;
mod metal;
mod noise;
mod opening;
mod paving;
mod recipe;
mod road;
mod roof;
mod synthetic;
#[cfg(test)]
mod tests;
mod things;
mod timber;
mod wall;

use std::sync::Arc;

use glam::{vec2, vec3};
use rayon::prelude::*;
use trove_model::{Surface, SurfaceKind, Tags};

pub(crate) use canvas::{Canvas, Texel};
pub(crate) use facade_plan::FacadePlan;
pub(crate) use noise::{Noise, hash, step};
pub(crate) use things::{refine, set};

use recipe::{NEW, Paint, Recipe, WORN, finished, plain, surface};
use road::{Cover, Wear};
use wall::Finish;

/// Every surface, in no particular order, with the facades of these plans; `detail` multiplies the resolution of all
/// but facades.
pub(crate) fn surfaces(plans: &[FacadePlan], detail: u32) -> Vec<Surface> {
    let recipes: Vec<Recipe> = ground_recipes().into_iter().chain(building_recipes()).collect();
    let mut surfaces: Vec<Surface> = recipes.par_iter().map(|recipe| surface(recipe, detail)).collect();
    surfaces.extend(facades(plans));
    surfaces.extend(things::surfaces(detail));
    surfaces
}

/// The facades of these plans.
pub(crate) fn facades(plans: &[FacadePlan]) -> Vec<Surface> {
    let painted = |plan: &FacadePlan| {
        let style = plan.style();
        let canvas = style.paint(plan.seed);
        // Near facades are cut, so that their gloss and relief is seen from afar only.
        let material = canvas.material(&plan.id, 4);
        let surface = finished(&plan.id, plan.kind.into(), &canvas, material, style.grid.cells);
        Surface { tags: Tags::new(&plan.tags), design: Some(Arc::new(style.rules())), ..surface }
    };
    plans.par_iter().map(painted).collect()
}

/// Roads, paths and land.
fn ground_recipes() -> Vec<Recipe> {
    use SurfaceKind::*;
    let walk = Wear { binder: 0.11, stone: 0.17, stone_m: 0.009, worn: 0.4, cracks: 0.3, size_m: 3.0, seed: 3 };
    let pale = Wear { binder: 0.13, stone: 0.21, worn: 0.75, cracks: 0.35, size_m: 3.0, seed: 4, ..WORN };
    let green = vec3(0.092, 0.138, 0.04);
    let straw = vec3(0.2, 0.165, 0.075);
    vec![
        plain("asphalt/new", Asphalt, &["new"], |d| road::asphalt(NEW, d)),
        plain("asphalt/worn", Asphalt, &["worn"], |d| road::asphalt(WORN, d)),
        plain("asphalt/worn-pale", Asphalt, &["worn", "pale"], move |d| road::asphalt(pale, d)),
        plain("marking/white", MarkingWhite, &["white"], |d| road::marking(vec3(0.74, 0.74, 0.71), 11, d)),
        plain("marking/yellow", MarkingYellow, &["yellow"], |d| road::marking(vec3(0.62, 0.36, 0.04), 12, d)),
        plain("cover/round", RoadCover, &["round"], |d| road::cover(Cover::Round, [0.68, 0.68], 13, d)),
        plain("cover/square", RoadCover, &["square"], |d| road::cover(Cover::Square, [0.9, 0.6], 14, d)),
        plain("cover/grating", RoadCover, &["grating"], |d| road::cover(Cover::Grating, [0.5, 0.4], 15, d)),
        plain("paving/slabs", Paving, &["slabs"], |d| paving::slabs(vec3(0.26, 0.248, 0.226), vec2(0.6, 0.6), 21, d)),
        plain("paving/bricks", Paving, &["bricks"], |d| paving::bricks(vec3(0.24, 0.13, 0.095), 22, d)),
        plain("paving/herringbone", Paving, &["herringbone"], |d| paving::herringbone(vec3(0.25, 0.19, 0.155), 23, d)),
        plain("paving/concrete", Paving, &["concrete"], |d| paving::flags(vec3(0.27, 0.258, 0.235), 24, d)),
        plain("paving/setts", Paving, &["setts"], |d| road::setts(vec3(0.2, 0.195, 0.19), 25, d)),
        plain("paving/mosaic", Paving, &["mosaic"], |d| road::mosaic(vec3(0.21, 0.205, 0.2), 26, d)),
        plain("paving/asphalt-walk", Paving, &["asphalt", "asphalt-walk"], move |d| road::asphalt(walk, d)),
        plain("paving/earth", Paving, &["earth"], |d| ground::trodden(vec3(0.25, 0.19, 0.135), 27, d)),
        plain("kerb/concrete", Kerb, &["concrete"], |d| paving::kerb(vec3(0.3, 0.29, 0.27), false, 31, d)),
        plain("kerb/granite", Kerb, &["granite"], |d| paving::kerb(vec3(0.25, 0.245, 0.24), false, 34, d)),
        plain("kerb/black-white", Kerb, &["black-white"], |d| paving::kerb(vec3(0.3, 0.29, 0.27), true, 32, d)),
        plain("concrete/plain", Concrete, &["plain"], |d| {
            paving::concrete(vec3(0.31, 0.3, 0.28), [4.0, 4.0], 0.0, 33, d)
        }),
        plain("grass/lawn", Grass, &["lawn"], move |d| ground::grass(green, straw, 0.12, 41, d)),
        plain("grass/worn", Grass, &["worn"], move |d| ground::grass(vec3(0.084, 0.136, 0.04), straw, 0.42, 42, d)),
        plain("soil/earth", Soil, &["earth"], |d| ground::soil(43, d)),
        plain("gravel/grey", Gravel, &["grey"], |d| ground::gravel(vec3(0.3, 0.29, 0.27), 0.05, 44, d)),
        plain("water/still", Water, &["still"], ground::water),
        plain("flat-roof/bitumen", FlatRoof, &["bitumen"], |d| roof::bitumen(51, d)),
        plain("flat-roof/gravel", FlatRoof, &["gravel"], |d| ground::gravel(vec3(0.36, 0.34, 0.31), 0.04, 52, d)),
        plain("flat-roof/membrane", FlatRoof, &["membrane"], |d| roof::membrane(vec3(0.5, 0.5, 0.48), 55, d)),
        plain("flat-roof/green", FlatRoof, &["green"], |d| roof::stonecrop(56, d)),
        plain("roof-tiles/slate", RoofTiles, &["slate"], |d| roof::slates(vec3(0.085, 0.09, 0.1), false, 57, d)),
        plain("roof-tiles/shingle", RoofTiles, &["shingle"], |d| roof::slates(vec3(0.115, 0.1, 0.088), true, 58, d)),
        plain("roof-tiles/metal", RoofTiles, &["metal"], |d| roof::seams(vec3(0.3, 0.31, 0.32), 0.2, 59, d)),
        plain("roof-tiles/copper", RoofTiles, &["copper"], |d| roof::seams(vec3(0.13, 0.27, 0.21), 1.0, 60, d)),
        plain("roof-tiles/red", RoofTiles, &["red"], |d| roof::tiles(vec3(0.27, 0.105, 0.06), 53, d)),
        plain("roof-tiles/dark", RoofTiles, &["dark"], |d| roof::tiles(vec3(0.085, 0.08, 0.08), 54, d)),
    ]
}

/// Walls of buildings, and what is seen in them.
fn building_recipes() -> Vec<Recipe> {
    use SurfaceKind::{RoomBack, ShopSign, Wall};
    let mut recipes: Vec<Recipe> = vec![
        ("sign/shops", ShopSign, &[], Paint::Cells(inside::SIGNS, inside::signs, 131)),
        ("room/backs", RoomBack, &[], Paint::Cells(inside::ROOMS, inside::rooms, 132)),
    ];
    recipes.extend(
        Finish::ALL.iter().map(|&finish| plain(finish.id(), Wall, finish.tags(), move |d| finish.bare(141, d))),
    );
    recipes
}
