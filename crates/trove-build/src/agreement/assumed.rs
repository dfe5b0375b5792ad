//! The street of a drive for which there is no map: along the driven path, as wide as those on it need it, and across
//! it where others drove. How fast the vehicle went tells a motorway from a street with houses.

use std::ops::RangeInclusive;

use glam::{DVec2, DVec3};
use trove_model::{
    Bounds, Class, Cuboid, Drive, Keyframe, Land, LandKind, Locale, Outcome, Report, Road, RoadKind, SidewalkSides,
    StreetMap,
};

use super::walls::wall_pieces;
use crate::geometry::plane::{strip, union};
use crate::geometry::segments::SegmentIndex;

/// Roads go on so far before and behind what was driven, metres: to where trees and houses close the view.
const BEYOND_M: f64 = 250.0;
/// Positions nearer to each other tell no direction, metres.
const STEP_M: f64 = 4.0;
/// Width of a lane, and between the outermost one and the kerb, metres.
const LANE_M: f64 = 3.3;
const GUTTER_M: f64 = 0.4;
/// Vehicles that run alike up to this angle (cosine of 25°) are on the same road, if they are this near to the edge of
/// what is known of it so far and the road becomes no wider than that, metres.
const ALIKE: f64 = 0.9;
const BESIDE_M: f64 = 2.5;
const WIDEST_M: f64 = 24.0;
/// Whoever drove this far away from known roads drove on another one, metres.
const OTHER_ROAD_M: f64 = 15.0;
/// Faster than this is a motorway, and than this a road without houses, m/s.
const MOTORWAY_MPS: f64 = 21.0;
const OPEN_ROAD_MPS: f64 = 15.0;
/// Between the carriageways of a motorway, metres.
const MEDIAN_M: f64 = 4.0;
/// The ground beside a street with houses is paved this far from its middle, metres.
const PAVED_M: f64 = 40.0;

/// Where so many pieces of wall are seen a sweep, a street has houses (47 and 66 in two of KITTI's frames with houses, 12 in
/// one without, from trunks and signs): so high above the wheels, where no fence and no car reaches, and so near, metres.
const LEAST_WALLS: usize = 25;
const WALL_M: RangeInclusive<f64> = 1.8..=15.0;
const WALL_REACH_M: f64 = 50.0;

/// Roads, and the paved land beside them, where the recording is all that is known. Streets with houses have sidewalks.
pub(crate) fn assumed(drive: &Drive, locale: &Locale, report: &Report) -> StreetMap {
    report.note(Outcome::Guessed, "streets, from who drove where, for want of a map", &drive.id);
    let kind = road_kind(drive);
    let mut roads: Vec<Road> = Vec::new();
    for line in driven_lines(drive) {
        let known = SegmentIndex::new(roads.iter().map(|r| r.centreline.as_slice()));
        let off_road = line.iter().filter(|p| known.nearest(**p, WIDEST_M / 2.0).is_none());
        if roads.is_empty() || Bounds::around(off_road.copied()).is_some_and(|b| b.size_m().length() > OTHER_ROAD_M) {
            roads.extend(along(&line, kind, drive, locale, roads.len() as i64));
        }
    }
    join(&mut roads);
    let is_street = has_houses(kind);
    let beside = union(&roads.iter().flat_map(|r| strip(&r.centreline, PAVED_M)).collect::<Vec<_>>());
    let paved = |(id, polygon)| Land { id: id as i64, kind: LandKind::Paved, polygon };
    StreetMap {
        land: if is_street { beside.into_iter().enumerate().map(paved).collect() } else { Vec::new() },
        roads,
        ..StreetMap::default()
    }
}

/// Whether houses stand along a road of a kind.
pub(crate) fn has_houses(kind: RoadKind) -> bool {
    (RoadKind::Tertiary..=RoadKind::Minor).contains(&kind)
}

/// By the speed that was reached and the walls that were seen; on a motorway nobody walks.
fn road_kind(drive: &Drive) -> RoadKind {
    let speed_mps = |pair: &[Keyframe]| {
        let [a, b] = [0, 1].map(|i| pair[i].world_from_ego.translation);
        a.distance(b) / ((pair[1].time_ns - pair[0].time_ns) as f64 * 1e-9).max(1e-3)
    };
    let mut speeds: Vec<f64> = drive.keyframes.windows(2).map(speed_mps).collect();
    speeds.sort_by(f64::total_cmp);
    let speed_mps = speeds.get(speeds.len() * 3 / 4).copied().unwrap_or(0.0);
    let is_walked = drive.tracks.iter().any(|t| t.kind.class() == Class::Human);
    match speed_mps {
        v if v > MOTORWAY_MPS && !is_walked => RoadKind::Motorway,
        v if v > OPEN_ROAD_MPS && !is_walked => RoadKind::Secondary,
        _ if !is_built_up(drive) => RoadKind::Secondary,
        _ => RoadKind::Tertiary,
    }
}

