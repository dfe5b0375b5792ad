//! The made-up place as maps: nuScenes' own form of the road, and OpenStreetMap's of everything.

use std::fmt::Write;

use glam::DVec2;
use serde_json::{Value, json};
use trove_model::{MapProjection, Random, Seed};

use super::street::{self, CROSSING_M, LAT_DEG, LON_DEG, MAIN_HALF_M, REACH_M, SIDE_HALF_M, SIDEWALK_M};
use super::tables::token;

/// Buildings begin this far behind the sidewalk.
const FRONT_GARDEN_M: f64 = 1.0;

/// The map expansion: drivable area, lanes, walkways, crossings, dividers.
pub(super) fn lane_map() -> Value {
    let mut layers = Layers::default();
    let drivable = layers.polygon(&street::carriageway());
    let lanes: Vec<Value> = street::lanes()
        .iter()
        .map(|&([from, to], half_m)| {
            let side = (to - from).normalize().perp() * half_m;
            let polygon = layers.polygon(&[from - side, to - side, to + side, from + side]);
            json!({ "token": layers.next("lane"), "polygon_token": polygon, "lane_type": "CAR" })
        })
        .collect();
    let walkways = layers.rows("walkway", &street::sidewalks());
    let crossings = layers.rows("ped_crossing", &street::crossings());
    let (between_directions, between_lanes) = street::dividers();
    let road_dividers = layers.lines("road_divider", &between_directions);
    let lane_dividers = layers.lines("lane_divider", &between_lanes);
    json!({
        "version": "1.3",
        "canvas_edge": [1000.0, 1000.0],
        "node": layers.nodes,
        "polygon": layers.polygons,
        "line": layers.line_rows,
        "drivable_area": [{ "token": layers.next("drivable_area"), "polygon_tokens": [drivable] }],
        "lane": lanes,
        "walkway": walkways,
        "ped_crossing": crossings,
        "road_divider": road_dividers,
        "lane_divider": lane_dividers,
    })
}

/// Geometry that the layers refer to.
#[derive(Default)]
struct Layers {
    nodes: Vec<Value>,
    polygons: Vec<Value>,
    line_rows: Vec<Value>,
    count: u64,
}

impl Layers {
    fn next(&mut self, kind: &str) -> String {
        self.count += 1;
        token(kind, self.count)
    }

    fn node_tokens(&mut self, points: &[DVec2]) -> Vec<String> {
        let mut tokens = Vec::new();
        for point in points {
            let global = *point + DVec2::from_array(CROSSING_M);
            let token = self.next("node");
            self.nodes.push(json!({ "token": token, "x": global.x, "y": global.y }));
            tokens.push(token);
        }
        tokens
    }

    fn polygon(&mut self, ring: &[DVec2]) -> String {
        let nodes = self.node_tokens(ring);
        let token = self.next("polygon");
        self.polygons.push(json!({ "token": token, "exterior_node_tokens": nodes, "holes": [] }));
        token
    }

    fn rows(&mut self, kind: &str, rings: &[Vec<DVec2>]) -> Vec<Value> {
        let row = |ring: &Vec<DVec2>| {
            let polygon = self.polygon(ring);
            json!({ "token": self.next(kind), "polygon_token": polygon })
        };
        rings.iter().map(row).collect()
    }

    fn lines(&mut self, kind: &str, lines: &[[DVec2; 2]]) -> Vec<Value> {
        let row = |line: &[DVec2; 2]| {
            let nodes = self.node_tokens(line);
            let line_token = self.next("line");
            self.line_rows.push(json!({ "token": line_token, "node_tokens": nodes }));
            json!({ "token": self.next(kind), "line_token": line_token })
        };
        lines.iter().map(row).collect()
    }
}

/// The OpenStreetMap file: streets, buildings, a park, trees, lamps, signals, benches.
pub(super) fn osm() -> String {
    let mut file = OsmFile::new();
    streets(&mut file);
    buildings(&mut file);
    park(&mut file);
    furniture(&mut file);
    file.finish()
}

