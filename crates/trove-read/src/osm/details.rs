//! Roads and buildings with all that their tags tell.

use std::fmt::Display;

use glam::DVec2;
use trove_model::{Building, Outcome, Polygon, Report, Road, RoadKind, RoofShape, SidewalkSides};

use super::colors::linear_color;
use super::meaning::{in_tunnel, layer};
use super::raw::Tags;
use super::values::{decimal, length_m};

/// A storey's height where only `min_level` is tagged, metres.
const STOREY_M: f64 = 3.0;

/// Reads tags' values and notes those that cannot be read.
struct Values<'a> {
    tags: &'a Tags,
    owner: &'a dyn Display,
    report: &'a Report,
}

impl Values<'_> {
    /// The first tagged key's value, where it can be read and lies in the range.
    fn number(
        &self,
        keys: &[&str],
        read: fn(&str) -> Option<f64>,
        range: std::ops::RangeInclusive<f64>,
    ) -> Option<f64> {
        self.parsed(keys, |text| read(text).filter(|value| range.contains(value)))
    }

    fn parsed<T>(&self, keys: &[&str], read: impl Fn(&str) -> Option<T>) -> Option<T> {
        let text = self.tags.first(keys);
        if text.is_empty() {
            return None;
        }
        let value = read(text);
        if value.is_none() {
            let what = format!("osm: {} that cannot be used", keys[0]);
            self.report.note(Outcome::Dropped, &what, format!("{}: {text}", self.owner));
        }
        value
    }
}

/// A way that is driven or walked on; `centreline` runs as the way does.
pub(super) fn road(id: i64, kind: RoadKind, mut centreline: Vec<DVec2>, tags: &Tags, report: &Report) -> Road {
    let owner = format!("way {id}");
    let values = Values { tags, owner: &owner, report };
    let count = |keys: &[&str]| values.number(keys, decimal, 1.0..=20.0).map(|n| n.round() as u32);
    let both = || Some(count(&["lanes:forward"])? + count(&["lanes:backward"])?);
    let mut sidewalk = sidewalks(tags);
    let against = matches!(tags.get("oneway"), "-1" | "reverse");
    if against {
        centreline.reverse();
        sidewalk = SidewalkSides { left: sidewalk.right, right: sidewalk.left };
    }
    let implied = matches!(tags.get("junction"), "roundabout" | "circular") || tags.get("highway") == "motorway";
    let oneway = match tags.get("oneway") {
        "yes" | "true" | "1" => true,
        "" => implied,
        _ => against,
    };
    Road {
        lanes: count(&["lanes"]).or_else(both),
        width_m: values.number(&["width"], length_m, 0.3..=100.0),
        oneway,
        sidewalk,
        layer: layer(tags),
        bridge: tags.has("bridge"),
        tunnel: in_tunnel(tags),
        surface: tags.get("surface").to_owned(),
        name: tags.get("name").to_owned(),
        ..Road::new(id, kind, centreline)
    }
}

/// A sidewalk that is a way of its own (`separate`) is not the road's: it would be there twice.
fn sidewalks(tags: &Tags) -> SidewalkSides {
    let side = |value: &str| match value {
        "yes" => Some(true),
        "no" | "none" | "separate" => Some(false),
        _ => None,
    };
    let (left, right) = match tags.get("sidewalk") {
        "both" | "yes" => (Some(true), Some(true)),
        "left" => (Some(true), Some(false)),
        "right" => (Some(false), Some(true)),
        "no" | "none" | "separate" => (Some(false), Some(false)),
        _ => (None, None),
    };
    let both = side(tags.get("sidewalk:both"));
    SidewalkSides {
        left: side(tags.get("sidewalk:left")).or(both).or(left),
        right: side(tags.get("sidewalk:right")).or(both).or(right),
    }
}

/// A building or a part of one.
pub(super) fn building(id: i64, footprint: Polygon, tags: &Tags, report: &Report) -> Building {
    let owner = if id < 0 { format!("relation {}", -id) } else { format!("way {id}") };
    let values = Values { tags, owner: &owner, report };
    let part = !tags.has("building");
    let height_m = values.number(&["height", "building:height", "est_height"], length_m, 0.1..=1000.0);
    let min_level = || values.number(&["building:min_level", "min_level"], decimal, 0.0..=200.0);
    let min_height_m = values
        .number(&["min_height", "building:min_height"], length_m, 0.0..=1000.0)
        .or_else(|| min_level().map(|levels| levels * STOREY_M))
        .filter(|&min_m| {
            let below = height_m.is_none_or(|height_m| min_m < height_m);
            if !below {
                let example = format!("{owner}: from {min_m} m up");
                report.note(Outcome::Dropped, "osm: min_height above the height", example);
            }
            below
        });
    Building {
        part,
        height_m,
        min_height_m: min_height_m.unwrap_or(0.0),
        levels: values.number(&["building:levels", "levels"], decimal, 0.0..=200.0),
        roof: values.parsed(&["roof:shape"], roof_shape),
        roof_height_m: values.number(&["roof:height"], length_m, 0.0..=200.0),
        material: tags
            .first(&["building:material", "building:facade:material", "building:cladding", "material"])
            .to_owned(),
        color: values.parsed(&["building:colour", "building:color", "building:facade:colour", "colour"], linear_color),
        roof_color: values.parsed(&["roof:colour", "roof:color"], linear_color),
        name: tags.get("name").to_owned(),
        ..Building::new(id, footprint, tags.get(if part { "building:part" } else { "building" }))
    }
}

fn roof_shape(text: &str) -> Option<RoofShape> {
    Some(match text {
        "flat" => RoofShape::Flat,
        "gabled" | "pitched" | "saltbox" | "gabled_height_moved" | "double_saltbox" => RoofShape::Gabled,
        "hipped" | "side_hipped" => RoofShape::Hipped,
        "half-hipped" | "half_hipped" | "side_half-hipped" => RoofShape::HalfHipped,
        "pyramidal" => RoofShape::Pyramidal,
        "gambrel" => RoofShape::Gambrel,
        "mansard" => RoofShape::Mansard,
        "skillion" | "lean_to" | "quadruple_saltbox" => RoofShape::Skillion,
        "dome" => RoofShape::Dome,
        "cone" | "conical" => RoofShape::Cone,
        "onion" => RoofShape::Onion,
        "round" | "barrel" => RoofShape::Round,
        _ => return None,
    })
}