/// Whether the LiDAR saw houses, where there was one.
fn is_built_up(drive: &Drive) -> bool {
    let sweeps: Vec<&Keyframe> = drive.keyframes.iter().filter(|k| k.lidar.is_some()).collect();
    let walls: usize = sweeps.iter().map(|k| wall_pieces(k, WALL_REACH_M, WALL_M).len()).sum();
    walls >= LEAST_WALLS * sweeps.len()
}

/// Where vehicles drove, in steps, the recording one first.
fn driven_lines(drive: &Drive) -> Vec<Vec<DVec2>> {
    let mut path = thinned(drive.keyframes.iter().map(|k| k.world_from_ego.translation.truncate()));
    if let ([only], Some(first)) = (path.as_slice(), drive.keyframes.first()) {
        // Whoever stood still tells the direction all the same.
        path = vec![*only, *only + first.world_from_ego.vector(DVec3::X).truncate().normalize_or(DVec2::X) * STEP_M];
    }
    let others = drive.tracks.iter().filter(|t| t.kind.is_car());
    let others = others.map(|t| thinned(t.boxes.iter().map(|(_, c)| c.world_from_body.translation.truncate())));
    std::iter::once(path).chain(others).filter(|line| line.len() > 1).collect()
}

fn thinned(points: impl Iterator<Item = DVec2>) -> Vec<DVec2> {
    let mut line: Vec<DVec2> = Vec::new();
    for p in points.filter(|p| p.is_finite()) {
        if line.last().is_none_or(|last| last.distance(p) >= STEP_M) {
            line.push(p);
        }
    }
    line
}

/// The road that somebody drove along a line on, and its other carriageway if it has one.
fn along(line: &[DVec2], kind: RoadKind, drive: &Drive, locale: &Locale, id: i64) -> Vec<Road> {
    // What lies to the left of the line is positive; the oncoming lane does where traffic keeps right.
    let oncoming = if locale.driving_side.is_left() { -1.0 } else { 1.0 };
    let course = extended(line);
    if kind == RoadKind::Motorway {
        let width_m = 3.0 * 3.6 + 1.0;
        let lanes = |id, centreline| Road {
            oneway: true,
            lanes: Some(3),
            width_m: Some(width_m),
            ..Road::new(id, kind, centreline)
        };
        let mut other = moved(&course, oncoming * (width_m + MEDIAN_M));
        other.reverse();
        return vec![lanes(id, course), lanes(id + 1, other)];
    }
    let own_m = LANE_M / 2.0 + GUTTER_M;
    let mut edges_m = [-own_m, own_m];
    edges_m[usize::from(oncoming > 0.0)] += oncoming * LANE_M;
    for [from_m, to_m] in beside(line, drive) {
        let [low_m, high_m] = [edges_m[0].min(from_m - GUTTER_M), edges_m[1].max(to_m + GUTTER_M)];
        if from_m < edges_m[1] + BESIDE_M && to_m > edges_m[0] - BESIDE_M && high_m - low_m < WIDEST_M {
            edges_m = [low_m, high_m];
        }
    }
    let both = Some(has_houses(kind));
    vec![Road {
        width_m: Some(edges_m[1] - edges_m[0]),
        sidewalk: SidewalkSides { left: both, right: both },
        ..Road::new(id, kind, moved(&course, (edges_m[0] + edges_m[1]) / 2.0))
    }]
}

/// How far to the left of a line the vehicles begin and end that stand or drive along it, the nearest first.
fn beside(line: &[DVec2], drive: &Drive) -> Vec<[f64; 2]> {
    let boxes = drive.keyframes.iter().flat_map(|k| &k.boxes).filter(|b| b.kind.is_car()).map(|b| &b.cuboid);
    let lateral = |cuboid: &Cuboid| {
        let at = cuboid.world_from_body.translation.truncate();
        let (from, ahead) = line
            .windows(2)
            .map(|w| (w[0], (w[1] - w[0]).normalize_or(DVec2::X)))
            .min_by(|a, b| a.0.distance_squared(at).total_cmp(&b.0.distance_squared(at)))?;
        let heading = cuboid.world_from_body.vector(DVec3::X).truncate().normalize_or_zero();
        let left_m = ahead.perp_dot(at - from);
        let half_m = cuboid.size_m.y / 2.0;
        let is_near = (at - from).dot(ahead).abs() < 2.0 * WIDEST_M;
        (heading.dot(ahead).abs() > ALIKE && is_near).then_some([left_m - half_m, left_m + half_m])
    };
    let mut found: Vec<[f64; 2]> = boxes.filter_map(lateral).collect();
    let off_m = |[from, to]: &[f64; 2]| ((from + to) / 2.0).abs();
    found.sort_by(|a, b| off_m(a).total_cmp(&off_m(b)));
    found
}

/// A line with its ends taken straight on.
fn extended(line: &[DVec2]) -> Vec<DVec2> {
    let n = line.len();
    // The last steps together: single ones waver.
    let reach = 3.min(n - 1);
    let before = (line[0] - line[reach]).normalize_or(DVec2::NEG_X);
    let after = (line[n - 1] - line[n - 1 - reach]).normalize_or(DVec2::X);
    let mut extended = vec![line[0] + before * BEYOND_M];
    extended.extend(line);
    extended.push(line[n - 1] + after * BEYOND_M);
    extended
}

