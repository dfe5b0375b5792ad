//! Vector map (`map/log_map_archive_*.json`) → `LaneMap` around the drive.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

use glam::{DVec2, DVec3};
use serde::Deserialize;
use serde::de::DeserializeOwned;
use serde_json::Value;
use trove_files::read_regular;
use trove_model::{Bounds, Lane, LaneMap, LaneMark, MarkPattern, Outcome, Paint, Polygon, Report};

use super::city::CityFrame;
use super::kinds::rows;
use super::poses::FARTHEST_M;

/// Mark type, paint and pattern, a line each.
const MARKS: &str = include_str!("marks.tsv");
/// What lies farther from the driven path is left out, metres.
pub(super) const REACH_M: f64 = 400.0;
/// A log's map takes a few hundred kilobytes.
const LARGEST_MAP: u64 = 64 << 20;
/// Distance of a centre line's vertices, metres, and the most there are.
const STEP_M: f64 = 2.0;
const MOST_STATIONS: f64 = 400.0;

/// Rows by id; each is read on its own, so that a damaged one costs no other.
#[derive(Deserialize)]
struct MapFile {
    #[serde(default)]
    lane_segments: BTreeMap<String, Value>,
    #[serde(default)]
    drivable_areas: BTreeMap<String, Value>,
    #[serde(default)]
    pedestrian_crossings: BTreeMap<String, Value>,
}

#[derive(Clone, Copy, Deserialize)]
struct Point {
    x: f64,
    y: f64,
}

#[derive(Deserialize)]
struct LaneSegment {
    lane_type: String,
    left_lane_boundary: Vec<Point>,
    right_lane_boundary: Vec<Point>,
    left_lane_mark_type: String,
    right_lane_mark_type: String,
}

#[derive(Deserialize)]
struct DrivableArea {
    area_boundary: Vec<Point>,
}

#[derive(Deserialize)]
struct PedestrianCrossing {
    edge1: [Point; 2],
    edge2: [Point; 2],
}

/// A log's map; `None` where it has none.
pub(super) fn file(log: &Path) -> Option<PathBuf> {
    let entries = std::fs::read_dir(log.join("map")).into_iter().flatten().flatten().map(|e| e.path());
    let is_map = |path: &PathBuf| {
        let name = path.file_name().and_then(|name| name.to_str()).unwrap_or_default();
        name.starts_with("log_map_archive_") && name.ends_with(".json")
    };
    entries.filter(is_map).min()
}

/// The city in a map's name (`log_map_archive_LOG____PIT_city_47896.json`).
pub(super) fn city(map: &Path) -> Option<String> {
    let (_, rest) = map.file_stem()?.to_str()?.split_once("____")?;
    let city = rest.split('_').next()?;
    (city.len() == 3 && city.bytes().all(|b| b.is_ascii_uppercase())).then(|| city.to_owned())
}

/// The map around a driven path; `None`, reported, where there is none that can be read.
pub(super) fn read(file: Option<&Path>, frame: &CityFrame, path: &[DVec2], report: &Report) -> Option<LaneMap> {
    let Some(file) = file else {
        report.note(Outcome::Warned, "Argoverse 2 log without a vector map", "map/log_map_archive_*.json");
        return None;
    };
    let unread = |why: String| {
        let example = format!("{}: {why}", file.display());
        report.note(Outcome::Dropped, "Argoverse 2 map that cannot be read", example);
    };
    let text = read_regular(file, LARGEST_MAP).inspect_err(|e| unread(e.to_string())).ok()?;
    let map: MapFile = serde_json::from_slice(&text).inspect_err(|e| unread(e.to_string())).ok()?;
    let near = Bounds::around(path.iter().copied())?.grown(REACH_M);
    Some(Around { frame, near, report }.lane_map(map))
}

struct Around<'a> {
    frame: &'a CityFrame,
    near: Bounds,
    report: &'a Report,
}

