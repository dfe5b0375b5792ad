//! Where made-up things may stand: off the road, out of buildings, and clear of everything that was recorded.

use std::collections::HashMap;
use std::f64::consts::FRAC_1_SQRT_2;

use glam::DVec2;
use trove_model::{Bounds, Cuboid, Drive, Keyframe, Polygon};

use crate::geometry::distance_field::DistanceField;
use crate::geometry::plane_raster::bucket;
use crate::placement::ego_cuboid;
use crate::roads::{Footing, RoadSurfaces};

/// Cells of the distance fields, metres.
const CELL_M: f64 = 0.5;
/// Of the distance to buildings, against which things are put.
const WALL_CELL_M: f64 = 0.25;
/// Buckets of what has been placed, metres.
const BUCKET_M: f64 = 8.0;
/// No made-up thing needs more room than this around its middle, metres.
const MAX_RADIUS_M: f64 = 8.0;

/// Distances to what keeps made-up things away, and the things placed so far.
pub(crate) struct Clearance<'a> {
    surfaces: &'a RoadSurfaces,
    /// Carriageway, water, and what lies below bridges.
    road_m: DistanceField,
    buildings_m: DistanceField,
    /// Annotated boxes over the whole drive, and the recording vehicle's way.
    recorded_m: DistanceField,
    placed: Taken,
    /// Plants grow into each other, and not into what else stands there: they are kept apart from it.
    planted: Taken,
}

/// Circles that are taken, by place; only ever looked up, so the order inside does not reach a result.
type Taken = HashMap<[i64; 2], Vec<(DVec2, f64)>>;

/// The room that a thing needs around its foot, metres.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Room {
    /// From carriageway and water.
    pub road_m: f64,
    /// From buildings.
    pub buildings_m: f64,
    /// From recorded objects and the driven path.
    pub recorded_m: f64,
    /// From other things, half of it each: half its own width, or half the distance that it keeps from its like.
    pub radius_m: f64,
}

impl<'a> Clearance<'a> {
    /// With nothing placed yet.
    pub(crate) fn new(drive: &Drive, surfaces: &'a RoadSurfaces, footprints: &[Polygon], bounds: Bounds) -> Self {
        let closed = |p: DVec2| {
            matches!(surfaces.footing(p), Footing::Carriageway | Footing::Water) || surfaces.is_below_deck(p)
        };
        let (road_m, (buildings_m, recorded_m)) = rayon::join(
            || DistanceField::to_cells(bounds, CELL_M, closed),
            || {
                rayon::join(
                    || DistanceField::to(footprints.iter().cloned(), bounds, WALL_CELL_M),
                    || DistanceField::to(recorded(drive), bounds, CELL_M),
                )
            },
        );
        Self { surfaces, road_m, buildings_m, recorded_m, placed: Taken::new(), planted: Taken::new() }
    }

    /// Whether a thing may stand at a position.
    pub(crate) fn is_free(&self, p: DVec2, room: &Room) -> bool {
        // The fields are exact to about half of a cell's diagonal.
        let far = |field: &DistanceField, least_m: f64, cell_m: f64| field.at(p) >= least_m + cell_m * FRAC_1_SQRT_2;
        !matches!(self.surfaces.footing(p), Footing::Carriageway | Footing::Water)
            && far(&self.road_m, room.road_m, CELL_M)
            && far(&self.buildings_m, room.buildings_m, WALL_CELL_M)
            && far(&self.recorded_m, room.recorded_m, CELL_M)
            && is_apart(&self.placed, p, room.radius_m)
    }

    /// Takes a position, so that nothing else is placed there.
    pub(crate) fn take(&mut self, p: DVec2, radius_m: f64) {
        self.placed.entry(bucket(p, BUCKET_M)).or_default().push((p, radius_m.min(MAX_RADIUS_M)));
    }

    /// Whether no other plant needs the room around a position.
    pub(crate) fn is_unplanted(&self, p: DVec2, radius_m: f64) -> bool {
        is_apart(&self.planted, p, radius_m)
    }

    /// Takes the room that a plant needs among plants.
    pub(crate) fn plant(&mut self, p: DVec2, radius_m: f64) {
        self.planted.entry(bucket(p, BUCKET_M)).or_default().push((p, radius_m.min(MAX_RADIUS_M)));
    }

