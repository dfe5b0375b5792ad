//! Waymo Open Dataset (perception), v1 TFRecord and v2 Parquet → `Drive`.
//!
//! Both forms are read into the same records, from which the drive is made. World is the dataset's global frame (x east,
//! y north, z up, with an origin that is not published) less the anchor: the first frame's position, rounded to whole
//! metres. Ego is Waymo's vehicle frame: x forward, y left, z up, its origin on the ground below the middle of the rear
//! axle. The dataset's papers do not say so; the real frame's top LiDAR stands 1.43 m before and 2.18 m above it, its front
//! and rear LiDARs 4.07 m before and 1.16 m behind it, and boxes of vehicles beside it end near z = 0, as on the Chrysler
//! Pacifica with its wheelbase of 3.09 m.
//!
//! Sources: `dataset.proto`, `label.proto`, `map.proto`, `range_image_utils.py` and the columns of `v2/perception` of
//! <https://github.com/waymo-research/waymo-open-dataset>.

mod boxes;
mod cameras;
mod components;
mod dataset;
mod drive;
mod fault;
mod frame_message;
mod lane_map;
mod list_column;
mod map_message;
mod matrix;
mod panoptic;
mod poses;
mod range_image;
mod records;
mod source;
mod tfrecord;
mod v1;
mod vocabulary;

pub use dataset::Waymo;
pub(crate) use source::DATASET;
