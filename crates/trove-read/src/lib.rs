//! Files → `Drive`, `StreetMap`, `EnvironmentMap`, `AssetLibrary`, `HumanBody`, `Locale`, `ClassMap`.
//!
//! What goes in: paths. What comes out: the model's nouns. A dataset's peculiarities (axis order, quaternion order,
//! class names, time units) end here; this crate must not know how scenes are built, rendered or written.
//!
//! ```
//! use glam::DVec2;
//! use trove_model::{Bounds, MapProjection, Report, RoadKind};
//! use trove_read::{locale::Locales, osm};
//!
//! let folder = tempfile::tempdir()?;
//! let path = folder.path().join("street.osm");
//! let street = r#"<osm>
//!   <node id="1" lat="51.501" lon="-0.142"/>
//!   <node id="2" lat="51.501" lon="-0.140"/>
//!   <way id="7"><nd ref="1"/><nd ref="2"/><tag k="highway" v="residential"/></way>
//! </osm>"#;
//! std::fs::write(&path, street)?;
//!
//! let report = Report::default();
//! let locale = Locales::built_in().at(51.501, -0.141, &report);
//! assert!(locale.driving_side.is_left(), "London");
//!
//! let projection = MapProjection::spherical(51.501, -0.141, DVec2::ZERO);
//! let area = Bounds::square(DVec2::ZERO, 400.0);
//! let map = osm::read(&path, &projection, area, locale.driving_side, &report)?;
//! assert_eq!(map.roads[0].kind, RoadKind::Residential);
//! let length_m = map.roads[0].centreline[0].distance(map.roads[0].centreline[1]);
//! assert!((length_m - 138.6).abs() < 0.1);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

pub mod argoverse2;
pub mod asset_files;
mod class_map_file;
mod clock_time;
mod datasets;
pub mod drive_source;
pub mod environment;
mod error;
mod geo_extent;
mod geodesy;
mod gps;
pub mod grid;
pub mod human_body;
pub mod kitti;
mod levelling;
mod lidar_file;
pub mod locale;
pub mod nuscenes;
pub mod osm;
mod parquet;
mod plain;
mod protobuf;
pub mod radar;
pub mod relief;
pub mod rig;
pub mod scanner;
mod toml_fault;
pub mod waymo;

pub use class_map_file::read_class_map;
pub use clock_time::ClockTime;
pub use datasets::DATASETS;
pub use error::ReadError;
