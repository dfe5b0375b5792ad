//! What a building wears: facade, ground floor, roof.

use std::sync::Arc;

use glam::{Vec3, vec3};
use trove_model::{
    Building, BuildingCustoms, BuildingKind, FacadeDesign, FacadeRule, FacadeUse, Mapping, Material, Mesh, Random,
    Role, Surface, SurfaceKind, Tags, WallMaterial,
};

use super::volumes::House;
use super::wall::Grid;
use crate::pieces::{ANY, Palette, tinted};

/// From this height on a building is a tower.
const TOWER_M: f64 = 45.0;
/// Up to this height an ordinary building is an old one.
const LOW_M: f64 = 16.0;
/// From this year on nobody puts up ornaments.
const PLAIN_FROM: i32 = 1925;

/// Some storeys.
pub(super) struct Storeys {
    pub grid: Grid,
    pub design: Option<Arc<FacadeDesign>>,
}

impl Storeys {
    fn of(surface: &Surface) -> Self {
        Self { grid: Grid::of(surface), design: surface.design.clone() }
    }
}

/// Materials in the order of [`super::shell::Slot`], and how facades are divided.
pub(super) struct Dress {
    pub materials: Vec<Material>,
    pub upper: Storeys,
    /// `None` where it looks like every other storey.
    pub ground_floor: Option<Storeys>,
}

impl Dress {
    /// The materials that a mesh uses; its slots are numbered anew.
    pub(super) fn for_mesh(self, mesh: &mut Mesh) -> Vec<Material> {
        let mut numbers: Vec<Option<u16>> = vec![None; self.materials.len()];
        let mut used = Vec::new();
        for slot in &mut mesh.slots {
            let from = usize::from(*slot);
            *slot = *numbers[from].get_or_insert_with(|| {
                used.push(self.materials[from].clone());
                used.len() as u16 - 1
            });
        }
        used
    }
}

/// Draws what a building wears by its tags, its kind, its height and its country.
pub(super) fn dress(house: &House<'_>, height_m: f64, palette: &Palette<'_>, random: &mut Random) -> Dress {
    let building = house.building;
    // A garage is a ground floor and nothing else.
    let facade = if matches!(building.kind, Some(BuildingKind::Garage | BuildingKind::Carport)) {
        palette.fitting(SurfaceKind::FacadeGroundFloor, &["garage"], random)
    } else {
        palette.fitting(SurfaceKind::Facade, &facade_tags(house, height_m, random), random)
    };
    let tags = ground_floor_tags(house, height_m, &facade.tags, random);
    let ground_floor = tags.map(|tags| palette.fitting(SurfaceKind::FacadeGroundFloor, tags, random));
    let paints = facade.design.as_ref().map_or(&[][..], |d| &d.paints);
    let paint = random.pick(paints).copied().unwrap_or(Vec3::ONE) * shade(random);
    let paint = building.color.map_or(paint, |color| tinted(Vec3::ONE, color));
    let mut flat = facade.material.clone();
    flat.base_color *= paint;
    let mut flat_ground = ground_floor.as_ref().map_or(&facade, |g| g).material.clone();
    // A ground floor of the same make is painted like what stands on it.
    let alike = |g: &Surface| g.design.as_ref().map(|d| &d.wall) == facade.design.as_ref().map(|d| &d.wall);
    let ground_paint = if ground_floor.as_ref().is_none_or(alike) { paint } else { shade(random) };
    flat_ground.base_color *= ground_paint;
    let trim = palette.fitting(SurfaceKind::Concrete, ANY, random).material;
    let mut roof = super::roof::materials(building, house.customs, &facade.tags, flat.base_color, palette, random);
    let bare = |surface: &Surface, paint: Vec3, random: &mut Random| {
        let design = surface.design.as_ref()?;
        let mut wall = palette.fitting(SurfaceKind::Wall, &[design.wall.as_str()], random).material;
        wall.base_color *= design.wall_tint * paint;
        Some(wall)
    };
    let wall = bare(&facade, paint, random);
    if let (Some(wall), Some(gable)) = (&wall, roof.get_mut(2)) {
        *gable = wall.clone();
    }
    let wall = wall.unwrap_or_else(|| flat.clone());
    let ground_wall = ground_floor.as_ref().and_then(|g| bare(g, ground_paint, random)).unwrap_or_else(|| wall.clone());
    let (upper, ground) = (Storeys::of(&facade), ground_floor.as_ref().map(Storeys::of));
    let fittings = fittings(&upper, ground.as_ref(), paint, palette, random);
    let walls = vec![wall, ground_wall];
    Dress { materials: [vec![flat, flat_ground, trim], roof, walls, fittings].concat(), upper, ground_floor: ground }
}

