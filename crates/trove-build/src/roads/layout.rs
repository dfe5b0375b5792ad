//! Which piece of the plane is what: carriageway, kerb, pavement.

use glam::DVec2;
use rayon::prelude::*;
use trove_model::{
    Bounds, Cycleway, Drive, DriveOrigin, DrivingSide, LandKind, Outcome, Polygon, Report, Road, RoadKind, StreetMap,
};

use super::corners;
use super::course::{self, Bay, Course};
use super::cross_section::{Band, CrossSection, cross_section};
use super::decks::{self, Deck, Lift, Trench};
use super::evidence::{self, Trace};
use super::houses::Houses;
use super::kerb;
use super::network::{self, BESIDE_M, NEAR, RECORDED, Stretch, resampled};
use crate::geometry::distance_field::DistanceField;
use crate::geometry::path::shifted;
use crate::geometry::plane::{closed, difference, grown, intersection, rectangle, strip, union};
use crate::geometry::plane_raster::PlaneRaster;

/// Width of a sidewalk that the map does not draw.
const SIDEWALK_M: f64 = 2.5;
/// Width of a path in a park.
const FOOTWAY_M: f64 = 1.8;
/// Half of the gaps that are closed between OpenStreetMap's carriageways: nobody builds narrower islands.
const SLIT_M: f64 = 0.4;
/// Roads are looked at this far beyond the place.
const BEYOND_M: f64 = 50.0;
/// Half of the gaps that are closed in a road of which only the driven path is known.
const CORNER_M: f64 = 2.5;
/// Half of the gaps that are closed between carriageway and walkway: what lies between them is paved too.
const GAP_M: f64 = 1.5;
/// A recorded road that more than this share of the recorded traffic left has gaps, usually at junctions; gaps up to
/// twice this radius are closed in it.
const PATCHY_SHARE: f64 = 0.05;
const PATCH_M: f64 = 4.0;
/// Islands in such a road smaller than this are gaps too, m².
const PATCHY_ISLAND_M2: f64 = 250.0;
/// Room on both sides of a vehicle that drove or parked, and the gaps between parked ones that are closed.
const CLEARANCE_M: f64 = 0.5;
const BAY_GAP_M: f64 = 2.0;
/// A vehicle parked this near to the carriageway stands in a bay of it.
const BAY_REACH_M: f64 = 3.0;
/// Room around vehicles on a car park.
const CAR_PARK_M: f64 = 3.0;
/// Islands smaller than this are errors of drawing, m².
const ISLAND_M2: f64 = 1.5;
/// Half of the width of a road of which only the driven path is known.
const PATH_HALF_WIDTH_M: f64 = 3.5;
/// How far such a road goes on before and behind the driven path.
const PATH_BEYOND_M: f64 = 30.0;
/// Half of the width of a path that people were seen on.
const WALKED_HALF_WIDTH_M: f64 = 1.0;
/// A street is built up where a building stands this near.
const BUILT_UP_M: f64 = 40.0;
const BUILT_UP_CELL_M: f64 = 4.0;
/// Width of a track for bicycles beside the carriageway, and the strip between.
const TRACK_M: f64 = 1.8;
const TRACK_OFF_M: f64 = 0.6;

