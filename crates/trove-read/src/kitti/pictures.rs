//! The recorded pictures.

use std::io::BufReader;
use std::path::Path;

use image::ImageReader;
use trove_files::open_regular;
use trove_model::{Outcome, Report};

/// Width and height of a picture by its header; `None` where it is not there, or none, which is reported.
pub(super) fn size_px(path: &Path, report: &Report) -> Option<[u32; 2]> {
    if !path.is_file() {
        return None;
    }
    let unusable = |why: String| {
        report.note(Outcome::Dropped, "KITTI picture that cannot be read", format!("{}: {why}", path.display()));
    };
    let file = open_regular(path).inspect_err(|error| unusable(error.to_string())).ok()?;
    let reader = ImageReader::new(BufReader::new(file)).with_guessed_format();
    let size = reader.map_err(|error| error.to_string()).and_then(|r| r.into_dimensions().map_err(|e| e.to_string()));
    let (width, height) = size.inspect_err(|why| unusable(why.clone())).ok()?;
    let is_size = |side: u32| (1..=65_535).contains(&side);
    (is_size(width) && is_size(height)).then_some([width, height])
}
