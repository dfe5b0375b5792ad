//! Map expansion (`maps/expansion/<place>.json`) → `LaneMap` around the drive.

use std::collections::HashMap;
use std::io::ErrorKind;
use std::path::Path;

use glam::DVec2;
use serde::Deserialize;
use trove_files::{LARGEST_FILE, PathComponent, read_regular};
use trove_model::{Lane, LaneMap, Outcome, Polygon, Report};

use super::arcline::{self, Arcline};
use super::centreline;
use super::poses::FARTHEST_M;

/// What lies farther from the driven path is left out, metres.
const REACH_M: f64 = 400.0;

#[derive(Default, Deserialize)]
#[serde(default)]
struct MapFile {
    node: Vec<Node>,
    polygon: Vec<PolygonRecord>,
    line: Vec<LineRecord>,
    drivable_area: Vec<Layer>,
    lane: Vec<Layer>,
    lane_connector: Vec<Layer>,
    walkway: Vec<Layer>,
    ped_crossing: Vec<Layer>,
    stop_line: Vec<Layer>,
    carpark_area: Vec<Layer>,
    road_divider: Vec<Layer>,
    lane_divider: Vec<Layer>,
    arcline_path_3: HashMap<String, Vec<Arcline>>,
    connectivity: HashMap<String, Connection>,
}

#[derive(Deserialize)]
struct Node {
    token: String,
    x: f64,
    y: f64,
}

#[derive(Deserialize)]
struct PolygonRecord {
    token: String,
    exterior_node_tokens: Vec<String>,
    #[serde(default)]
    holes: Vec<LineRecord>,
}

#[derive(Deserialize)]
struct LineRecord {
    #[serde(default)]
    token: String,
    node_tokens: Vec<String>,
}

/// A row of any layer; what a layer does not have is empty.
#[derive(Deserialize)]
struct Layer {
    token: String,
    #[serde(default)]
    polygon_token: String,
    #[serde(default)]
    polygon_tokens: Vec<String>,
    #[serde(default)]
    line_token: String,
}

/// What comes before and after a lane: lane connectors, and lanes before and after those.
#[derive(Default, Deserialize)]
#[serde(default)]
struct Connection {
    incoming: Vec<String>,
    outgoing: Vec<String>,
}

/// The map's file below the root; `None` for a place that has no name.
pub(super) fn file(place: &str) -> Option<String> {
    PathComponent::new(place).ok().map(|place| format!("maps/expansion/{}.json", place.as_str()))
}

/// The map around a driven path; `None`, reported, where there is none that can be read.
pub(super) fn read(root: &Path, place: &str, anchor_m: DVec2, path: &[DVec2], report: &Report) -> Option<LaneMap> {
    let Some(file) = file(place) else {
        report.note(Outcome::Warned, "no nuScenes map expansion for the drive's place", place);
        return None;
    };
    let text = match read_regular(&root.join(&file), LARGEST_FILE) {
        Ok(text) => text,
        Err(e) if e.kind() == ErrorKind::NotFound => {
            report.note(Outcome::Warned, "no nuScenes map expansion for the drive's place", &file);
            return None;
        }
        Err(e) => {
            report.note(Outcome::Dropped, "nuScenes map expansion that cannot be read", format!("{file}: {e}"));
            return None;
        }
    };
    match serde_json::from_slice::<MapFile>(&text) {
        Ok(map) => Some(Around::new(&map, anchor_m, path, report).lane_map(&map)),
        Err(e) => {
            report.note(Outcome::Dropped, "nuScenes map expansion that cannot be read", format!("{file}: {e}"));
            None
        }
    }
}

/// The map's shapes by token, and what of them is near.
struct Around<'a> {
    nodes: HashMap<&'a str, DVec2>,
    polygons: HashMap<&'a str, &'a PolygonRecord>,
    lines: HashMap<&'a str, &'a LineRecord>,
    anchor_m: DVec2,
    path: &'a [DVec2],
    report: &'a Report,
}

impl<'a> Around<'a> {
    fn new(map: &'a MapFile, anchor_m: DVec2, path: &'a [DVec2], report: &'a Report) -> Self {
        // A node at no place on earth is as good as missing.
        let nodes = map.node.iter().filter(|n| n.x.abs().max(n.y.abs()) < FARTHEST_M);
        Self {
            nodes: nodes.map(|n| (n.token.as_str(), DVec2::new(n.x, n.y) - anchor_m)).collect(),
            polygons: map.polygon.iter().map(|p| (p.token.as_str(), p)).collect(),
            lines: map.line.iter().map(|l| (l.token.as_str(), l)).collect(),
            anchor_m,
            path,
            report,
        }
    }

    fn lane_map(&self, map: &MapFile) -> LaneMap {
        LaneMap {
            drivable: self.surfaces("drivable_area", &map.drivable_area),
            lanes: self.lanes(map),
            walkways: self.surfaces("walkway", &map.walkway),
            crossings: self.surfaces("ped_crossing", &map.ped_crossing),
            stop_lines: self.surfaces("stop_line", &map.stop_line),
            carparks: self.surfaces("carpark_area", &map.carpark_area),
            road_dividers: self.dividers("road_divider", &map.road_divider),
            lane_dividers: self.dividers("lane_divider", &map.lane_divider),
            ..LaneMap::default()
        }
    }

