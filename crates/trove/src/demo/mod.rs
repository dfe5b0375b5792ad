//! The demo: a made-up crossing, written as nuScenes tables and an OpenStreetMap file, so that it takes the same way
//! through the program as a real recording.

mod map;
mod road_users;
mod street;
mod tables;

use std::path::Path;

use anyhow::Result;
use trove_write::write_atomically;

use self::street::PLACE;
use crate::recipe::Recipe;
use crate::run::{PRIVATE, refuse_foreign};

const RECIPE: &str = r#"seed = 7

[drive]
dataset = "nuscenes"
root = "nuscenes"
scenes = ["demo-0001"]
keyframes = [2]

[map]
osm = "crossing.osm"

[render]
scale = 0.5
spp = 16
"#;

/// Writes the demo's drive, map and recipe below `out` and returns the recipe.
pub(crate) fn recipe(out: &Path) -> Result<Recipe> {
    refuse_foreign(out)?;
    let folder = out.join(PRIVATE).join("demo");
    let expansion = folder.join("nuscenes/maps/expansion");
    std::fs::create_dir_all(&expansion)?;
    for (name, table) in tables::tables() {
        let version = folder.join("nuscenes/v1.0-demo");
        std::fs::create_dir_all(&version)?;
        write_atomically(&version.join(format!("{name}.json")), &serde_json::to_vec_pretty(&table)?)?;
    }
    let lane_map = serde_json::to_vec_pretty(&map::lane_map())?;
    write_atomically(&expansion.join(format!("{PLACE}.json")), &lane_map)?;
    write_atomically(&folder.join("crossing.osm"), map::osm().as_bytes())?;
    let path = folder.join("recipe.toml");
    write_atomically(&path, RECIPE.as_bytes())?;
    Recipe::read(&path)
}

#[cfg(test)]
mod tests {
    use super::*;
    use trove_model::Report;

    #[test]
    fn the_demo_s_drive_reads_without_a_complaint() {
        let dir = tempfile::tempdir().unwrap();
        let recipe = recipe(dir.path()).unwrap();
        let report = Report::default();
        let sources = crate::sources::Sources::open(&recipe, &report).unwrap();
        let (timeline, map) = sources.drive("demo-0001", &report).unwrap();
        let drive = timeline.recorded;
        assert_eq!((drive.keyframes.len(), drive.rig.len()), (tables::KEYFRAMES, 6));
        assert!(drive.keyframes.iter().all(|k| k.boxes.len() >= 25 && k.exposures.len() == 6));
        let kinds: std::collections::BTreeSet<_> = drive.tracks.iter().map(|track| track.kind).collect();
        assert!(kinds.len() >= 14, "{kinds:?}");
        let map = map.unwrap();
        assert!(map.buildings.len() >= 15 && map.roads.len() >= 2 && map.furniture.len() >= 30);
        let complaints: Vec<_> =
            report.entries().into_iter().filter(|e| e.outcome == trove_model::Outcome::Dropped).collect();
        assert!(complaints.is_empty(), "{complaints:?}");
    }
}
