//! Which fences, walls and guard rails there are: those of the map, and by rule along kerbs and around building sites.

use glam::DVec2;
use trove_model::{BarrierStyle, Kind, LandKind, LineKind, MapLine, Outcome, Random, Report, Road, RoadKind, Seed};

use super::boundaries;
use super::layer::{Layer, ROAD_REACH_M, Run};
use super::yard::Yard;
use crate::geometry::segments::SegmentIndex;
use crate::pieces::Piece;
use crate::surroundings::{KERB_STEP_M, KerbPoint};

/// Guard rails and railings behind the kerb, metres.
const GUARD_OFF_KERB_M: f64 = 0.6;
const RAILING_OFF_KERB_M: f64 = 0.4;
/// Railings run this far with gaps of as much, on this share of the kerbs of main roads, metres.
const RAILING_RUN_M: [f64; 2] = [14.0, 40.0];
const RAILING_SHARE: f64 = 0.4;
/// Cameras stay as far from railings and hoardings as from what is so wide to each side, metres.
const WIDE_M: f64 = 0.5;
/// Walls and fences whose height the map lacks are this share of their model's.
const HEIGHTS: [f64; 2] = [0.7, 1.0];

/// Everything along lines: mapped, then by rule along the kerbs and around building sites.
pub(super) fn place(yard: &mut Yard<'_, '_, '_>, seed: Seed, report: &Report) -> Vec<Piece> {
    let Some(map) = yard.around.place.map else { return Vec::new() };
    let mut layer = Layer::new(yard, map, seed);
    for line in &map.lines {
        let mut random = seed.child("line").nth(line.id as u64).random();
        if let Some((kind, tags, height)) = model(line, &mut random) {
            let facing_road = layer.traffic_on_the_right(line.line.clone());
            layer.lay(&Run { kind, tags, line: &facing_road, scale: height, in_sight_m: None }, report);
        }
    }
    for site in map.land.iter().filter(|l| l.kind == LandKind::Construction) {
        let mut ring = site.polygon.exterior.clone();
        ring.extend(site.polygon.exterior.first());
        let makes = [&["fence", "hoarding"], &["fence", "pasted"], &["fence", "site"], &["fence", "site"]];
        let tags = makes[seed.nth(site.id as u64).random().index(makes.len())];
        layer.lay(&Run { kind: Kind::Fence, tags, line: &ring, scale: 1.0, in_sight_m: Some(WIDE_M) }, report);
        report.note(Outcome::Guessed, "fence around a building site", format_args!("osm {}", site.id));
    }
    along_kerbs(&mut layer, seed, report);
    boundaries::along_sidewalks(&mut layer, seed.child("boundary"), report);
    layer.take()
}

/// Guard rails along motorways, railings along the sidewalks of main roads where the region has them.
fn along_kerbs(layer: &mut Layer<'_, '_, '_, '_>, seed: Seed, report: &Report) {
    let around = layer.yard.around;
    let roads: Vec<&Road> = around.place.map.iter().flat_map(|m| &m.roads).filter(|r| r.kind.is_for_cars()).collect();
    let index = SegmentIndex::new(roads.iter().map(|r| r.centreline.as_slice()));
    for (i, run) in around.kerbs.runs.iter().enumerate() {
        let mut random = seed.child("kerb").nth(i as u64).random();
        let mut at = 0;
        while at < run.len() {
            let length = (random.range(RAILING_RUN_M[0], RAILING_RUN_M[1]) / KERB_STEP_M) as usize;
            let stretch = &run[at..(at + length).min(run.len())];
            at += length;
            let middle = &stretch[stretch.len() / 2];
            let Some(kind) = index.nearest(middle.position, ROAD_REACH_M).map(|n| roads[n.line].kind) else { continue };
            let sidewalk = stretch.iter().all(|k| k.sidewalk);
            let fast = kind <= RoadKind::Trunk;
            let railed =
                layer.yard.locale.street.railings && kind <= RoadKind::Secondary && random.chance(RAILING_SHARE);
            let (tags, off_m): (&[&str], f64) = match (sidewalk, fast, railed) {
                (false, true, _) => (&["guard-rail", "w-beam"], GUARD_OFF_KERB_M),
                (true, false, true) => (&["guard-rail", "railing", "painted"], RAILING_OFF_KERB_M),
                _ => continue,
            };
            let line: Vec<DVec2> = stretch.iter().map(|k: &KerbPoint| k.position + k.outward * off_m).collect();
            let line = layer.traffic_on_the_right(line);
            layer.lay(&Run { kind: Kind::GuardRail, tags, line: &line, scale: 1.0, in_sight_m: Some(WIDE_M) }, report);
        }
    }
}

/// What a mapped line looks like, with its height over the model's; `None` for what others build.
fn model(line: &MapLine, random: &mut Random) -> Option<(Kind, &'static [&'static str], f64)> {
    use BarrierStyle as S;
    let (kind, tags, model_m): (Kind, &[&str], f64) = match (line.kind, line.style) {
        (LineKind::Fence, Some(S::Handrail)) => (Kind::GuardRail, &["guard-rail", "railing"], 1.04),
        (LineKind::Fence, Some(S::Wire)) => (Kind::Fence, &["fence", "chain-link"], 1.85),
        (LineKind::Fence, Some(S::Wood)) => (Kind::Fence, &["fence", "wood"], 1.73),
        (LineKind::Fence, Some(S::Bars)) => (Kind::Fence, &["fence", "bars"], 1.32),
        (LineKind::Fence, Some(S::Panels | S::Concrete)) => (Kind::Fence, &["fence", "panel"], 1.85),
        (LineKind::Fence, Some(S::Hoarding)) => (Kind::Fence, &["fence", "hoarding"], 2.12),
        (LineKind::Fence, Some(S::Brick | S::Stone) | None) => *random.pick::<(Kind, &[&str], f64)>(&[
            (Kind::Fence, &["fence", "bars"], 1.32),
            (Kind::Fence, &["fence", "bars"], 1.32),
            (Kind::Fence, &["fence", "chain-link"], 1.85),
            (Kind::Fence, &["fence", "wood"], 1.73),
        ])?,
        (LineKind::Wall, Some(S::Brick)) => (Kind::Wall, &["wall", "brick"], 2.4),
        (LineKind::Wall, Some(S::Stone)) => (Kind::Wall, &["wall", "stone"], 2.2),
        (LineKind::Wall, Some(S::Concrete)) => (Kind::Wall, &["wall", "concrete"], 2.0),
        (LineKind::Wall, _) => *random.pick::<(Kind, &[&str], f64)>(&[
            (Kind::Wall, &["wall", "brick"], 2.4),
            (Kind::Wall, &["wall", "concrete"], 2.0),
            (Kind::Wall, &["wall", "stone"], 2.2),
        ])?,
        (LineKind::GuardRail, Some(S::Concrete)) => (Kind::GuardRail, &["guard-rail", "parapet"], 0.86),
        (LineKind::GuardRail, _) => (Kind::GuardRail, &["guard-rail", "w-beam"], 0.76),
        (LineKind::Hedge | LineKind::PowerLine | LineKind::Tram | LineKind::Railway, _) => return None,
    };
    let guessed = if kind == Kind::GuardRail { 1.0 } else { random.range(HEIGHTS[0], HEIGHTS[1]) };
    let scale = line.height_m.filter(|h| (0.3..=8.0).contains(h)).map_or(guessed, |height_m| height_m / model_m);
    Some((kind, tags, scale))
}
