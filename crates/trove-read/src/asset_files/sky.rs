//! Which pictures are skies.

use std::io::BufReader;
use std::path::Path;

use image::{ImageFormat, ImageReader};
use trove_files::open_regular;

/// Whether a `.hdr` or `.exr` file is twice as wide as it is high, by its header alone.
pub(super) fn is_sky(path: &Path) -> bool {
    size(path).is_some_and(|(width, height)| width >= 64 && width == 2 * height)
}

fn size(path: &Path) -> Option<(u32, u32)> {
    let ending = path.extension()?.to_str()?.to_lowercase();
    if !["hdr", "exr"].contains(&ending.as_str()) {
        return None;
    }
    let file = BufReader::new(open_regular(path).ok()?);
    if ending == "hdr" {
        return ImageReader::with_format(file, ImageFormat::Hdr).into_dimensions().ok();
    }
    let size = exr::meta::MetaData::read_from_buffered(file, false).ok()?.headers.first()?.layer_size;
    Some((u32::try_from(size.x()).ok()?, u32::try_from(size.y()).ok()?))
}