/// The plane, divided; no two areas overlap.
pub(super) struct Layout<'a> {
    pub driving_side: DrivingSide,
    /// What the dataset's map says; within the carriageway.
    pub recorded: PlaneRaster,
    /// Road beyond it.
    pub stretches: Vec<Stretch<'a>>,
    /// Where traffic runs: recorded lanes and stretches.
    pub courses: Vec<Course>,
    pub carriageway: Vec<Polygon>,
    pub kerb: Vec<Polygon>,
    pub pavement: Vec<Polygon>,
    /// Tracks for bicycles, as high as the pavement.
    pub tracks: Vec<Polygon>,
    /// What is left.
    pub land: Vec<Polygon>,
    /// Roads above and below the ground; their solid and open ramps, which belong to none of the areas above; and
    /// where one passes below.
    pub decks: Vec<(Deck<'a>, CrossSection)>,
    pub trenches: Vec<(Trench<'a>, CrossSection)>,
    pub ramps: Vec<Polygon>,
    pub above: Vec<Polygon>,
    /// Where kerbs are dropped; may reach into all of the above.
    pub dropped: Vec<Polygon>,
    /// Where roads lead through houses.
    pub passages: Vec<Polygon>,
    /// Around vehicles that were parked; may reach into all of the above.
    pub car_parks: Vec<Polygon>,
}

/// Divides the plane within `bounds`.
pub(super) fn layout<'a>(
    drive: &Drive,
    map: Option<&'a StreetMap>,
    driving_side: DrivingSide,
    bounds: Bounds,
    lift: &Lift<'_>,
    report: &Report,
) -> Layout<'a> {
    let whole = vec![rectangle(bounds)];
    let lanes = drive.lane_map.as_ref();
    let drivable = lanes.map(|m| union(&[m.drivable.clone(), m.carparks.clone()].concat())).unwrap_or_default();
    let drivable = intersection(&drivable, &whole);
    let mut recorded = PlaneRaster::new(bounds, 0.25);
    recorded.fill(&grown(&drivable, BESIDE_M), NEAR);
    recorded.fill(&drivable, RECORDED);

    // Roads of the map where the recording ends, their corners rounded.
    let on_left = driving_side.is_left();
    let levels = map.map(|m| decks::levels(m, &recorded, bounds.grown(BEYOND_M), lift, report)).unwrap_or_default();
    let houses = Houses::new(map, bounds);
    let stretches = network::stretches(levels.ground, &recorded, &houses, on_left, report);
    let section = |road: &Road| cross_section(road, road.width_m.filter(|w| (2.0..=30.0).contains(w)), on_left);
    let decks: Vec<_> = levels.decks.into_iter().map(|d| (d.clone(), section(d.road))).collect();
    let trenches: Vec<_> = levels.trenches.into_iter().map(|t| (t.clone(), section(t.deck.road))).collect();
    let [ramps, above] = footprints(&decks, &trenches, &whole);
    let nodes = corners::nodes(&stretches);
    let dropped = kerb::dropped(drive, map, &stretches, bounds);
    let bays = course::bays(&stretches, &nodes, &dropped);
    let mut strips: Vec<Polygon> = stretches.par_iter().flat_map_iter(|s| strip(&s.line, s.width_m / 2.0)).collect();
    strips.extend(corners::corners(&nodes, &strips));
    strips.extend(bays.iter().flat_map(Bay::area));
    let mut known = drivable.clone();
    let mut carriageway = union(&[drivable, closed(&union(&strips), SLIT_M)].concat());

    // Vehicles drove and parked on the road, whatever the maps say.
    let traces = evidence::driven(drive);
    if lanes.is_some() && is_patchy(&traces, &recorded) {
        report.note(Outcome::Substituted, "gaps in the recorded drivable area, closed", &drive.id);
        known.extend(traces.iter().flat_map(|t| strip(&t.line, t.half_width_m + CLEARANCE_M)));
        carriageway = closed(&union(&[carriageway, known.clone()].concat()), PATCH_M);
        carriageway = without_specks(carriageway, PATCHY_ISLAND_M2);
    }
    let path = untouched_path(drive, &carriageway);
    if !path.is_empty() {
        report.note(Outcome::Guessed, "road under the driven path that is on no map", &drive.id);
        let strips: Vec<Polygon> = path.iter().flat_map(|line| strip(line, PATH_HALF_WIDTH_M)).collect();
        let strips = closed(&union(&strips), CORNER_M);
        known.extend(strips.iter().cloned());
        carriageway = union(&[carriageway, strips].concat());
    }
    let parked = evidence::parked(drive);
    let lots = map.map(|m| car_parks(m, &recorded, bounds)).unwrap_or_default();
    known.extend(grown(&union(&parked), CLEARANCE_M));
    let carriageway = with_bays(carriageway, &parked, &lots, bounds);
    let passages = houses.passages(stretches.iter().map(|s| (s.line.as_slice(), s.width_m)));
    known.extend(passages.iter().cloned());
    let carriageway = intersection(&houses.left_of(carriageway, &known, bounds), &whole);
    let carriageway = without_islands(without_specks(carriageway, ISLAND_M2), map, bounds);

    // Walkways of the dataset, bands along the other roads, footpaths.
    let mut walks = lanes.map(|m| m.walkways.clone()).unwrap_or_default();
    if lanes.is_some() && walks.is_empty() {
        report.note(Outcome::Guessed, "sidewalks along recorded roads that have none", &drive.id);
        walks.extend(grown(&carriageway, SIDEWALK_M));
        walks.extend(evidence::walked(drive).iter().flat_map(|t| strip(&t.line, WALKED_HALF_WIDTH_M)));
    }
    if let Some(map) = map {
        let built_up = built_up(map, bounds);
        walks.extend(stretches.par_iter().flat_map_iter(|s| bands(s, &built_up)).collect::<Vec<_>>());
        walks.extend(footways(map, &recorded, bounds));
    }
    let walks = union(&walks);
    let walked = closed(&union(&[walks, carriageway.clone()].concat()), GAP_M);

    // A ramp ends where a road begins.
    let ramps = if ramps.is_empty() { ramps } else { difference(&ramps, &carriageway) };
    let whole = if ramps.is_empty() { whole } else { difference(&whole, &ramps) };
    let stones = grown(&carriageway, kerb::STONE_M);
    let kerb = intersection(&difference(&stones, &carriageway), &whole);
    let pavement = intersection(&difference(&walked, &stones), &whole);
    let land = difference(&difference(&whole, &stones), &pavement);
    let tracks = cycle_tracks(&stretches, map, bounds);
    let tracks = if tracks.is_empty() { tracks } else { intersection(&pavement, &union(&tracks)) };
    let pavement = if tracks.is_empty() { pavement } else { difference(&pavement, &tracks) };
    let car_parks = closed(&grown(&union(&parked), CAR_PARK_M), CAR_PARK_M);
    let courses = course::courses(drive, &stretches, &bays);
    Layout {
        driving_side,
        recorded,
        stretches,
        courses,
        carriageway,
        kerb,
        pavement,
        tracks,
        land,
        decks,
        trenches,
        ramps,
        above,
        dropped,
        passages,
        car_parks,
    }
}

