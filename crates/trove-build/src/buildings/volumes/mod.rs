//! What is to be built: which outlines and parts, where, how high, and what stands beside them.

mod apart;
mod beside;
mod heights;
mod house;
#[cfg(test)]
mod tests;

use rayon::prelude::*;
use trove_model::{
    Bounds, Building, BuildingCustoms, Drive, DriveOrigin, HeightField, Outcome, Polygon, Report, RoofShape, Seed,
};

use self::house::{FAR_M, LEAST_M2};
use crate::geometry::near::Near;
use crate::geometry::plane::{difference, grown, intersection, union};
use crate::geometry::segments::SegmentIndex;
use crate::roads::{Footing, HEADROOM_M, KERB_M, RoadSurfaces};
use crate::surroundings::recorded;
pub(super) use beside::beside;
use heights::{Neighbourhood, heights};
#[cfg(test)]
pub(super) use house::Beside;
pub(super) use house::{FIRST_UNMAPPED_ID, House, Model, STOREY_M, Volume, name};

/// A building of which less than this share stands clear of the road is a mistake of one of the maps.
const CLEAR_SHARE: f64 = 0.5;
/// Walls are this far from what was recorded beside them, metres, and give way by at most this share of their building.
const BESIDE_WALL_M: f64 = 0.4;
const VACATED_SHARE: f64 = 0.1;
/// Height of a passage through a building, of what stands beside it, and how much of the building either side is where
/// nothing else tells that it is one, metres.
const PASSAGE_M: f64 = 4.2;
const UNDER_M: f64 = PASSAGE_M - 0.01;
const PASSAGE_SIDE_SHARE: f64 = 0.08;
/// So much of what a road takes of a building lies where it leads through it.
const LED_THROUGH_SHARE: f64 = 0.8;
/// An outline without a part on it is built only if it is this share of the whole.
const REST_SHARE: f64 = 0.1;
/// Posts of a canopy stand this far in from its edge and at most this far apart, metres.
const POST_INSET_M: f64 = 0.5;
const POSTS_APART_M: f64 = 6.0;
/// Eaves are seen up to this distance from the driven path, metres.
pub(super) const EAVES_SEEN_M: f64 = 250.0;
/// Under a building on less than this the ground counts as level, metres.
const LEAST_SLOPE_M: f64 = 1.5;
/// The ground below a building is looked at in these steps, metres.
const GROUND_STEP_M: f64 = 4.0;

/// What the buildings of a place are made in view of.
pub(super) struct Plot<'a> {
    pub drive: &'a Drive,
    pub customs: &'a BuildingCustoms,
    pub streets: &'a RoadSurfaces,
    pub ground: &'a HeightField,
    pub bounds: Bounds,
    /// For each building what the LiDAR saw of its walls, above the ground.
    pub seen_m: &'a [Option<f64>],
}

