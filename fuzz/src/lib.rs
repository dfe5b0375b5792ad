//! Every reader of strangers' files, as targets of fuzzers.
//!
//! What goes in: bytes. What comes out: nothing, or a panic, a hang or too much memory, which are faults. `make fuzz`
//! runs the mutator of this crate on stable Rust; cargo-fuzz runs the same targets with libFuzzer.
//!
//! ```
//! trove_fuzz::run_once("recipe", b"[drive]\ndataset = 7");
//! ```

mod argoverse2;
mod audits;
mod datasets;
mod elevation;
mod frames;
mod kitti;
mod maps;
mod models;
pub mod mutator;
mod recordings;
mod texts;
mod waymo;

use std::cell::RefCell;
use std::collections::BTreeMap;
use std::path::Path;

use tempfile::TempDir;

/// A reader to be fed.
#[derive(Clone, Copy, Debug)]
pub struct Target {
    /// Its name, which its folder in `fuzz/corpus` has too.
    pub name: &'static str,
    /// Valid inputs that mutations start from, beside those in the corpus.
    pub seeds: fn() -> Vec<Vec<u8>>,
    /// Makes ready a folder of its own.
    pub prepare: fn(&Path),
    /// Feeds it with bytes, in that folder.
    pub feed: fn(&Path, &[u8]),
}