/// Whether the recorded traffic left the recorded road for more than it should.
fn is_patchy(traces: &[Trace], recorded: &PlaneRaster) -> bool {
    let points: Vec<DVec2> = traces.iter().flat_map(|t| resampled(&t.line)).collect();
    let off = points.iter().filter(|&&p| recorded.at(p) == NEAR).count();
    off as f64 > PATCHY_SHARE * points.len() as f64
}

/// The map's car parks away from what was recorded.
fn car_parks(map: &StreetMap, recorded: &PlaneRaster, bounds: Bounds) -> Vec<Polygon> {
    let lots = map.land.iter().filter(|l| l.kind == LandKind::Parking).map(|l| &l.polygon);
    let near = |p: &&Polygon| p.bounds().is_some_and(|b| b.overlaps(&bounds));
    lots.filter(near).filter(|p| p.exterior.iter().all(|&v| recorded.at(v) == 0)).cloned().collect()
}

/// The carriageway with bays for the vehicles that were parked beside it, and the car parks that it touches.
fn with_bays(carriageway: Vec<Polygon>, parked: &[Polygon], lots: &[Polygon], bounds: Bounds) -> Vec<Polygon> {
    if parked.is_empty() && lots.is_empty() {
        return carriageway;
    }
    let road_m = DistanceField::to(carriageway.iter().cloned(), bounds, 1.0);
    let beside = |p: &&Polygon| road_m.at(p.centroid()) < BAY_REACH_M;
    let touches = |p: &&Polygon| p.exterior.iter().any(|&v| road_m.at(v) < BAY_REACH_M);
    let bays: Vec<Polygon> = parked.iter().filter(beside).cloned().collect();
    let lots: Vec<Polygon> = lots.iter().filter(touches).cloned().collect();
    let bays = union(&[grown(&union(&bays), CLEARANCE_M), lots].concat());
    if bays.is_empty() {
        return carriageway;
    }
    let road = intersection(&carriageway, &grown(&bays, 4.0 * BAY_GAP_M));
    let filled = closed(&union(&[road, bays.clone()].concat()), BAY_GAP_M);
    let near = intersection(&filled, &grown(&bays, BAY_GAP_M));
    union(&[carriageway, bays, near].concat())
}

