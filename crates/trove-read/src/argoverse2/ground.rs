//! Ground height (`map/*_ground_height_surface____CITY.npy` with its `*___img_Sim2_city.json`) → points of the ground.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use glam::{DMat2, DVec2, DVec3};
use serde::Deserialize;
use trove_files::{LARGEST_TEXT, read_regular};
use trove_model::{Bounds, Outcome, Raster, Report};

use super::city::CityFrame;
use super::lane_map::REACH_M;
use super::npy;

/// A log's raster takes a few megabytes.
const LARGEST_RASTER: u64 = 256 << 20;
/// The raster's cells of 0.3 m are averaged over squares of this side, which takes off the rounding of its float16 (6 cm at a
/// height of 70 m), metres.
const SQUARE_M: f64 = 2.0;
/// No ground is higher or lower, metres.
const HIGHEST_M: f32 = 1e4;

/// Similarity that takes city coordinates to the raster's columns and rows: `s · (R · p + t)`, R row by row.
#[derive(Deserialize)]
struct Sim2 {
    #[serde(rename = "R")]
    rotation: [f64; 4],
    t: [f64; 2],
    s: f64,
}

impl Sim2 {
    fn is_similarity(&self) -> bool {
        let [a, b, c, d] = self.rotation;
        let is_turn = (a - d).abs() < 1e-3 && (b + c).abs() < 1e-3 && (a.hypot(c) - 1.0).abs() < 1e-3;
        is_turn && (0.01..100.0).contains(&self.s) && self.t.iter().all(|t| t.abs() < 1e7)
    }

    fn city_from_raster(&self, column_row: DVec2) -> DVec2 {
        let [a, b, c, d] = self.rotation;
        let turn_back = DMat2::from_cols(DVec2::new(a, b), DVec2::new(c, d));
        turn_back * (column_row / self.s - DVec2::from_array(self.t))
    }
}

/// Raster and similarity of a log, where both are there.
pub(super) fn files(log: &Path) -> Option<[PathBuf; 2]> {
    let entries = std::fs::read_dir(log.join("map")).into_iter().flatten().flatten().map(|e| e.path());
    let entries: Vec<_> = entries.collect();
    let find = |is: fn(&str) -> bool| {
        entries.iter().filter(|path| path.file_name().and_then(|n| n.to_str()).is_some_and(is)).min().cloned()
    };
    let raster = find(|name| name.contains("_ground_height_surface____") && name.ends_with(".npy"))?;
    Some([raster, find(|name| name.ends_with("___img_Sim2_city.json"))?])
}

/// Points of the ground near a driven path, World, at most one a square; none, reported, where there is no raster that can be
/// read.
pub(super) fn read(log: &Path, frame: &CityFrame, path: &[DVec2], report: &Report) -> Vec<DVec3> {
    let Some([raster_file, similarity_file]) = files(log) else {
        report.note(Outcome::Warned, "Argoverse 2 log without a ground height", log.display());
        return Vec::new();
    };
    let unread = |file: &Path, why: String| {
        let what = "Argoverse 2 ground height that cannot be read";
        report.note(Outcome::Dropped, what, format!("{}: {why}", file.display()));
    };
    let similarity = read_regular(&similarity_file, LARGEST_TEXT)
        .map_err(|e| e.to_string())
        .and_then(|text| serde_json::from_slice::<Sim2>(&text).map_err(|e| e.to_string()))
        .and_then(|s| if s.is_similarity() { Ok(s) } else { Err("expected a rotation and a scale".to_owned()) });
    let raster = read_regular(&raster_file, LARGEST_RASTER)
        .map_err(|e| e.to_string())
        .and_then(|bytes| npy::read(&bytes).map_err(|(expected, found)| format!("expected {expected}, found {found}")));
    match (similarity, raster) {
        (Ok(similarity), Ok(raster)) => points(&raster, &similarity, frame, path),
        (similarity, raster) => {
            similarity.err().into_iter().for_each(|why| unread(&similarity_file, why));
            raster.err().into_iter().for_each(|why| unread(&raster_file, why));
            Vec::new()
        }
    }
}

fn points(raster: &Raster<f32>, similarity: &Sim2, frame: &CityFrame, path: &[DVec2]) -> Vec<DVec3> {
    let Some(near) = Bounds::around(path.iter().copied()).map(|bounds| bounds.grown(REACH_M)) else {
        return Vec::new();
    };
    let mut squares = BTreeMap::<(i64, i64), (DVec3, f64)>::new();
    for (i, &height_m) in raster.data.iter().enumerate() {
        if !(-HIGHEST_M..HIGHEST_M).contains(&height_m) {
            continue; // NaN: beyond the mapped ground
        }
        let (column, row) = (i as u32 % raster.width, i as u32 / raster.width);
        let middle = DVec2::new(f64::from(column), f64::from(row)) + 0.5;
        let point = frame.world(similarity.city_from_raster(middle).extend(f64::from(height_m)));
        if near.contains(point.truncate()) {
            let square = (point.truncate() / SQUARE_M).floor().as_i64vec2();
            let (sum, count) = squares.entry((square.x, square.y)).or_default();
            *sum += point;
            *count += 1.0;
        }
    }
    squares.into_values().map(|(sum, count)| sum / count).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_published_similarity_is_undone() {
        let text = br#"{"R": [0.6, -0.8, 0.8, 0.6], "t": [-50.0, -20.0], "s": 4.0}"#;
        let similarity: Sim2 = serde_json::from_slice(text).unwrap();
        assert!(similarity.is_similarity());
        // s · (R · (90, 10) + t) = 4 · (54 − 8 − 50, 72 + 6 − 20)
        let city = similarity.city_from_raster(DVec2::new(-16.0, 232.0));
        assert!(city.distance(DVec2::new(90.0, 10.0)) < 1e-9, "{city}");
    }

    #[test]
    fn heights_are_averaged_over_squares_and_holes_stay_empty() {
        let report = Report::default();
        let frame = CityFrame::new(None, DVec3::new(0.0, 0.0, 10.0), &report);
        let similarity = Sim2 { rotation: [1.0, 0.0, 0.0, 1.0], t: [0.0, 0.0], s: 1.0 };
        let height = |x: u32, _| if x < 2 { 12.0 + x as f32 } else { f32::NAN };
        let found = points(&Raster::from_fn(4, 2, height), &similarity, &frame, &[DVec2::ZERO]);
        assert_eq!(found, [DVec3::new(1.0, 1.0, 2.5)]);
    }
}
