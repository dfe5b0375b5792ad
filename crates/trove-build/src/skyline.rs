//! What stands beyond the place, up to the horizon: nothing is known of it, so its own houses and trees are repeated.

use std::collections::BTreeMap;

use glam::{DAffine3, DMat3, DQuat, DVec2, DVec3};
use trove_model::{Bounds, Kind, Outcome};

use crate::buildings::BuiltBuildings;
use crate::geometry::near::Near;
use crate::ground::{Drape, Land, beyond_m};
use crate::pieces::{Piece, Scenery};
use crate::place::Place;
use crate::roads::{Footing, RoadSurfaces};

/// So far beyond the place something stands, metres.
const REACH_M: f64 = 320.0;
/// Nothing stands so near to the place, metres.
const APART_M: f64 = 3.0;
/// What lies at the border goes on beyond it: it is looked up so far inside, metres.
const INSIDE_M: f64 = 4.0;
/// Houses that touch stand where they do, up or down, to this, metres.
const UNEVEN_M: f64 = 1.5;
/// At most so many plants; those near the place come first.
const MOST_PLANTS: usize = 2500;

/// Houses and trees beyond a place.
#[derive(Default)]
pub(crate) struct Skyline<'a> {
    pub houses: Vec<Piece>,
    pub plants: Vec<Scenery<'a>>,
}

/// Repeats the houses and trees of a place around it: each of its neighbours is the place itself, turned by half about
/// the middle of the side that both share, so what is alike at the border lies beside each other. Houses that touch are
/// repeated together, and neither over water nor where the land rises otherwise or something of the place reaches out.
pub(crate) fn skyline<'a>(
    place: &Place<'_>,
    surfaces: &RoadSurfaces,
    land: Option<Land<'_>>,
    buildings: &BuiltBuildings,
    plants: &[Scenery<'a>],
) -> Skyline<'a> {
    let drape = Drape::new(place.ground);
    let bounds = place.bounds;
    let mut blocks: BTreeMap<usize, Vec<(&Piece, Bounds)>> = BTreeMap::new();
    for (house, block) in buildings.pieces.iter().zip(&buildings.blocks) {
        if let Some(own) = footprint(house, &house.world_from_mesh) {
            blocks.entry(*block).or_default().push((house, own));
        }
    }
    let all = || blocks.values().flatten().map(|(_, own)| *own);
    let reaches_out = |own: &Bounds| !(bounds.contains(own.min) && bounds.contains(own.max));
    let out: Vec<Bounds> = all().filter(reaches_out).collect();
    let is_dry = |p: DVec2| {
        let inside = p.clamp(bounds.min + INSIDE_M, bounds.max - INSIDE_M);
        surfaces.footing(inside) != Footing::Water && !land.is_some_and(|land| land.is_sea(p))
    };
    let height_m = |p: DVec2| beyond_m(&drape, land, p);
    let mut found = Skyline::default();
    let mut taken: Vec<Bounds> = out.clone();
    let near = bounds.grown(APART_M);
    let far = bounds.grown(REACH_M);
    for turn in neighbours(bounds) {
        let beside = Near::new(taken.iter().copied().map(Some));
        for block in blocks.values() {
            let turned = |(house, own): &(&Piece, Bounds)| {
                let there = footprint(house, &(turn * house.world_from_mesh))?;
                let lift_m = height_m(there.centre()) - place.ground.height_m(own.centre());
                Some((there, lift_m))
            };
            let Some(there) = block.iter().map(turned).collect::<Option<Vec<_>>>() else { continue };
            let [low_m, high_m] = [f64::min, f64::max].map(|f| there.iter().map(|t| t.1).reduce(f).unwrap_or_default());
            let is_free = |(there, _): &(Bounds, f64)| {
                !there.overlaps(&near) && beside.at(*there).next().is_none() && is_dry(there.centre())
            };
            let is_near = there.iter().any(|(there, _)| far.contains(there.centre()));
            if is_near && high_m - low_m < UNEVEN_M && there.iter().all(is_free) {
                let lift = DAffine3::from_translation(DVec3::Z * low_m);
                let raised =
                    |house: &Piece| Piece { world_from_mesh: lift * turn * house.world_from_mesh, ..house.clone() };
                found.houses.extend(block.iter().map(|(house, _)| raised(house)));
                taken.extend(there.into_iter().map(|(there, _)| there));
            }
        }
    }
    let built = Near::new(taken.iter().copied().map(Some));
    for turn in neighbours(bounds) {
        let turned = turn.matrix3.x_axis.truncate().to_angle();
        for plant in plants.iter().filter(|plant| plant.asset.kind == Kind::Tree) {
            let p = turn.transform_point3(plant.foot_world).truncate();
            let at = Bounds { min: p, max: p };
            if !near.contains(p) && far.contains(p) && is_dry(p) && built.at(at).next().is_none() {
                let foot_world = p.extend(height_m(p));
                found.plants.push(Scenery { foot_world, yaw_rad: plant.yaw_rad + turned, ..plant.clone() });
            }
        }
    }
    let away_m = |s: &Scenery| {
        let p = s.foot_world.truncate();
        p.distance(p.clamp(bounds.min, bounds.max))
    };
    found.plants.sort_by(|a, b| away_m(a).total_cmp(&away_m(b)));
    found.plants.truncate(MOST_PLANTS);
    let count = found.houses.len() + found.plants.len();
    place.report.measure("skyline.repeated", count as f64);
    if count > 0 {
        let example = format!("{}: {} houses, {} trees", place.drive.id, found.houses.len(), found.plants.len());
        place.report.note(Outcome::Guessed, "houses and trees beyond the place, repeated from it", example);
    }
    found
}

