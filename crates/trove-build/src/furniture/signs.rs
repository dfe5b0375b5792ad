//! Signs at junctions, crossings and along the road, each turned to the traffic that it is for.

use std::collections::BTreeMap;

use glam::DVec2;
use trove_model::{CrossingMarking, FurnitureKind, Kind, Parking, Random, Report, Road, RoadKind, Seed, WarrantedSign};

use super::junctions::{Arm, Junction, KerbSearch, kerb_side};
use super::yard::{Source, Wish, Yard};
use crate::geometry::segments::SegmentIndex;
use crate::surroundings::{KERB_STEP_M, KerbPoint};

/// A pole behind the kerb, metres.
const OFF_KERB_M: f64 = 0.6;
/// Signs before a junction stand within this of its middle, and those behind it, metres.
const BEFORE_M: [f64; 2] = [-6.0, -28.0];
const BEHIND_M: [f64; 2] = [6.0, 28.0];
/// A mapped sign at a junction stands within this of it, metres.
const MAPPED_REACH_M: f64 = 28.0;
/// Signs of a road follow one another within this, metres.
const SPACING_M: [f64; 2] = [40.0, 80.0];
/// A speed limit is shown again after this, metres.
const LIMIT_AGAIN_M: f64 = 280.0;
/// A kerb's road is at most this far from it, metres.
const ROAD_REACH_M: f64 = 14.0;
/// A crossing's signs stand this far before it, metres.
const BEFORE_CROSSING_M: f64 = 3.2;
const CROSSING_REACH_M: f64 = 14.0;

