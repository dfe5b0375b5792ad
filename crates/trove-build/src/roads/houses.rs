//! Houses that roads give way to: their outlines were surveyed, most widths of roads are guessed.

use glam::DVec2;
use rayon::prelude::*;
use trove_model::{Bounds, BuildingKind, Polygon, RoadKind, StreetMap};

use crate::geometry::distance_field::DistanceField;
use crate::geometry::path::{Path, closed};
use crate::geometry::plane::{difference, grown, strip, union};
use crate::geometry::segments::SegmentIndex;

/// Between a wall and the road before it, metres: buildings are cut where a carriageway comes nearer than half a metre.
const BEFORE_WALL_M: f64 = 0.52;
/// What starts this high stands over a road, not on it, metres: a low storey.
pub(crate) const HEADROOM_M: f64 = 2.2;
/// Walls further away than this leave room for any road, metres.
const REACH_M: f64 = 16.0;
/// The cosine between a road and the way to a wall from which on the wall stands at its end and not at its side.
const AHEAD: f64 = 0.5;
/// Streets leave this much for a sidewalk where houses are near, metres.
const NARROWEST_WALK_M: f64 = 1.0;
/// How exactly it is told whether a house is near a road, metres.
const CELL_M: f64 = 1.0;
/// A street is as wide as it can be along so much of it; where it is narrower still it is pinched.
const PINCHED_SHARE: f64 = 0.1;

/// Houses that stand on the ground.
#[derive(Default)]
pub(super) struct Houses<'a> {
    footprints: Vec<(&'a Polygon, Bounds)>,
    walls: SegmentIndex,
}

impl<'a> Houses<'a> {
    /// Those of a map within `bounds`.
    pub(super) fn new(map: Option<&'a StreetMap>, bounds: Bounds) -> Self {
        let is_solid = |kind: Option<BuildingKind>| !kind.is_some_and(BuildingKind::is_canopy);
        let buildings = map.iter().flat_map(|m| &m.buildings);
        let on_ground = buildings.filter(|b| b.min_height_m < HEADROOM_M && is_solid(b.kind));
        let with_bounds = on_ground.filter_map(|b| Some((&b.footprint, b.footprint.bounds()?)));
        let footprints: Vec<_> = with_bounds.filter(|(_, b)| b.overlaps(&bounds)).collect();
        let walls: Vec<Vec<DVec2>> = footprints.iter().flat_map(|(p, _)| p.rings()).map(|ring| closed(ring)).collect();
        let walls = SegmentIndex::new(walls.iter().map(Vec::as_slice));
        Self { footprints, walls }
    }

    /// From kerb to kerb what houses leave of a road of some kind along a line, metres; infinite where none is near.
    pub(super) fn room_m(&self, kind: RoadKind, line: &[DVec2]) -> f64 {
        let wall_m = |pair: &[DVec2]| {
            let along = (pair[1] - pair[0]).normalize_or_zero();
            let near = self.walls.nearest(pair[0], REACH_M).filter(|_| !self.holds(pair[0]));
            let at_side = near.filter(|n| (n.position - pair[0]).normalize_or_zero().dot(along).abs() < AHEAD);
            at_side.map_or(f64::INFINITY, |n| n.distance_m)
        };
        let mut found_m: Vec<f64> = line.windows(2).map(wall_m).collect();
        found_m.sort_by(f64::total_cmp);
        let wall_m = found_m.get((found_m.len() as f64 * PINCHED_SHARE) as usize).copied().unwrap_or(f64::INFINITY);
        let is_street = (RoadKind::Primary..=RoadKind::Minor).contains(&kind);
        2.0 * (wall_m - BEFORE_WALL_M - if is_street { NARROWEST_WALK_M } else { 0.0 })
    }

    /// What is left of a carriageway beside houses; `kept` stays.
    pub(super) fn left_of(&self, road: Vec<Polygon>, kept: &[Polygon], bounds: Bounds) -> Vec<Polygon> {
        if self.footprints.is_empty() {
            return road;
        }
        let road_m = DistanceField::to(road.iter().cloned(), bounds, CELL_M);
        let is_near = |ring: &Vec<DVec2>| {
            let wall = closed(ring);
            let path = Path::new(&wall);
            let places = (0..=path.length_m() as u32).map(|m| path.at(f64::from(m)).0);
            wall.len() > 1 && places.into_iter().any(|p| road_m.at(p) < BEFORE_WALL_M + CELL_M)
        };
        let near = self.footprints.par_iter().filter(|(p, _)| is_near(&p.exterior));
        let yards: Vec<Polygon> =
            near.flat_map_iter(|(p, _)| grown(&union(std::slice::from_ref(*p)), BEFORE_WALL_M)).collect();
        if yards.is_empty() {
            return road;
        }
        difference(&road, &difference(&union(&yards), &union(kept)))
    }

