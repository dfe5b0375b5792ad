//! Properties of features → OpenStreetMap's tags, by a table.

use std::collections::BTreeMap;
use std::sync::LazyLock;

use serde::de::{IgnoredAny, MapAccess, SeqAccess};

use super::super::raw::{LONGEST_WORDS, Tags, is_kept};
use super::json::{Presence, Scalar, Take, To, text_of};

/// Deeper objects are not looked into.
const DEEPEST: usize = 8;
/// More values of one feature are not looked at.
const MOST: usize = 256;

const TABLE: &str = include_str!("properties.tsv");

/// Rows by their property, each with its number: the first that gives a key decides.
static ROWS: LazyLock<BTreeMap<&str, Vec<(usize, Row)>>> = LazyLock::new(|| {
    let mut rows = BTreeMap::<&str, Vec<(usize, Row)>>::new();
    let lines = TABLE.lines().filter(|line| !line.is_empty() && !line.starts_with('#'));
    for (i, line) in lines.enumerate() {
        if let [of, property, value, tag] = line.split('\t').collect::<Vec<_>>()[..] {
            rows.entry(property).or_default().push((i, Row { of, value, tag }));
        }
    }
    rows
});

/// What a property of this value is as a tag.
#[derive(Clone, Copy, Debug)]
struct Row {
    of: &'static str,
    value: &'static str,
    tag: &'static str,
}

/// What a feature is drawn as.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Of {
    Point,
    Line,
    Area,
}

impl Row {
    fn is_of(&self, of: Of) -> bool {
        matches!((self.of, of), ("any", _) | ("line", Of::Line) | ("area", Of::Area))
    }
}

/// `properties`, as far as they may mean something.
#[derive(Debug, Default)]
pub(super) struct Properties {
    /// Each value with its name, in which those of objects within objects are joined by dots.
    found: Vec<(String, String)>,
    /// They are neither an object nor null.
    pub(super) odd: bool,
    /// Values that hold on a part of the line only, and are left out.
    pub(super) partial: usize,
    /// Values that are longer than a tag's may be.
    pub(super) too_long: usize,
    path: String,
    depth: usize,
    in_list: bool,
    /// The members of the object in a list that is told as a whole, with the length of its path.
    whole: Option<(usize, Vec<String>)>,
}

impl Properties {
    /// How much memory they take, bytes.
    pub(super) fn size(&self) -> usize {
        self.found.iter().map(|(name, value)| size_of::<(String, String)>() + name.len() + value.len()).sum()
    }

    /// Their tags, and whether they are OpenStreetMap's own, which say what the thing is.
    pub(super) fn tags(&self, of: Of) -> (Tags, bool) {
        let mut own = Tags::default();
        for (key, value) in &self.found {
            own.push(key, value);
        }
        if !own.main_key().is_empty() {
            return (own, true);
        }
        let mut told: Vec<(usize, &str, &str)> = Vec::new();
        for (name, value) in &self.found {
            let rows = ROWS.get(name.as_str()).into_iter().flatten().filter(|(_, row)| row.is_of(of));
            let rows: Vec<&(usize, Row)> = rows.collect();
            let exact = rows.iter().any(|(_, row)| row.value == value);
            let before = told.len();
            let fitting = rows.iter().filter(|(_, row)| row.value == if exact { value } else { "*" });
            told.extend(fitting.map(|(i, row)| (*i, row.tag, value.as_str())));
            if told.len() == before {
                // After all rows.
                told.push((usize::MAX, name, value));
            }
        }
        told.sort_by_key(|(i, ..)| *i);
        let mut tags: Vec<(&str, String)> = Vec::new();
        for (i, tag, value) in told {
            let has = |tags: &[(&str, String)], key: &str| tags.iter().position(|(k, _)| *k == key);
            if i == usize::MAX {
                tags.extend(has(&tags, tag).is_none().then(|| (tag, value.to_owned())));
            } else if let Some((key, ending)) = tag.split_once("+=") {
                let whole = has(&tags, key).map(|at| &mut tags[at].1).filter(|whole| !whole.ends_with(ending));
                whole.into_iter().for_each(|whole| whole.push_str(ending));
            } else if let Some((key, template)) = tag.split_once('=')
                && has(&tags, key).is_none()
            {
                tags.push((key, template.replace('*', value)));
            }
        }
        let mut translated = Tags::default();
        for (key, value) in &tags {
            translated.push(key, value);
        }
        (translated, false)
    }
}