/// The buildings within the plot, standing clear of the road and of each other; what stands beside them is not told yet.
pub(super) fn houses<'a>(buildings: &[&'a Building], plot: &Plot<'a>, seed: Seed, report: &Report) -> Vec<House<'a>> {
    let around = Neighbourhood::new(buildings, plot.customs);
    let path: Vec<_> = plot.drive.keyframes.iter().map(|k| k.world_from_ego.translation.truncate()).collect();
    let path = SegmentIndex::new([[path.as_slice(), &path[path.len().saturating_sub(1)..]].concat().as_slice()]);
    let recorded: Vec<Polygon> = recorded(plot.drive).collect();
    let mut houses: Vec<House<'a>> = grouped(buildings, plot)
        .into_par_iter()
        .filter_map(|(whole, seen_m, parts)| {
            let mut random = seed.child("height").nth(whole.id as u64).random();
            let mut shapes = shapes(whole, seen_m, &parts, &around, &mut random, report);
            let mut volumes = Vec::new();
            for shape in &mut shapes {
                let whole = std::mem::take(&mut shape.footprint);
                let left = clear(whole.clone(), shape, plot.streets, report);
                let left: Vec<Polygon> = left.into_iter().flat_map(|p| vacated(p, shape, &recorded, report)).collect();
                let upper = is_passage(&whole, &left, shape, plot).then(|| {
                    report.note(
                        Outcome::Guessed,
                        "passage through a building where a road crosses it",
                        name(shape.building),
                    );
                    let upper = Volume { footprint: whole, bottom_m: PASSAGE_M, ..shape.clone() };
                    *shape = Volume {
                        is_built_on: true,
                        ..Volume::new(shape.building, 0.0, UNDER_M, UNDER_M, RoofShape::Flat)
                    };
                    upper
                });
                let lower = left.into_iter().map(|footprint| Volume { footprint, ..shape.clone() });
                for volume in lower.chain(upper) {
                    let posts = if volume.is_canopy { posts(&volume.footprint, plot.streets) } else { Vec::new() };
                    let footprint = without_straight_points(volume.footprint);
                    volumes.push(Volume { footprint, posts, ..volume });
                }
            }
            let [lowest_m, highest_m] = ground_m(&volumes, plot.ground);
            rise(&mut volumes, highest_m - lowest_m);
            let floor_m = lowest_m + KERB_M;
            let near = path.nearest(whole.footprint.centroid(), FAR_M + 100.0);
            let reach_m = whole.footprint.bounds().map_or(0.0, |b| b.size_m().length() / 2.0);
            let path_m = near.map_or(FAR_M, |n| (n.distance_m - reach_m).max(0.0));
            let customs = plot.customs;
            (!volumes.is_empty()).then_some(House { building: whole, volumes, floor_m, path_m, customs, model: None })
        })
        .collect();
    apart::apart(&mut houses, report);
    houses.retain(|h| !h.volumes.is_empty());
    houses
}

/// Outlines with what was seen of them and the parts that lie in them; a part in none is a building of its own.
fn grouped<'a>(buildings: &[&'a Building], plot: &Plot<'_>) -> Vec<(&'a Building, Option<f64>, Vec<&'a Building>)> {
    let inside = |(_, b): &(usize, &'a Building)| plot.bounds.contains(b.footprint.centroid());
    let all = buildings.iter().copied().enumerate().filter(inside);
    let (parts, outlines): (Vec<_>, Vec<_>) = all.partition(|(_, b)| b.part);
    let near = Near::new(outlines.iter().map(|(_, b)| b.footprint.bounds()));
    let seen_m = |i: usize| plot.seen_m.get(i).copied().flatten();
    let mut found: Vec<_> = outlines.iter().map(|&(i, b)| (b, seen_m(i), Vec::new())).collect();
    for (i, part) in parts {
        let at = a_point_within(&part.footprint);
        let holds = |&o: &usize| outlines[o].1.footprint.contains(at);
        let area_m2 = |o: &usize| outlines[*o].1.footprint.area_m2();
        let homes = near.at(Bounds { min: at, max: at }).filter(holds);
        match homes.min_by(|a, b| area_m2(a).total_cmp(&area_m2(b)).then(a.cmp(b))) {
            Some(home) => found[home].2.push(part),
            None => found.push((part, seen_m(i), Vec::new())),
        }
    }
    found
}

/// A point inside a polygon: its centroid, or beside the middle of an edge.
fn a_point_within(polygon: &Polygon) -> glam::DVec2 {
    let centroid = polygon.centroid();
    if polygon.contains(centroid) {
        return centroid;
    }
    let inside = |(a, b): (glam::DVec2, glam::DVec2)| {
        let turn = (b - a).normalize_or_zero().perp() * 0.2;
        let middle = (a + b) / 2.0;
        [middle + turn, middle - turn].into_iter().find(|&p| polygon.contains(p))
    };
    polygon.edges().find_map(inside).unwrap_or(centroid)
}

