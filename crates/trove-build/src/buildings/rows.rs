//! Rows of houses along streets where nothing is known: assumed streets, and gaps of a map that are to be filled. Where a
//! LiDAR saw that something else is there, no house is.

use std::collections::BTreeSet;

use glam::DVec2;
use trove_model::{
    Bounds, Building, BuildingCustoms, BuildingKind, Drive, Land, LandKind, Outcome, Polygon, Random, Report, Road,
    Seed,
};

use super::lidar::{LEAST_M2, guess, kept_free};
use super::volumes::{FIRST_UNMAPPED_ID, STOREY_M};
use crate::agreement::has_houses;
use crate::geometry::near::Near;
use crate::geometry::path::Path;
use crate::geometry::plane::{difference, grown};
use crate::geometry::plane_raster::bucket;
use crate::place::Place;
use crate::roads::{Footing, RoadSurfaces};

/// Between the carriageway and the houses there is a sidewalk of about this width, metres.
const SIDEWALK_M: [f64; 2] = [2.8, 4.2];
/// The kerb is looked for in such steps, up to so far from the middle of the road, metres.
const KERB_STEP_M: f64 = 0.25;
const WIDEST_M: f64 = 15.0;
/// Where no house fits, the next is tried so much further on, metres.
const STEP_M: f64 = 4.0;
/// A house keeps at least this share of its plot.
const LEAST_SHARE: f64 = 0.85;
/// Where so many square metres of a plot show LiDAR points, there is no house: it would hide them.
const MOST_SEEN: usize = 4;
/// Points this near to the edge of a plot may be of the house itself, metres.
const EDGE_M: f64 = 1.0;
/// Nearer to a mapped building than this nothing is missing, metres.
const MAPPED_M: f64 = 15.0;

/// What stands along a street, by what the land is used for; lengths in metres.
struct Habit {
    /// Along the street.
    length_m: [f64; 2],
    /// Between sidewalk and house.
    garden_m: [f64; 2],
    /// So many have a gap before the next, of this width.
    gap_share: f64,
    gap_m: [f64; 2],
    /// Kind, storeys and depth; `None` where they follow from its length.
    form: Option<(BuildingKind, [f64; 2], [f64; 2])>,
}

/// Houses wall to wall, with an alley here and there.
const TOWN: Habit =
    Habit { length_m: [9.0, 20.0], garden_m: [0.0, 0.0], gap_share: 0.2, gap_m: [3.0, 9.0], form: None };
const FAMILY_HOUSES: Habit = Habit {
    length_m: [8.0, 13.0],
    garden_m: [2.0, 5.0],
    gap_share: 0.9,
    gap_m: [3.0, 8.0],
    form: Some((BuildingKind::House, [1.0, 2.4], [8.0, 11.0])),
};
const WORKS: Habit = Habit {
    length_m: [20.0, 45.0],
    garden_m: [5.0, 12.0],
    gap_share: 1.0,
    gap_m: [6.0, 15.0],
    form: Some((BuildingKind::Warehouse, [2.0, 3.0], [18.0, 32.0])),
};

/// Houses on both sides of the streets of a place where nothing is known, clear of each other and of those in `built`.
pub(super) fn rows(place: &Place<'_>, streets: &RoadSurfaces, built: &[Building], seed: Seed) -> Vec<Building> {
    let Some(map) = place.map else { return Vec::new() };
    // What lies beside assumed streets is assumed too.
    let land = if place.is_assumed { &[][..] } else { &map.land };
    let free = land.iter().filter(|land| !is_built_on(land.kind)).map(|land| &land.polygon);
    let taken = kept_free(place.drive).into_iter().chain(built.iter().map(|b| b.footprint.clone()));
    let taken = taken.chain(free.cloned()).filter_map(|polygon| Some((polygon.bounds()?, polygon)));
    let mapped: Vec<&Polygon> = map.buildings.iter().map(|building| &building.footprint).collect();
    let mut row = Rows {
        bounds: place.bounds,
        streets,
        customs: &place.locale.buildings,
        used: land.iter().filter(|land| is_built_on(land.kind)).collect(),
        near: Near::new(mapped.iter().map(|footprint| Some(footprint.bounds()?.grown(MAPPED_M)))),
        mapped,
        seen: seen(place.drive),
        taken: taken.collect(),
        next_id: FIRST_UNMAPPED_ID + built.len() as i64,
        report: place.report,
    };
    let mut random = seed.child("rows").random();
    let roads = map.roads.iter().filter(|road| has_houses(road.kind));
    let houses: Vec<Building> = roads
        .filter(|road| !road.bridge && !road.tunnel && !road.link)
        .flat_map(|road| row.along(road, &mut random))
        .collect();
    place.report.measure("buildings.invented", houses.len() as f64);
    houses
}

