//! A shape target: a line a vertex that it moves.

use std::path::Path;

use glam::Vec3;

use super::file::{format, from_makehuman, text};
use crate::ReadError;

/// Vertices below `count` and how far they move.
pub(super) fn parse(path: &Path, count: usize) -> Result<Vec<(u32, Vec3)>, ReadError> {
    let text = text(path)?;
    let mut moves = Vec::new();
    for (i, line) in text.lines().enumerate() {
        let line = line.trim();
        if line.is_empty() || line.starts_with('#') {
            continue;
        }
        let mut words = line.split_ascii_whitespace();
        let vertex = words.next().and_then(|w| w.parse::<u32>().ok()).filter(|&v| (v as usize) < count);
        let mut number = || words.next().and_then(|w| w.parse::<f32>().ok()).filter(|x| x.is_finite());
        let offset = (|| Some([number()?, number()?, number()?]))();
        let (Some(vertex), Some(offset)) = (vertex, offset) else {
            let expected = format!("a vertex below {count} and three offsets");
            return Err(format(path, format!("line {}", i + 1), &expected, line));
        };
        moves.push((vertex, from_makehuman(offset)));
    }
    Ok(moves)
}
