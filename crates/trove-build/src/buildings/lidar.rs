//! Buildings that no map has, from the walls that the LiDAR saw, and how high it saw the walls of mapped ones.
//!
//! Seen from above a wall is a line of points, while leaves fill the plane. What lies behind it is made up.

use std::collections::{BTreeMap, BTreeSet};

use glam::{DVec2, DVec3, IVec3};
use trove_model::{
    Bounds, Building, BuildingKind, Drive, HeightField, LidarBuildings, LidarClass, Outcome, Polygon, Random, Report,
    Seed,
};

use super::volumes::{FIRST_UNMAPPED_ID, STOREY_M};
use crate::geometry::near::Near;
use crate::geometry::plane::{difference, grown, strip, union};
use crate::roads::{Footing, RoadSurfaces};
use crate::surroundings::recorded;

/// Points further from the sensor are too few to tell, metres.
const REACH_M: f64 = 100.0;
/// Recorded objects are seen past buildings up to this distance, metres.
const SIGHT_M: f64 = 60.0;
/// Fences, cars and people are below, metres over the ground.
const LOWEST_M: f64 = 2.5;
/// A LiDAR whose beams rise no steeper than this sees no near wall so high, radians: lower points of its count, and a
/// wall that so large a share of is seen within so little of the highest beam goes on above it.
const LEVEL_RAD: f64 = 0.1;
const LOWEST_LEVEL_M: f64 = 1.8;
const EDGE_RAD: f64 = 0.012;
const EDGE_SHARE: f64 = 0.6;
/// One point is kept a cube of this side, so that near walls do not outweigh far ones, metres.
const CUBE_M: f64 = 0.25;
/// Directions of lines, and the width of the strips that are looked along, metres.
const DIRECTIONS: usize = 180;
const STRIP_M: f64 = 0.3;
/// A line is seen in steps of this length, of which it fills this share, without a gap longer than that, metres.
const STEP_M: f64 = 1.5;
const FILLED: f64 = 0.45;
const GAP_M: f64 = 5.0;
/// A facade is at least this long, of at least so many points, seen up to this height and down to that, metres.
const MIN_FACADE_M: f64 = 8.0;
const MIN_POINTS: usize = 12;
const MIN_TOP_M: f64 = 3.4;
const MAX_LOW_M: f64 = 3.6;
/// Points within the first distance of a line are its own; up to the second crowns have as many a square metre, and a
/// wall has this many times fewer.
const OWN_M: f64 = 0.3;
const BESIDE_M: f64 = 1.6;
const CONTRAST: f64 = 4.0;
/// Lines that run along each other no further apart than this belong to one building, metres.
const LAYERS_M: f64 = 6.0;
/// So many facades are looked for.
const MOST_FACADES: usize = 16;
/// What a map that has buildings does not show this near to them is none, metres.
const MAPPED_M: f64 = 40.0;
/// Smaller than this is not built, m².
pub(super) const LEAST_M2: f64 = 30.0;
/// A longer facade is that of an office or a block of flats, metres.
const LARGE_M: f64 = 16.0;
/// Points within this distance of a wall belong to it; of so many of them the highest twentieth is left out.
const WALL_M: f64 = 0.6;
const MIN_WALL_POINTS: usize = 20;

/// A point that may be of a wall.
#[derive(Clone, Copy)]
struct Seen {
    at: DVec2,
    above_m: f64,
    /// Near the highest beam of a LiDAR that sees no higher.
    is_at_edge: bool,
    /// Where it was seen from.
    origin: DVec2,
}

/// A wall as a line on the ground.
#[derive(Clone, Copy, Debug)]
struct Facade {
    from: DVec2,
    to: DVec2,
    /// Away from the sensor, unit.
    away: DVec2,
    /// From the sensor to its line.
    distance_m: f64,
    top_m: f64,
}