fn is_built_on(kind: LandKind) -> bool {
    matches!(kind, LandKind::Residential | LandKind::Commercial | LandKind::Industrial)
}

/// Square metres in which a LiDAR saw something.
fn seen(drive: &Drive) -> BTreeSet<[i64; 2]> {
    let points = drive.keyframes.iter().filter_map(|k| k.lidar.as_ref()).flat_map(|sweep| &sweep.points_world);
    points.map(|p| bucket(p.as_dvec3().truncate(), 1.0)).collect()
}

/// What is known while houses are placed one after the other.
struct Rows<'a> {
    bounds: Bounds,
    streets: &'a RoadSurfaces,
    customs: &'a BuildingCustoms,
    /// Land that the map says is built on.
    used: Vec<&'a Land>,
    mapped: Vec<&'a Polygon>,
    /// Boxes around those and what is near to them.
    near: Near,
    seen: BTreeSet<[i64; 2]>,
    taken: Vec<(Bounds, Polygon)>,
    next_id: i64,
    report: &'a Report,
}

impl Rows<'_> {
    fn along(&mut self, road: &Road, random: &mut Random) -> Vec<Building> {
        let path = Path::new(&road.centreline);
        let mut houses = Vec::new();
        for side in [1.0, -1.0] {
            let sidewalk_m = between(SIDEWALK_M, random);
            let mut at_m = 0.0;
            while at_m < path.length_m() {
                let (here, ahead) = path.at(at_m);
                let away = ahead.perp() * side;
                let kerb_m = self.kerb_m(here, away);
                let Some((off_m, habit)) = kerb_m.and_then(|kerb_m| {
                    let off_m = kerb_m + sidewalk_m;
                    Some((off_m, self.habit(here + away * (off_m + EDGE_M))?))
                }) else {
                    at_m += STEP_M;
                    continue;
                };
                let length_m = between(habit.length_m, random);
                let (kind, storeys, depth_m) = match habit.form {
                    None => guess(length_m, &self.customs.from_lidar, random),
                    Some((kind, storeys, depth_m)) => {
                        (kind, between(storeys, random).round(), between(depth_m, random))
                    }
                };
                let off_m = off_m + between(habit.garden_m, random);
                let [from, to] = [at_m, at_m + length_m].map(|s| path.at(s).0);
                let away = (to - from).normalize_or_zero().perp() * side;
                let plot = [
                    from + away * off_m,
                    to + away * off_m,
                    to + away * (off_m + depth_m),
                    from + away * (off_m + depth_m),
                ];
                let Some((bounds, footprint)) = self.free(Polygon::simple(plot.to_vec()).oriented()) else {
                    at_m += STEP_M;
                    continue;
                };
                self.report.note(
                    Outcome::Guessed,
                    "house along a street where nothing is known",
                    self.next_id - FIRST_UNMAPPED_ID,
                );
                self.taken.push((bounds, footprint.clone()));
                let height_m = Some(storeys * STOREY_M);
                houses.push(Building { height_m, ..Building::new(self.next_id, footprint, Some(kind)) });
                self.next_id += 1;
                at_m += length_m;
                if random.unit() < habit.gap_share {
                    at_m += between(habit.gap_m, random);
                }
            }
        }
        houses
    }

    /// How far the kerb is from the middle of a road; `None` where nobody lives beside it, as at junctions.
    fn kerb_m(&self, middle: DVec2, away: DVec2) -> Option<f64> {
        let mut steps = (0..(WIDEST_M / KERB_STEP_M) as usize).map(|i| i as f64 * KERB_STEP_M);
        steps.find(|off_m| self.streets.footing(middle + away * *off_m) != Footing::Carriageway)
    }

    /// What stands at a place; `None` outside of what is built, and where the map knows what land is for but not of this.
    fn habit(&self, at: DVec2) -> Option<&'static Habit> {
        if !self.bounds.contains(at) {
            return None;
        }
        let around = self.used.iter().filter(|land| land.polygon.contains(at));
        match around.min_by(|a, b| a.polygon.area_m2().total_cmp(&b.polygon.area_m2())).map(|land| land.kind) {
            Some(LandKind::Industrial) => Some(&WORKS),
            Some(LandKind::Residential) if self.customs.family_houses && !self.customs.tall_homes => {
                Some(&FAMILY_HOUSES)
            }
            Some(_) => Some(&TOWN),
            None => self.used.is_empty().then_some(&TOWN),
        }
    }

    /// What of a plot a house may stand on, if that is most of it.
    fn free(&self, plot: Polygon) -> Option<(Bounds, Polygon)> {
        let bounds = plot.bounds()?;
        if self.is_mapped(&plot, bounds) {
            return None;
        }
        let near: Vec<Polygon> =
            self.taken.iter().filter(|(around, _)| around.overlaps(&bounds)).map(|(_, taken)| taken.clone()).collect();
        let street = grown(&self.streets.carriageway_near(&plot), SIDEWALK_M[0] - 0.5);
        let plot_m2 = plot.area_m2();
        let left = difference(&difference(&[plot], &street), &near);
        let house = left.into_iter().max_by(|a, b| a.area_m2().total_cmp(&b.area_m2()))?;
        let is_most = house.area_m2() > (LEAST_SHARE * plot_m2).max(LEAST_M2);
        (is_most && !self.is_seen(&house)).then_some((bounds, house))
    }

    /// Whether a building of the map stands on a plot or near to it.
    fn is_mapped(&self, plot: &Polygon, bounds: Bounds) -> bool {
        self.near.at(bounds).any(|i| {
            let footprint = self.mapped[i];
            let reaches = |p: &DVec2| footprint.contains(*p) || footprint.edge_distance_m(*p) < MAPPED_M;
            plot.exterior.iter().any(reaches) || footprint.exterior.iter().any(|p| plot.contains(*p))
        })
    }

    /// Whether a LiDAR saw into it.
    fn is_seen(&self, house: &Polygon) -> bool {
        let Some(bounds) = house.bounds() else { return true };
        let [low, high] = [bounds.min, bounds.max].map(|p| bucket(p, 1.0));
        let columns = (low[0]..=high[0]).flat_map(|x| self.seen.range([x, low[1]]..=[x, high[1]]));
        let middle = |cell: &[i64; 2]| DVec2::new(cell[0] as f64, cell[1] as f64) + 0.5;
        let inside = columns.filter(|c| house.contains(middle(c)) && house.edge_distance_m(middle(c)) > EDGE_M);
        inside.take(MOST_SEEN).count() >= MOST_SEEN
    }
}