impl Around<'_> {
    fn lane_map(&self, map: MapFile) -> LaneMap {
        let mut lane_map = LaneMap::default();
        let mut painted = BTreeSet::new();
        for (id, segment) in self.rows::<LaneSegment>("lane segment", map.lane_segments) {
            let sides = self.line(&segment.left_lane_boundary).zip(self.line(&segment.right_lane_boundary));
            let Some((left, right)) = sides else {
                self.dropped("lane segment", &id, "a boundary of too few or absurd points");
                continue;
            };
            for (line, name) in [(&left, &segment.left_lane_mark_type), (&right, &segment.right_lane_mark_type)] {
                // Neighbours share a boundary, in one direction or the other.
                if self.is_near(line) && painted.insert(key(line)) {
                    lane_map.marks.extend(self.mark(&id, line, name));
                }
            }
            lane_map.lanes.extend(self.lane(id, &segment.lane_type, &left, &right));
        }
        for (id, area) in self.rows::<DrivableArea>("drivable area", map.drivable_areas) {
            lane_map.drivable.extend(self.polygon("drivable area", &id, &area.area_boundary));
        }
        for (id, crossing) in self.rows::<PedestrianCrossing>("pedestrian crossing", map.pedestrian_crossings) {
            let ([a, b], [c, d]) = (crossing.edge1, crossing.edge2);
            // Its two edges run the same way or opposite ways; their ends are joined without crossing.
            let gap = |p: Point, q: Point| (p.x - q.x).hypot(p.y - q.y);
            let ring = if gap(a, c) + gap(b, d) <= gap(a, d) + gap(b, c) { [a, b, d, c] } else { [a, b, c, d] };
            lane_map.crossings.extend(self.polygon("pedestrian crossing", &id, &ring));
        }
        lane_map
    }

    fn rows<T: DeserializeOwned>(&self, layer: &str, rows: BTreeMap<String, Value>) -> Vec<(String, T)> {
        let row = |(id, value): (String, Value)| match serde_json::from_value(value) {
            Ok(row) => Some((id, row)),
            Err(e) => {
                self.dropped(layer, &id, &e.to_string());
                None
            }
        };
        rows.into_iter().filter_map(row).collect()
    }

    fn lane(&self, id: String, lane_type: &str, left: &[DVec2], right: &[DVec2]) -> Option<Lane> {
        let ring = left.iter().chain(right.iter().rev()).copied().collect();
        if lane_type == "BIKE" {
            // The builder's lanes are for motor vehicles.
            self.report.note(Outcome::Dropped, "Argoverse 2 bicycle lane, of which only the paint is kept", &id);
            return None;
        }
        let polygon = self.ring("lane segment", &id, ring)?;
        let length_m = length_m(left).max(length_m(right));
        let steps = (length_m / STEP_M).ceil().clamp(1.0, MOST_STATIONS) as usize;
        let middle = |i: usize| {
            let share = i as f64 / steps as f64;
            at_share(left, share).midpoint(at_share(right, share))
        };
        Some(Lane { token: id, polygon, centreline: (0..=steps).map(middle).collect() })
    }

    fn mark(&self, id: &str, line: &[DVec2], name: &str) -> Option<LaneMark> {
        if matches!(name, "NONE" | "UNKNOWN") {
            return None;
        }
        let Some(row) = rows(MARKS).find(|row| row[0] == name) else {
            self.dropped("lane mark", id, &format!("unknown type '{name}'"));
            return None;
        };
        let pattern = pattern(row[2])?;
        let paint = if row[1] == "yellow" { Paint::Yellow } else { Paint::White };
        Some(LaneMark { line: line.to_vec(), paint, pattern })
    }

    fn polygon(&self, layer: &str, id: &str, points: &[Point]) -> Option<Polygon> {
        match self.line(points) {
            Some(ring) => self.ring(layer, id, ring),
            None => {
                self.dropped(layer, id, "too few or absurd points");
                None
            }
        }
    }

    /// A polygon that is near; `None`, and reported, also where it is none.
    fn ring(&self, layer: &str, id: &str, mut ring: Vec<DVec2>) -> Option<Polygon> {
        while ring.len() > 1 && ring.first() == ring.last() {
            ring.pop();
        }
        if ring.len() < 3 || Polygon::simple(ring.clone()).area_m2() < 1e-6 {
            self.dropped(layer, id, "an outline that encloses nothing");
            return None;
        }
        self.is_near(&ring).then(|| Polygon::simple(ring).oriented())
    }

    /// In World, without repetitions; `None` for fewer than two points and for what is no position.
    fn line(&self, points: &[Point]) -> Option<Vec<DVec2>> {
        let is_position = |p: &Point| p.x.abs() < FARTHEST_M && p.y.abs() < FARTHEST_M;
        let world = |p: &Point| self.frame.world(DVec3::new(p.x, p.y, 0.0)).truncate();
        let mut line: Vec<_> = points.iter().all(is_position).then(|| points.iter().map(world).collect())?;
        line.dedup();
        (line.len() >= 2).then_some(line)
    }

    fn is_near(&self, line: &[DVec2]) -> bool {
        Bounds::around(line.iter().copied()).is_some_and(|bounds| bounds.overlaps(&self.near))
    }

    fn dropped(&self, layer: &str, id: &str, why: &str) {
        self.report.note(Outcome::Dropped, &format!("Argoverse 2 map {layer}"), format!("{id}: {why}"));
    }
}

