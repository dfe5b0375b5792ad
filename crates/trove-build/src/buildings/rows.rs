//! Rows of houses along streets that are assumed themselves, where no LiDAR saw that something else is there.

use std::collections::BTreeSet;

use glam::DVec2;
use trove_model::{Building, Drive, LidarBuildings, Outcome, Polygon, Random, Report, Road, Seed};

use super::lidar::{LEAST_M2, guess, kept_free};
use super::volumes::{FIRST_UNMAPPED_ID, STOREY_M};
use crate::agreement::has_houses;
use crate::geometry::plane::{difference, grown, union};
use crate::geometry::plane_raster::bucket;
use crate::place::Place;
use crate::roads::{Path, RoadSurfaces};

/// Between the carriageway and the houses there is a sidewalk of about this width, metres.
const SIDEWALK_M: [f64; 2] = [2.8, 4.2];
/// Length of a house along the street, metres.
const LENGTH_M: [f64; 2] = [9.0, 20.0];
/// So many have an alley before the next, of this width, metres.
const ALLEY_SHARE: f64 = 0.2;
const ALLEY_M: [f64; 2] = [3.0, 9.0];
/// Where no house fits, the next is tried so much further on, metres.
const STEP_M: f64 = 4.0;
/// A house keeps at least this share of its plot.
const LEAST_SHARE: f64 = 0.85;
/// Where so many square metres of a plot show LiDAR points, there is no house: it would hide them.
const MOST_SEEN: usize = 4;
/// Points this near to the edge of a plot may be of the house itself, metres.
const EDGE_M: f64 = 1.0;

/// Houses on both sides of the assumed streets of a place, clear of each other and of those in `built`.
pub(super) fn rows(place: &Place<'_>, streets: &RoadSurfaces, built: &[Building], seed: Seed) -> Vec<Building> {
    let roads = place.map.iter().flat_map(|map| &map.roads).filter(|road| has_houses(road.kind));
    let mut row = Rows {
        streets,
        usual: &place.locale.buildings.from_lidar,
        seen: seen(place.drive),
        taken: union(&[kept_free(place.drive), built.iter().map(|b| b.footprint.clone()).collect()].concat()),
        next_id: FIRST_UNMAPPED_ID + built.len() as i64,
        report: place.report,
    };
    let mut random = seed.child("rows").random();
    roads.flat_map(|road| row.along(road, &mut random)).collect()
}

/// Square metres in which a LiDAR saw something.
fn seen(drive: &Drive) -> BTreeSet<[i64; 2]> {
    let points = drive.keyframes.iter().filter_map(|k| k.lidar.as_ref()).flat_map(|sweep| &sweep.points_world);
    points.map(|p| bucket(p.as_dvec3().truncate(), 1.0)).collect()
}

/// What is known while houses are placed one after the other.
struct Rows<'a> {
    streets: &'a RoadSurfaces,
    usual: &'a LidarBuildings,
    seen: BTreeSet<[i64; 2]>,
    taken: Vec<Polygon>,
    next_id: i64,
    report: &'a Report,
}

impl Rows<'_> {
    fn along(&mut self, road: &Road, random: &mut Random) -> Vec<Building> {
        let path = Path::new(&road.centreline);
        let mut houses = Vec::new();
        for side in [1.0, -1.0] {
            let off_m = road.width_m.unwrap_or(0.0) / 2.0 + between(SIDEWALK_M, random);
            let mut at_m = 0.0;
            while at_m < path.length_m() {
                let length_m = between(LENGTH_M, random);
                let (kind, storeys, depth_m) = guess(length_m, self.usual, random);
                let [from, to] = [at_m, at_m + length_m].map(|s| path.at(s).0);
                let away = (to - from).normalize_or_zero().perp() * side;
                let plot = [
                    from + away * off_m,
                    to + away * off_m,
                    to + away * (off_m + depth_m),
                    from + away * (off_m + depth_m),
                ];
                let Some(footprint) = self.free(Polygon::simple(plot.to_vec()).oriented()) else {
                    at_m += STEP_M;
                    continue;
                };
                self.report.note(
                    Outcome::Guessed,
                    "house along a street of which nothing is known",
                    self.next_id - FIRST_UNMAPPED_ID,
                );
                self.taken.push(footprint.clone());
                let height_m = Some(storeys * STOREY_M);
                houses.push(Building { height_m, ..Building::new(self.next_id, footprint, Some(kind)) });
                self.next_id += 1;
                at_m += length_m;
                if random.unit() < ALLEY_SHARE {
                    at_m += between(ALLEY_M, random);
                }
            }
        }
        houses
    }

    /// What of a plot a house may stand on, if that is most of it.
    fn free(&self, plot: Polygon) -> Option<Polygon> {
        let bounds = plot.bounds()?;
        let near: Vec<Polygon> =
            self.taken.iter().filter(|t| t.bounds().is_some_and(|b| b.overlaps(&bounds))).cloned().collect();
        let street = grown(&self.streets.carriageway_near(&plot), SIDEWALK_M[0] - 0.5);
        let plot_m2 = plot.area_m2();
        let left = difference(&difference(&[plot], &street), &near);
        let house = left.into_iter().max_by(|a, b| a.area_m2().total_cmp(&b.area_m2()))?;
        let is_most = house.area_m2() > (LEAST_SHARE * plot_m2).max(LEAST_M2);
        (is_most && !self.is_seen(&house)).then_some(house)
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
    use crate::{roads, testing};
    use glam::DVec3;
    use trove_model::{HeightField, LidarSweep};

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
}