fn streets(file: &mut OsmFile) {
    let crossing = file.node(DVec2::ZERO, &[("highway", "traffic_signals")]);
    let main: &[(&str, &str)] =
        &[("highway", "secondary"), ("name", "Long Street"), ("lanes", "4"), ("width", "17.6"), ("sidewalk", "both")];
    let side: &[(&str, &str)] =
        &[("highway", "residential"), ("name", "Cross Street"), ("lanes", "2"), ("width", "8.4"), ("sidewalk", "both")];
    for (along, tags) in [(DVec2::X, main), (DVec2::Y, side)] {
        let (start, end) = (file.node(-along * REACH_M, &[]), file.node(along * REACH_M, &[]));
        file.way(&[start, crossing, end], tags);
    }
}

/// Rows of houses along both streets; the south-west quarter is a park instead.
fn buildings(file: &mut OsmFile) {
    let kinds: [(&str, &[(&str, &str)]); 6] = [
        ("apartments", &[("building:levels", "5"), ("building:material", "brick")]),
        ("office", &[("building:levels", "9"), ("building:material", "glass")]),
        ("retail", &[("building:levels", "2")]),
        ("apartments", &[("building:levels", "4"), ("building:material", "plaster"), ("roof:shape", "gabled")]),
        ("commercial", &[("height", "21")]),
        ("house", &[("building:levels", "2"), ("roof:shape", "hipped")]),
    ];
    let mut random = Seed(1).child("demo buildings").random();
    let front = |half_m: f64| half_m + SIDEWALK_M + FRONT_GARDEN_M;
    for (sx, sy) in [(1.0, 1.0), (-1.0, 1.0), (1.0, -1.0)] {
        let mut x = front(SIDE_HALF_M);
        while x < 200.0 {
            let (width, depth) = (random.range(14.0, 30.0), random.range(11.0, 17.0));
            let y = front(MAIN_HALF_M);
            let mut ring = vec![[x, y], [x + width, y], [x + width, y + depth], [x, y + depth]];
            if random.chance(0.25) {
                ring = l_shape(x, y, width, depth);
            }
            let ring: Vec<DVec2> = ring.iter().map(|&[x, y]| DVec2::new(sx * x, sy * y)).collect();
            building(file, &ring, random.pick(&kinds));
            x += width + if random.chance(0.3) { random.range(3.0, 9.0) } else { 0.05 };
        }
        let mut y = front(MAIN_HALF_M) + 24.0;
        while y < 180.0 {
            let (width, depth) = (random.range(11.0, 16.0), random.range(12.0, 24.0));
            let x = front(SIDE_HALF_M);
            let ring = [[x, y], [x + width, y], [x + width, y + depth], [x, y + depth]];
            let ring: Vec<DVec2> = ring.iter().map(|&[x, y]| DVec2::new(sx * x, sy * y)).collect();
            building(file, &ring, random.pick(&kinds));
            y += depth + random.range(0.05, 6.0);
        }
    }
}

fn l_shape(x: f64, y: f64, width: f64, depth: f64) -> Vec<[f64; 2]> {
    let (wing, deep) = (width * 0.4, depth * 1.5);
    vec![[x, y], [x + width, y], [x + width, y + depth], [x + wing, y + depth], [x + wing, y + deep], [x, y + deep]]
}

fn building(file: &mut OsmFile, ring: &[DVec2], kind: Option<&(&str, &[(&str, &str)])>) {
    let Some((kind, tags)) = kind else { return };
    let tags: Vec<(&str, &str)> = std::iter::once(("building", *kind)).chain(tags.iter().copied()).collect();
    file.ring(ring, &tags);
}

fn park(file: &mut OsmFile) {
    let (near_x, near_y) = (SIDE_HALF_M + SIDEWALK_M, MAIN_HALF_M + SIDEWALK_M);
    let corner = |x: f64, y: f64| DVec2::new(-x, -y);
    let ring = [corner(near_x, near_y), corner(140.0, near_y), corner(140.0, 120.0), corner(near_x, 120.0)];
    file.ring(&ring, &[("leisure", "park"), ("name", "Corner Park")]);
    let mut random = Seed(1).child("demo park").random();
    for _ in 0..45 {
        let tree = corner(random.range(near_x + 4.0, 136.0), random.range(near_y + 4.0, 116.0));
        file.node(tree, &[("natural", "tree")]);
    }
    for x in [20.0, 34.0, 60.0] {
        file.node(corner(x, near_y + 1.2), &[("amenity", "bench"), ("direction", "N")]);
    }
}