/// Without pieces that are too small to be meant, and islands smaller than `least_m2`.
fn without_specks(mut carriageway: Vec<Polygon>, least_m2: f64) -> Vec<Polygon> {
    for polygon in &mut carriageway {
        polygon.holes.retain(|hole| Polygon::simple(hole.clone()).area_m2() > least_m2);
    }
    carriageway.retain(|p| p.area_m2() > ISLAND_M2);
    carriageway
}

/// Stretches of the driven path that lie on no carriageway; a point off it makes a stretch with its neighbours.
fn untouched_path(drive: &Drive, carriageway: &[Polygon]) -> Vec<Vec<DVec2>> {
    // Nobody drove from one standpoint of a made-up drive to the next.
    if drive.origin == DriveOrigin::MadeUp {
        return Vec::new();
    }
    let path: Vec<DVec2> = drive.keyframes.iter().map(|k| k.world_from_ego.translation.truncate()).collect();
    let off: Vec<bool> = path.iter().map(|&p| !carriageway.iter().any(|c| c.contains(p))).collect();
    let mut lines: Vec<Vec<DVec2>> = Vec::new();
    for i in 0..path.len().saturating_sub(1) {
        if !(off[i] || off[i + 1]) {
            continue;
        }
        match lines.last_mut() {
            Some(line) if line.last() == Some(&path[i]) => line.push(path[i + 1]),
            _ => lines.push(vec![path[i], path[i + 1]]),
        }
    }
    // The road did not begin where the recording did; a vehicle that stood still tells its direction.
    if let (true, Some(k)) = (path.len() == 1 && off[0], drive.keyframes.first()) {
        lines.push(vec![path[0], path[0] + k.world_from_ego.vector(glam::DVec3::X).truncate()]);
    }
    for line in &mut lines {
        line.dedup_by(|a, b| a.distance(*b) < 0.5);
        let n = line.len();
        if n > 1 {
            let (start, end) =
                ((line[0] - line[1]).normalize_or_zero(), (line[n - 1] - line[n - 2]).normalize_or_zero());
            line.insert(0, line[0] + start * PATH_BEYOND_M);
            line.push(line[n] + end * PATH_BEYOND_M);
        }
    }
    lines
}

