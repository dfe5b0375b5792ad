//! `.osm`: OpenStreetMap XML, as the API, JOSM and Overpass write it.

use std::io::BufRead;

use quick_xml::events::{BytesStart, Event};
use quick_xml::{Reader, XmlVersion};
use trove_model::{Outcome, Report};

use crate::geo_extent::GeoExtent;

use super::fault::Fault;
use super::raw::{LONGEST_WORDS, Raw, RawNode, RawRelation, RawWay, Tags};

/// The element that is open below the root.
enum Open {
    Nothing,
    Node(Option<RawNode>),
    Way(RawWay),
    Relation(RawRelation),
    /// Deleted, or without an id.
    Ignored,
}

/// Reads a whole file; a file that ends early is an error.
pub(super) fn parse(input: impl BufRead, report: &Report) -> Result<Raw, Fault> {
    let mut reader = Reader::from_reader(input);
    let (mut raw, mut buffer) = (Raw::default(), Vec::new());
    let (mut open, mut tags, mut depth) = (Open::Nothing, Tags::default(), 0usize);
    loop {
        let event = reader.read_event_into(&mut buffer);
        let byte = reader.buffer_position();
        match event {
            Err(e) => return Err(xml_fault(reader.error_position(), e)),
            Ok(Event::Start(element)) => {
                begin(&element, depth, &mut open, &mut tags, &mut raw, report).map_err(|e| e.at(byte))?;
                depth += 1;
            }
            Ok(Event::Empty(element)) => {
                begin(&element, depth, &mut open, &mut tags, &mut raw, report).map_err(|e| e.at(byte))?;
                if depth == 1 {
                    end(&mut open, &mut tags, &mut raw, report);
                }
            }
            Ok(Event::End(_)) => {
                depth = depth.saturating_sub(1);
                if depth == 1 {
                    end(&mut open, &mut tags, &mut raw, report);
                }
                if depth == 0 {
                    return Ok(raw);
                }
            }
            Ok(Event::Eof) => {
                let found = if depth == 0 { "no element at all" } else { "the end of the file before it" };
                return Err(Fault::new("</osm>", found, "the file is cut off: download it again").at(byte));
            }
            Ok(_) => {}
        }
        buffer.clear();
    }
}

fn begin(
    element: &BytesStart,
    depth: usize,
    open: &mut Open,
    tags: &mut Tags,
    raw: &mut Raw,
    report: &Report,
) -> Result<(), Fault> {
    let name = element.name();
    let name = name.as_ref();
    match (depth, name) {
        (0, "osm") => {}
        (0, _) => {
            let remedy = "give an OpenStreetMap extract (.osm or .osm.pbf); servers answer in HTML when they are busy";
            return Err(Fault::new("<osm>", format!("<{name}>"), remedy));
        }
        (1, "bounds") => {
            let mut edges = [None; 4];
            for_attributes(element, |name, text| {
                let at = ["minlat", "maxlat", "minlon", "maxlon"].iter().position(|edge| *edge == name);
                at.into_iter().for_each(|at| edges[at] = text.parse().ok());
            })?;
            let extent = if let [Some(south), Some(north), Some(west), Some(east)] = edges {
                GeoExtent::between([south, north], [west, east])
            } else {
                None
            };
            extent.into_iter().for_each(|extent| raw.cover(extent));
        }
        (1, "node" | "way" | "relation") => {
            *tags = Tags::default();
            *open = element_named(name, element, report)?;
        }
        (2, "tag") => {
            let (mut key, mut value) = (String::new(), String::new());
            for_attributes(element, |name, text| match name {
                "k" => key = text.to_owned(),
                "v" => value = text.to_owned(),
                _ => {}
            })?;
            if key.len().max(value.len()) > LONGEST_WORDS {
                let example = format!("{} bytes", key.len().max(value.len()));
                report.note(Outcome::Dropped, "osm: text longer than a tag may be", example);
            } else {
                tags.push(&key, &value);
            }
        }
        (2, "nd") => {
            if let Open::Way(way) = open {
                let mut place = [None; 2];
                let mut reference = None;
                for_attributes(element, |name, text| match name {
                    "ref" => reference = text.parse().ok(),
                    // Overpass writes the places beside the references (`out geom`).
                    "lat" => place[0] = text.parse().ok(),
                    "lon" => place[1] = text.parse().ok(),
                    _ => {}
                })?;
                match (reference, place) {
                    (Some(id), [Some(lat_deg), Some(lon_deg)]) => {
                        way.nodes.push(id);
                        raw.add_node(RawNode { id, lat_deg, lon_deg }, Tags::default(), report);
                    }
                    (Some(id), _) => way.nodes.push(id),
                    (None, _) => report.note(
                        Outcome::Dropped,
                        "osm: node reference that is not a number",
                        format!("way {}", way.id),
                    ),
                }
            }
        }
        (2, "member") => {
            if let Open::Relation(relation) = open {
                let (mut kind, mut reference) = (String::new(), None::<i64>);
                for_attributes(element, |name, text| match name {
                    "type" => kind = text.to_owned(),
                    "ref" => reference = text.parse().ok(),
                    _ => {}
                })?;
                match kind.as_str() {
                    "way" => relation.ways.extend(reference),
                    "node" => relation.nodes.extend(reference),
                    _ => {}
                }
            }
        }
        _ => {}
    }
    Ok(())
}