/// Buildings behind the facades that the LiDAR saw and the map does not have, in a fixed order.
pub(super) fn unmapped(
    drive: &Drive,
    mapped: &[Building],
    usual: &LidarBuildings,
    streets: &RoadSurfaces,
    ground: &HeightField,
    seed: Seed,
    report: &Report,
) -> Vec<Building> {
    if drive.keyframes.iter().all(|k| k.lidar.is_none()) {
        return Vec::new();
    }
    let near = Near::new(mapped.iter().map(|b| Some(b.footprint.bounds()?.grown(MAPPED_M))));
    let is_unknown = |p: &Seen| near.at(Bounds { min: p.at, max: p.at }).next().is_none();
    let off_road = |p: &Seen| streets.footing(p.at) != Footing::Carriageway;
    let points = structures(drive, ground).filter(|p| is_unknown(p) && off_road(p));
    let mut taken = kept_free(drive);
    let mut random = seed.child("lidar").random();
    let mut built = Vec::new();
    for facade in facades(points.collect()) {
        let (kind, storeys, depth_m) = guess(facade.from.distance(facade.to), usual, &mut random);
        let footprint = facade.behind(depth_m);
        let road = streets.carriageway_near(&footprint);
        let left = difference(&difference(&[footprint], &road), &taken);
        let largest = left.into_iter().max_by(|a, b| a.area_m2().total_cmp(&b.area_m2()));
        let Some(footprint) = largest.filter(|p| p.area_m2() >= LEAST_M2) else { continue };
        let centre = footprint.centroid();
        report.note(
            Outcome::Guessed,
            "building that is on no map, from LiDAR",
            format_args!("{:.0}, {:.0}", centre.x, centre.y),
        );
        taken = union(&[taken, vec![footprint.clone()]].concat());
        // The beams do not reach the eaves.
        let height_m = Some((storeys * STOREY_M).max(facade.top_m));
        built.push(Building {
            height_m,
            ..Building::new(FIRST_UNMAPPED_ID + built.len() as i64, footprint, Some(kind))
        });
    }
    report.measure("buildings.from_lidar", built.len() as f64);
    built
}

/// Kind, storeys and depth of a building of which only a facade of some length is known.
pub(super) fn guess(length_m: f64, usual: &LidarBuildings, random: &mut Random) -> (BuildingKind, f64, f64) {
    let (drawn, storeys, depth) = (random.unit(), random.unit(), random.unit());
    if length_m < LARGE_M {
        return (
            if drawn < 0.6 { BuildingKind::Commercial } else { BuildingKind::Apartments },
            (3.0 + 3.0 * storeys).round(),
            8.0 + 6.0 * depth,
        );
    }
    let is_office = drawn < usual.office_share;
    let kind = if is_office { BuildingKind::Office } else { BuildingKind::Apartments };
    let [least, most] = usual.storeys;
    let storeys = least + (most - least) * storeys;
    (kind, storeys.round(), 14.0 + 10.0 * depth)
}

/// The height above the ground up to which the LiDAR saw each building's walls; `None` where it saw too little.
pub(super) fn seen_walls(drive: &Drive, buildings: &[&Building], ground: &HeightField) -> Vec<Option<f64>> {
    let near = Near::new(buildings.iter().map(|b| Some(b.footprint.bounds()?.grown(WALL_M))));
    let mut heights: BTreeMap<usize, Vec<f64>> = BTreeMap::new();
    for point in structures(drive, ground).filter(|p| p.above_m > LOWEST_M) {
        let is_at = |&i: &usize| buildings[i].footprint.edge_distance_m(point.at) < WALL_M;
        for i in near.at(Bounds { min: point.at, max: point.at }).filter(is_at) {
            heights.entry(i).or_default().push(point.above_m);
        }
    }
    let mut seen_m = vec![None; buildings.len()];
    for (i, mut heights) in heights {
        heights.sort_by(f64::total_cmp);
        seen_m[i] = (heights.len() >= MIN_WALL_POINTS).then(|| heights[(heights.len() - 1) * 19 / 20]);
    }
    seen_m
}

