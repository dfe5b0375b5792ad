//! How high a building is, and what roof it has: by its tags, its neighbours, its kind and where it stands.

use std::collections::HashMap;

use glam::DVec2;
use trove_model::{
    Building, BuildingCustoms, BuildingKind, Outcome, Polygon, Random, Report, RoofShape, RoofShare, weighted_at,
};

use super::house::{CANOPY_THICK_M, Volume, kind, name};

/// Buildings this near tell what is usual here, metres.
const NEAR_M: f64 = 130.0;
/// So many of them make a rule.
const LEAST_NEIGHBOURS: usize = 4;
/// Of like size is what has up to so many times the area.
const LIKE_SIZE: f64 = 3.0;
/// A pitched roof's usual slope, rise over run.
const USUAL_SLOPE: f64 = 0.75;
/// No guessed roof is higher, metres.
const HIGHEST_ROOF_M: f64 = 7.0;
/// A part is at least this thick, metres; a building that is guessed at least this high.
const THINNEST_M: f64 = 0.2;
const LOWEST_M: f64 = 2.2;

/// Heights that the map tells, to guess the others from.
pub(super) struct Neighbourhood<'c> {
    customs: &'c BuildingCustoms,
    // Only looked up; what is found is sorted.
    cells: HashMap<[i64; 2], Vec<Known>>,
}

#[derive(Clone, Copy)]
struct Known {
    at: DVec2,
    group: Group,
    area_m2: f64,
    walls_m: f64,
}

/// Kinds that are of like height.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Group {
    House,
    Outbuilding,
    Dwelling,
    Work,
    Hall,
    Special,
    Any,
}

impl Group {
    fn of(kind: Option<BuildingKind>) -> Self {
        use BuildingKind as K;
        match kind {
            Some(K::House | K::Bungalow) => Self::House,
            Some(K::Canopy | K::Carport | K::Garage | K::Shed | K::Kiosk | K::Hut | K::Service | K::Greenhouse) => {
                Self::Outbuilding
            }
            Some(K::Apartments | K::Residential | K::Terrace) => Self::Dwelling,
            Some(K::Office | K::Commercial | K::Hotel | K::Public) => Self::Work,
            Some(K::Industrial | K::Warehouse | K::Hangar | K::Retail | K::Supermarket) => Self::Hall,
            Some(K::Worship | K::Chapel | K::Stadium) => Self::Special,
            Some(K::School | K::University | K::Hospital | K::Transport | K::Parking | K::Construction | K::Other)
            | None => Self::Any,
        }
    }
}

impl<'c> Neighbourhood<'c> {
    /// What the map tells of these buildings.
    pub(super) fn new(buildings: &[&Building], customs: &'c BuildingCustoms) -> Self {
        let mut cells: HashMap<[i64; 2], Vec<Known>> = HashMap::new();
        for building in buildings {
            let Some(walls_m) = known_walls_m(building) else { continue };
            let at = building.footprint.centroid();
            let area_m2 = building.footprint.area_m2();
            cells.entry(cell(at)).or_default().push(Known { at, group: Group::of(building.kind), area_m2, walls_m });
        }
        Self { customs, cells }
    }

    /// The usual height of walls of buildings of like kind and size nearby, and half the spread of their middle half;
    /// `None` where too few are known.
    fn usual_walls_m(&self, footprint: &Polygon, kind: Option<BuildingKind>) -> Option<(f64, f64)> {
        let (at, area_m2, group) = (footprint.centroid(), footprint.area_m2(), Group::of(kind));
        let [x, y] = cell(at);
        let like = |k: &&Known| {
            let size = k.area_m2 / area_m2;
            k.group == group && (1.0 / LIKE_SIZE..LIKE_SIZE).contains(&size) && k.at.distance(at) < NEAR_M
        };
        let around = (x - 1..=x + 1).flat_map(|x| (y - 1..=y + 1).map(move |y| [x, y]));
        let mut found: Vec<f64> =
            around.filter_map(|c| self.cells.get(&c)).flatten().filter(like).map(|k| k.walls_m).collect();
        found.sort_by(f64::total_cmp);
        let quarter = |n: usize| found[(found.len() - 1) * n / 4];
        (found.len() >= LEAST_NEIGHBOURS).then(|| (quarter(2), (quarter(3) - quarter(1)) / 2.0))
    }
}

fn cell(p: DVec2) -> [i64; 2] {
    let cell = (p / NEAR_M).floor();
    [cell.x as i64, cell.y as i64]
}