/// Materials from [`super::shell::Slot::Stone`] on.
fn fittings(
    upper: &Storeys,
    ground: Option<&Storeys>,
    paint: Vec3,
    palette: &Palette<'_>,
    random: &mut Random,
) -> Vec<Material> {
    let design = upper.design.as_deref().cloned().unwrap_or_default();
    let shop = ground.and_then(|g| g.design.as_deref()).unwrap_or(&design);
    let mut pick = |colors: &[Vec3]| random.pick(colors).copied().unwrap_or(Vec3::splat(0.4));
    let doors = [
        vec3(0.02, 0.05, 0.12),
        vec3(0.2, 0.02, 0.02),
        vec3(0.02, 0.08, 0.04),
        vec3(0.03, 0.03, 0.03),
        vec3(0.15, 0.08, 0.04),
        vec3(0.3, 0.29, 0.27),
    ];
    let cloths = [
        vec3(0.35, 0.04, 0.03),
        vec3(0.03, 0.15, 0.08),
        vec3(0.05, 0.1, 0.25),
        vec3(0.5, 0.35, 0.08),
        vec3(0.12, 0.12, 0.12),
        vec3(0.5, 0.45, 0.35),
    ];
    let (door, cloth) = (pick(&doors), pick(&cloths));
    let floor = pick(&[vec3(0.2, 0.12, 0.07), vec3(0.25, 0.24, 0.22), vec3(0.1, 0.07, 0.05)]);
    let warm = pick(&[vec3(0.4, 0.31, 0.2), vec3(0.34, 0.2, 0.14), vec3(0.22, 0.28, 0.3), vec3(0.28, 0.32, 0.24)]);
    let drapes = pick(&[vec3(0.42, 0.3, 0.2), vec3(0.3, 0.06, 0.05), vec3(0.2, 0.24, 0.3), vec3(0.4, 0.38, 0.3)]);
    let shutter = design
        .shutters
        .map(|color| pick(&[color, color, vec3(0.3, 0.22, 0.14), vec3(0.08, 0.13, 0.2), vec3(0.5, 0.5, 0.48)]));
    let band = design.courses.iter().chain(&shop.courses).find(|c| c.out_m <= 0.0).map_or(design.trim, |c| c.color);
    let iron = pick(&[vec3(0.03, 0.03, 0.032), vec3(0.05, 0.055, 0.06), vec3(0.03, 0.05, 0.04)]);
    let roller = {
        let mut sheet = palette.fitting(SurfaceKind::Wall, &["corrugated"], random).material;
        sheet.base_color *= pick_shade(random);
        sheet
    };
    let cast = palette.fitting(SurfaceKind::Concrete, ANY, random).material;
    let sign = Material { role: Some(Role::ShopSign), ..palette.fitting(SurfaceKind::ShopSign, ANY, random).material };
    let back = palette.fitting(SurfaceKind::RoomBack, ANY, random).material;
    let stone = |color: Vec3| {
        let color = color * (Vec3::ONE * 0.6 + paint * 0.4) / 0.31;
        Material { base_color: cast.base_color * color, name: "facade stone".into(), ..cast.clone() }
    };
    let plain = |name: &str, color: Vec3, roughness: f32| Material::plain(name, color, roughness);
    let awning = |name: &str, color: Vec3| {
        let role = Some(Role::Awning);
        Material { sheen: 0.4, translucency: 0.2, dirt: 0.2, role, ..plain(name, color, 0.9) }
    };
    let tint = (design.glass * 0.87).min(Vec3::ONE);
    let glass = |name: &str, color: Vec3| Material { transmission: 0.92, ..plain(name, color, 0.02) };
    vec![
        stone(design.trim),
        Material { dirt: 0.4, ..plain("facade band", band * paint, 0.8) },
        Material { mapping: Mapping::Triplanar, ..stone(vec3(0.33, 0.32, 0.3)) },
        Material { dirt: 0.2, ..plain("window frame", design.frame, 0.45) },
        Material { dirt: 0.2, ..plain("shop frame", shop.frame, 0.4) },
        glass("window glass", tint),
        glass("balustrade glass", vec3(0.75, 0.85, 0.82)),
        plain("door", door, 0.35),
        roller,
        Material { dirt: 0.3, ..plain("shutter", shutter.unwrap_or(Vec3::splat(0.1)), 0.6) },
        Material { metalness: 0.3, ..plain("iron", iron, 0.5) },
        Material { dirt: 0.4, ..plain("zinc", vec3(0.46, 0.46, 0.45), 0.45) },
        Material { dirt: 0.3, ..plain("downpipe", vec3(0.33, 0.34, 0.34) * shade(random), 0.5) },
        plain("dark opening", Vec3::splat(0.02), 0.6),
        Material { sheen: 0.3, translucency: 0.4, ..plain("curtain", vec3(0.6, 0.59, 0.56), 0.9) },
        Material { sheen: 0.3, translucency: 0.2, ..plain("drapes", drapes, 0.9) },
        Material { translucency: 0.2, ..plain("blind", vec3(0.5, 0.49, 0.46), 0.7) },
        plain("room pale", vec3(0.45, 0.44, 0.41), 0.9),
        plain("room warm", warm, 0.9),
        plain("room floor", floor, 0.5),
        back,
        Material { role: Some(Role::RoomLamp), ..plain("lampshade", vec3(0.6, 0.57, 0.5), 0.9) },
        Material { role: Some(Role::LightPanel), ..plain("light panel", Vec3::splat(0.7), 0.5) },
        Material { role: Some(Role::ShopPanel), ..plain("light panel", Vec3::splat(0.7), 0.5) },
        Material { role: Some(Role::SignLamp), ..plain("sign lamp", Vec3::splat(0.6), 0.3) },
        Material { role: Some(Role::WallLamp), ..plain("wall lamp", Vec3::splat(0.6), 0.3) },
        awning("awning", cloth),
        awning("awning stripe", vec3(0.55, 0.54, 0.5)),
        sign,
        Material { translucency: 0.5, ..plain("scaffold net", vec3(0.08, 0.25, 0.14), 0.9) },
        Material { dirt: 0.4, ..plain("plank", vec3(0.3, 0.22, 0.13), 0.85) },
    ]
}

