//! Roads above and below the ground: which they are, and how high they run.
//!
//! A bridge rises from where it meets roads on the ground, at the slope that its crossings ask for; the road that
//! leads up to it rises with it as far as nothing else meets it.

mod crossings;
mod deck;
mod heights;
mod lift;
mod sweep;
mod trenches;

use std::collections::BTreeMap;

use glam::DVec2;
use trove_model::{Bounds, Outcome, Report, Road, StreetMap};

use self::crossings::Crossings;
use self::deck::{Key, key, split};
use self::heights::Attempt;
use super::network::{RECORDED, resampled};
use crate::geometry::plane_raster::PlaneRaster;

pub(super) use self::deck::Deck;
pub(super) use self::lift::Lift;
pub(super) use self::sweep::meshes;
pub(super) use self::trenches::Trench;

/// Recorded traffic passes below a deck that is at least this high, metres.
const ABOVE_TRAFFIC_M: f64 = 4.5;
/// A bridge of which more than this share lies along the recorded area is the level of the recording.
const RECORDED_SHARE: f64 = 0.5;

/// All roads for cars, divided.
#[derive(Default)]
pub(super) struct Levels<'a> {
    /// Lines that lie on the ground; less than their roads' where these rise.
    pub ground: Vec<(&'a Road, Vec<DVec2>)>,
    pub decks: Vec<Deck<'a>>,
    pub trenches: Vec<Trench<'a>>,
}

/// Divides the map's roads for cars around a place; what can be built on no level is dropped and reported.
pub(super) fn levels<'a>(
    map: &'a StreetMap,
    recorded: &PlaneRaster,
    bounds: Bounds,
    lift: &Lift<'_>,
    report: &Report,
) -> Levels<'a> {
    let reaches = |r: &&Road| Bounds::around(r.centreline.iter().copied()).is_some_and(|b| b.overlaps(&bounds));
    let cars: Vec<&Road> = map.roads.iter().filter(|r| r.kind.is_for_cars()).filter(reaches).collect();
    let mut ground: Vec<&Road> = Vec::new();
    let mut raised: Vec<&Road> = Vec::new();
    let mut tunnels: Vec<&Road> = Vec::new();
    for &road in &cars {
        let points = resampled(&road.centreline);
        let beside = points.iter().filter(|&&p| recorded.at(p) != 0).count();
        let is_recorded = beside as f64 > RECORDED_SHARE * points.len() as f64;
        if road.tunnel {
            tunnels.push(road);
        } else if (road.bridge || road.layer > 0) && !is_recorded {
            raised.push(road);
        } else {
            ground.push(road);
        }
    }

    let mut decks = Vec::new();
    let mut risen: BTreeMap<usize, [f64; 2]> = BTreeMap::new();
    let mut level: Vec<&Road> = Vec::new();
    for group in connected(&raised) {
        let crossings = Crossings::new(&group, &ground, &raised, map);
        if crossings.is_empty() && !group.iter().any(|road| lift.is_high(road)) {
            // Over nothing but water a bridge carries its road on the level.
            level.extend(group);
            continue;
        }
        match Attempt::first_that_clears(&group, &ground, &crossings, lift) {
            Some(attempt) => {
                let built = attempt.decks(&group, &ground, lift);
                // What would rise out of the recorded road is that road.
                let rises = |d: &Deck<'_>| {
                    let mut points = d.line.iter().zip(&d.heights_m);
                    points.any(|(&p, &height_m)| height_m < ABOVE_TRAFFIC_M && recorded.at(p) == RECORDED)
                };
                if built.iter().any(rises) {
                    level.extend(group);
                    continue;
                }
                decks.extend(built);
                for (road, ends) in attempt.risen {
                    let known = risen.entry(road).or_default();
                    *known = [known[0].max(ends[0]), known[1].max(ends[1])];
                }
            }
            None => {
                for road in group {
                    let what = "bridge whose ramps do not fit between the roads that it crosses and joins";
                    report.note(Outcome::Dropped, what, format_args!("osm way {}", road.id));
                }
            }
        }
    }
    let ends = |i: usize| risen.get(&i).copied().unwrap_or_default();
    let mut lines: Vec<(&Road, Vec<DVec2>)> =
        ground.iter().enumerate().map(|(i, road)| (*road, shortened(&road.centreline, ends(i)))).collect();
    lines.extend(level.into_iter().map(|road| (road, road.centreline.clone())));
    lines.retain(|(_, line)| line.len() > 1);
    let trenches = trenches::trenches(&tunnels, &ground, map, recorded, lift, report);
    Levels { ground: lines, decks, trenches }
}

