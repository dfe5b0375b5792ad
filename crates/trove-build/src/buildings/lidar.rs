//! Buildings that no map has, from the walls that the LiDAR saw.
//!
//! Seen from above a wall is a line, while leaves fill the plane. A line of such pieces is a facade; what lies behind
//! it is made up.

use glam::{DVec2, DVec3};
use trove_model::{Building, Drive, HeightField, Outcome, Polygon, Report, Seed};

use super::volumes::STOREY_M;
use crate::clearance::recorded;
use crate::plane::{difference, grown, strip, union};
use crate::roads::{Footing, RoadSurfaces};
use crate::wall_pieces::{CUBE_M, WallPiece, wall_pieces};

/// Ids of these buildings start here, far below those of any relation.
pub(super) const FIRST_ID: i64 = i64::MIN / 2;
/// Points further from the sensor are too few to tell, metres.
const REACH_M: f64 = 60.0;
/// Fences, cars and people are below, metres over the ground.
const LOWEST_M: f64 = 2.5;
/// Pieces of one facade run alike to this (cosine), and lie no further apart and off its line than this, metres.
const ALIKE: f64 = 0.94;
const GAP_M: f64 = 4.0;
const OFF_LINE_M: f64 = 0.8;
/// A facade is at least this long and seen up to this height, of at least so many pieces.
const MIN_FACADE_M: f64 = 8.0;
const MIN_TOP_M: f64 = 3.4;
const MIN_PIECES: usize = 4;
/// What a map that has buildings does not show this near to them is none, metres.
const MAPPED_M: f64 = 40.0;
/// Smaller than this is not built, m².
const LEAST_M2: f64 = 30.0;

/// Buildings behind the facades that the LiDAR saw and the map does not have, in a fixed order.
pub(super) fn unmapped(
    drive: &Drive,
    mapped: &[Building],
    streets: &RoadSurfaces,
    ground: &HeightField,
    seed: Seed,
    report: &Report,
) -> Vec<Building> {
    if drive.keyframes.iter().all(|k| k.lidar.is_none()) {
        return Vec::new();
    }
    let is_unknown = |p: &WallPiece| {
        let near =
            |b: &Building| b.footprint.bounds().is_some_and(|bounds| bounds.grown(MAPPED_M).contains(p.position));
        !mapped.iter().any(near)
    };
    let above_m = |position: DVec3| {
        let plane = position.truncate();
        let above_m = position.z - ground.height_m(plane);
        let is_structure = above_m > LOWEST_M && streets.footing(plane) != Footing::Carriageway;
        is_structure.then_some(above_m)
    };
    let pieces: Vec<WallPiece> =
        drive.keyframes.iter().flat_map(|k| wall_pieces(k, REACH_M, above_m)).filter(is_unknown).collect();
    let mut facades: Vec<Vec<WallPiece>> = facades(&pieces);
    facades.sort_by_key(|f| std::cmp::Reverse(f.len()));
    let mut taken = kept_free(drive);
    let mut random = seed.child("lidar").random();
    let mut built = Vec::new();
    for facade in &facades {
        let (depth_m, storeys) = (random.range(8.0, 14.0), random.range(3.0, 7.0).round());
        let Some((footprint, seen_m)) = behind(facade, depth_m) else { continue };
        let road = streets.carriageway_near(&footprint);
        let left = difference(&difference(&[footprint], &road), &taken);
        let largest = left.into_iter().max_by(|a, b| a.area_m2().total_cmp(&b.area_m2()));
        let Some(footprint) = largest.filter(|p| p.area_m2() >= LEAST_M2) else { continue };
        let centre = footprint.centroid();
        report.note(
            Outcome::Guessed,
            "building that no map has, from LiDAR",
            format_args!("{:.0}, {:.0}", centre.x, centre.y),
        );
        taken = union(&[taken, vec![footprint.clone()]].concat());
        // The beams do not reach the eaves.
        let height_m = Some((storeys * STOREY_M).max(seen_m));
        built.push(Building { height_m, ..Building::new(FIRST_ID + built.len() as i64, footprint, "yes") });
    }
    report.measure("buildings.from_lidar", built.len() as f64);
    built
}