fn facade_tags<'h>(house: &House<'h>, height_m: f64, random: &mut Random) -> Vec<&'h str> {
    use BuildingKind as K;
    let (building, customs) = (house.building, house.customs);
    let old = building.year.is_none_or(|year| year < PLAIN_FROM);
    match (building.kind, building.material) {
        (Some(K::Construction), _) => return vec!["carcass"],
        (_, Some(WallMaterial::Brick)) => return vec!["brick", "victorian"],
        (_, Some(WallMaterial::Glass)) => return vec!["glass"],
        (_, Some(WallMaterial::Metal)) => return vec!["metal"],
        (_, Some(WallMaterial::Concrete)) => return vec!["slab", "ribbon", "panel"],
        (_, Some(WallMaterial::Plaster)) => return rendered(customs, old && height_m > 9.0),
        (_, Some(WallMaterial::Stone)) => return vec!["victorian", "hotel", "ornate"],
        (_, Some(WallMaterial::Wood)) => return vec!["wood"],
        (_, Some(WallMaterial::Tiles)) => return vec!["tiled"],
        (_, None) => {}
    }
    let home = matches!(building.kind, Some(K::Apartments | K::Residential | K::Terrace) | None);
    match building.kind {
        Some(kind) if kind.is_works() => return vec!["warehouse", "mill"],
        Some(K::Shed) => return vec!["wood", "plaster-plain"],
        Some(K::Hotel) => return vec!["hotel", "panel"],
        Some(K::Parking) => return vec!["ribbon"],
        Some(K::Office | K::Commercial) => return vec!["glass", "ribbon", "panel", "mill"],
        Some(K::Retail | K::Supermarket) if height_m < LOW_M => return vec!["mixed", "panel", "brick"],
        Some(kind) if kind.is_house() => return strs(&customs.house_facades),
        _ => {}
    }
    if height_m > TOWER_M && !home {
        return vec!["glass", "hotel", "ribbon", "panel"];
    }
    let fits = |rule: &&FacadeRule| {
        let is_of = match rule.of {
            FacadeUse::Any => true,
            FacadeUse::Homes => home,
            FacadeUse::Terrace => building.kind == Some(K::Terrace),
        };
        is_of && height_m > rule.above_m && rule.below_m.is_none_or(|below_m| height_m < below_m)
    };
    let Some(rule) = customs.facades.iter().find(fits) else { return Vec::new() };
    let may_be_ornate = rule.ornate_share > 0.0 && (old || !rule.ornate_if_old);
    if may_be_ornate && random.chance(rule.ornate_share) { rendered(customs, true) } else { strs(&rule.tags) }
}

/// Rendered walls of a country.
fn rendered(customs: &BuildingCustoms, ornate: bool) -> Vec<&str> {
    if ornate { vec!["ornate"] } else { strs(&customs.rendered) }
}

fn strs(tags: &[String]) -> Vec<&str> {
    tags.iter().map(String::as_str).collect()
}