fn furniture(file: &mut OsmFile) {
    let mut random = Seed(1).child("demo furniture").random();
    let along = |file: &mut OsmFile, step_m: f64, first_m: f64, y: f64, tags: &[(&str, &str)], random: &mut Random| {
        let mut x = first_m;
        while x < 180.0 {
            for sign in [-1.0, 1.0] {
                file.node(DVec2::new(sign * x + random.range(-0.5, 0.5), y), tags);
            }
            x += step_m;
        }
    };
    let kerbside = MAIN_HALF_M + 0.9;
    for side in [-1.0, 1.0] {
        along(file, 28.0, 22.0, side * kerbside, &[("highway", "street_lamp")], &mut random);
        along(file, 14.0, 29.0, side * (kerbside + 0.3), &[("natural", "tree")], &mut random);
    }
    for (x, y) in [(1.0, -1.0), (-1.0, 1.0), (1.0, 1.0), (-1.0, -1.0)] {
        let post = DVec2::new(x * (SIDE_HALF_M + 2.6), y * (MAIN_HALF_M + 2.6));
        file.node(post, &[("highway", "traffic_signals")]);
    }
    file.node(DVec2::new(-26.0, -MAIN_HALF_M - 1.0), &[("emergency", "fire_hydrant")]);
    file.node(DVec2::new(30.0, -MAIN_HALF_M - 1.6), &[("highway", "bus_stop")]);
    for x in [-18.0, 24.0] {
        file.node(DVec2::new(x, MAIN_HALF_M + 1.4), &[("amenity", "waste_basket")]);
        file.node(DVec2::new(x - 6.0, -MAIN_HALF_M - 0.8), &[("traffic_sign", "yes"), ("direction", "W")]);
    }
}

/// An OpenStreetMap file in the making.
struct OsmFile {
    projection: MapProjection,
    nodes: String,
    ways: String,
    next_id: i64,
}

impl OsmFile {
    fn new() -> Self {
        let anchor_m = DVec2::from_array(CROSSING_M);
        let projection = MapProjection::spherical(LAT_DEG, LON_DEG, anchor_m);
        Self { projection, nodes: String::new(), ways: String::new(), next_id: 1 }
    }

    fn id(&mut self) -> i64 {
        self.next_id += 1;
        self.next_id
    }

    fn node(&mut self, position: DVec2, tags: &[(&str, &str)]) -> i64 {
        let id = self.id();
        let (lat, lon) = self.projection.geo_from_world(position);
        self.nodes.push_str(&format!("  <node id=\"{id}\" lat=\"{lat:.8}\" lon=\"{lon:.8}\">\n"));
        self.nodes.push_str(&tag_lines(tags));
        self.nodes.push_str("  </node>\n");
        id
    }

    fn way(&mut self, nodes: &[i64], tags: &[(&str, &str)]) {
        let id = self.id();
        let references = nodes.iter().fold(String::new(), |mut text, node| {
            let _ = writeln!(text, "    <nd ref=\"{node}\"/>"); // a String takes everything
            text
        });
        self.ways.push_str(&format!("  <way id=\"{id}\">\n{references}{}  </way>\n", tag_lines(tags)));
    }

    fn ring(&mut self, ring: &[DVec2], tags: &[(&str, &str)]) {
        let mut nodes: Vec<i64> = ring.iter().map(|&p| self.node(p, &[])).collect();
        nodes.push(nodes[0]);
        self.way(&nodes, tags);
    }

    fn finish(self) -> String {
        format!(
            "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<osm version=\"0.6\" generator=\"trove demo\">\n{}{}</osm>\n",
            self.nodes, self.ways
        )
    }
}

fn tag_lines(tags: &[(&str, &str)]) -> String {
    tags.iter().map(|(key, value)| format!("    <tag k=\"{key}\" v=\"{value}\"/>\n")).collect()
}