    fn surfaces(&self, layer: &str, rows: &[Layer]) -> Vec<Polygon> {
        let tokens = rows.iter().flat_map(|row| {
            let one = (!row.polygon_token.is_empty()).then_some(&row.polygon_token);
            row.polygon_tokens.iter().chain(one)
        });
        tokens.filter_map(|token| self.polygon(layer, token)).collect()
    }

    fn lanes(&self, map: &MapFile) -> Vec<Lane> {
        let mut lanes = Vec::new();
        for (layer, rows) in [("lane", &map.lane), ("lane_connector", &map.lane_connector)] {
            for row in rows {
                if row.polygon_token.is_empty() {
                    self.dropped(layer, &row.token, "it has no polygon");
                } else if let Some(polygon) = self.polygon(layer, &row.polygon_token) {
                    let arclines = map.arcline_path_3.get(&row.token).map_or(&[][..], Vec::as_slice);
                    let centreline = arcline::vertices(arclines).into_iter().map(|p| p - self.anchor_m).collect();
                    lanes.push(Lane { token: row.token.clone(), polygon, centreline });
                }
            }
        }
        self.derive_centrelines(map, &mut lanes);
        lanes
    }

    /// Gives lanes without a centre line one from their outlines, where that tells.
    fn derive_centrelines(&self, map: &MapFile, lanes: &mut [Lane]) {
        let polygons: HashMap<String, Polygon> = lanes.iter().map(|l| (l.token.clone(), l.polygon.clone())).collect();
        for lane in lanes.iter_mut().filter(|l| l.centreline.is_empty()) {
            let neighbours = |of: fn(&Connection) -> &[String]| -> Vec<&Polygon> {
                // Lanes meet directly, or over a connector that has no outline of its own.
                let of_token = |token: &str| map.connectivity.get(token).map_or(&[][..], of);
                let near = of_token(&lane.token).iter();
                let tokens = near.flat_map(|token| std::iter::once(token).chain(of_token(token)));
                tokens.filter_map(|token| polygons.get(token)).collect()
            };
            let (before, after) = (neighbours(|c| &c.incoming), neighbours(|c| &c.outgoing));
            lane.centreline = centreline::between_sides(&lane.polygon.exterior, &before, &after);
            let (outcome, what) = if lane.centreline.is_empty() {
                (Outcome::Warned, "nuScenes map lane without a centre line")
            } else {
                (Outcome::Guessed, "nuScenes map lane's centre line, from its outline and neighbours")
            };
            self.report.note(outcome, what, &lane.token);
        }
    }

    fn dividers(&self, layer: &str, rows: &[Layer]) -> Vec<Vec<DVec2>> {
        let line = |row: &Layer| {
            let record = self.lines.get(row.line_token.as_str());
            let line = record.and_then(|record| self.vertices(&record.node_tokens)).filter(|line| line.len() >= 2);
            if line.is_none() {
                self.dropped(layer, &row.token, "its line has unknown or too few nodes");
            }
            line.filter(|line| self.is_near(line))
        };
        rows.iter().filter_map(line).collect()
    }

    /// A polygon that is near; `None`, and reported, also where it is none.
    fn polygon(&self, layer: &str, token: &str) -> Option<Polygon> {
        let Some(record) = self.polygons.get(token) else {
            self.dropped(layer, token, "unknown polygon");
            return None;
        };
        let Some(exterior) = self.ring(&record.exterior_node_tokens) else {
            self.dropped(layer, token, "its outline has unknown or too few nodes");
            return None;
        };
        if !self.is_near(&exterior) {
            return None;
        }
        let holes = record.holes.iter().filter_map(|hole| {
            let ring = self.ring(&hole.node_tokens);
            if ring.is_none() {
                self.dropped(layer, token, "a hole has unknown or too few nodes");
            }
            ring
        });
        Some(Polygon { exterior, holes: holes.collect() }.oriented())
    }

    /// An open ring of at least three vertices that encloses something.
    fn ring(&self, tokens: &[String]) -> Option<Vec<DVec2>> {
        let mut ring = self.vertices(tokens)?;
        while ring.len() > 1 && ring.first() == ring.last() {
            ring.pop();
        }
        (ring.len() >= 3 && Polygon::simple(ring.clone()).area_m2() > 1e-6).then_some(ring)
    }

    /// Vertices without repetitions; `None` where a node is not known.
    fn vertices(&self, tokens: &[String]) -> Option<Vec<DVec2>> {
        let mut vertices: Vec<_> = tokens.iter().map(|t| self.nodes.get(t.as_str()).copied()).collect::<Option<_>>()?;
        vertices.dedup();
        Some(vertices)
    }

    fn is_near(&self, vertices: &[DVec2]) -> bool {
        let low = vertices.iter().copied().fold(DVec2::INFINITY, DVec2::min);
        let high = vertices.iter().copied().fold(DVec2::NEG_INFINITY, DVec2::max);
        self.path.iter().any(|p| p.clamp(low, high).distance(*p) <= REACH_M)
    }

    fn dropped(&self, layer: &str, token: &str, why: &str) {
        self.report.note(Outcome::Dropped, &format!("nuScenes map {layer}: {why}"), token);
    }
}
