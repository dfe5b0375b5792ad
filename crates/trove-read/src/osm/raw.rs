//! Nodes, ways and relations as they stand in the file, whatever its format.

use trove_model::{Outcome, Report};

use crate::geo_extent::GeoExtent;

/// A key or value has at most 255 characters, of at most four bytes each.
pub(super) const LONGEST_WORDS: usize = 1020;
/// A way has at most 2000 nodes in the database; in extracts of old states of it more.
const LONGEST_WAY: usize = 50_000;

/// The tags that say something about what a place looks like; all others are not kept.
#[rustfmt::skip]
const KEYS: [&str; 126] = [
    "advertising", "aeroway", "amenity", "area", "area:highway", "barrier", "boundary", "bridge", "building",
    "building:cladding", "building:color", "building:colour", "building:facade:colour", "building:facade:material",
    "building:height", "building:levels", "building:material", "building:min_height", "building:min_level",
    "building:part", "bus", "colour", "craft", "crossing", "crossing:markings", "crossing_ref", "cycleway",
    "cycleway:both", "cycleway:left", "cycleway:right", "direction", "emergency", "est_height", "est_width",
    "fence_type", "fire_hydrant:type", "footway", "genus", "height", "highway", "historic", "indoor",
    "junction", "lamp_mount", "landcover", "landuse", "lanes", "lanes:backward", "lanes:forward", "layer",
    "leaf_type", "leisure", "level", "levels", "lit", "location", "man_made", "manhole", "material", "maxspeed",
    "maxspeed:backward", "maxspeed:forward", "min_height", "min_level", "name", "natural", "office", "oneway",
    "parking", "parking:both", "parking:both:orientation", "parking:lane:both", "parking:lane:both:diagonal",
    "parking:lane:both:parallel", "parking:lane:both:perpendicular", "parking:lane:left", "parking:lane:left:diagonal",
    "parking:lane:left:parallel", "parking:lane:left:perpendicular", "parking:lane:right",
    "parking:lane:right:diagonal", "parking:lane:right:parallel", "parking:lane:right:perpendicular", "parking:left",
    "parking:left:orientation", "parking:right", "parking:right:orientation", "path", "place", "playground", "power",
    "public_transport", "railway", "roof:color", "roof:colour", "roof:direction", "roof:height", "roof:levels",
    "roof:material", "roof:orientation", "roof:shape", "roof:slope:direction", "shop", "sidewalk", "sidewalk:both",
    "sidewalk:left", "sidewalk:right", "species", "start_date", "support", "surface", "taxon", "tourism",
    "traffic_calming", "traffic_sign", "traffic_signals:direction", "tunnel", "turn:lanes", "turn:lanes:backward",
    "turn:lanes:forward", "type", "wall", "waterway", "width", "width:carriageway", "zone:maxspeed",
];

/// Whether a tag of this key is kept.
pub(super) fn is_kept(key: &str) -> bool {
    KEYS.binary_search(&key).is_ok()
}

/// Tags of [`KEYS`].
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Tags(Vec<(&'static str, String)>);

impl Tags {
    /// Adds a tag where its key is one that is looked at; how many bytes it takes.
    pub(super) fn push(&mut self, key: &str, value: &str) -> usize {
        let Ok(i) = KEYS.binary_search(&key) else { return 0 };
        self.0.push((KEYS[i], value.trim().to_owned()));
        size_of_val(&self.0[0]) + value.len()
    }

    /// Adds the tags of another thing; of two of the same key the first counts.
    pub(super) fn extend(&mut self, tags: Self) {
        self.0.extend(tags.0);
    }

    /// The value of a key; empty where it is not tagged.
    pub(super) fn get(&self, key: &str) -> &str {
        debug_assert!(KEYS.binary_search(&key).is_ok(), "{key} is not kept");
        self.0.iter().find(|(k, _)| *k == key).map_or("", |(_, value)| value)
    }

    /// The value of the first key that is tagged; empty where none is.
    pub(super) fn first(&self, keys: &[&str]) -> &str {
        keys.iter().map(|key| self.get(key)).find(|value| !value.is_empty()).unwrap_or("")
    }

    /// Whether a key is tagged with anything but a denial.
    pub(super) fn has(&self, key: &str) -> bool {
        !matches!(self.get(key), "" | "no" | "none" | "0" | "false")
    }

    /// Whether nothing is tagged.
    pub(super) fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// The key that says what a thing is, for reports; empty where none does.
    pub(super) fn main_key(&self) -> &'static str {
        #[rustfmt::skip]
        const MAIN: [&str; 25] = [
            "building", "building:part", "highway", "area:highway", "railway", "barrier", "natural", "landuse", "landcover",
            "leisure", "amenity", "man_made", "waterway", "power", "public_transport", "place", "traffic_calming", "tourism",
            "historic", "playground", "boundary", "aeroway", "emergency", "office", "indoor",
        ];
        let tagged = |key: &&&str| self.has(key);
        MAIN.iter().find(tagged).copied().unwrap_or("")
    }
}

/// A node's place.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct RawNode {
    pub(super) id: i64,
    pub(super) lat_deg: f64,
    pub(super) lon_deg: f64,
}

