//! Walls with whole bays and whole storeys: flat ones, and which of them are worth more.

use std::f64::consts::PI;

use glam::{DVec2, DVec3};
use trove_model::{Polygon, Seed};

use super::facade;
use super::shell::Shell;
use super::sight::{Detail, Sight};
use super::volumes::Volume;
use super::wall::{Band, STATIONS, Wall};
use crate::roads::Footing;

/// Edges that meet at less than this make one wall, radians: round fronts keep their rhythm of windows.
const SAME_WALL_RAD: f64 = 0.35;
/// A wall is straight if its corners are this near to the line between its ends, metres.
const STRAIGHT_M: f64 = 0.03;
/// A neighbour that hides this share of a wall's height leaves the rest blank: nobody has windows towards it.
const PARTY_SHARE: f64 = 0.4;
/// A wall with a street at most this far before it is a front, metres.
const FRONT_M: f64 = 18.0;

/// The walls of a volume whose floor is at 0 and whose walls reach up to a level.
pub(super) fn walls_of(volume: &Volume<'_>, top_m: f64, sight: &Sight<'_>) -> Vec<Wall> {
    let mut walls = Vec::new();
    let mut first_edge = 0;
    for (which, ring) in volume.footprint.rings().enumerate() {
        let first = walls.len();
        for (number, edges) in runs(ring).into_iter().enumerate() {
            let n = ring.len();
            let line: Vec<DVec2> =
                edges.iter().map(|&e| ring[e]).chain(edges.last().map(|&e| ring[(e + 1) % n])).collect();
            let sides = || edges.iter().filter_map(|&e| volume.sides.get(first_edge + e));
            let hidden = |up_to_m: f64| {
                let covers = sides().flat_map(|s| &s.covers).filter(|c| c.up_to_m >= up_to_m);
                covers.map(|c| c.to_m - c.from_m).sum::<f64>() > 0.6 * sides().map(|s| s.length_m).sum::<f64>()
            };
            let is_blank =
                !volume.sides.is_empty() && hidden(volume.bottom_m + PARTY_SHARE * (top_m - volume.bottom_m));
            let (a, b) = (line[0], line[line.len() - 1]);
            let is_straight = line.iter().all(|p| (*p - a).perp_dot((b - a).normalize_or_zero()).abs() < STRAIGHT_M);
            let detail = if is_blank || !is_straight { Detail::Flat } else { sight.detail(a, b) };
            let thickness_m = |t: f64| match detail {
                Detail::Flat => 0.0,
                _ => thickness(&volume.footprint, a.lerp(b, t), (b - a).normalize_or_zero().perp()),
            };
            walls.push(Wall {
                is_front: detail != Detail::Flat && faces_a_street(a, b, sight),
                thick_m: thickness_m(0.5),
                thicknesses_m: std::array::from_fn(|i| {
                    let corner_m =
                        if detail == Detail::Flat { 50.0 } else { corner_behind(&volume.footprint, [a, b], i) };
                    thickness_m((i as f64 + 0.5) / STATIONS as f64).min(corner_m)
                }),
                line,
                number: walls.len() as u64,
                first_bay: (which * 5 + number * 3) % 8,
                detail,
                is_blank,
                corner: [0.0; 2],
                mitre: [None; 2],
            });
        }
        first_edge += ring.len();
        corners(&mut walls[first..]);
    }
    walls
}

/// What happens where the walls of a ring meet.
fn corners(walls: &mut [Wall]) {
    let n = walls.len();
    for i in 0..n {
        let k = (i + 1) % n;
        let (before, after) = (&walls[i].line, &walls[k].line);
        let built = [i, k].map(|w| walls[w].detail != Detail::Flat);
        // What is not built may be bent: its edge at the corner tells where it runs.
        let into = before[before.len() - 1] - before[if built[0] { 0 } else { before.len() - 2 }];
        let out_of = after[if built[1] { after.len() - 1 } else { 1 }] - after[0];
        let turn = into.angle_to(out_of).clamp(-0.9 * PI, 0.9 * PI);
        let slope = (turn / 2.0).tan();
        let full = [i, k].iter().all(|&w| walls[w].detail == Detail::Full);
        if n > 2 {
            // Half of a corner is either wall's; of one beside a wall without rooms only what is acute is lost.
            let lost = if built == [true; 2] { slope } else { (turn - PI / 2.0).clamp(0.0, 0.45 * PI).tan() };
            walls[i].corner[1] = lost.max(0.0);
            walls[k].corner[0] = lost.max(0.0);
        }
        if n > 2 && full && slope.abs() < 1.3 {
            walls[i].mitre[1] = Some(slope);
            walls[k].mitre[0] = Some(slope);
        }
    }
}

/// Whether a road or a sidewalk lies straight before a wall.
fn faces_a_street(a: DVec2, b: DVec2, sight: &Sight<'_>) -> bool {
    let out = -(b - a).normalize_or_zero().perp();
    let street = |p: DVec2| matches!(sight.streets.footing(p), Footing::Carriageway | Footing::Sidewalk);
    [0.25, 0.5, 0.75].iter().any(|&t| (1..=9).any(|k| street(a.lerp(b, t) + out * (FRONT_M * f64::from(k) / 9.0))))
}

