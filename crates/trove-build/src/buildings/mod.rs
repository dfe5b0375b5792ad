//! Buildings from their footprints, or from the LiDAR where no map has them: extruded with a facade, or replaced by an asset where it fits.

mod bays;
mod blocks;
mod dress;
mod extrude;
mod facade;
mod floor_plan;
mod lidar;
mod rectangle;
mod replace;
mod roof;
mod rows;
mod shell;
mod sight;
mod volumes;
mod wall;
mod walls;

use std::collections::BTreeMap;
use std::sync::Arc;

use glam::DAffine3;
use rayon::prelude::*;
use trove_model::{Asset, Building, Class, Kind, Material, Mesh, Outcome, Polygon, Random, Report, Slot};

use crate::pieces::Palette;
use crate::pieces::Piece;
use crate::place::Place;
use crate::roads::RoadSurfaces;
use bays::Bays;
use sight::Sight;
use volumes::{House, Model};

/// The buildings of a place.
#[derive(Clone, Debug)]
pub(crate) struct BuiltBuildings {
    /// One a building, each an object of its own.
    pub pieces: Vec<Piece>,
    /// Of each piece its block: houses that touch each other are of one.
    pub blocks: Vec<usize>,
    /// Where they stand; parts of one building may overlap.
    pub footprints: Vec<Polygon>,
}

/// Builds every building of the map that does not stand in the way, and those that only the LiDAR saw.
pub(crate) fn buildings(place: &Place<'_>, keep_clear: &RoadSurfaces) -> BuiltBuildings {
    let Place { drive, map, bounds, ground, library, locale, seeds, report, .. } = *place;
    let customs = &locale.buildings;
    let mapped = map.map_or(&[][..], |m| &m.buildings);
    let seed = seeds.facades.child("buildings");
    let plan_seed = seeds.place.child("buildings");
    let mut unmapped = lidar::unmapped(drive, mapped, &customs.from_lidar, keep_clear, ground, plan_seed, report);
    if place.invents {
        unmapped.extend(rows::rows(place, keep_clear, &unmapped, plan_seed));
    }
    let all: Vec<&Building> = mapped.iter().chain(&unmapped).collect();
    let seen_m = lidar::seen_walls(drive, &all, ground);
    let plot = volumes::Plot { drive, customs, streets: keep_clear, ground, bounds, seen_m: &seen_m };
    let mut houses = volumes::houses(&all, &plot, seed, report);
    replace::assign(&mut houses, library, keep_clear, seed.child("model"), report);
    volumes::beside(&mut houses);
    let grown = grown(&houses);
    let palette = Palette { library, report };
    let sight = Sight::new(drive, keep_clear);
    let build = |house: &House<'_>| {
        let mut random = seed.child("building").nth(house.building.id as u64).random();
        match &house.model {
            Some(model) => replaced(house, model, &grown, &mut random, report),
            None => extruded(house, &palette, &sight, &mut random, report),
        }
    };
    let built = houses.par_iter().map(build).zip(blocks::blocks(&houses));
    let (pieces, blocks): (Vec<Piece>, Vec<usize>) = built.filter(|(p, _)| !p.mesh.triangles.is_empty()).unzip();
    report.measure("buildings.built", pieces.len() as f64);
    report.measure("buildings.replaced_by_assets", pieces.iter().filter(|p| p.asset.is_some()).count() as f64);
    let triangles: usize = pieces.iter().filter(|p| p.asset.is_none()).map(|p| p.mesh.triangles.len()).sum();
    report.measure("buildings.triangles", triangles as f64);
    let models = houses.iter().filter_map(|h| h.model.as_ref()).map(replace::outline);
    let footprints = houses.iter().flat_map(|h| &h.volumes).map(|v| v.footprint.clone()).chain(models).collect();
    BuiltBuildings { pieces, blocks, footprints }
}

fn extruded(
    house: &House<'_>,
    palette: &Palette<'_>,
    sight: &Sight<'_>,
    random: &mut Random,
    report: &Report,
) -> Piece {
    let height_m = house.volumes.iter().map(|v| v.top_m).fold(0.0, f64::max);
    let dress = dress::dress(house, height_m, palette, random);
    let mut mesh = extrude::extrude(house, &dress, sight, random, report);
    Piece {
        materials: dress.for_mesh(&mut mesh),
        mesh: Arc::new(mesh),
        world_from_mesh: DAffine3::IDENTITY,
        class: Class::Building,
        kind: Some(Kind::Building),
        asset: None,
    }
}

/// The meshes of models with their bays and storeys, each once.
type Grown<'a> = BTreeMap<(&'a str, Bays), Arc<Mesh>>;

fn grown<'a>(houses: &[House<'a>]) -> Grown<'a> {
    let models: BTreeMap<(&str, Bays), &Asset> =
        houses.iter().filter_map(|h| h.model).map(|m| ((m.asset.id.as_str(), m.bays), m.asset)).collect();
    let models: Vec<_> = models.into_iter().collect();
    models.into_par_iter().map(|((id, bays), asset)| ((id, bays), bays.mesh(asset))).collect()
}

fn replaced(house: &House<'_>, model: &Model<'_>, grown: &Grown<'_>, random: &mut Random, report: &Report) -> Piece {
    let (name, asset) = (volumes::name(house.building), model.asset);
    report.note(
        Outcome::Substituted,
        "rectangular building, replaced by an asset",
        format_args!("{name}: {}", asset.id),
    );
    Piece {
        mesh: Arc::clone(&grown[&(asset.id.as_str(), model.bays)]),
        world_from_mesh: model.world_from_mesh,
        class: Class::Building,
        materials: asset.slots.iter().map(|slot| painted(slot, random)).collect(),
        kind: Some(Kind::Building),
        asset: Some(asset.id.clone()),
    }
}

fn painted(slot: &Slot, random: &mut Random) -> Material {
    let base_color = random.pick(&slot.paints).copied().unwrap_or(slot.material.base_color);
    Material { base_color, ..slot.material.clone() }
}