/// Points high above the ground that belong to nothing recorded, one a small cube.
fn structures<'a>(drive: &'a Drive, ground: &'a HeightField) -> impl Iterator<Item = Seen> + 'a {
    let mut cubes: BTreeSet<[i32; 3]> = BTreeSet::new();
    drive.keyframes.iter().filter_map(|k| Some((k, k.lidar.as_ref()?))).flat_map(move |(keyframe, sweep)| {
        let boxes: Vec<_> = keyframe.boxes.iter().map(|b| b.cuboid.grown(0.25)).collect();
        let labels = (sweep.classes.len() == sweep.points_world.len()).then_some(&sweep.classes);
        let highest_rad = sweep.highest_beam_rad();
        let is_level = highest_rad < LEVEL_RAD;
        let lowest_m = if is_level { LOWEST_LEVEL_M } else { LOWEST_M };
        let is_new = |position: DVec3, cubes: &mut BTreeSet<[i32; 3]>| {
            let cube: IVec3 = (position / CUBE_M).floor().as_ivec3();
            cubes.insert(cube.to_array())
        };
        let mut found = Vec::new();
        for (i, point) in sweep.points_world.iter().enumerate() {
            let position = point.as_dvec3();
            if labels.is_some_and(|l| l[i] != LidarClass::Manmade) || position.distance(sweep.origin_world) > REACH_M {
                continue;
            }
            let above_m = position.z - ground.height_m(position.truncate());
            if above_m > lowest_m && !boxes.iter().any(|b| b.contains(position)) && is_new(position, &mut cubes) {
                let is_at_edge = is_level && sweep.height_rad(position) > highest_rad - EDGE_RAD;
                let origin = sweep.origin_world.truncate();
                found.push(Seen { at: position.truncate(), above_m, is_at_edge, origin });
            }
        }
        found
    })
}

/// What no made-up house may stand on: recorded objects with the vehicle's way, and the sight lines from it to them.
pub(super) fn kept_free(drive: &Drive) -> Vec<Polygon> {
    let mut free = grown(&union(&recorded(drive).collect::<Vec<_>>()), 1.0);
    let path: Vec<DVec2> = drive.keyframes.iter().map(|k| k.world_from_ego.translation.truncate()).collect();
    free.extend(strip(&path, 2.0));
    for keyframe in drive.keyframes.iter().filter(|k| k.lidar.is_some()) {
        let eye = keyframe.world_from_ego.translation.truncate();
        let seen = keyframe.boxes.iter().filter(|b| b.lidar_points != Some(0));
        for cuboid in seen.map(|b| &b.cuboid) {
            let at = cuboid.world_from_body.translation.truncate();
            if at.distance(eye) < SIGHT_M {
                free.extend(strip(&[eye, at], cuboid.size_m.truncate().min_element() / 2.0 + 0.3));
            }
        }
    }
    union(&free)
}

/// The straight lines in some points, the longest first; of several before one another the nearest to the sensor.
fn facades(points: Vec<Seen>) -> Vec<Facade> {
    let mut left = points.clone();
    let mut found: Vec<Facade> = Vec::new();
    for _ in 0..MOST_FACADES {
        let Some(line) = longest_line(&left) else { break };
        left.retain(|p| !line.is_near(p.at, 0.8));
        found.extend(line.facade(&points));
    }
    let hides = |a: &Facade, b: &Facade| {
        let along = (b.to - b.from).normalize_or_zero();
        let alike = (a.to - a.from).normalize_or_zero().perp_dot(along).abs() < 0.15;
        let offset_m = ((a.from + a.to) / 2.0 - b.from).perp_dot(along).abs();
        let reach = [a.from, a.to].map(|p| (p - b.from).dot(along).clamp(0.0, b.from.distance(b.to)));
        let overlap_m = (reach[0] - reach[1]).abs();
        alike && offset_m < LAYERS_M && overlap_m > 0.5 * b.from.distance(b.to) && a.distance_m < b.distance_m
    };
    (0..found.len()).filter(|&i| !found.iter().any(|a| hides(a, &found[i]))).map(|i| found[i]).collect()
}