fn between([from, to]: [f64; 2], random: &mut Random) -> f64 {
    from + (to - from) * random.unit()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::agreement::assumed;
    use crate::geometry::plane::rectangle;
    use crate::{roads, testing};
    use glam::DVec3;
    use trove_model::{HeightField, LidarSweep, RoadKind, StreetMap};

    fn houses(points: &[DVec3]) -> Vec<Building> {
        let mut drive = Drive { lane_map: None, ..testing::drive() };
        if !points.is_empty() {
            drive.keyframes[2].lidar = Some(LidarSweep {
                origin_world: DVec3::new(10.0, 0.0, 1.8),
                points_world: points.iter().map(|p| p.as_vec3()).collect(),
                classes: Vec::new(),
            });
        }
        let (library, seeds, report) = (testing::library(), Seed(0).into(), Report::default());
        let bounds = crate::area(&drive).unwrap();
        let ground = HeightField::flat(bounds, 0.0);
        let map =
            assumed(&Drive { keyframes: testing::drive().keyframes, ..drive.clone() }, &testing::locale("SG"), &report);
        let place = testing::place(&drive, Some(&map), bounds, &ground, &library, &seeds, &report);
        let place = Place { is_assumed: true, invents: true, ..place };
        let streets = roads::surfaces(&place, &crate::ground::Spans::default(), None);
        rows(&place, &streets, &[], Seed(1))
    }

    #[test]
    fn houses_stand_on_both_sides_clear_of_the_road_of_each_other_and_of_what_was_recorded() {
        let found = houses(&[]);
        let sides = [1.0, -1.0].map(|side| found.iter().filter(|h| h.footprint.centroid().y * side > 0.0).count());
        assert!(sides.iter().all(|&n| n > 10), "{sides:?}");
        for (i, house) in found.iter().enumerate() {
            let bounds = house.footprint.bounds().unwrap();
            assert!(bounds.min.y > 9.0 || bounds.max.y < -4.0, "{bounds:?}");
            assert!(!house.footprint.contains(DVec2::new(30.0, -6.0)));
            let others = difference(
                std::slice::from_ref(&house.footprint),
                &found[..i].iter().map(|h| h.footprint.clone()).collect::<Vec<_>>(),
            );
            assert!((others.iter().map(Polygon::area_m2).sum::<f64>() - house.footprint.area_m2()).abs() < 1.0);
        }
    }

    #[test]
    fn where_the_lidar_saw_through_no_house_stands() {
        let garden =
            Polygon::simple([[20.0, -40.0], [60.0, -40.0], [60.0, -5.0], [20.0, -5.0]].map(DVec2::from_array).to_vec());
        let seen: Vec<DVec3> =
            (0..40 * 35).map(|i| DVec3::new(20.5 + f64::from(i % 40), -39.5 + f64::from(i / 40), 0.0)).collect();
        let in_garden = |houses: Vec<Building>| houses.iter().any(|h| garden.contains(h.footprint.centroid()));
        assert!(in_garden(houses(&[])));
        assert!(!in_garden(houses(&seen)));
    }

    /// Houses along a street of 200 m with `land` beside it and a mapped house at 100 m.
    fn invented(land: &[(LandKind, [f64; 4])], country: &str) -> Vec<Building> {
        let drive = Drive { lane_map: None, ..testing::drive() };
        let (library, seeds, report) = (testing::library(), Seed(0).into(), Report::default());
        let bounds = Bounds { min: DVec2::splat(-150.0), max: DVec2::splat(150.0) };
        let ground = HeightField::flat(bounds, 0.0);
        let area = |[x0, y0, x1, y1]: [f64; 4]| rectangle(Bounds { min: DVec2::new(x0, y0), max: DVec2::new(x1, y1) });
        let land =
            land.iter().enumerate().map(|(id, (kind, at))| Land { id: id as i64, kind: *kind, polygon: area(*at) });
        let line = vec![DVec2::new(-100.0, 60.0), DVec2::new(100.0, 60.0)];
        let map = StreetMap {
            roads: vec![Road { width_m: Some(7.0), ..Road::new(1, RoadKind::Residential, line) }],
            buildings: vec![Building::new(2, area([-5.0, 70.0, 5.0, 80.0]), None)],
            land: land.collect(),
            ..StreetMap::default()
        };
        let locale = testing::locale(country);
        let place = testing::place(&drive, Some(&map), bounds, &ground, &library, &seeds, &report);
        let place = Place { locale: &locale, invents: true, ..place };
        let streets = roads::surfaces(&place, &crate::ground::Spans::default(), None);
        rows(&place, &streets, &[], Seed(1))
    }

    #[test]
    fn gaps_of_a_map_are_filled_by_the_use_of_the_land() {
        const NORTH: [f64; 4] = [-150.0, 60.0, 150.0, 150.0];
        const SOUTH: [f64; 4] = [-150.0, -150.0, 150.0, 60.0];
        let found = invented(&[(LandKind::Residential, NORTH), (LandKind::Park, SOUTH)], "DE");
        assert!(found.len() > 5 && found.iter().all(|house| house.kind == Some(BuildingKind::House)), "{found:?}");
        for house in &found {
            let bounds = house.footprint.bounds().unwrap();
            assert!(bounds.min.y > 60.0 && (bounds.min.x > 19.0 || bounds.max.x < -19.0), "{bounds:?}");
        }
        let works = invented(&[(LandKind::Industrial, NORTH)], "DE");
        assert!(works.len() > 2 && works.iter().all(|house| house.kind == Some(BuildingKind::Warehouse)));
        assert!(works.iter().all(|house| house.footprint.centroid().y > 60.0), "land of no known use is left alone");
        // Where no use of land is known, all of it is built on.
        assert!(invented(&[], "DE").iter().any(|house| house.footprint.centroid().y < 60.0));
    }
}