/// A node with tags.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct RawThing {
    pub(super) node: RawNode,
    pub(super) tags: Tags,
}

#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct RawWay {
    pub(super) id: i64,
    pub(super) nodes: Vec<i64>,
    pub(super) tags: Tags,
}

impl RawWay {
    /// Whether it ends where it begins.
    pub(super) fn is_closed(&self) -> bool {
        self.nodes.len() > 3 && self.nodes.first() == self.nodes.last()
    }
}

/// A relation with its member ways and nodes.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct RawRelation {
    pub(super) id: i64,
    pub(super) ways: Vec<i64>,
    pub(super) nodes: Vec<i64>,
    pub(super) tags: Tags,
}

/// A file's content.
#[derive(Debug, Default, PartialEq)]
pub(super) struct Raw {
    /// Sorted by id after [`Raw::sorted`].
    pub(super) nodes: Vec<RawNode>,
    pub(super) things: Vec<RawThing>,
    /// Sorted by id after [`Raw::sorted`].
    pub(super) ways: Vec<RawWay>,
    /// Sorted by id after [`Raw::sorted`].
    pub(super) relations: Vec<RawRelation>,
    /// What the file says that it covers; ways may lead beyond it.
    pub(super) covers: Option<GeoExtent>,
    /// Licence, with whom to name; empty where the file does not state any.
    pub(super) licence: String,
}

impl Raw {
    /// Adds a node, or notes why it is not one.
    pub(super) fn add_node(&mut self, node: RawNode, tags: Tags, report: &Report) {
        let (lat_deg, lon_deg) = (node.lat_deg, node.lon_deg);
        if !(lat_deg.abs() <= 90.0 && lon_deg.abs() <= 180.0) {
            let example = format!("node {} at latitude {lat_deg}, longitude {lon_deg}", node.id);
            report.note(Outcome::Dropped, "osm: node with impossible coordinates", example);
            return;
        }
        self.nodes.push(node);
        if !tags.is_empty() {
            self.things.push(RawThing { node, tags });
        }
    }

    /// Notes that the file covers this too.
    pub(super) fn cover(&mut self, extent: GeoExtent) {
        let whole = self.covers.get_or_insert(extent);
        *whole = GeoExtent {
            min_lat_deg: whole.min_lat_deg.min(extent.min_lat_deg),
            max_lat_deg: whole.max_lat_deg.max(extent.max_lat_deg),
            min_lon_deg: whole.min_lon_deg.min(extent.min_lon_deg),
            max_lon_deg: whole.max_lon_deg.max(extent.max_lon_deg),
        };
    }

    /// Adds a way, or notes why it is none.
    pub(super) fn add_way(&mut self, way: RawWay, report: &Report) {
        if way.nodes.len() > LONGEST_WAY {
            let example = format!("way {} with {} nodes", way.id, way.nodes.len());
            report.note(Outcome::Dropped, "osm: way with more nodes than ways may have", example);
        } else {
            self.ways.push(way);
        }
    }

    /// Everything in the order of ids; of those with the same id the first.
    pub(super) fn sorted(mut self) -> Self {
        // The one number that has no negative, by which ways and relations are told apart.
        let ids = self.ways.iter_mut().map(|w| &mut w.id).chain(self.relations.iter_mut().map(|r| &mut r.id));
        ids.for_each(|id| *id = (*id).max(-i64::MAX));
        self.nodes.sort_by_key(|n| n.id);
        self.nodes.dedup_by_key(|n| n.id);
        self.things.sort_by_key(|t| t.node.id);
        self.things.dedup_by_key(|t| t.node.id);
        self.ways.sort_by_key(|w| w.id);
        self.ways.dedup_by_key(|w| w.id);
        self.relations.sort_by_key(|r| r.id);
        self.relations.dedup_by_key(|r| r.id);
        self
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn keys_can_be_searched() {
        assert!(KEYS.is_sorted());
    }
}