/// A stretch of a line.
struct Line {
    along: DVec2,
    /// Of the line to the left of World's origin.
    offset_m: f64,
    from_m: f64,
    to_m: f64,
}

/// The line along which most of a wall's length is seen; `None` where none is long enough.
fn longest_line(points: &[Seen]) -> Option<Line> {
    use rayon::prelude::*;
    let of_direction = |i: usize| -> Option<(usize, f64, f64, [f64; 2])> {
        let along = DVec2::from_angle(i as f64 * std::f64::consts::PI / DIRECTIONS as f64);
        let mut placed: Vec<(i64, f64)> =
            points.iter().map(|p| ((p.at.dot(along.perp()) / STRIP_M).floor() as i64, p.at.dot(along))).collect();
        placed.sort_by(|a, b| a.0.cmp(&b.0).then(a.1.total_cmp(&b.1)));
        let mut best: Option<(usize, f64, f64, [f64; 2])> = None;
        for run in placed.chunk_by(|a, b| a.0 == b.0 && b.1 - a.1 < GAP_M) {
            let (from_m, to_m) = (run[0].1, run[run.len() - 1].1);
            let steps = run.chunk_by(|a, b| (a.1 / STEP_M).floor() == (b.1 / STEP_M).floor()).count();
            let filled_m = steps as f64 * STEP_M;
            let is_long = to_m - from_m >= MIN_FACADE_M && run.len() >= MIN_POINTS;
            if is_long && filled_m > FILLED * (to_m - from_m) && best.is_none_or(|b| filled_m > b.1) {
                best = Some((i, filled_m, (run[0].0 as f64 + 0.5) * STRIP_M, [from_m, to_m]));
            }
        }
        best
    };
    let all: Vec<_> = (0..DIRECTIONS).into_par_iter().filter_map(of_direction).collect();
    let (i, _, offset_m, [from_m, to_m]) = all.into_iter().max_by(|a, b| a.1.total_cmp(&b.1).then(b.0.cmp(&a.0)))?;
    let along = DVec2::from_angle(i as f64 * std::f64::consts::PI / DIRECTIONS as f64);
    Some(Line { along, offset_m, from_m, to_m })
}

impl Line {
    fn off_m(&self, p: DVec2) -> f64 {
        (p.dot(self.along.perp()) - self.offset_m).abs()
    }

    fn is_near(&self, p: DVec2, distance_m: f64) -> bool {
        let s = p.dot(self.along);
        self.off_m(p) < distance_m && s > self.from_m - 1.0 && s < self.to_m + 1.0
    }

    /// The facade along the line, if it stands out from what is beside it and comes down to the ground.
    fn facade(&self, points: &[Seen]) -> Option<Facade> {
        let beside: Vec<&Seen> = points.iter().filter(|p| self.is_near(p.at, BESIDE_M)).collect();
        let (own, others): (Vec<&Seen>, Vec<&Seen>) = beside.iter().partition(|p| self.off_m(p.at) < OWN_M);
        let others = others.iter().filter(|p| self.off_m(p.at) > 1.5 * OWN_M).count() as f64;
        let density = [own.len() as f64 / OWN_M, others / (BESIDE_M - 1.5 * OWN_M)];
        let top_m = own.iter().map(|p| p.above_m).fold(0.0, f64::max);
        let low_m = own.iter().map(|p| p.above_m).fold(f64::INFINITY, f64::min);
        let steps = |of: &mut dyn Iterator<Item = &Seen>| {
            of.map(|p| (p.at.dot(self.along) / STEP_M).floor() as i64).collect::<BTreeSet<_>>().len() as f64
        };
        let all = steps(&mut own.iter().copied());
        let goes_on = steps(&mut own.iter().copied().filter(|p| p.is_at_edge)) > EDGE_SHARE * all;
        let is_high = top_m > MIN_TOP_M || goes_on;
        if density[0] < CONTRAST * density[1] || !is_high || low_m > MAX_LOW_M {
            return None;
        }
        let origin = own.first()?.origin;
        let normal = self.along.perp();
        let side = self.offset_m - origin.dot(normal);
        let at = |s: f64| self.along * s + normal * self.offset_m;
        let away = if side < 0.0 { -normal } else { normal };
        let (from, to) = (at(self.from_m - STEP_M / 2.0), at(self.to_m + STEP_M / 2.0));
        Some(Facade { from, to, away, distance_m: side.abs(), top_m })
    }
}