/// The same for a line and its reverse.
fn key(line: &[DVec2]) -> Vec<[i64; 2]> {
    let decimetres = |p: &DVec2| (*p * 10.0).round().as_i64vec2().to_array();
    let forward: Vec<_> = line.iter().map(decimetres).collect();
    let backward: Vec<_> = forward.iter().rev().copied().collect();
    forward.min(backward)
}

fn pattern(name: &str) -> Option<MarkPattern> {
    Some(match name {
        "solid" => MarkPattern::Solid,
        "dashed" => MarkPattern::Dashed,
        "double-solid" => MarkPattern::DoubleSolid,
        "double-dashed" => MarkPattern::DoubleDashed,
        "solid-dashed" => MarkPattern::SolidDashed,
        "dashed-solid" => MarkPattern::DashedSolid,
        _ => return None,
    })
}

fn length_m(line: &[DVec2]) -> f64 {
    line.windows(2).map(|w| w[0].distance(w[1])).sum()
}

/// The point after a share of a line's length.
fn at_share(line: &[DVec2], share: f64) -> DVec2 {
    let mut left_m = share * length_m(line);
    for w in line.windows(2) {
        let step_m = w[0].distance(w[1]);
        if left_m <= step_m && step_m > 0.0 {
            return w[0].lerp(w[1], left_m / step_m);
        }
        left_m -= step_m;
    }
    line[line.len() - 1]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_city_stands_in_the_map_s_name() {
        let city = |name: &str| city(Path::new(name));
        assert_eq!(city("a/log_map_archive_7fab2350____PIT_city_47896.json").as_deref(), Some("PIT"));
        assert_eq!(city("log_map_archive_x____pit_city_1.json"), None);
        assert_eq!(city("log_map_archive_x.json"), None);
    }

    #[test]
    fn every_mark_has_a_paint_and_a_pattern() {
        for row in rows(MARKS) {
            assert!(matches!(row[1], "white" | "yellow") && pattern(row[2]).is_some(), "{row:?}");
        }
        assert_eq!(rows(MARKS).count(), 13);
    }

    #[test]
    fn a_line_is_walked_by_its_length_and_known_backwards() {
        let line = [DVec2::ZERO, DVec2::new(3.0, 0.0), DVec2::new(3.0, 1.0)];
        assert_eq!(at_share(&line, 0.5), DVec2::new(2.0, 0.0));
        assert_eq!(at_share(&line, 1.0), DVec2::new(3.0, 1.0));
        let back: Vec<_> = line.iter().rev().copied().collect();
        assert_eq!(key(&line), key(&back));
    }
}