/// Roads in groups that share nodes.
fn connected<'a>(roads: &[&'a Road]) -> Vec<Vec<&'a Road>> {
    let mut group_of: Vec<usize> = (0..roads.len()).collect();
    let mut first: BTreeMap<Key, usize> = BTreeMap::new();
    for (i, road) in roads.iter().enumerate() {
        for &p in &road.centreline {
            let other = *first.entry(key(p)).or_insert(i);
            let (a, b) = (group_of[i], group_of[other]);
            if a != b {
                group_of.iter_mut().filter(|g| **g == a.max(b)).for_each(|g| *g = a.min(b));
            }
        }
    }
    let mut groups: BTreeMap<usize, Vec<&Road>> = BTreeMap::new();
    for (i, road) in roads.iter().enumerate() {
        groups.entry(group_of[i]).or_default().push(road);
    }
    groups.into_values().collect()
}

/// A line without some metres at its start and end.
fn shortened(line: &[DVec2], ends_m: [f64; 2]) -> Vec<DVec2> {
    let mut line = line.to_vec();
    for end_m in ends_m {
        if end_m > 0.0 {
            line = split(&line, end_m).1;
        }
        line.reverse();
    }
    line
}

#[cfg(test)]
mod tests {
    use super::deck::LEVEL_M;
    use super::*;
    use trove_model::RoadKind;

    fn place() -> StreetMap {
        let road = |id, points: &[[f64; 2]]| crate::testing::road(id, RoadKind::Secondary, points);
        let bridge = Road { bridge: true, layer: 1, ..road(2, &[[-40.0, 0.0], [0.0, 0.0], [40.0, 0.0]]) };
        let roads = vec![
            road(1, &[[-200.0, 0.0], [-40.0, 0.0]]),
            bridge,
            road(3, &[[40.0, 0.0], [200.0, 0.0]]),
            road(4, &[[0.0, -150.0], [0.0, 150.0]]),
            road(5, &[[160.0, -50.0], [160.0, 50.0]]),
        ];
        StreetMap { roads, ..StreetMap::default() }
    }

    /// Ways on the ground with their lengths, and above it with their heights.
    type Ways = Vec<(i64, f64)>;

    fn levels_of(map: &StreetMap, report: &Report) -> (Ways, Ways) {
        let bounds = Bounds::square(DVec2::ZERO, 500.0);
        let flat = trove_model::HeightField::flat(bounds, 0.0);
        let lift = Lift { ground: &flat, spans: &crate::ground::Spans::default() };
        let levels = levels(map, &PlaneRaster::new(bounds, 1.0), bounds, &lift, report);
        let length = |line: &[DVec2]| line.windows(2).map(|w| w[0].distance(w[1])).sum::<f64>();
        let highest = |d: &Deck<'_>| d.heights_m.iter().copied().fold(0.0, f64::max);
        let ground = levels.ground.iter().map(|(r, line)| (r.id, length(line).round())).collect();
        (ground, levels.decks.iter().map(|d| (d.road.id, highest(d))).collect())
    }

    #[test]
    fn a_short_bridge_over_a_road_is_led_up_to_and_the_road_below_stays() {
        let (ground, decks) = levels_of(&place(), &Report::default());
        assert!(ground.contains(&(4, 300.0)) && ground.contains(&(5, 100.0)), "{ground:?}");
        assert!(ground.iter().find(|(id, _)| *id == 1).unwrap().1 < 120.0, "{ground:?}");
        let over = decks.iter().find(|(id, _)| *id == 2).unwrap().1;
        assert!((5.0..LEVEL_M + 0.01).contains(&over), "{decks:?}");
        assert_eq!(decks.iter().map(|(id, _)| *id).collect::<Vec<_>>(), [2, 1, 3]);
    }

    #[test]
    fn a_bridge_over_nothing_lies_on_the_level_and_one_without_room_is_reported() {
        let mut map = place();
        map.roads.remove(3);
        assert!(levels_of(&map, &Report::default()).1.is_empty());
        let mut map = place();
        map.roads.push(crate::testing::road(6, RoadKind::Residential, &[[-40.0, 0.0], [-40.0, 80.0]]));
        map.roads.push(crate::testing::road(7, RoadKind::Residential, &[[40.0, 0.0], [40.0, 80.0]]));
        map.roads[1].centreline = [[-40.0, 0.0], [-30.0, 0.0], [40.0, 0.0]].map(DVec2::from_array).to_vec();
        map.roads[3].centreline = [[-30.0, -80.0], [-30.0, 80.0]].map(DVec2::from_array).to_vec();
        let report = Report::default();
        assert!(levels_of(&map, &report).1.is_empty());
        assert!(report.entries().iter().any(|e| e.outcome == Outcome::Dropped && e.count == 1));
    }
}