/// Height of a building's walls, where its tags tell.
fn known_walls_m(building: &Building) -> Option<f64> {
    let roof_m = building.roof_height_m.unwrap_or(0.0);
    let tagged = tagged_height_m(building).map(|h| h - roof_m);
    tagged.or_else(|| tagged_levels(building).map(|l| l * storey_m(building.kind))).filter(|h| *h > 1.0)
}

fn tagged_height_m(building: &Building) -> Option<f64> {
    building.height_m.filter(|h| h.is_finite() && *h > building.min_height_m)
}

fn tagged_levels(building: &Building) -> Option<f64> {
    building.levels.filter(|l| (0.5..200.0).contains(l))
}

/// Height of a storey that is not measured, metres.
fn storey_m(kind: Option<BuildingKind>) -> f64 {
    match Group::of(kind) {
        Group::House | Group::Outbuilding => 2.8,
        Group::Dwelling | Group::Any => 3.1,
        Group::Work => 3.7,
        Group::Hall => 4.5,
        Group::Special => 5.0,
    }
}

/// A volume's heights and roof; its footprint and surroundings are still to be filled in.
pub(super) fn heights<'a>(
    source: &'a Building,
    whole: &Building,
    around: &Neighbourhood,
    seen_m: Option<f64>,
    random: &mut Random,
    report: &Report,
) -> Volume<'a> {
    let kind = kind(source, whole);
    let is_canopy = kind.is_some_and(BuildingKind::is_canopy);
    // Both are drawn first, so that the draws do not depend on the tags.
    let (drawn, shape_drawn) = (random.unit(), random.unit());
    let bottom_m = source.min_height_m.max(0.0);
    let tagged = tagged_height_m(source)
        .or_else(|| tagged_height_m(whole).filter(|_| source.part && tagged_levels(source).is_none()));
    let storeys = tagged_levels(source).map(|l| l * storey_m(kind));
    let guessed_walls_m = || -> f64 {
        let (walls_m, what) = match around.usual_walls_m(&source.footprint, kind) {
            Some((usual_m, spread_m)) => {
                let spread_m = spread_m.clamp(0.04 * usual_m, 0.2 * usual_m);
                (usual_m + spread_m * (2.0 * drawn - 1.0), "height of a building, from its neighbours")
            }
            None => {
                let [low, high] = usual_walls_m(kind, source.footprint.area_m2(), around.customs);
                (low + (high - low) * drawn, "height of a building, from its kind")
            }
        };
        report.note(Outcome::Guessed, what, name(source));
        walls_m
    };
    let (tagged_top_m, mut walls_m) = match (tagged, storeys) {
        (Some(top_m), _) => (Some(top_m), top_m - bottom_m),
        (None, Some(storeys_m)) => (None, storeys_m),
        (None, None) => {
            let guessed_m = bottom_m + guessed_walls_m();
            match seen_m.filter(|seen_m| *seen_m > guessed_m) {
                Some(seen_m) => {
                    report.note(Outcome::Guessed, "height of a building, raised to LiDAR points", name(source));
                    (None, seen_m)
                }
                None => (None, guessed_m),
            }
        }
    };
    let roof = source.roof.unwrap_or_else(|| {
        let shape = if source.part || is_canopy {
            RoofShape::Flat
        } else {
            usual_roof(kind, source, walls_m, around.customs, shape_drawn)
        };
        if shape != RoofShape::Flat {
            report.note(Outcome::Guessed, "roof of a building, from its kind and region", name(source));
        }
        shape
    });
    let width_m = width_m(&source.footprint);
    let usual_roof_m = match roof {
        RoofShape::Flat => 0.0,
        RoofShape::Skillion => width_m * 0.18,
        RoofShape::Dome | RoofShape::Round => width_m * 0.5,
        RoofShape::Onion => width_m * 0.9,
        RoofShape::Cone | RoofShape::Pyramidal if source.part => width_m * 0.7,
        RoofShape::Mansard | RoofShape::Gambrel => (width_m * 0.4).max(storey_m(kind)),
        _ => width_m / 2.0 * USUAL_SLOPE,
    };
    let by_levels_m = source.roof_levels.filter(|l| *l > 0.0 && roof != RoofShape::Flat).map(|l| l * 2.7);
    let tagged_roof_m = source.roof_height_m.filter(|h| h.is_finite() && *h >= 0.0).or(by_levels_m);
    let roof_m = tagged_roof_m.unwrap_or_else(|| usual_roof_m.min(HIGHEST_ROOF_M));
    let top_m = match tagged_top_m {
        Some(top_m) => top_m.max(bottom_m + THINNEST_M),
        None => {
            walls_m = walls_m.max(if bottom_m > 0.0 { THINNEST_M } else { LOWEST_M });
            bottom_m.max(walls_m) + if bottom_m >= walls_m { LOWEST_M } else { 0.0 } + roof_m
        }
    };
    // Walls keep two metres at least, unless the part is all roof.
    let least_walls_m = if source.part { 0.0 } else { 2.0 };
    let eaves_m =
        if roof == RoofShape::Flat { top_m } else { (top_m - roof_m).max((bottom_m + least_walls_m).min(top_m)) };
    let mut volume = Volume::new(source, bottom_m, eaves_m, top_m, roof);
    if is_canopy && !source.part {
        volume.bottom_m = volume.bottom_m.max(eaves_m - CANOPY_THICK_M);
        volume.is_canopy = true;
    }
    volume
}