/// The volumes of a building before anything is cut off them, a footprint each.
fn shapes<'a>(
    whole: &'a Building,
    seen_m: Option<f64>,
    parts: &[&'a Building],
    around: &Neighbourhood,
    random: &mut trove_model::Random,
    report: &Report,
) -> Vec<Volume<'a>> {
    let sound = |b: &Building| union(std::slice::from_ref(&b.footprint));
    let mut volumes: Vec<Volume<'a>> = Vec::new();
    for part in parts {
        let levels = heights(part, whole, around, seen_m, random, report);
        volumes.extend(sound(part).into_iter().map(|footprint| Volume { footprint, ..levels.clone() }));
    }
    // Parts stand for the outline; what they leave of it is built as the outline says, but not above the parts.
    let mut rest = sound(whole);
    if !parts.is_empty() {
        let covered: Vec<Polygon> = volumes.iter().map(|v| v.footprint.clone()).collect();
        rest = difference(&rest, &union(&covered));
        rest.retain(|p| p.area_m2() > REST_SHARE * whole.footprint.area_m2());
    }
    if rest.is_empty() && parts.is_empty() {
        report.note(Outcome::Dropped, "building without area", name(whole));
    }
    if !rest.is_empty() {
        let mut levels = heights(whole, whole, around, seen_m, random, report);
        let mut tops: Vec<f64> = volumes.iter().map(|v| v.top_m).collect();
        tops.sort_by(f64::total_cmp);
        if let Some(&middle_m) = tops.get(tops.len().saturating_sub(1) / 2).filter(|m| **m < levels.top_m) {
            levels = Volume::new(whole, levels.bottom_m.min(middle_m), middle_m, middle_m, RoofShape::Flat);
        }
        volumes.extend(rest.into_iter().map(|footprint| Volume { footprint, ..levels.clone() }));
    }
    volumes
}

/// What of a footprint stands clear of the road.
fn clear(footprint: Polygon, volume: &Volume<'_>, keep_clear: &RoadSurfaces, report: &Report) -> Vec<Polygon> {
    let source = volume.building;
    if footprint.area_m2() < LEAST_M2 && volume.bottom_m <= 0.0 {
        report.note(Outcome::Dropped, "building smaller than 4 m²", name(source));
        return Vec::new();
    }
    if volume.bottom_m >= HEADROOM_M || !touches_road(&footprint, keep_clear) {
        return vec![footprint];
    }
    let before_m2 = footprint.area_m2();
    let road = keep_clear.carriageway_near(&footprint);
    let whole = [footprint];
    let on_road = intersection(&whole, &road);
    let on_road_m2: f64 = on_road.iter().map(Polygon::area_m2).sum();
    if on_road_m2 > (1.0 - CLEAR_SHARE) * before_m2 {
        report.note(Outcome::Dropped, "building that stands on the road", name(source));
        return Vec::new();
    }
    report.note(Outcome::Substituted, "building cut where it stands on the road", name(source));
    let mut left = difference(&whole, &road);
    left.retain(|p| p.area_m2() >= LEAST_M2);
    left
}

/// What of a footprint nobody was recorded in: maps are some decimetres off, and people walk along walls. A building that
/// would lose much stays, since it must have been entered.
fn vacated(footprint: Polygon, volume: &Volume<'_>, recorded: &[Polygon], report: &Report) -> Vec<Polygon> {
    let Some(bounds) = footprint.bounds().filter(|_| volume.bottom_m < HEADROOM_M) else { return vec![footprint] };
    let is_inside = |p: &&Polygon| {
        p.bounds().is_some_and(|b| b.overlaps(&bounds)) && p.exterior.iter().any(|&v| footprint.contains(v))
    };
    let inside: Vec<Polygon> = recorded.iter().filter(is_inside).cloned().collect();
    if inside.is_empty() {
        return vec![footprint];
    }
    let whole_m2 = footprint.area_m2();
    let mut left = difference(std::slice::from_ref(&footprint), &grown(&union(&inside), BESIDE_WALL_M));
    left.retain(|p| p.area_m2() >= LEAST_M2);
    if left.iter().map(Polygon::area_m2).sum::<f64>() < (1.0 - VACATED_SHARE) * whole_m2 {
        report.note(Outcome::Warned, "building with recorded objects in it", name(volume.building));
        return vec![footprint];
    }
    report.note(Outcome::Substituted, "building cut where something was recorded", name(volume.building));
    left
}