    /// Whether neither carriageway nor sidewalk nor water lies at a position.
    pub(crate) fn is_land(&self, p: DVec2) -> bool {
        self.surfaces.footing(p) == Footing::Land
    }

    /// Distance to the nearest carriageway or water, metres.
    pub(crate) fn road_distance_m(&self, p: DVec2) -> f64 {
        self.road_m.at(p)
    }

    /// Distance to the nearest building, metres.
    pub(crate) fn building_distance_m(&self, p: DVec2) -> f64 {
        self.buildings_m.at(p)
    }
}

fn is_apart(taken: &Taken, p: DVec2, radius_m: f64) -> bool {
    let radius_m = radius_m.min(MAX_RADIUS_M);
    let (low, high) = (bucket(p - radius_m - MAX_RADIUS_M, BUCKET_M), bucket(p + radius_m + MAX_RADIUS_M, BUCKET_M));
    let near = |x, y| taken.get(&[x, y]).into_iter().flatten();
    !(low[0]..=high[0])
        .flat_map(|x| (low[1]..=high[1]).map(move |y| (x, y)))
        .flat_map(|(x, y)| near(x, y))
        .any(|(other, other_m)| other.distance(p) < radius_m + other_m)
}

/// Outlines of every box at every keyframe and of the recording vehicle on its way.
pub(crate) fn recorded(drive: &Drive) -> impl Iterator<Item = Polygon> {
    let boxes = drive.keyframes.iter().flat_map(|k| &k.boxes).map(|b| outline(&b.cuboid));
    let ego = move |k: &Keyframe| ego_cuboid(drive, k);
    // Between keyframes the vehicle is where it is in the middle of them, too: a lane's width is swept.
    let path = drive.keyframes.windows(2).filter_map(move |pair| {
        let (a, b) = (ego(&pair[0]), ego(&pair[1]));
        let [a_m, b_m] = [&a, &b].map(|c| c.world_from_body.translation.truncate());
        let along = (b_m - a_m).try_normalize()?;
        let near = a_m.distance(b_m) < 60.0;
        let side = along.perp() * a.size_m.y / 2.0;
        let (from, to) = (a_m - along * a.size_m.x / 2.0, b_m + along * b.size_m.x / 2.0);
        near.then(|| Polygon::simple(vec![from - side, to - side, to + side, from + side]))
    });
    let stands = drive.keyframes.iter().map(move |k| outline(&ego(k)));
    boxes.chain(path).chain(stands).filter(|p| p.exterior.iter().all(|v| v.is_finite()))
}

/// A box seen from above.
fn outline(cuboid: &Cuboid) -> Polygon {
    Polygon::simple(cuboid.corners_world()[..4].iter().map(|c| c.truncate()).collect())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing;
    use trove_model::HeightField;

    #[test]
    fn nothing_is_free_on_the_road_in_a_building_beside_a_recorded_person_or_where_something_stands() {
        let drive = testing::drive();
        let bounds = crate::area(&drive).unwrap();
        let surfaces = testing::surfaces(&drive, &HeightField::flat(bounds, 0.0));
        let house = [[20.0, -40.0], [40.0, -40.0], [40.0, -20.0], [20.0, -20.0]].map(DVec2::from_array);
        let mut clearance = Clearance::new(&drive, &surfaces, &[Polygon::simple(house.to_vec())], bounds);
        let room = Room { road_m: 0.5, buildings_m: 1.0, recorded_m: 1.0, radius_m: 1.0 };
        for (x, y, free) in [
            (0.0, 0.0, false),
            (0.0, -4.3, false),
            (0.0, -5.0, true),
            (30.0, -30.0, false),
            (19.2, -30.0, false),
            (18.0, -30.0, true),
            (31.0, -6.0, false),
            (31.0, -8.0, true),
        ] {
            assert_eq!(clearance.is_free(DVec2::new(x, y), &room), free, "{x} {y}");
        }
        clearance.take(DVec2::new(0.0, -6.0), 0.5);
        assert!(!clearance.is_free(DVec2::new(0.0, -5.0), &room));
        assert!(clearance.is_free(DVec2::new(0.0, -7.6), &room));
    }
}
