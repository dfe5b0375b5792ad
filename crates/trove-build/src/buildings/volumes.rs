//! What is to be built: which outlines and parts, where, and how high.

use trove_model::{Bounds, Building, Outcome, Polygon, Random, Report, RoofShape, Seed};

use crate::plane::{difference, intersection, union};
use crate::roads::{Footing, RoadSurfaces};

/// Height of a storey that is not measured.
pub(super) const STOREY_M: f64 = 3.2;
/// Ground that is left of a building must be at least this much to be built on, m².
const LEAST_M2: f64 = 4.0;
/// A building of which less than this share stands clear of the road is a mistake of one of the maps.
const CLEAR_SHARE: f64 = 0.5;
/// A building that starts this high stands over the road, not on it.
const HEADROOM_M: f64 = 4.0;

/// A prism of a building.
#[derive(Clone, Debug)]
pub(super) struct Volume<'a> {
    pub building: &'a Building,
    pub footprint: Polygon,
    /// Above the ground, metres.
    pub bottom_m: f64,
    /// Where the roof starts.
    pub eaves_m: f64,
    pub top_m: f64,
    pub roof: RoofShape,
}

/// One building: an outline, or the parts that stand for it.
#[derive(Clone, Debug)]
pub(super) struct House<'a> {
    pub building: &'a Building,
    pub volumes: Vec<Volume<'a>>,
}

/// The buildings within `bounds`, standing clear of the road.
pub(super) fn houses<'a>(
    buildings: &[&'a Building],
    keep_clear: &RoadSurfaces,
    bounds: Bounds,
    seed: Seed,
    report: &Report,
) -> Vec<House<'a>> {
    use rayon::prelude::*;
    let inside = |b: &&'a Building| bounds.contains(b.footprint.centroid());
    let (parts, outlines): (Vec<&Building>, Vec<&Building>) =
        buildings.iter().copied().filter(inside).partition(|b| b.part);
    let boxes: Vec<Option<Bounds>> = outlines.iter().map(|b| b.footprint.bounds()).collect();
    let home = |part: &Building| {
        let at = part.footprint.centroid();
        let near = |i: &usize| boxes[*i].is_some_and(|b| b.contains(at)) && outlines[*i].footprint.contains(at);
        (0..outlines.len()).find(near)
    };
    let mut parts_of: Vec<Vec<&Building>> = vec![Vec::new(); outlines.len()];
    let mut alone = Vec::new();
    for part in parts {
        match home(part) {
            Some(i) => parts_of[i].push(part),
            None => alone.push((part, Vec::new())),
        }
    }
    let all: Vec<(&Building, Vec<&Building>)> = outlines.into_iter().zip(parts_of).chain(alone).collect();
    all.into_par_iter()
        .filter_map(|(building, parts)| {
            let mut random = seed.child("height").nth(building.id as u64).random();
            let mut volumes = Vec::new();
            // Parts stand for the outline; what they leave of it is built as the outline says.
            let rest = if parts.is_empty() {
                union(std::slice::from_ref(&building.footprint))
            } else {
                let covered = union(&parts.iter().map(|p| p.footprint.clone()).collect::<Vec<_>>());
                let mut rest = difference(&union(std::slice::from_ref(&building.footprint)), &covered);
                rest.retain(|p| p.area_m2() > 0.1 * building.footprint.area_m2());
                rest
            };
            if rest.is_empty() && parts.is_empty() {
                report.note(Outcome::Dropped, "building without area", name(building));
            }
            let shapes = parts.iter().map(|p| (*p, union(std::slice::from_ref(&p.footprint))));
            for (source, areas) in shapes.chain(std::iter::once((building, rest))) {
                let levels = heights(source, building, &mut random, report);
                for area in areas {
                    for footprint in clear(area, source, keep_clear, report) {
                        volumes.push(Volume { building: source, footprint, ..levels.clone() });
                    }
                }
            }
            (!volumes.is_empty()).then_some(House { building, volumes })
        })
        .collect()
}

/// `osm way 12`; `LiDAR building 3` for one that no map has.
pub(super) fn name(building: &Building) -> String {
    if building.id < super::lidar::FIRST_ID / 2 {
        return format!("LiDAR building {}", building.id - super::lidar::FIRST_ID);
    }
    if building.id < 0 { format!("osm relation {}", -building.id) } else { format!("osm way {}", building.id) }
}

