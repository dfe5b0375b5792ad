//! What things are made of, for every family of models: each set is painted once.

use std::collections::BTreeMap;
use std::sync::{LazyLock, OnceLock};

use glam::{Vec3, vec3};
use trove_model::{Asset, Mapping, Material, Surface, SurfaceKind, Texture};

use super::canvas::Canvas;
use super::masonry::Bond;
use super::recipe::{NEW, Recipe, WORN, plain, surface};
use super::road::Wear;
use super::{cloth, ground, masonry, metal, paving, road, synthetic, timber};

/// A set and, once it was asked for, its surface at the ordinary resolution.
type Kept = (Recipe, OnceLock<Surface>);

static THINGS: LazyLock<BTreeMap<&'static str, Kept>> =
    LazyLock::new(|| recipes().into_iter().map(|recipe| (recipe.0, (recipe, OnceLock::new()))).collect());

/// The material of a set, laid triplanar in metres; shapes with uvs in metres set the mapping back to theirs. Sets that
/// are said to be white are coloured by the material's base colour. Panics where there is no such set.
pub(crate) fn set(id: &str) -> Material {
    let kept = THINGS.get(id).unwrap_or_else(|| panic!("no set of textures is called {id}"));
    Material { mapping: Mapping::Triplanar, ..painted(kept).material }
}

fn painted((recipe, kept): &Kept) -> Surface {
    kept.get_or_init(|| surface(recipe, 1)).clone()
}

/// Every set as a surface.
pub(super) fn surfaces(detail: u32) -> Vec<Surface> {
    use rayon::prelude::*;
    let kept: Vec<&Kept> = THINGS.values().collect();
    kept.par_iter().map(|kept| if detail == 1 { painted(kept) } else { surface(&kept.0, detail) }).collect()
}

/// Gives assets that wear a set its images in these surfaces.
pub(crate) fn refine(assets: &mut [Asset], surfaces: &[Surface]) {
    let things = surfaces.iter().filter(|s| s.kind == SurfaceKind::Thing);
    let images: BTreeMap<&str, &std::sync::Arc<Texture>> =
        things.flat_map(|s| s.material.textures()).map(|image| (image.name.as_str(), image)).collect();
    for material in assets.iter_mut().flat_map(|asset| &mut asset.slots).map(|slot| &mut slot.material) {
        let maps =
            [&mut material.base_color_map, &mut material.orm_map, &mut material.normal_map, &mut material.height_map];
        for map in maps.into_iter().flatten() {
            if let Some(&fine) = images.get(map.name.as_str()) {
                *map = fine.clone();
            }
        }
    }
}

