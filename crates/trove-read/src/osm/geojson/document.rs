//! A file's features, one after another.

use serde::de::{DeserializeSeed, IgnoredAny, MapAccess, SeqAccess};

use super::super::fault::Fault;
use super::geometry::Draft;
use super::json::{Take, Text, To};
use super::properties::Properties;

/// A feature as it stands in the file.
#[derive(Debug, Default)]
pub(super) struct Feature {
    pub(super) kind: Text,
    pub(super) id: Text,
    pub(super) geometry: Draft,
    pub(super) properties: Properties,
}

/// What the file says beside its features.
#[derive(Debug, Default)]
pub(super) struct Heading {
    /// The name of its coordinate reference system (GeoJSON of 2008); empty where there is none.
    pub(super) crs: String,
    pub(super) licence: String,
}

/// Whoever wants the features.
pub(super) trait Collector {
    /// Takes one; an error ends the reading.
    fn feature(&mut self, feature: &Feature) -> Result<(), Fault>;

    /// Takes note of a line that is no JSON.
    fn broken_line(&mut self, line: usize, error: &serde_json::Error);
}

/// Gives every feature of a file to `collector`: of one value, or of one a line (newline-delimited GeoJSON).
pub(super) fn read(bytes: &[u8], collector: &mut impl Collector) -> Result<Heading, Fault> {
    let mut document = Document { collector, heading: Heading::default(), fault: None, own: Feature::default() };
    let first = bytes.iter().position(|&b| b == b'\n').map_or(bytes, |end| &bytes[..end]);
    let more = bytes[first.len()..].iter().any(|b| !b.is_ascii_whitespace());
    if more && serde_json::from_slice::<IgnoredAny>(first).is_ok() {
        for (i, line) in bytes.split(|&b| b == b'\n').enumerate() {
            if line.iter().all(u8::is_ascii_whitespace) {
                continue;
            }
            if let Err(error) = document.value(line) {
                document.fault.take().map_or(Ok(()), Err)?;
                document.collector.broken_line(i + 1, &error);
            }
        }
    } else if let Err(error) = document.value(bytes) {
        return Err(document.fault.take().unwrap_or_else(|| fault_of(bytes, &error)));
    }
    Ok(document.heading)
}

/// A FeatureCollection or a single feature.
struct Document<'c, C> {
    collector: &'c mut C,
    heading: Heading,
    fault: Option<Fault>,
    /// What it is itself, where it is a feature.
    own: Feature,
}

impl<C: Collector> Document<'_, C> {
    fn value(&mut self, bytes: &[u8]) -> Result<(), serde_json::Error> {
        let mut deserializer = serde_json::Deserializer::from_slice(bytes);
        self.own = Feature::default();
        To(&mut *self).deserialize(&mut deserializer)?;
        deserializer.end()?;
        let own = std::mem::take(&mut self.own);
        if own.kind.0 != "FeatureCollection" { self.give(&own) } else { Ok(()) }
    }

    fn give<E: serde::de::Error>(&mut self, feature: &Feature) -> Result<(), E> {
        self.collector.feature(feature).map_err(|fault| {
            self.fault = Some(fault);
            E::custom("not taken")
        })
    }
}

impl<C: Collector> Take for Document<'_, C> {
    fn object<'de, A: MapAccess<'de>>(&mut self, mut object: A) -> Result<(), A::Error> {
        while let Some(key) = object.next_key::<String>()? {
            match key.as_str() {
                "features" => object.next_value_seed(To(&mut Features(self)))?,
                "crs" => object.next_value_seed(To(&mut Crs(&mut self.heading.crs)))?,
                // As Overpass turbo, JOSM and others state it.
                "copyright" | "attribution" | "licence" | "license" => {
                    let mut text = Text::default();
                    object.next_value_seed(To(&mut text))?;
                    if self.heading.licence.is_empty() {
                        self.heading.licence = text.0;
                    }
                }
                key => member(&mut self.own, key, &mut object)?,
            }
        }
        Ok(())
    }
}

struct Features<'d, 'c, C>(&'d mut Document<'c, C>);

impl<C: Collector> Take for Features<'_, '_, C> {
    fn list<'de, A: SeqAccess<'de>>(&mut self, mut list: A) -> Result<(), A::Error> {
        let mut feature = Feature::default();
        while list.next_element_seed(To(&mut feature))?.is_some() {
            self.0.give::<A::Error>(&std::mem::take(&mut feature))?;
        }
        Ok(())
    }
}

impl Take for Feature {
    fn object<'de, A: MapAccess<'de>>(&mut self, mut object: A) -> Result<(), A::Error> {
        while let Some(key) = object.next_key::<String>()? {
            member(self, &key, &mut object)?;
        }
        Ok(())
    }
}

fn member<'de, A: MapAccess<'de>>(feature: &mut Feature, key: &str, object: &mut A) -> Result<(), A::Error> {
    match key {
        "type" => object.next_value_seed(To(&mut feature.kind)),
        "id" => object.next_value_seed(To(&mut feature.id)),
        "geometry" => object.next_value_seed(To(&mut feature.geometry)),
        "properties" => object.next_value_seed(To(&mut feature.properties)),
        _ => object.next_value::<IgnoredAny>().map(drop),
    }
}

/// `{"type": "name", "properties": {"name": "…"}}`, of which the name alone is of use.
struct Crs<'n>(&'n mut String);

impl Take for Crs<'_> {
    fn object<'de, A: MapAccess<'de>>(&mut self, mut object: A) -> Result<(), A::Error> {
        while let Some(key) = object.next_key::<String>()? {
            match key.as_str() {
                "properties" => object.next_value_seed(To(&mut Crs(self.0)))?,
                "name" => {
                    let mut text = Text::default();
                    object.next_value_seed(To(&mut text))?;
                    *self.0 = text.0;
                }
                _ => drop(object.next_value::<IgnoredAny>()?),
            }
        }
        Ok(())
    }
}

fn fault_of(bytes: &[u8], error: &serde_json::Error) -> Fault {
    let line_start: usize =
        bytes.split_inclusive(|&b| b == b'\n').take(error.line().saturating_sub(1)).map(<[u8]>::len).sum();
    let at = usize::min(line_start + error.column(), bytes.len());
    let near = String::from_utf8_lossy(&bytes[at.saturating_sub(2)..(at + 10).min(bytes.len())]);
    let found = error.to_string();
    let found = found.split(" at line").next().unwrap_or_default();
    let column = error.column();
    let fault = if error.is_eof() {
        Fault::new("whole GeoJSON", "the end of the file before its end", "the file is cut off: download it again")
    } else if near.contains("NaN") || near.contains("Infinity") {
        let remedy = "write null for what is not known; no other reader takes it either";
        Fault::new("GeoJSON", format!("NaN or Infinity at column {column}, which are no JSON"), remedy)
    } else {
        let remedy = "the file is damaged or no JSON: write or download it again";
        Fault::new("GeoJSON", format!("{found} at column {column}"), remedy)
    };
    fault.at(at as u64)
}