/// What of a footprint stands clear of the road.
fn clear(footprint: Polygon, source: &Building, keep_clear: &RoadSurfaces, report: &Report) -> Vec<Polygon> {
    if footprint.area_m2() < LEAST_M2 {
        report.note(Outcome::Dropped, "building smaller than 4 m²", name(source));
        return Vec::new();
    }
    if source.min_height_m >= HEADROOM_M || !touches_road(&footprint, keep_clear) {
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

/// Whether an edge of the footprint comes to lie on the road, to half a metre.
fn touches_road(footprint: &Polygon, keep_clear: &RoadSurfaces) -> bool {
    footprint.edges().any(|(a, b)| {
        let steps = (a.distance(b) / 0.5).ceil().max(1.0);
        (0..steps as usize).any(|i| keep_clear.footing(a.lerp(b, i as f64 / steps)) == Footing::Carriageway)
    })
}

/// A volume's heights, from its tags, its storeys, or drawn by the kind of building.
fn heights<'a>(source: &'a Building, whole: &Building, random: &mut Random, report: &Report) -> Volume<'a> {
    let area_m2 = source.footprint.area_m2();
    let drawn_m = usual_height_m(kind(source, whole), area_m2, random);
    let roof = source.roof.unwrap_or(if is_house(kind(source, whole)) { RoofShape::Gabled } else { RoofShape::Flat });
    let narrow_m = source.footprint.bounds().map_or(4.0, |b| b.size_m().min_element());
    let usual_roof_m = match roof {
        RoofShape::Flat => 0.0,
        RoofShape::Skillion => narrow_m * 0.2,
        RoofShape::Dome | RoofShape::Onion | RoofShape::Round => narrow_m * 0.5,
        RoofShape::Mansard => STOREY_M,
        _ => narrow_m * 0.35,
    };
    let usual_roof_m = usual_roof_m.min(6.0);
    let bottom_m = source.min_height_m.max(0.0);
    let tagged = source.height_m.filter(|h| h.is_finite() && *h > bottom_m);
    let storeys = source.levels.filter(|l| (0.5..200.0).contains(l)).map(|l| l * STOREY_M);
    let roof_m = source.roof_height_m.filter(|h| h.is_finite() && *h >= 0.0).unwrap_or(usual_roof_m);
    let top_m = tagged.or_else(|| storeys.map(|s| s + roof_m)).unwrap_or_else(|| {
        report.note(Outcome::Guessed, "height of a building, from its kind", name(source));
        drawn_m + roof_m
    });
    let top_m = top_m.max(bottom_m + 2.0);
    // Walls keep two metres at least, unless the part is all roof.
    let eaves_m = (top_m - roof_m).max((bottom_m + 2.0).min(top_m)).max(bottom_m);
    let eaves_m = if source.part && roof != RoofShape::Flat { (top_m - roof_m).max(bottom_m) } else { eaves_m };
    Volume { building: source, footprint: Polygon::default(), bottom_m, eaves_m, top_m, roof }
}

/// The kind that tells most: a part's own, else its building's.
pub(super) fn kind<'a>(source: &'a Building, whole: &'a Building) -> &'a str {
    if matches!(source.kind.as_str(), "yes" | "") { &whole.kind } else { &source.kind }
}

pub(super) fn is_house(kind: &str) -> bool {
    matches!(kind, "house" | "detached" | "semidetached_house" | "bungalow" | "cabin" | "farm")
}

/// A height for a building that has none, metres.
fn usual_height_m(kind: &str, area_m2: f64, random: &mut Random) -> f64 {
    let (low, high) = match kind {
        "garage" | "garages" | "shed" | "carport" | "kiosk" | "roof" | "hut" | "service" | "toilets" => (2.6, 3.4),
        kind if is_house(kind) => (5.0, 8.0),
        "terrace" | "residential" => (8.0, 13.0),
        "apartments" | "dormitory" => (10.0, 22.0),
        "office" | "commercial" | "hotel" => (14.0, 38.0),
        "retail" | "supermarket" => (5.0, 8.0),
        "industrial" | "warehouse" | "hangar" => (7.0, 12.0),
        "church" | "cathedral" | "mosque" | "temple" | "synagogue" => (12.0, 20.0),
        "school" | "university" | "hospital" | "public" | "civic" | "college" => (9.0, 18.0),
        _ if area_m2 < 40.0 => (2.8, 4.0),
        _ if area_m2 < 250.0 => (6.5, 12.0),
        _ => (10.0, 24.0),
    };
    random.range(low, high)
}