    /// Where roads, told by their lines and widths, lead through houses or into them, with a step before and behind.
    pub(super) fn passages<'r>(&self, roads: impl Iterator<Item = (&'r [DVec2], f64)>) -> Vec<Polygon> {
        let passages = |(line, width_m): (&[DVec2], f64)| {
            let inside: Vec<bool> = line.iter().map(|&p| self.holds(p)).collect();
            let is_kept = |i: usize| (i.saturating_sub(1)..=(i + 1).min(inside.len() - 1)).any(|k| inside[k]);
            let kept: Vec<usize> = (0..inside.len()).filter(|&i| is_kept(i)).collect();
            let runs = kept.chunk_by(|a, b| a + 1 == *b);
            runs.flat_map(|run| strip(&line[run[0]..=run[run.len() - 1]], width_m / 2.0)).collect::<Vec<_>>()
        };
        union(&roads.collect::<Vec<_>>().into_par_iter().flat_map_iter(passages).collect::<Vec<_>>())
    }

    fn holds(&self, p: DVec2) -> bool {
        self.footprints.iter().any(|(polygon, bounds)| bounds.contains(p) && polygon.contains(p))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::plane::{intersection, rectangle};
    use crate::geometry::plane_raster::PlaneRaster;
    use crate::roads::network::{Stretch, stretches};
    use trove_model::{Building, Report, Road};

    fn bounds() -> Bounds {
        Bounds::square(DVec2::ZERO, 200.0)
    }

    fn house(low: [f64; 2], high: [f64; 2]) -> Polygon {
        rectangle(Bounds { min: DVec2::from_array(low), max: DVec2::from_array(high) })
    }

    fn map(houses: &[Polygon]) -> StreetMap {
        let building = |(i, footprint): (usize, &Polygon)| Building::new(i as i64, footprint.clone(), None);
        StreetMap { buildings: houses.iter().enumerate().map(building).collect(), ..StreetMap::default() }
    }

    /// A street along x.
    fn street(width_m: Option<f64>) -> Road {
        Road { width_m, ..crate::testing::road(1, RoadKind::Residential, &[[-80.0, 0.0], [80.0, 0.0]]) }
    }

    fn stretch<'a>(road: &'a Road, houses: &Houses<'_>) -> Stretch<'a> {
        let nothing = PlaneRaster::new(bounds(), 0.5);
        let ground = vec![(road, road.centreline.clone())];
        stretches(ground, &nothing, houses, false, &Report::default()).remove(0)
    }

    fn shared_m2(a: &[Polygon], b: &[Polygon]) -> f64 {
        intersection(a, b).iter().map(Polygon::area_m2).sum()
    }

    #[test]
    fn a_street_whose_width_is_guessed_fits_between_its_houses() {
        let map = map(&[house([-70.0, 4.0], [70.0, 14.0]), house([-70.0, -15.0], [70.0, -5.0])]);
        let houses = Houses::new(Some(&map), bounds());
        let width_m = |tagged, houses: &Houses<'_>| stretch(&street(tagged), houses).width_m;
        assert!((width_m(None, &Houses::default()) - 6.9).abs() < 1e-9);
        assert!((width_m(None, &houses) - 2.0 * (4.0 - BEFORE_WALL_M - NARROWEST_WALK_M)).abs() < 1e-9);
        assert_eq!(width_m(Some(7.5), &houses), 7.5);
    }

    #[test]
    fn a_wall_at_the_end_of_a_street_does_not_narrow_it() {
        let map = map(&[house([81.0, -20.0], [95.0, 20.0])]);
        assert!((stretch(&street(None), &Houses::new(Some(&map), bounds())).width_m - 6.9).abs() < 1e-9);
    }

    #[test]
    fn a_road_gives_way_to_a_house_but_where_somebody_was_recorded() {
        let footprint = house([-10.0, 3.0], [10.0, 13.0]);
        let map = map(std::slice::from_ref(&footprint));
        let (houses, road) = (Houses::new(Some(&map), bounds()), [house([-80.0, -4.0], [80.0, 4.0])]);
        let yard = grown(std::slice::from_ref(&footprint), 0.5);
        assert!(shared_m2(&road, &yard) > 20.0);
        assert!(shared_m2(&houses.left_of(road.to_vec(), &[], bounds()), &yard) < 1e-3);
        let recorded = [house([-5.0, 2.0], [5.0, 4.0])];
        let left = houses.left_of(road.to_vec(), &recorded, bounds());
        assert!((shared_m2(&left, &recorded) - 20.0).abs() < 0.1);
    }

    #[test]
    fn a_road_leads_through_the_house_that_it_runs_into() {
        let map = map(&[house([20.0, -9.0], [32.0, 9.0])]);
        let (houses, road) = (Houses::new(Some(&map), bounds()), street(Some(4.0)));
        let passages = {
            let Stretch { line, width_m, .. } = stretch(&road, &houses);
            houses.passages(std::iter::once((line.as_slice(), width_m)))
        };
        let within = [house([20.0, -2.0], [32.0, 2.0])];
        assert!((shared_m2(&passages, &within) - 48.0).abs() < 0.1);
        assert!(passages.iter().all(|p| p.exterior.iter().all(|v| (15.9..36.1).contains(&v.x))));
        assert!(houses.passages(std::iter::empty()).is_empty());
    }
}