fn ground_floor_tags(
    house: &House<'_>,
    height_m: f64,
    facade: &Tags,
    random: &mut Random,
) -> Option<&'static [&'static str]> {
    let building: &Building = house.building;
    let shop = building.shop || random.chance(0.35);
    let is = |tag: &str| facade.has(tag);
    use BuildingKind as K;
    match building.kind {
        Some(kind) if kind.is_house() && !building.shop => None,
        Some(
            K::Garage
            | K::Carport
            | K::Shed
            | K::Canopy
            | K::Hut
            | K::Worship
            | K::Chapel
            | K::Construction
            | K::Parking,
        ) => None,
        Some(kind) if kind.is_works() => Some(&["loading"]),
        Some(K::Office | K::Commercial | K::Hotel) => Some(&["lobby"]),
        Some(K::Retail | K::Supermarket) => Some(&["shops"]),
        _ if is("public-flats") => Some(&["void-deck"]),
        _ if is("tiled") || (house.customs.arcades && height_m < TOWER_M) => Some(&["arcade"]),
        _ if is("ornate") => Some(&["rusticated"]),
        _ if is("plaster") && !shop => None,
        _ if is("brick") && !shop => Some(&["entrances"]),
        _ if height_m > TOWER_M || is("glass") || is("ribbon") || is("panel") => Some(&["lobby"]),
        _ if shop || height_m > LOW_M => Some(&["shops"]),
        _ => Some(&["entrances"]),
    }
}

/// Houses of one material differ a little in shade and warmth.
fn shade(random: &mut Random) -> Vec3 {
    let (light, warm) = (random.range(0.82, 1.12), random.range(-0.05, 0.05));
    Vec3::new((light * (1.0 + warm)) as f32, light as f32, (light * (1.0 - warm)) as f32)
}

/// Sheets come in grey, blue, green, cream.
fn pick_shade(random: &mut Random) -> Vec3 {
    let colors = [Vec3::ONE, vec3(0.6, 0.8, 1.1), vec3(0.7, 1.0, 0.8), vec3(1.4, 1.3, 1.05)];
    random.pick(&colors).copied().unwrap_or(Vec3::ONE) * shade(random)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::buildings::shell::Slot;
    use crate::testing;

    fn house<'a>(building: &'a Building, country: &str) -> House<'a> {
        House { customs: testing::building_customs(country), ..House::alone(building, Vec::new()) }
    }

    #[test]
    fn a_mesh_keeps_the_materials_that_it_uses() {
        let material = |i: usize| Material::plain(&i.to_string(), Vec3::ONE, 0.5);
        let storeys = Storeys { grid: Grid { bay_m: 3.0, storey_m: 3.0 }, design: None };
        let dress = Dress { materials: (0..9).map(material).collect(), upper: storeys, ground_floor: None };
        let mut mesh = Mesh { slots: vec![7, 2, 7], ..Mesh::default() };
        let names: Vec<String> = dress.for_mesh(&mut mesh).into_iter().map(|m| m.name).collect();
        assert_eq!((mesh.slots, names), (vec![0, 1, 0], vec!["7".to_owned(), "2".to_owned()]));
    }

    #[test]
    fn there_is_a_material_for_every_slot() {
        let building = Building::new(1, trove_model::Polygon::default(), Some(BuildingKind::Apartments));
        let (library, report) = (trove_model::AssetLibrary::default(), trove_model::Report::default());
        let palette = Palette { library: &library, report: &report };
        let dress = dress(&house(&building, "TW"), 20.0, &palette, &mut trove_model::Seed(1).random());
        assert_eq!(dress.materials.len(), Slot::Plank as usize + 1);
        assert_eq!(dress.materials[Slot::Glass as usize].name, "window glass");
        assert_eq!(dress.materials[Slot::Lamp as usize].name, "wall lamp");
        assert_eq!(dress.materials[Slot::LightPanel as usize].name, "light panel");
        let roles = [Slot::Sign, Slot::Cloth, Slot::Stripe].map(|slot| dress.materials[slot as usize].role);
        assert_eq!(roles, [Some(Role::ShopSign), Some(Role::Awning), Some(Role::Awning)]);
    }

    #[test]
    fn the_same_flats_wear_what_people_build_there() {
        let building = Building::new(1, trove_model::Polygon::default(), Some(BuildingKind::Apartments));
        let worn = |country, random: &mut Random| {
            facade_tags(&house(&building, country), 20.0, random).into_iter().map(str::to_owned).collect::<Vec<_>>()
        };
        let mut random = trove_model::Seed(3).random();
        assert!(worn("TW", &mut random).contains(&"tiled".to_owned()));
        assert!(worn("SG", &mut random).contains(&"public-flats".to_owned()));
        assert!(worn("ES", &mut random).iter().all(|w| w.contains("plaster") || *w == "ornate"));
        assert!(worn("US", &mut random).iter().all(|w| *w != "tiled" && *w != "ornate"));
    }
}