/// Where ramps lie in the place of the ground, and where one passes below decks.
fn footprints(
    decks: &[(Deck<'_>, CrossSection)],
    trenches: &[(Trench<'_>, CrossSection)],
    whole: &[Polygon],
) -> [Vec<Polygon>; 2] {
    let mut areas = [Vec::new(), Vec::new()];
    areas[0].extend(trenches.iter().flat_map(|(trench, section)| trench.footprint(section.width_m)));
    for (deck, section) in decks {
        for (area, part) in areas.iter_mut().zip(deck.footprint(section.width_m)) {
            area.extend(part);
        }
    }
    areas.map(|area| if area.is_empty() { area } else { intersection(&union(&area), whole) })
}

/// The carriageway without the islands that the map has in it.
fn without_islands(carriageway: Vec<Polygon>, map: Option<&StreetMap>, bounds: Bounds) -> Vec<Polygon> {
    let land = map.iter().flat_map(|m| &m.land).filter(|l| l.kind == LandKind::TrafficIsland).map(|l| &l.polygon);
    let islands: Vec<Polygon> = land.filter(|p| p.bounds().is_some_and(|b| b.overlaps(&bounds))).cloned().collect();
    if islands.is_empty() { carriageway } else { difference(&carriageway, &union(&islands)) }
}

/// The sidewalks of a stretch with the cycle tracks in them: as tagged, else on both sides of a street in a built-up
/// place.
fn bands(stretch: &Stretch<'_>, built_up: &PlaneRaster) -> Vec<Polygon> {
    let road = stretch.road;
    let usual = (RoadKind::Primary..=RoadKind::Minor).contains(&road.kind)
        && stretch.line.iter().step_by(10).any(|&p| built_up.at(p) > 0);
    let width_m = |tagged: Option<bool>, cycleway, bay: Option<Band>| {
        let walk_m = if tagged.unwrap_or(usual) { sidewalk_m(road.kind) } else { 0.0 };
        let track_m = if cycleway == Some(Cycleway::Track) { TRACK_OFF_M + TRACK_M } else { 0.0 };
        let bay_m = bay.filter(|_| walk_m + track_m > 0.0).map_or(0.0, |b| b.width_m());
        walk_m + track_m + bay_m
    };
    let [left_bay, right_bay] = stretch.section.bays;
    let left_m = width_m(road.sidewalk.left, road.cycleway.left, left_bay);
    let right_m = width_m(road.sidewalk.right, road.cycleway.right, right_bay);
    if left_m + right_m == 0.0 {
        return Vec::new();
    }
    strip(&shifted(&stretch.line, (left_m - right_m) / 2.0), (stretch.width_m + left_m + right_m) / 2.0)
}

/// Width of a sidewalk that the map does not draw.
fn sidewalk_m(kind: RoadKind) -> f64 {
    match kind {
        RoadKind::Motorway | RoadKind::Trunk | RoadKind::Primary | RoadKind::Secondary => 3.5,
        RoadKind::Tertiary => 3.0,
        _ => SIDEWALK_M,
    }
}

/// Tracks for bicycles beside the carriageway, and ways of their own.
fn cycle_tracks(stretches: &[Stretch<'_>], map: Option<&StreetMap>, bounds: Bounds) -> Vec<Polygon> {
    let beside = |s: &Stretch<'_>| {
        let off_m = s.width_m / 2.0 + TRACK_OFF_M + TRACK_M / 2.0;
        let bay_m = s.section.bays.map(|bay| bay.map_or(0.0, |b| b.width_m()));
        let track = |side: Option<Cycleway>, off_m: f64| {
            let line = (side == Some(Cycleway::Track)).then(|| shifted(&s.line, off_m));
            line.map(|line| strip(&line, TRACK_M / 2.0)).unwrap_or_default()
        };
        [track(s.road.cycleway.left, off_m + bay_m[0]), track(s.road.cycleway.right, -off_m - bay_m[1])].concat()
    };
    let ways = map.iter().flat_map(|m| &m.roads).filter(|r| r.kind == RoadKind::Cycleway && is_level(r));
    let ways = ways.filter(|r| Bounds::around(r.centreline.iter().copied()).is_some_and(|b| b.overlaps(&bounds)));
    stretches.iter().flat_map(beside).chain(ways.flat_map(|r| strip(&r.centreline, walk_width_m(r) / 2.0))).collect()
}

/// Where streets are built up: near a building, or everywhere in a place without any.
fn built_up(map: &StreetMap, bounds: Bounds) -> PlaneRaster {
    let mut raster = PlaneRaster::new(bounds.grown(BUILT_UP_M), BUILT_UP_CELL_M);
    for near in map.buildings.iter().filter_map(|b| b.footprint.bounds()) {
        raster.fill(&[rectangle(near.grown(BUILT_UP_M))], 1);
    }
    if map.buildings.is_empty() {
        raster.fill(&[rectangle(bounds)], 1);
    }
    raster
}

/// Footpaths and cycleways away from what was recorded.
fn footways(map: &StreetMap, recorded: &PlaneRaster, bounds: Bounds) -> Vec<Polygon> {
    map.roads
        .iter()
        .filter(|r| matches!(r.kind, RoadKind::Pedestrian | RoadKind::Cycleway | RoadKind::Footway) && is_level(r))
        .filter(|r| Bounds::around(r.centreline.iter().copied()).is_some_and(|b| b.overlaps(&bounds)))
        .filter(|r| r.centreline.iter().any(|&p| recorded.at(p) == 0))
        .flat_map(|r| strip(&r.centreline, walk_width_m(r) / 2.0))
        .collect()
}

fn is_level(road: &Road) -> bool {
    road.layer == 0 && !road.tunnel && !road.bridge
}

fn walk_width_m(road: &Road) -> f64 {
    let usual_m = if road.kind == RoadKind::Pedestrian { 2.0 * FOOTWAY_M } else { FOOTWAY_M };
    road.width_m.filter(|w| (0.5..=20.0).contains(w)).unwrap_or(usual_m)
}