impl Take for Properties {
    fn scalar(&mut self, value: Scalar) {
        let Some(text) = text_of(value) else { return };
        self.odd |= self.depth == 0;
        if text.len() > LONGEST_WORDS {
            self.too_long += 1;
            return;
        }
        if let Some((start, members)) = &mut self.whole
            && members.len() < MOST
        {
            members.push(format!("{}={text}", self.path.get(*start..).unwrap_or_default()));
        }
        let means = ROWS.contains_key(self.path.as_str()) || is_kept(&self.path);
        if means && self.found.len() < MOST {
            self.found.push((self.path.clone(), text));
        }
    }

    fn list<'de, A: SeqAccess<'de>>(&mut self, mut list: A) -> Result<(), A::Error> {
        self.odd |= self.depth == 0;
        if self.depth == 0 || self.depth > DEEPEST {
            while list.next_element::<IgnoredAny>()?.is_some() {}
            return Ok(());
        }
        self.depth += 1;
        loop {
            self.in_list = true;
            if list.next_element_seed(To(self))?.is_none() {
                break;
            }
        }
        self.in_list = false;
        self.depth -= 1;
        Ok(())
    }

    fn object<'de, A: MapAccess<'de>>(&mut self, mut object: A) -> Result<(), A::Error> {
        if self.depth > DEEPEST {
            while object.next_entry::<IgnoredAny, IgnoredAny>()?.is_some() {}
            return Ok(());
        }
        let (start, before) = (self.path.len(), self.found.len());
        let in_list = std::mem::take(&mut self.in_list);
        let whole = format!("{}[]", self.path);
        let is_whole = in_list && self.whole.is_none() && ROWS.contains_key(whole.as_str());
        if is_whole {
            self.whole = Some((start + 1, Vec::new()));
        }
        let mut partial = Presence::default();
        self.depth += 1;
        while let Some(key) = object.next_key::<String>()? {
            if in_list && key == "between" {
                object.next_value_seed(To(&mut partial))?;
            } else if start + key.len() > LONGEST_WORDS {
                object.next_value::<IgnoredAny>()?;
            } else {
                self.path.extend([if start > 0 { "." } else { "" }, &key]);
                object.next_value_seed(To(self))?;
                self.path.truncate(start);
            }
            self.in_list = false;
        }
        self.depth -= 1;
        let told = if is_whole { self.whole.take() } else { None };
        if partial.0 {
            self.partial += usize::from(self.found.len() > before || told.is_some());
            self.found.truncate(before);
        } else if let Some((_, mut members)) = told {
            members.sort();
            let value = members.join(" ");
            if value.len() <= LONGEST_WORDS && self.found.len() < MOST {
                self.found.push((whole, value));
            }
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use serde::de::DeserializeSeed;

    use super::*;

    fn properties(text: &str) -> Properties {
        let mut properties = Properties::default();
        To(&mut properties).deserialize(&mut serde_json::Deserializer::from_str(text)).unwrap();
        properties
    }

    #[test]
    fn every_row_is_whole_and_gives_a_key_that_is_kept() {
        let lines = TABLE.lines().filter(|line| !line.is_empty() && !line.starts_with('#')).count();
        assert_eq!(ROWS.values().map(Vec::len).sum::<usize>(), lines);
        for (property, rows) in &*ROWS {
            for (i, (_, row)) in rows.iter().enumerate() {
                assert!(["any", "line", "area"].contains(&row.of), "{property}: {row:?}");
                let key = row.tag.split_once("+=").or(row.tag.split_once('=')).map(|(key, _)| key);
                assert!(row.tag == "-" || key.is_some_and(is_kept), "{property}: {row:?}");
                let twice = rows[..i].iter().any(|(_, other)| (other.of, other.value) == (row.of, row.value));
                assert!(!twice, "{property}: {row:?} stands twice");
            }
        }
    }

    #[test]
    fn properties_are_tags_whoever_wrote_them() {
        let check = |of: Of, text: &str, tags: &str, is_own: bool| {
            let mut expect = Tags::default();
            for (key, value) in tags.split('|').filter_map(|tag| tag.split_once('=')) {
                expect.push(key, value);
            }
            assert_eq!(properties(text).tags(of), (expect, is_own), "{text}");
        };
        // OpenStreetMap's own, as osmtogeojson and Overpass turbo write them.
        check(
            Of::Line,
            r#"{"@id": "way/7", "highway": "primary", "lanes": 4, "width": 12.5, "oneway": true, "name": null, "class": "x"}"#,
            "highway=primary|lanes=4|width=12.5|oneway=yes",
            true,
        );
        // Microsoft's footprints.
        check(Of::Area, r#"{"height": -1.0, "confidence": -1}"#, "", false);
        check(Of::Area, r#"{"height": 5.25, "confidence": 0.9}"#, "height=5.25", false);
        check(Of::Area, "null", "", false);
        // Overture's buildings.
        check(
            Of::Area,
            r##"{"class": "apartments", "subtype": "residential", "height": 12, "num_floors": 4, "roof_shape": "half_hipped",
                "facade_color": "#aabbcc", "roof_direction": 90, "level": 1, "names": {"primary": "A", "common": {"en": "B"}},
                "sources": [{"property": "", "dataset": "OpenStreetMap"}], "version": 3, "is_underground": false}"##,
            "name=A|building=apartments|building:levels=4|layer=1|building:colour=#aabbcc|roof:shape=half_hipped\
             |roof:direction=90|height=12",
            false,
        );
        check(Of::Area, r#"{"subtype": "education", "class": null}"#, "building=school", false);
        check(Of::Area, r#"{"type": "building_part", "min_height": 3}"#, "building:part=yes|min_height=3", false);
        // Overture's segments.
        check(
            Of::Line,
            r#"{"subtype": "road", "class": "motorway", "subclass": "link", "road_surface": [{"value": "paved", "between": null}],
                "road_flags": [{"values": ["is_bridge", "is_link"]}], "width_rules": [{"value": 7.5}],
                "speed_limits": [{"max_speed": {"value": 35, "unit": "mph"}}],
                "access_restrictions": [{"access_type": "denied", "when": {"heading": "backward"}}]}"#,
            "highway=motorway_link|bridge=yes|surface=paved|width=7.5|maxspeed=35 mph|oneway=yes",
            false,
        );
        check(Of::Line, r#"{"class": "footway", "subclass": "crosswalk"}"#, "highway=footway|footway=crossing", false);
        check(Of::Line, r#"{"class": "tram", "subtype": "rail"}"#, "railway=rail", false);
        check(Of::Line, r#"{"class": "unknown"}"#, "highway=road", false);
        // Bicycles alone may not ride against it.
        check(
            Of::Line,
            r#"{"class": "service",
                "access_restrictions": [{"access_type": "denied", "when": {"heading": "backward", "mode": ["bicycle"]}}]}"#,
            "highway=service",
            false,
        );
        check(Of::Line, r#"{"class": "residential", "lanes": "2"}"#, "highway=residential|lanes=2", false);
        check(Of::Point, r#"{"class": "residential"}"#, "", false);
        check(Of::Area, "{}", "", false);
    }

    #[test]
    fn what_holds_on_a_part_of_a_line_is_left_out_and_counted() {
        let found = properties(
            r#"{"class": "primary", "road_flags": [{"values": ["is_bridge"], "between": [0.2, 0.3]}, {"values": ["is_covered"]}],
                "access_restrictions": [{"access_type": "denied", "when": {"heading": "backward"}, "between": [0, 0.5]}]}"#,
        );
        let (tags, _) = found.tags(Of::Line);
        assert_eq!((tags.get("bridge"), tags.get("oneway"), tags.get("tunnel")), ("", "", "building_passage"));
        assert_eq!(found.partial, 2);
    }

    #[test]
    fn properties_of_another_type_and_too_long_or_too_many_are_left_out() {
        assert!(properties("7").odd && properties("[{\"class\": \"x\"}]").odd && !properties("null").odd);
        let long = "x".repeat(LONGEST_WORDS + 1);
        let found = properties(&format!(r#"{{"name": "{long}", "{long}": 1, "class": "primary"}}"#));
        assert_eq!((found.too_long, found.found.len()), (1, 1));
        let many = format!(r#"{{"height": [{}0]}}"#, "1,".repeat(100_000));
        assert_eq!(properties(&many).found.len(), MOST);
        let nested = format!(r#"{{"height": {}3{}, "class": "x"}}"#, "[".repeat(100_000), "]".repeat(100_000));
        assert_eq!(properties(&nested).found.len(), 1);
    }
}