/// Whether a road goes through a building, which goes on above it: it leads through it or parts a high one in two, and
/// nobody drove there.
fn is_passage(whole: &Polygon, left: &[Polygon], volume: &Volume<'_>, plot: &Plot<'_>) -> bool {
    let left_m2: f64 = left.iter().map(Polygon::area_m2).sum();
    let cut_m2 = whole.area_m2() - left_m2;
    let is_high = volume.bottom_m <= 0.0 && volume.eaves_m > PASSAGE_M + STOREY_M && !volume.is_canopy;
    if left.is_empty() || cut_m2 < LEAST_M2 || !is_high {
        return false;
    }
    let is_large = |p: &&Polygon| p.area_m2() > PASSAGE_SIDE_SHARE * whole.area_m2();
    let leads_through = || {
        let through = intersection(std::slice::from_ref(whole), &plot.streets.passages_near(whole));
        through.iter().map(Polygon::area_m2).sum::<f64>() > LED_THROUGH_SHARE * cut_m2
    };
    let is_recorded = plot.drive.origin == DriveOrigin::Recorded;
    let path = || plot.drive.keyframes.iter().map(|k| k.world_from_ego.translation.truncate());
    let was_driven = is_recorded && path().any(|p| whole.contains(p));
    !was_driven && (left.iter().filter(is_large).count() > 1 || leads_through())
}

/// Whether an edge of the footprint comes to lie on the road, to half a metre.
fn touches_road(footprint: &Polygon, keep_clear: &RoadSurfaces) -> bool {
    footprint.edges().any(|(a, b)| {
        let steps = (a.distance(b) / 0.5).ceil().max(1.0);
        (0..steps as usize).any(|i| keep_clear.footing(a.lerp(b, i as f64 / steps)) == Footing::Carriageway)
    })
}

/// Where the posts of a canopy stand: a little within its corners and along its edges, off the road.
fn posts(footprint: &Polygon, streets: &RoadSurfaces) -> Vec<glam::DVec2> {
    let inner = grown(std::slice::from_ref(footprint), -POST_INSET_M);
    let mut posts: Vec<glam::DVec2> = Vec::new();
    for (a, b) in inner.iter().flat_map(Polygon::edges) {
        let steps = (a.distance(b) / POSTS_APART_M).ceil().max(1.0);
        for i in 0..steps as usize {
            let at = a.lerp(b, i as f64 / steps);
            let off_road = !matches!(streets.footing(at), Footing::Carriageway | Footing::Water);
            if off_road && posts.iter().all(|p| p.distance(at) > POSTS_APART_M / 3.0) {
                posts.push(at);
            }
        }
    }
    posts
}

/// Makes a house higher where the slope that it stands on would bury it, so that what rises above the slope's upper side
/// is a storey at least; what hangs above the ground rises with it.
fn rise(volumes: &mut [Volume<'_>], slope_m: f64) {
    let lowest_eaves_m = volumes.iter().map(|v| v.eaves_m).fold(f64::INFINITY, f64::min);
    let by_m = slope_m + STOREY_M - KERB_M - lowest_eaves_m;
    if slope_m < LEAST_SLOPE_M || by_m <= 0.0 || !by_m.is_finite() {
        return;
    }
    for volume in volumes {
        volume.eaves_m += by_m;
        volume.top_m += by_m;
        if volume.bottom_m > 0.0 {
            volume.bottom_m += by_m;
        }
    }
}

/// Lowest and highest height of the ground around some volumes.
fn ground_m(volumes: &[Volume<'_>], ground: &HeightField) -> [f64; 2] {
    let edges = volumes.iter().flat_map(|v| v.footprint.edges());
    let along = edges.flat_map(|(a, b)| {
        let steps = (a.distance(b) / GROUND_STEP_M).ceil().max(1.0) as usize;
        (0..steps).map(move |i| a.lerp(b, i as f64 / steps as f64))
    });
    let heights_m = along.map(|p| ground.height_m(p));
    heights_m.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], z| [low.min(z), high.max(z)])
}

/// Without the points that lie on the line of their neighbours, to a millimetre.
fn without_straight_points(mut polygon: Polygon) -> Polygon {
    let tidy = |ring: &mut Vec<glam::DVec2>| {
        let mut i = 0;
        while ring.len() > 3 && i < ring.len() {
            let n = ring.len();
            let [a, b, c] = [ring[(i + n - 1) % n], ring[i], ring[(i + 1) % n]];
            let along = (c - a).normalize_or_zero();
            if (b - a).perp_dot(along).abs() < 1e-3 && (b - a).dot(along) > 0.0 && (c - b).dot(along) > 0.0 {
                ring.remove(i);
            } else {
                i += 1;
            }
        }
    };
    tidy(&mut polygon.exterior);
    polygon.holes.iter_mut().for_each(tidy);
    polygon
}