/// All of them.
pub const TARGETS: &[Target] = &[
    Target { name: "osm_xml", seeds: maps::xml_seeds, prepare: |_| (), feed: maps::feed },
    Target { name: "osm_pbf", seeds: maps::pbf_seeds, prepare: |_| (), feed: maps::feed_pbf },
    Target { name: "geojson", seeds: maps::geojson_seeds, prepare: |_| (), feed: maps::feed_geojson },
    Target { name: "hgt", seeds: elevation::tile_seeds, prepare: |_| (), feed: elevation::feed_tile },
    Target { name: "geotiff", seeds: elevation::picture_seeds, prepare: |_| (), feed: elevation::feed_picture },
    Target {
        name: "nuscenes_tables",
        seeds: datasets::table_seeds,
        prepare: datasets::prepare,
        feed: datasets::feed_table,
    },
    Target {
        name: "nuscenes_lidar",
        seeds: datasets::lidar_seeds,
        prepare: datasets::prepare,
        feed: datasets::feed_lidar,
    },
    Target {
        name: "nuscenes_can_bus",
        seeds: datasets::can_bus_seeds,
        prepare: datasets::prepare,
        feed: datasets::feed_can_bus,
    },
    Target {
        name: "nuscenes_lane_map",
        seeds: datasets::lane_map_seeds,
        prepare: datasets::prepare,
        feed: datasets::feed_lane_map,
    },
    Target {
        name: "nuscenes_index",
        seeds: datasets::index_seeds,
        prepare: datasets::prepare_index,
        feed: datasets::feed_index,
    },
    Target {
        name: "kitti_calibration",
        seeds: kitti::calibration_seeds,
        prepare: kitti::prepare,
        feed: kitti::feed_calibration,
    },
    Target { name: "kitti_labels", seeds: kitti::label_seeds, prepare: kitti::prepare, feed: kitti::feed_labels },
    Target { name: "kitti_oxts", seeds: kitti::oxts_seeds, prepare: kitti::prepare, feed: kitti::feed_oxts },
    Target {
        name: "kitti_tracklets",
        seeds: kitti::tracklet_seeds,
        prepare: kitti::prepare,
        feed: kitti::feed_tracklets,
    },
    Target { name: "drive_json", seeds: recordings::json_seeds, prepare: |_| (), feed: recordings::feed_json },
    Target { name: "drive_lines", seeds: recordings::lines_seeds, prepare: |_| (), feed: recordings::feed_lines },
    Target { name: "pcd", seeds: recordings::pcd_seeds, prepare: recordings::prepare_pcd, feed: recordings::feed_pcd },
    Target { name: "las", seeds: recordings::las_seeds, prepare: recordings::prepare_las, feed: recordings::feed_las },
    Target { name: "gpx", seeds: recordings::gpx_seeds, prepare: |_| (), feed: recordings::feed_gpx },
    Target { name: "gps_csv", seeds: recordings::csv_seeds, prepare: |_| (), feed: recordings::feed_csv },
    Target { name: "waymo_tfrecord", seeds: waymo::tfrecord_seeds, prepare: |_| (), feed: waymo::feed_tfrecord },
    Target {
        name: "waymo_component",
        seeds: waymo::component_seeds,
        prepare: waymo::prepare_components,
        feed: waymo::feed_component,
    },
    Target {
        name: "argoverse2_feather",
        seeds: argoverse2::feather_seeds,
        prepare: argoverse2::prepare,
        feed: argoverse2::feed_feather,
    },
    Target {
        name: "argoverse2_ground",
        seeds: argoverse2::height_seeds,
        prepare: argoverse2::prepare,
        feed: argoverse2::feed_height,
    },
    Target {
        name: "argoverse2_map",
        seeds: argoverse2::map_seeds,
        prepare: argoverse2::prepare,
        feed: argoverse2::feed_map,
    },
    Target { name: "gltf", seeds: models::gltf_seeds, prepare: models::prepare, feed: models::feed_gltf },
    Target { name: "fbx", seeds: models::fbx_seeds, prepare: models::prepare, feed: models::feed_fbx },
    Target { name: "obj", seeds: models::obj_seeds, prepare: models::prepare, feed: models::feed_obj },
    Target {
        name: "texture",
        seeds: models::picture_seeds,
        prepare: models::prepare_texture,
        feed: models::feed_texture,
    },
    Target { name: "sky", seeds: models::sky_seeds, prepare: |_| (), feed: models::feed_sky },
    Target { name: "labels", seeds: models::label_seeds, prepare: models::prepare_labels, feed: models::feed_labels },
    Target { name: "recipe", seeds: texts::recipe_seeds, prepare: |_| (), feed: texts::feed_recipe },
    Target { name: "library", seeds: texts::library_seeds, prepare: models::prepare, feed: texts::feed_library },
    Target { name: "plans", seeds: texts::plans_seeds, prepare: |_| (), feed: texts::feed_plans },
    Target { name: "locales", seeds: texts::locales_seeds, prepare: |_| (), feed: texts::feed_locales },
    Target {
        name: "cached_library",
        seeds: texts::cached_library_seeds,
        prepare: |_| (),
        feed: texts::feed_cached_library,
    },
    Target { name: "ies", seeds: texts::ies_seeds, prepare: |_| (), feed: texts::feed_ies },
    Target { name: "scanner", seeds: texts::scanner_seeds, prepare: |_| (), feed: texts::feed_scanner },
    Target { name: "class_map", seeds: texts::class_map_seeds, prepare: |_| (), feed: texts::feed_class_map },
    Target { name: "frame_table", seeds: frames::table_seeds, prepare: frames::prepare, feed: frames::feed_table },
    Target { name: "frame_files", seeds: frames::picture_seeds, prepare: frames::prepare, feed: frames::feed_picture },
    Target { name: "labels_of_others", seeds: audits::seeds, prepare: audits::prepare, feed: audits::feed },
    Target { name: "output_folder", seeds: texts::output_seeds, prepare: |_| (), feed: texts::feed_output },
];

/// The target of a name.
pub fn target(name: &str) -> Option<&'static Target> {
    TARGETS.iter().find(|target| target.name == name)
}

/// Feeds a target by its name, in a folder that this thread keeps for it.
///
/// # Panics
/// Where the target does, and for a name that is no target's.
pub fn run_once(name: &str, data: &[u8]) {
    thread_local!(static FOLDERS: RefCell<BTreeMap<&'static str, TempDir>> = const { RefCell::new(BTreeMap::new()) });
    let target = target(name).expect("a name of TARGETS");
    let folder = FOLDERS.with_borrow_mut(|folders| {
        let folder = folders.entry(target.name).or_insert_with(|| {
            let folder = tempfile::tempdir().expect("a temporary folder");
            (target.prepare)(folder.path());
            folder
        });
        folder.path().to_owned()
    });
    (target.feed)(&folder, data);
}