impl Facade {
    /// The rectangle behind it, as seen from the sensor.
    fn behind(&self, depth_m: f64) -> Polygon {
        let back = self.away * depth_m;
        Polygon::simple(vec![self.from, self.to, self.to + back, self.from + back]).oriented()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing;
    use trove_model::LidarSweep;

    fn built(low: DVec3, size: DVec3, mapped: &[Building]) -> Vec<Building> {
        built_from(&[(low, size, 4000)], mapped)
    }

    /// From boxes with so many points in each.
    fn built_from(clouds: &[(DVec3, DVec3, usize)], mapped: &[Building]) -> Vec<Building> {
        let mut random = Seed(2).random();
        let mut cloud = |&(low, size, count): &(DVec3, DVec3, usize)| -> Vec<glam::Vec3> {
            let point = |_| (low + DVec3::new(random.unit(), random.unit(), random.unit()) * size).as_vec3();
            (0..count).map(point).collect()
        };
        let mut drive = testing::drive();
        drive.keyframes[2].lidar = Some(LidarSweep {
            origin_world: DVec3::new(10.0, 0.0, 1.8),
            points_world: clouds.iter().flat_map(&mut cloud).collect(),
            classes: Vec::new(),
        });
        let ground = HeightField::flat(crate::area(&drive).unwrap(), 0.0);
        let streets = testing::surfaces(&drive, &ground);
        unmapped(
            &drive,
            mapped,
            &testing::building_customs("SG").from_lidar,
            &streets,
            &ground,
            Seed(1),
            &Report::default(),
        )
    }

    fn wall() -> [DVec3; 2] {
        [DVec3::new(0.0, -20.0, 0.0), DVec3::new(24.0, 0.03, 6.0)]
    }

    #[test]
    fn a_wall_becomes_a_building_behind_it_and_always_the_same() {
        let [low, size] = wall();
        let found = built(low, size, &[]);
        assert_eq!(found.len(), 1);
        let bounds = found[0].footprint.bounds().unwrap();
        assert!(bounds.max.y < -19.5 && bounds.min.y < -27.0 && bounds.size_m().x > 20.0, "{bounds:?}");
        assert!(found[0].height_m.unwrap() >= 6.0);
        assert_eq!(format!("{found:?}"), format!("{:?}", built(low, size, &[])));
    }

    #[test]
    fn a_wall_of_which_level_beams_see_only_the_foot_goes_on_above_them_and_a_fence_does_not() {
        let (low, size) = (DVec3::new(0.0, -20.0, 0.0), DVec3::new(24.0, 0.03, 2.3));
        let found = built(low, size, &[]);
        assert_eq!(found.len(), 1);
        assert!(found[0].height_m.unwrap() > 6.0);
        // The same points, below beams that rise to 13° and would have seen more of a wall.
        let [foot, crown] = [(low, size, 4000), (DVec3::new(30.0, -40.0, 9.0), DVec3::ONE, 200)];
        assert!(built_from(&[foot, crown], &[]).is_empty());
    }

    #[test]
    fn a_crown_a_mapped_building_and_a_wall_over_the_road_give_none() {
        assert!(built(DVec3::new(0.0, -24.0, 2.0), DVec3::new(8.0, 8.0, 4.0), &[]).is_empty());
        let [low, size] = wall();
        let mapped = built(low, size, &[]);
        assert!(built(low, size, &mapped).is_empty());
        assert!(built(DVec3::new(0.0, 8.0, 0.0), size, &[]).is_empty());
    }
}