/// From the place to each of the eight around it.
fn neighbours(bounds: Bounds) -> Vec<DAffine3> {
    let (centre, size) = (bounds.centre(), bounds.size_m());
    let all = [-1.0, 0.0, 1.0].into_iter().flat_map(|x| [-1.0, 0.0, 1.0].map(|y| DVec2::new(x, y)));
    all.filter(|way| *way != DVec2::ZERO)
        .map(|way| {
            // Two half turns, over a side and the next, are none.
            let is_turned = way.x == 0.0 || way.y == 0.0;
            let turn = if is_turned { DMat3::from_quat(half_turn()) } else { DMat3::IDENTITY };
            let to = (centre + size * way).extend(0.0);
            DAffine3::from_mat3_translation(turn, to - turn * centre.extend(0.0))
        })
        .collect()
}

fn half_turn() -> DQuat {
    DQuat::from_xyzw(0.0, 0.0, 1.0, 0.0)
}

/// The box around a piece, seen from above.
fn footprint(piece: &Piece, world_from_mesh: &DAffine3) -> Option<Bounds> {
    let (low, high) = piece.mesh.bounds()?;
    let corners = [[low.x, low.y], [high.x, low.y], [low.x, high.y], [high.x, high.y]];
    let world = |[x, y]: [f32; 2]| {
        world_from_mesh.transform_point3(DVec3::new(f64::from(x), f64::from(y), f64::from(low.z))).truncate()
    };
    Bounds::around(corners.into_iter().map(world))
}

#[cfg(test)]
mod tests {
    use super::*;
    use trove_model::{Building, InstanceId, Land as MapLand, LandKind, Polygon, Report, StreetMap};

    use crate::testing;

    fn square(centre: [f64; 2], half_m: f64) -> Polygon {
        let corners = [[-half_m, -half_m], [half_m, -half_m], [half_m, half_m], [-half_m, half_m]];
        Polygon::simple(corners.map(|c| DVec2::from_array(centre) + DVec2::from_array(c)).to_vec())
    }

    /// Middles of the buildings of a place with one house near its eastern side, and the place.
    fn houses(land: Vec<MapLand>) -> (Vec<DVec2>, Bounds) {
        let drive = testing::drive();
        let bounds = crate::area(&drive).unwrap();
        let house = bounds.centre() + DVec2::new(bounds.size_m().x / 2.0 - 40.0, 100.0);
        let buildings = vec![Building::new(3, square(house.to_array(), 8.0), None)];
        let map = StreetMap { buildings, land, ..testing::map_with_road([[-200.0, 4.0], [200.0, 4.0]]) };
        let site =
            crate::build(&drive, Some(&map), &testing::library(), &testing::settings(), &Report::default()).unwrap();
        let scene = site.scene(&drive, 0);
        let mut ids: Vec<InstanceId> = scene.instances.iter().map(|i| i.id).filter(|id| id.0 > 0).collect();
        let count = ids.len();
        ids.sort();
        ids.dedup();
        assert_eq!(ids.len(), count);
        let is_house = |o: &&trove_model::SceneObject| o.kind == Kind::Building;
        let objects = scene.instances.iter().filter_map(|i| i.object.as_deref()).filter(is_house);
        (objects.map(|o| o.cuboid.world_from_body.translation.truncate()).collect(), bounds)
    }

    #[test]
    fn houses_go_on_beyond_each_side_as_they_are_at_it_and_not_over_water() {
        let (found, bounds) = houses(Vec::new());
        let (centre, half_m) = (bounds.centre(), bounds.size_m().x / 2.0);
        let expected = |to: [f64; 2]| found.iter().any(|p| p.distance(centre + DVec2::from_array(to)) < 3.0);
        // Turned by half about the middle of the eastern side.
        assert!(expected([half_m - 40.0, 100.0]) && expected([half_m + 40.0, -100.0]), "{found:?}");
        let outside: Vec<_> = found.iter().filter(|p| !bounds.contains(**p)).collect();
        assert_eq!(outside.len(), found.len() - 1);
        assert!(!outside.is_empty() && outside.iter().all(|p| bounds.grown(REACH_M).contains(**p)));
        // Water along the eastern side goes on as well.
        let sea = square((centre + DVec2::X * half_m).to_array(), half_m);
        let sea =
            Polygon::simple(sea.exterior.iter().map(|p| p.max(DVec2::new(centre.x + half_m - 20.0, p.y))).collect());
        let (by_the_sea, _) = houses(vec![MapLand { id: 9, kind: LandKind::Water, polygon: sea }]);
        assert!(by_the_sea.iter().all(|p| p.x < centre.x + half_m), "{by_the_sea:?}");
        assert!(by_the_sea.len() > 1);
    }
}