/// The shorter side of the rectangle of the same area and circumference: the width of a wing of any outline, metres.
fn width_m(footprint: &Polygon) -> f64 {
    let half_m = footprint.edges().map(|(a, b)| a.distance(b)).sum::<f64>() / 2.0;
    let area_m2 = footprint.area_m2();
    let square = half_m * half_m - 4.0 * area_m2;
    if square > 0.0 { (half_m - square.sqrt()) / 2.0 } else { area_m2.sqrt() }
}

/// Walls' height of a building of which nothing is known, from and to, metres.
fn usual_walls_m(kind: Option<BuildingKind>, area_m2: f64, customs: &BuildingCustoms) -> [f64; 2] {
    use BuildingKind as K;
    let dense = customs.tall_homes;
    match kind {
        Some(K::Carport) => [2.5, 2.9],
        Some(K::Canopy) => [4.4, 5.2],
        Some(K::Garage | K::Shed | K::Kiosk | K::Hut | K::Service) => [2.6, 3.4],
        Some(K::Bungalow) => [2.8, 3.4],
        Some(K::House) => [5.0, 7.0],
        Some(K::Terrace) => [6.0, 9.5],
        Some(K::Residential | K::Apartments) if dense => [14.0, 30.0],
        Some(K::Residential) => [8.0, 13.0],
        Some(K::Apartments) => [12.0, 21.0],
        Some(K::Office | K::Commercial | K::Hotel) => [14.0, 38.0],
        Some(K::Retail | K::Supermarket) => [5.0, 8.0],
        Some(K::Industrial | K::Warehouse | K::Hangar) => [7.0, 12.0],
        Some(K::Worship) => [10.0, 16.0],
        Some(K::School | K::University | K::Hospital | K::Public) => [9.0, 18.0],
        Some(K::Transport | K::Chapel | K::Stadium | K::Parking | K::Greenhouse | K::Construction | K::Other)
        | None => match area_m2 {
            small if small < 40.0 => [2.8, 4.0],
            middling if middling < 250.0 && dense => [9.0, 18.0],
            middling if middling < 250.0 => [6.5, 12.0],
            _ => [10.0, 24.0],
        },
    }
}

/// The roof that a building of some kind usually has where it stands.
fn usual_roof(
    kind: Option<BuildingKind>,
    source: &Building,
    walls_m: f64,
    customs: &BuildingCustoms,
    drawn: f64,
) -> RoofShape {
    let (area_m2, width_m) = (source.footprint.area_m2(), width_m(&source.footprint));
    let pick = |shares: &[RoofShare]| {
        let flat = 1.0 - shares.iter().map(|roof| roof.share).sum::<f64>();
        let weights = shares.iter().map(|roof| roof.share).chain([flat]);
        weighted_at(drawn, weights).and_then(|i| shares.get(i)).map_or(RoofShape::Flat, |roof| roof.shape)
    };
    let gabled = |share| pick(&[RoofShare { shape: RoofShape::Gabled, share }]);
    if !source.footprint.holes.is_empty() && !customs.pitched_courtyards || width_m < 3.0 {
        return RoofShape::Flat;
    }
    match Group::of(kind) {
        Group::House => pick(&customs.house_roofs),
        Group::Dwelling | Group::Any if walls_m < 24.0 && width_m < 18.0 && area_m2 > 60.0 => {
            let is_small = walls_m < 8.0 && area_m2 < 200.0;
            pick(if is_small { &customs.small_home_roofs } else { &customs.home_roofs })
        }
        Group::Hall if width_m < 30.0 && kind.is_some_and(BuildingKind::is_works) => gabled(0.3),
        Group::Special => gabled(0.8),
        _ => RoofShape::Flat,
    }
}
