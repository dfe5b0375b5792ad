//! Which pictures are skies.

use std::path::Path;

/// Whether a `.hdr` or `.exr` file is twice as wide as it is high, by its header alone.
pub(super) fn is_sky(path: &Path) -> bool {
    let size = match path.extension().and_then(|e| e.to_str()).map(str::to_lowercase).as_deref() {
        Some("hdr") => image::ImageReader::open(path).ok().and_then(|r| r.into_dimensions().ok()),
        Some("exr") => exr::meta::MetaData::read_from_file(path, false).ok().and_then(|meta| {
            let size = meta.headers.first()?.layer_size;
            Some((size.x() as u32, size.y() as u32))
        }),
        _ => None,
    };
    size.is_some_and(|(width, height)| width >= 64 && width == 2 * height)
}