fn element_named(name: &str, element: &BytesStart, report: &Report) -> Result<Open, Fault> {
    let (mut id, mut lat_deg, mut lon_deg, mut deleted) = (None, None, None, false);
    for_attributes(element, |name, text| match name {
        "id" => id = text.parse().ok(),
        "lat" => lat_deg = text.parse().ok(),
        "lon" => lon_deg = text.parse().ok(),
        "visible" => deleted |= text == "false",
        "action" => deleted |= text == "delete",
        _ => {}
    })?;
    if deleted {
        return Ok(Open::Ignored);
    }
    let Some(id) = id else {
        report.note(Outcome::Dropped, "osm: element whose id is not a number", name);
        return Ok(Open::Ignored);
    };
    Ok(match (name, lat_deg, lon_deg) {
        ("node", Some(lat_deg), Some(lon_deg)) => Open::Node(Some(RawNode { id, lat_deg, lon_deg })),
        ("node", ..) => {
            report.note(Outcome::Dropped, "osm: node without coordinates", format!("node {id}"));
            Open::Node(None)
        }
        ("way", ..) => Open::Way(RawWay { id, ..RawWay::default() }),
        _ => Open::Relation(RawRelation { id, ..RawRelation::default() }),
    })
}

fn end(open: &mut Open, tags: &mut Tags, raw: &mut Raw, report: &Report) {
    let tags = std::mem::take(tags);
    match std::mem::replace(open, Open::Nothing) {
        Open::Node(Some(node)) => raw.add_node(node, tags, report),
        Open::Way(way) => raw.add_way(RawWay { tags, ..way }, report),
        Open::Relation(relation) => raw.relations.push(RawRelation { tags, ..relation }),
        Open::Node(None) | Open::Ignored | Open::Nothing => {}
    }
}

fn for_attributes(element: &BytesStart, mut take: impl FnMut(&str, &str)) -> Result<(), Fault> {
    for attribute in element.attributes() {
        let attribute = attribute.map_err(|e| xml_fault(0, e.into()))?;
        let value = attribute.normalized_value(XmlVersion::Implicit1_0).map_err(|e| xml_fault(0, e))?;
        take(attribute.key.as_ref(), &value);
    }
    Ok(())
}

fn xml_fault(byte: u64, error: quick_xml::Error) -> Fault {
    match error {
        quick_xml::Error::Io(source) => Fault::Io(std::io::Error::new(source.kind(), source.to_string())),
        e => Fault::new("well-formed XML", e.to_string(), "the file is damaged: download it again").at(byte),
    }
}