/// What nothing may stand on: recorded objects with the vehicle's way, and the sight lines from it to them.
fn kept_free(drive: &Drive) -> Vec<Polygon> {
    let mut free = grown(&union(&recorded(drive).collect::<Vec<_>>()), 1.0);
    let path: Vec<DVec2> = drive.keyframes.iter().map(|k| k.world_from_ego.translation.truncate()).collect();
    free.extend(strip(&path, 2.0));
    for keyframe in drive.keyframes.iter().filter(|k| k.lidar.is_some()) {
        let eye = keyframe.world_from_ego.translation.truncate();
        let seen = keyframe.boxes.iter().filter(|b| b.lidar_points != Some(0));
        for cuboid in seen.map(|b| &b.cuboid) {
            let at = cuboid.world_from_body.translation.truncate();
            if at.distance(eye) < REACH_M {
                free.extend(strip(&[eye, at], cuboid.size_m.truncate().min_element() / 2.0 + 0.3));
            }
        }
    }
    union(&free)
}

/// Pieces in one line that follow one another, in the order of their first piece.
fn facades(pieces: &[WallPiece]) -> Vec<Vec<WallPiece>> {
    let follows = |a: &WallPiece, b: &WallPiece| {
        let way = b.position - a.position;
        let off_m = a.axis.perp_dot(way).abs().max(b.axis.perp_dot(way).abs());
        way.length() < GAP_M && off_m < OFF_LINE_M && a.axis.dot(b.axis).abs() > ALIKE
    };
    let mut is_free = vec![true; pieces.len()];
    let mut found = Vec::new();
    for first in 0..pieces.len() {
        if !std::mem::take(&mut is_free[first]) {
            continue;
        }
        let mut facade = vec![pieces[first]];
        let mut next = 0;
        while let Some(&piece) = facade.get(next) {
            for (other, free) in pieces.iter().zip(&mut is_free) {
                if *free && follows(&piece, other) {
                    *free = false;
                    facade.push(*other);
                }
            }
            next += 1;
        }
        found.push(facade);
    }
    found
}

/// The rectangle behind a facade, as seen from the sensor, and the height that was seen of it.
fn behind(facade: &[WallPiece], depth_m: f64) -> Option<(Polygon, f64)> {
    let n = facade.len() as f64;
    let mean = facade.iter().map(|p| p.position).sum::<DVec2>() / n;
    // Directions repeat after half a turn: angles are averaged twice as large.
    let doubled: DVec2 = facade.iter().map(|p| DVec2::from_angle(2.0 * p.axis.to_angle())).sum();
    let axis = DVec2::from_angle(doubled.to_angle() / 2.0);
    let away = if axis.perp().dot(mean - facade.first()?.origin) < 0.0 { -axis.perp() } else { axis.perp() };
    let along = facade.iter().map(|p| (p.position - mean).dot(axis));
    let (low, high) = along.fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), x| (l.min(x), h.max(x)));
    let (low, high) = (low - CUBE_M / 2.0, high + CUBE_M / 2.0);
    let top_m = facade.iter().map(|p| p.top_m).fold(0.0, f64::max);
    if high - low < MIN_FACADE_M || top_m < MIN_TOP_M || facade.len() < MIN_PIECES {
        return None;
    }
    let corner = |along_m: f64, depth_m: f64| mean + axis * along_m + away * depth_m;
    let ring = vec![corner(low, 0.0), corner(high, 0.0), corner(high, depth_m), corner(low, depth_m)];
    Some((Polygon::simple(ring).oriented(), top_m))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing;
    use trove_model::LidarSweep;

    fn built(low: DVec3, size: DVec3, mapped: &[Building]) -> Vec<Building> {
        let mut random = Seed(2).random();
        let point = |_| (low + DVec3::new(random.unit(), random.unit(), random.unit()) * size).as_vec3();
        let mut drive = testing::drive();
        drive.keyframes[2].lidar = Some(LidarSweep {
            origin_world: DVec3::new(10.0, 0.0, 1.8),
            points_world: (0..4000).map(point).collect(),
            classes: Vec::new(),
        });
        let ground = HeightField::flat(crate::area(&drive).unwrap(), 0.0);
        let streets = testing::surfaces(&drive, &ground);
        unmapped(&drive, mapped, &streets, &ground, Seed(1), &Report::default())
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
    fn a_crown_a_mapped_building_and_a_wall_over_the_road_give_none() {
        assert!(built(DVec3::new(0.0, -24.0, 2.0), DVec3::new(8.0, 8.0, 4.0), &[]).is_empty());
        let [low, size] = wall();
        let mapped = built(low, size, &[]);
        assert!(built(low, size, &mapped).is_empty());
        assert!(built(DVec3::new(0.0, 8.0, 0.0), size, &[]).is_empty());
    }
}