/// A line moved to its left.
fn moved(line: &[DVec2], left_m: f64) -> Vec<DVec2> {
    let direction = |i: usize| (line[(i + 1).min(line.len() - 1)] - line[i.saturating_sub(1)]).normalize_or(DVec2::X);
    (0..line.len()).map(|i| line[i] + direction(i).perp() * left_m).collect()
}

/// Gives roads that cross a common vertex there, which makes it a junction.
fn join(roads: &mut [Road]) {
    let mut found: Vec<Vec<(usize, f64, DVec2)>> = vec![Vec::new(); roads.len()];
    for j in 1..roads.len() {
        for i in 0..j {
            for (k, a) in roads[i].centreline.windows(2).enumerate() {
                for (l, b) in roads[j].centreline.windows(2).enumerate() {
                    if let Some((along_a, along_b, p)) = crossing([a[0], a[1]], [b[0], b[1]]) {
                        found[i].push((k, along_a, p));
                        found[j].push((l, along_b, p));
                    }
                }
            }
        }
    }
    for (road, mut crossings) in roads.iter_mut().zip(found) {
        // From the last to the first, so that places before keep their numbers.
        crossings.sort_by(|a, b| b.0.cmp(&a.0).then(b.1.total_cmp(&a.1)));
        for (segment, _, p) in crossings {
            road.centreline.insert(segment + 1, p);
        }
    }
}

/// Where two segments cross: how far along each, 0 to 1, and the place.
fn crossing([a, b]: [DVec2; 2], [c, d]: [DVec2; 2]) -> Option<(f64, f64, DVec2)> {
    let (r, s) = (b - a, d - c);
    let area = r.perp_dot(s);
    if area.abs() < 1e-9 {
        return None;
    }
    let (t, u) = ((c - a).perp_dot(s) / area, (c - a).perp_dot(r) / area);
    ((0.0..1.0).contains(&t) && (0.0..1.0).contains(&u)).then(|| (t, u, a + r * t))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing;
    use trove_model::Kind;

    fn found(drive: &Drive) -> StreetMap {
        assumed(drive, &testing::locale("DE"), &Report::default())
    }

    /// Eastwards at 10 m/s, with a lorry that comes towards it at y = 3.5 and a car that is parked at y = 6.
    fn drive() -> Drive {
        Drive { lane_map: None, ..testing::drive() }
    }

    #[test]
    fn the_street_is_as_wide_as_those_on_it_need_it_and_has_sidewalks() {
        let map = found(&drive());
        assert_eq!(map.roads.len(), 1);
        let road = &map.roads[0];
        let (middle_m, half_m) = (road.centreline[1].y, road.width_m.unwrap() / 2.0);
        assert!((-2.1..=-2.0).contains(&(middle_m - half_m)), "{middle_m} {half_m}");
        assert!((7.0..8.0).contains(&(middle_m + half_m)), "{middle_m} {half_m}");
        assert_eq!((road.kind, road.sidewalk.left), (RoadKind::Tertiary, Some(true)));
        assert!(road.centreline[0].x < -200.0 && road.centreline.last().unwrap().x > 200.0);
        assert!(map.land.iter().any(|l| l.polygon.contains(DVec2::new(20.0, -20.0))));
    }

    #[test]
    fn whoever_drove_across_did_so_on_a_street_of_its_own_that_meets_the_first() {
        let mut drive = drive();
        for (i, (_, cuboid)) in drive.tracks[1].boxes.iter_mut().enumerate() {
            cuboid.world_from_body = trove_model::Pose::from_yaw(1.57, DVec3::new(25.0, 8.0 * i as f64 - 40.0, 0.8));
        }
        let map = found(&drive);
        assert_eq!(map.roads.len(), 2);
        let [a, b] = [0, 1].map(|i| &map.roads[i].centreline);
        assert_eq!(a.iter().filter(|p| b.contains(p)).count(), 1);
    }

    #[test]
    fn whoever_is_fast_drives_on_a_motorway_unless_somebody_walks_there() {
        let mut fast = drive();
        for (i, keyframe) in fast.keyframes.iter_mut().enumerate() {
            keyframe.world_from_ego.translation.x = 15.0 * i as f64;
        }
        assert!(found(&fast).roads.iter().all(|r| r.kind == RoadKind::Tertiary));
        fast.tracks.retain(|t| t.kind != Kind::Adult);
        let map = found(&fast);
        assert_eq!(map.roads.iter().filter(|r| r.kind == RoadKind::Motorway && r.oneway).count(), 2);
        assert!(map.land.is_empty());
        let [own, other] = [0, 1].map(|i| map.roads[i].centreline[1].y);
        assert!(own == 0.0 && other > 12.0, "{own} {other}");
    }

    #[test]
    fn a_single_moment_tells_a_straight_street() {
        let mut still = drive();
        still.keyframes.truncate(1);
        let road = &found(&still).roads[0];
        assert!(road.centreline.iter().all(|p| (p.y - road.centreline[0].y).abs() < 1e-9));
    }
}