/// Signs of priority, entry and crossings, then those along the kerbs.
pub(super) fn place(junctions: &[Junction<'_>], yard: &mut Yard<'_, '_, '_>, seed: Seed, report: &Report) {
    let is_priority = |kind| matches!(kind, FurnitureKind::StopSign | FurnitureKind::GiveWaySign);
    let furniture = yard.around.place.map.iter().flat_map(|m| &m.furniture);
    let mapped: Vec<DVec2> = furniture.filter(|f| is_priority(f.kind)).map(|f| f.position).collect();
    for junction in junctions.iter().filter(|j| j.arms.len() > 2) {
        if !junction.signalled && !mapped.iter().any(|p| p.distance(junction.centre) < MAPPED_REACH_M) {
            priority(junction, yard, report);
        }
        for arm in junction.arms.iter().filter(|a| a.road.oneway && !a.road.roundabout) {
            one_way(junction, arm, yard, report);
        }
    }
    crossings(junctions, yard, report);
    along(yard, seed, report);
}

/// The kerb beside an arm that is meant; a sign that looks at traffic in a direction stands there.
fn at_kerb(
    yard: &mut Yard<'_, '_, '_>,
    junction: &Junction<'_>,
    search: &KerbSearch,
    seen_from: DVec2,
    tags: &[&str],
    report: &Report,
) -> bool {
    let Some(kerb) = junction.kerb(yard.around, search) else { return false };
    let position = kerb.position + kerb.outward * OFF_KERB_M;
    let yaw_rad = (-seen_from).to_angle();
    yard.place(&Wish { kind: Kind::TrafficSign, tags, position, yaw_rad, source: Source::MadeUp }, report)
}

/// Who comes from a lesser road stops or gives way; among equals some stop, and others give way to the right.
fn priority(junction: &Junction<'_>, yard: &mut Yard<'_, '_, '_>, report: &Report) {
    let signs = &yard.locale.signs;
    let Some(main) = junction.arms.iter().map(|a| a.road.kind).min() else { return };
    // A road goes straight on over the junction or ends at it.
    let ends = |arm: &Arm<'_>| !junction.arms.iter().any(|other| other.inward.dot(arm.inward) < -0.8);
    for arm in junction.arms.iter().filter(|a| a.enters) {
        let lesser = arm.road.kind > main;
        let says = match signs.priority {
            WarrantedSign::Stop if arm.road.link => "give-way",
            WarrantedSign::Stop if lesser || ends(arm) => "stop",
            WarrantedSign::GiveWay if lesser => "give-way",
            _ => continue,
        };
        let side = kerb_side(arm.inward, yard.locale.driving_side.is_left());
        let search = KerbSearch { traffic: arm.inward, on_road: arm.end, side, along_m: BEFORE_M };
        at_kerb(yard, junction, &search, arm.inward, &signs.tags(says), report);
    }
}

/// Where a one-way street begins it says so, and where it ends nobody may enter.
fn one_way(junction: &Junction<'_>, arm: &Arm<'_>, yard: &mut Yard<'_, '_, '_>, report: &Report) {
    let on_left = yard.locale.driving_side.is_left();
    let outward = -arm.inward;
    let side = kerb_side(outward, on_left);
    let search = KerbSearch { traffic: outward, on_road: arm.end, side, along_m: BEHIND_M };
    let signs = &yard.locale.signs;
    if arm.enters || !signs.one_way_arrows {
        let says = if arm.enters { "no-entry" } else { "one-way" };
        at_kerb(yard, junction, &search, outward, &signs.tags(says), report);
        return;
    }
    // The arrow looks at those who would turn, and points along the street.
    let crossing = junction.arms.iter().find(|a| a.enters && a.inward.dot(outward).abs() < 0.5);
    let Some(crossing) = crossing else { return };
    let to_left = crossing.inward.perp_dot(outward) > 0.0;
    let says = if to_left { "one-way-left" } else { "one-way" };
    at_kerb(yard, junction, &search, crossing.inward, &signs.tags(says), report);
}

/// Both directions of traffic see a crossing without signals.
fn crossings(junctions: &[Junction<'_>], yard: &mut Yard<'_, '_, '_>, report: &Report) {
    let Some(map) = yard.around.place.map else { return };
    let is_marked = |marking: Option<CrossingMarking>| {
        marking.is_some_and(|m| !matches!(m, CrossingMarking::Unmarked | CrossingMarking::Signals))
    };
    let lines = map.roads.iter().filter(|r| r.kind == RoadKind::Crossing && is_marked(r.crossing));
    let middles = lines.map(|r| r.centreline.iter().sum::<DVec2>() / r.centreline.len() as f64);
    let nodes = map.furniture.iter().filter(|f| f.kind == FurnitureKind::Crossing && is_marked(f.crossing()));
    let tags = yard.locale.signs.tags("crossing");
    for middle in middles.chain(nodes.map(|f| f.position)) {
        let signalled = junctions.iter().any(|j| j.signalled && j.centre.distance(middle) < MAPPED_REACH_M);
        if signalled || !yard.around.place.bounds.contains(middle) {
            continue;
        }
        for kerb in yard.around.kerbs.near(middle, CROSSING_REACH_M) {
            let ahead_m = (middle - kerb.position).dot(kerb.traffic);
            let on_side = kerb.outward.dot(kerb_side(kerb.traffic, yard.locale.driving_side.is_left())) > 0.7;
            let before = (BEFORE_CROSSING_M..BEFORE_CROSSING_M + 2.0).contains(&ahead_m);
            if on_side && before && !yard.has_near(Kind::TrafficSign, kerb.position, 3.0) {
                yard.place_at_kerb(Kind::TrafficSign, &tags, &kerb, Source::MadeUp, report);
            }
        }
    }
}

/// Limits, and where one may park, along the kerbs.
fn along(yard: &mut Yard<'_, '_, '_>, seed: Seed, report: &Report) {
    let roads: Vec<&Road> =
        yard.around.place.map.iter().flat_map(|m| &m.roads).filter(|r| r.kind.is_for_cars()).collect();
    let index = SegmentIndex::new(roads.iter().map(|r| r.centreline.as_slice()));
    let mut shown: BTreeMap<String, Vec<KerbPoint>> = BTreeMap::new();
    for (i, run) in yard.around.kerbs.runs.iter().enumerate() {
        let mut random = seed.nth(i as u64).random();
        let mut at_m = random.range(10.0, SPACING_M[0]);
        while let Some(kerb) = run.get((at_m / KERB_STEP_M) as usize) {
            at_m += random.range(SPACING_M[0], SPACING_M[1]);
            let Some(nearest) = index.nearest(kerb.position, ROAD_REACH_M) else { continue };
            let road = roads[nearest.line];
            if nearest.along.dot(kerb.traffic).abs() < 0.8 || yard.has_near(Kind::TrafficSign, kerb.position, 12.0) {
                continue;
            }
            let to_left = (kerb.position - nearest.position).dot(nearest.along.perp()) > 0.0;
            let name = limit(road, kerb, yard, &mut shown).or_else(|| parking(road, to_left, &mut random));
            if let Some(name) = name {
                let tags = yard.locale.signs.tags(&name);
                yard.place_at_kerb(Kind::TrafficSign, &tags, kerb, Source::MadeUp, report);
            }
        }
    }
}

/// The road's limit, unless it has been shown not long before.
fn limit(
    road: &Road,
    kerb: &KerbPoint,
    yard: &Yard<'_, '_, '_>,
    shown: &mut BTreeMap<String, Vec<KerbPoint>>,
) -> Option<String> {
    if kerb.outward.dot(kerb_side(kerb.traffic, yard.locale.driving_side.is_left())) < 0.7 {
        return None;
    }
    let name = yard.locale.signs.speed_limit(road.speed_limit_kmh?);
    let before = shown.entry(name.clone()).or_default();
    let again =
        before.iter().any(|b| b.position.distance(kerb.position) < LIMIT_AGAIN_M && b.traffic.dot(kerb.traffic) > 0.7);
    if again || !yard.has(Kind::TrafficSign, &yard.locale.signs.tags(&name)) {
        return None;
    }
    before.push(*kerb);
    Some(name)
}

/// Whether one may park on a side of a road, where the map says it; main roads forbid it here and there.
fn parking(road: &Road, to_left: bool, random: &mut Random) -> Option<String> {
    let parking = if to_left { road.parking.left } else { road.parking.right };
    match parking {
        Some(Parking::No) => Some("no-stopping".into()),
        Some(_) => Some("parking".into()),
        None if road.kind <= RoadKind::Residential && random.chance(0.4) => Some("no-stopping".into()),
        None => None,
    }
}
