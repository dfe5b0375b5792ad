//! Files of LiDAR points: `.bin` (x, y, z, intensity, each a little-endian float32), `.pcd` and `.las`.

mod bin;
mod bytes;
mod las;
mod lzf;
mod pcd;

use std::path::Path;

use glam::DVec3;
use trove_files::read_regular;

use trove_files::Budget;

/// Larger files are refused: a billion points, bytes.
const LARGEST: u64 = 2 << 30;

/// The endings of the files that can be read.
pub(crate) const ENDINGS: [&str; 3] = ["bin", "pcd", "las"];

/// A file's points in its own axes, metres, in its order; a point that is not a number is among them, so that labels fit.
/// The error says what is wrong with the file.
pub(crate) fn read(path: &Path) -> Result<Vec<DVec3>, String> {
    let bytes = read_regular(path, LARGEST).map_err(|error| error.to_string())?;
    let budget = Budget::of_file(bytes.len() as u64);
    let ending = path.extension().and_then(|e| e.to_str()).unwrap_or_default().to_ascii_lowercase();
    match ending.as_str() {
        "bin" => bin::points(&bytes),
        "pcd" => pcd::points(&bytes, &budget),
        "las" => las::points(&bytes, &budget),
        _ => Err(format!("expected a file that ends in .{}", ENDINGS.join(", ."))),
    }
}