#[rustfmt::skip]
fn recipes() -> Vec<Recipe> {
    let thing = |id, tags, paint: fn(u32) -> Canvas| plain(id, SurfaceKind::Thing, tags, paint);
    vec![
        thing("metal/galvanised", &["metal", "galvanised"], metal::galvanised),
        thing("metal/brushed", &["metal", "brushed"], metal::brushed),
        thing("metal/cast", &["metal", "cast"], metal::cast),
        thing("metal/rusted", &["metal", "rusted"], metal::rusted),
        // White.
        thing("metal/painted", &["metal", "painted"], metal::painted),
        thing("metal/diamond-plate", &["metal", "diamond-plate"], metal::diamond_plate),
        thing("metal/corrugated-rusty", &["metal", "corrugated-rusty"], metal::corrugated),
        // White.
        thing("paint/lacquer", &["paint", "lacquer"], synthetic::lacquer),
        // White.
        thing("plastic/scuffed", &["plastic", "scuffed"], synthetic::plastic),
        // White.
        thing("sheeting/reflective", &["sheeting", "reflective"], synthetic::sheeting),
        thing("rubber/worn", &["rubber", "worn"], synthetic::rubber),
        thing("glass/pane", &["glass", "pane"], synthetic::glass),
        // White.
        thing("fabric/woven", &["fabric", "woven"], cloth::woven),
        // White.
        thing("fabric/tarpaulin", &["fabric", "tarpaulin"], cloth::tarpaulin),
        thing("fabric/denim", &["fabric", "denim"], cloth::denim),
        // White.
        thing("leather/grained", &["leather", "grained"], cloth::leather),
        thing("paper/cardboard", &["paper", "cardboard"], cloth::cardboard),
        thing("wood/oiled", &["wood", "oiled"], |d| timber::boards(0.6, [1.2, 0.6], vec3(0.3, 0.165, 0.075), 0.12, 301, d)),
        thing("wood/weathered", &["wood", "weathered"], |d| timber::boards(0.6, [1.2, 0.6], vec3(0.25, 0.17, 0.1), 0.75, 302, d)),
        thing("wood/planks", &["wood", "planks"], |d| timber::boards(0.12, [2.4, 1.2], vec3(0.27, 0.17, 0.095), 0.4, 303, d)),
        thing("wood/plywood", &["wood", "plywood"], timber::plywood),
        thing("wood/bark", &["wood", "bark"], timber::bark),
        thing("concrete/cast", &["concrete", "cast"], |d| paving::concrete(vec3(0.33, 0.32, 0.295), [2.0, 2.0], 0.0, 35, d)),
        thing("concrete/board-marked", &["concrete", "board-marked"], |d| paving::board_marked(vec3(0.32, 0.31, 0.29), 36, d)),
        thing("concrete/weathered", &["concrete", "weathered"], |d| paving::weathered(vec3(0.33, 0.32, 0.3), 37, d)),
        thing("brick/flemish", &["brick", "flemish"], |d| masonry::bricks(Bond::Flemish, RED, LIME, 311, d)),
        thing("brick/stock", &["brick", "stock"], |d| masonry::bricks(Bond::English, STOCK, LIME, 312, d)),
        thing("brick/clinker", &["brick", "clinker"], |d| masonry::bricks(Bond::Running, CLINKER, CEMENT, 313, d)),
        thing("brick/white", &["brick", "white"], |d| masonry::bricks(Bond::Stack, [Vec3::splat(0.5); 3], LIME, 314, d)),
        thing("stone/ashlar", &["stone", "ashlar"], |d| masonry::ashlar(vec3(0.4, 0.35, 0.27), 321, d)),
        thing("stone/rubble", &["stone", "rubble"], |d| masonry::rubble(vec3(0.24, 0.22, 0.19), 322, d)),
        thing("stone/granite", &["stone", "granite"], masonry::granite),
        thing("tile/glazed", &["tile", "glazed"], |d| masonry::tiles(vec3(0.55, 0.57, 0.55), 0.1, true, 331, d)),
        thing("tile/quarry", &["tile", "quarry"], |d| masonry::tiles(vec3(0.27, 0.12, 0.075), 0.15, false, 332, d)),
        thing("asphalt/patched", &["asphalt", "patched"], |d| road::patched(WORN, NEW, d)),
        thing("asphalt/wet", &["asphalt", "wet"], |d| road::asphalt(Wear { size_m: 3.0, ..WORN }, d)),
        thing("soil/earth-dry", &["soil", "earth-dry"], |d| ground::soil(343, d)),
        thing("soil/mud", &["soil", "mud"], |d| ground::mud(341, d)),
        thing("soil/sand", &["soil", "sand"], |d| ground::sand(342, d)),
    ]
}

const RED: [Vec3; 3] = [vec3(0.24, 0.095, 0.058), vec3(0.17, 0.07, 0.05), vec3(0.08, 0.05, 0.045)];
const STOCK: [Vec3; 3] = [vec3(0.33, 0.26, 0.15), vec3(0.27, 0.19, 0.11), vec3(0.13, 0.1, 0.075)];
const CLINKER: [Vec3; 3] = [vec3(0.1, 0.055, 0.045), vec3(0.07, 0.052, 0.055), vec3(0.13, 0.075, 0.05)];
const LIME: Vec3 = vec3(0.37, 0.345, 0.3);
const CEMENT: Vec3 = vec3(0.2, 0.195, 0.185);
