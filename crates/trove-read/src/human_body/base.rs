//! The base mesh, a Wavefront OBJ of quads in groups.

use std::collections::BTreeMap;
use std::path::Path;

use glam::Vec3;

use super::file::{format, from_makehuman, text};
use crate::ReadError;

/// What a base mesh holds.
#[derive(Debug)]
pub(super) struct Base {
    pub(super) positions: Vec<Vec3>,
    pub(super) groups: BTreeMap<String, Vec<[u32; 4]>>,
}

/// Vertices and the faces of every group.
pub(super) fn parse(path: &Path) -> Result<Base, ReadError> {
    let text = text(path)?;
    let (mut positions, mut groups) = (Vec::new(), BTreeMap::<String, Vec<[u32; 4]>>::new());
    let mut group = String::new();
    for (i, line) in text.lines().enumerate() {
        let wrong = |expected: &str| format(path, format!("line {}", i + 1), expected, line);
        let mut words = line.split_ascii_whitespace();
        match words.next() {
            Some("v") => {
                let numbers: Vec<f32> = words.take(3).filter_map(|w| w.parse().ok()).collect();
                let [x, y, z] = numbers[..] else { return Err(wrong("three coordinates")) };
                let position = from_makehuman([x, y, z]);
                if !position.is_finite() {
                    return Err(wrong("finite coordinates"));
                }
                positions.push(position);
            }
            Some("g") => group = words.next().ok_or_else(|| wrong("a group's name"))?.to_owned(),
            Some("f") => {
                let corner = |word: &str| {
                    let number: usize = word.split('/').next()?.parse().ok()?;
                    (1..=positions.len()).contains(&number).then(|| number as u32 - 1)
                };
                let corners: Option<Vec<u32>> = words.map(corner).collect();
                let face = match corners.as_deref() {
                    Some(&[a, b, c]) => [a, b, c, c],
                    Some(&[a, b, c, d]) => [a, b, c, d],
                    _ => return Err(wrong("indices of three or four vertices above")),
                };
                groups.entry(group.clone()).or_default().push(face);
            }
            _ => {}
        }
    }
    if !groups.contains_key("body") {
        let end = format!("line {}", text.lines().count());
        return Err(format(path, end, "faces of the group body", "the end of the file"));
    }
    Ok(Base { positions, groups })
}