/// From a place on a wall to the next wall behind it.
fn thickness(footprint: &Polygon, from: DVec2, inward: DVec2) -> f64 {
    let hit = |(p, q): (DVec2, DVec2)| {
        let edge = q - p;
        let across = inward.perp_dot(edge);
        let (s, t) = ((p - from).perp_dot(edge) / across, (p - from).perp_dot(inward) / across);
        (across.abs() > 1e-9 && s > 0.05 && (0.0..=1.0).contains(&t)).then_some(s)
    };
    footprint.edges().filter_map(hit).fold(50.0, f64::min)
}

/// From a wall to the nearest of the outline's corners behind one of its stations: what juts in between two of them.
fn corner_behind(footprint: &Polygon, [a, b]: [DVec2; 2], station: usize) -> f64 {
    let along = (b - a).normalize_or_zero();
    let wide_m = a.distance(b) / STATIONS as f64;
    let behind = |p: &DVec2| {
        let (x, depth_m) = ((*p - a).dot(along), (*p - a).dot(along.perp()));
        let is_there = (x / wide_m - station as f64 - 0.5).abs() <= 0.5 && depth_m > 0.05;
        is_there.then_some(depth_m)
    };
    footprint.rings().flatten().filter_map(behind).fold(50.0, f64::min)
}

/// Puts up a wall between a band's bottom and top.
pub(super) fn raise(shell: &mut Shell, wall: &Wall, band: &Band<'_>, seed: Seed) {
    if let (Some(design), false) = (band.design, wall.detail == Detail::Flat) {
        return facade::relief(shell, wall, band, design, seed);
    }
    let length_m: f64 = wall.line.windows(2).map(|w| w[0].distance(w[1])).sum();
    let blank = wall.is_blank && band.design.is_some();
    let slot = if blank { band.wall } else { band.slot };
    let (u0, u1) = if blank { (0.0, length_m) } else { band.grid.along(length_m, wall.first_bay as f64) };
    let mut at_m = 0.0;
    for pair in wall.line.windows(2) {
        let next_m = at_m + pair[0].distance(pair[1]);
        let u = [at_m, next_m].map(|m| u0 + (u1 - u0) * m / length_m);
        let corner = |p: DVec2, u: f64, z: f64| -> (DVec3, DVec2) {
            (p.extend(z), DVec2::new(u, if blank { z } else { band.v(z) }))
        };
        let (a, b) = (pair[0], pair[1]);
        let mut heights = vec![band.bottom_m];
        if band.bottom_m < band.floor_m {
            heights.push(band.floor_m);
        }
        heights.push(band.top_m);
        for z in heights.windows(2) {
            let [low, high] = [z[0], z[1]];
            shell.face(
                slot,
                &[corner(a, u[0], low), corner(b, u[1], low), corner(b, u[1], high), corner(a, u[0], high)],
            );
        }
        at_m = next_m;
    }
}

/// A closed ring as walls: runs of edges that hardly turn, by the edges' numbers.
fn runs(ring: &[DVec2]) -> Vec<Vec<usize>> {
    let n = ring.len();
    let turns = |i: usize| {
        let (before, after) = (ring[i] - ring[(i + n - 1) % n], ring[(i + 1) % n] - ring[i]);
        before.angle_to(after).abs() > SAME_WALL_RAD
    };
    let Some(start) = (0..n).find(|&i| turns(i)) else {
        return vec![(0..n).collect()];
    };
    let mut walls: Vec<Vec<usize>> = Vec::new();
    for i in (0..n).map(|k| (start + k) % n) {
        match walls.last_mut() {
            Some(wall) if !turns(i) => wall.push(i),
            _ => walls.push(vec![i]),
        }
    }
    walls
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_round_tower_is_one_wall_and_a_square_house_four() {
        let ring = |n: u32| -> Vec<DVec2> {
            (0..n).map(|i| DVec2::from_angle(std::f64::consts::TAU * f64::from(i) / f64::from(n)) * 5.0).collect()
        };
        assert_eq!(runs(&ring(24)).len(), 1);
        assert_eq!(runs(&ring(4)).len(), 4);
        assert!(runs(&ring(4)).iter().all(|wall| wall.len() == 1));
    }

    #[test]
    fn rooms_beside_a_bent_wall_end_before_its_edge_at_their_corner() {
        let wall = |line: &[DVec2], detail| Wall {
            line: line.to_vec(),
            number: 0,
            first_bay: 0,
            detail,
            is_blank: false,
            is_front: false,
            corner: [0.0; 2],
            mitre: [None; 2],
            thick_m: 5.0,
            thicknesses_m: [5.0; STATIONS],
        };
        // It leans over the house by 20° at the corner and is upright on the whole.
        let mut bent = vec![DVec2::new(10.0, 0.0)];
        for turned_deg in [110.0f64, 90.0, 70.0] {
            bent.push(bent[bent.len() - 1] + DVec2::from_angle(turned_deg.to_radians()) * 3.0);
        }
        let [first, last] = [bent[0], bent[3]];
        let mut walls = [
            wall(&[DVec2::ZERO, first], Detail::Full),
            wall(&bent, Detail::Flat),
            wall(&[last, DVec2::ZERO], Detail::Flat),
        ];
        corners(&mut walls);
        assert!((walls[0].corner[1] - 20f64.to_radians().tan()).abs() < 1e-9, "{:?}", walls[0].corner);
    }
}
