//! `geometry`: its type, and its coordinates however deep they are nested.

use serde::de::{IgnoredAny, MapAccess, SeqAccess};

use super::json::{Scalar, Take, Text, To};

/// How deep a position lies in the coordinates of a MultiPolygon, the deepest of all.
const DEEPEST: usize = 3;

/// What a geometry is, by the positions of its lines or rings: x and y, which are longitude and latitude.
#[derive(Debug, PartialEq)]
pub(super) enum Geometry<'g> {
    Points(&'g [[f64; 2]]),
    Lines(Vec<&'g [[f64; 2]]>),
    /// Of each polygon its rings.
    Polygons(Vec<Vec<&'g [[f64; 2]]>>),
}

/// A geometry as it stands in the file.
#[derive(Debug, Default)]
pub(super) struct Draft {
    pub(super) kind: Text,
    coordinates: Coordinates,
    /// It is an object, and not null.
    pub(super) is_there: bool,
}

impl Take for Draft {
    fn scalar(&mut self, value: Scalar) {
        self.is_there = !matches!(value, Scalar::Null);
    }

    fn object<'de, A: MapAccess<'de>>(&mut self, mut object: A) -> Result<(), A::Error> {
        self.is_there = true;
        while let Some(key) = object.next_key::<String>()? {
            match key.as_str() {
                "type" => object.next_value_seed(To(&mut self.kind))?,
                "coordinates" => {
                    self.coordinates = Coordinates::default();
                    object.next_value_seed(To(&mut self.coordinates))?;
                }
                _ => drop(object.next_value::<IgnoredAny>()?),
            }
        }
        Ok(())
    }
}

impl Draft {
    /// How many positions its coordinates have.
    pub(super) fn positions(&self) -> usize {
        self.coordinates.positions.len()
    }

    /// What it is; `None` where its coordinates are not those of its type, or the type is none that is read.
    pub(super) fn geometry(&self) -> Option<Geometry<'_>> {
        let Coordinates { positions, ends, at, odd, .. } = &self.coordinates;
        let depth = match self.kind.0.as_str() {
            "Point" => 0,
            "MultiPoint" | "LineString" => 1,
            "MultiLineString" | "Polygon" => 2,
            "MultiPolygon" => 3,
            _ => return None,
        };
        if *odd || *at != Some(depth) {
            return None;
        }
        let lists = |level: usize| {
            let starts = std::iter::once(0).chain(ends[level].iter().copied());
            starts.zip(&ends[level]).map(|(start, &end)| start..end)
        };
        let lines = |level: usize| lists(level).map(|line| &positions[line]);
        Some(match self.kind.0.as_str() {
            "Point" | "MultiPoint" => Geometry::Points(positions),
            "LineString" => Geometry::Lines(lines(0).collect()),
            "MultiLineString" => Geometry::Lines(lines(1).collect()),
            "Polygon" => Geometry::Polygons(vec![lines(1).collect()]),
            _ => {
                let mut rings = lists(2).peekable();
                let of = |polygon: std::ops::Range<usize>| {
                    let within = std::iter::from_fn(|| rings.next_if(|ring| ring.end <= polygon.end));
                    within.map(|ring| &positions[ring]).collect()
                };
                Geometry::Polygons(lists(1).map(of).collect())
            }
        })
    }
}

/// Nested lists of positions.
#[derive(Debug, Default)]
struct Coordinates {
    positions: Vec<[f64; 2]>,
    /// For each depth where each list there ends in `positions`.
    ends: [Vec<usize>; DEEPEST],
    /// How deep the positions lie; `None` where there are none.
    at: Option<usize>,
    /// They are no such lists.
    odd: bool,
    depth: usize,
    /// What the last value was.
    last: Last,
}

#[derive(Clone, Copy, Debug, Default)]
enum Last {
    Number(f64),
    List,
    #[default]
    Odd,
}

impl Take for Coordinates {
    fn scalar(&mut self, value: Scalar) {
        self.last = match value {
            Scalar::Whole(number) => Last::Number(number as f64),
            Scalar::Number(number) => Last::Number(number),
            _ => Last::Odd,
        };
        self.odd |= self.depth == 0;
    }

    fn list<'de, A: SeqAccess<'de>>(&mut self, mut list: A) -> Result<(), A::Error> {
        let depth = self.depth;
        let (mut numbers, mut lists, mut position) = (0usize, 0usize, [0.0; 2]);
        if depth > DEEPEST {
            self.odd = true;
            while list.next_element::<IgnoredAny>()?.is_some() {}
        }
        self.depth += 1;
        while list.next_element_seed(To(self))?.is_some() {
            match self.last {
                Last::Number(number) => {
                    position.get_mut(numbers).into_iter().for_each(|n| *n = number);
                    numbers += 1;
                }
                Last::List => lists += 1,
                Last::Odd => self.odd = true,
            }
        }
        self.depth = depth;
        self.last = Last::List;
        match (numbers, lists) {
            (2.., 0) => {
                self.odd |= *self.at.get_or_insert(depth) != depth;
                self.positions.push(position);
            }
            (0, _) if depth < DEEPEST => self.ends[depth].push(self.positions.len()),
            _ => self.odd = true,
        }
        Ok(())
    }

    fn object<'de, A: MapAccess<'de>>(&mut self, mut object: A) -> Result<(), A::Error> {
        (self.odd, self.last) = (true, Last::Odd);
        while object.next_entry::<IgnoredAny, IgnoredAny>()?.is_some() {}
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use serde::de::DeserializeSeed;

    use super::*;

    fn draft(text: &str) -> Draft {
        let mut draft = Draft::default();
        To(&mut draft).deserialize(&mut serde_json::Deserializer::from_str(text)).unwrap();
        draft
    }

    #[test]
    fn coordinates_are_those_of_their_type() {
        let check = |kind: &str, coordinates: &str, expect: Option<Geometry>| {
            // The type may stand before the coordinates or after them.
            for text in [
                format!(r#"{{"type": "{kind}", "coordinates": {coordinates}}}"#),
                format!(r#"{{"bbox": [0, 1], "coordinates": {coordinates}, "type": "{kind}"}}"#),
            ] {
                assert_eq!(draft(&text).geometry(), expect, "{text}");
            }
        };
        let (a, b, c) = ([1.0, 2.0], [3.5, 4.0], [5.0, -6.0]);
        check("Point", "[1, 2]", Some(Geometry::Points(&[a])));
        check("MultiPoint", "[[1, 2], [3.5, 4]]", Some(Geometry::Points(&[a, b])));
        check("LineString", "[[1, 2, 30.5], [3.5, 4], [5, -6]]", Some(Geometry::Lines(vec![&[a, b, c]])));
        check("LineString", "[[1, 2], [3.5, 4, 7, \"m\"]]", None);
        check("MultiLineString", "[[[1, 2], [3.5, 4]], [[5, -6]]]", Some(Geometry::Lines(vec![&[a, b], &[c]])));
        check("Polygon", "[[[1, 2], [3.5, 4]], [[5, -6]]]", Some(Geometry::Polygons(vec![vec![&[a, b], &[c]]])));
        check(
            "MultiPolygon",
            "[[[[1, 2], [3.5, 4]], [[5, -6]]], [], [[[1, 2]]]]",
            Some(Geometry::Polygons(vec![vec![&[a, b], &[c]], vec![], vec![&[a]]])),
        );
        check("Polygon", "[[1, 2], [3.5, 4]]", None);
        check("LineString", "[[[1, 2], [3.5, 4]]]", None);
        check("LineString", "[[1, 2], [[3, 4]]]", None);
        check("LineString", "[]", None);
        check("LineString", "[1, 2, 3, 4]", None);
        check("LineString", "[[1], [2]]", None);
        check("LineString", "[[1, null], [2, 3]]", None);
        check("LineString", "[[\"1\", \"2\"], [\"3\", \"4\"]]", None);
        check("LineString", "{\"0\": [1, 2]}", None);
        check("LineString", "7", None);
        check("MultiPolygon", "[[[[[1, 2]]]]]", None);
        check("GeometryCollection", "[1, 2]", None);
        check("Circle", "[1, 2]", None);
    }

    #[test]
    fn a_geometry_of_another_type_is_there_and_null_is_not() {
        assert!(!draft("null").is_there);
        assert!(draft("7").is_there && draft("7").geometry().is_none());
        assert!(draft("{}").is_there && draft("{}").geometry().is_none());
    }
}
