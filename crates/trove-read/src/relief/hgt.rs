//! SRTM tiles: one degree by one degree of big-endian 16-bit heights, from north to south, named by their south-west corner.

use std::path::Path;

use glam::DVec2;
use trove_model::Raster;

use super::sheet::{Grid, Sheet, Window, plausible};
use crate::ReadError;

/// Samples along a side of tiles of three arc seconds and of one.
const SIDES: [u32; 2] = [1201, 3601];
/// The larger tile, bytes.
pub(super) const LARGEST: u64 = 2 * 3601 * 3601;
/// Of the tiles that NASA and the USGS give out.
pub(super) const LICENCE: &str = "SRTM, NASA and USGS: public domain";

/// The part of a tile in a window, void samples NaN; `name` is the tile's own, which tells where it lies.
pub(super) fn parse(path: &Path, name: &str, bytes: &[u8], window: &Window) -> Result<Option<Sheet>, ReadError> {
    let fault = |expected: &str, found: String, remedy: &str| ReadError::Format {
        path: path.to_owned(),
        place: name.to_owned(),
        expected: expected.into(),
        found,
        remedy: remedy.into(),
    };
    let Some((south_deg, west_deg)) = corner(name) else {
        let expected =
            "a name with the tile's south-west corner, N00 to N89 or S01 to S90 and E000 to E179 or W001 to W180";
        return Err(fault(expected, format!("{name:?}"), "give the tile its name back, such as N43E007.hgt"));
    };
    let Some(side) = SIDES.into_iter().find(|&side| bytes.len() == 2 * side as usize * side as usize) else {
        let expected = "2884802 bytes (1201 × 1201 samples) or 25934402 (3601 × 3601)";
        return Err(fault(expected, format!("{} bytes", bytes.len()), "download the tile again"));
    };
    let step_deg = DVec2::splat(1.0 / f64::from(side - 1));
    let grid = Grid { north_west_deg: DVec2::new(west_deg, south_deg + 1.0), step_deg, size: [side, side] };
    let Some(cut) = window.cut(&grid) else { return Ok(None) };
    let heights_m = Raster::from_fn(cut.size[0], cut.size[1], |x, y| {
        let at = 2 * ((cut.first[1] + y) as usize * side as usize + (cut.first[0] + x) as usize);
        plausible(f64::from(i16::from_be_bytes([bytes[at], bytes[at + 1]])))
    });
    Ok(Some(Sheet { grid: grid.cut(cut), heights_m }))
}

/// Latitude and longitude of the corner that a name such as `N43E007.SRTMGL1.hgt` tells.
fn corner(name: &str) -> Option<(f64, f64)> {
    let part = |from: usize, to: usize| name.get(from..to);
    let degrees =
        |from: usize, to: usize| part(from, to)?.bytes().all(|b| b.is_ascii_digit()).then(|| part(from, to))?;
    let (lat, lon): (f64, f64) = (degrees(1, 3)?.parse().ok()?, degrees(4, 7)?.parse().ok()?);
    // Nothing but the tile's kind may follow.
    if !matches!(name.as_bytes().get(7), None | Some(b'.' | b'_')) {
        return None;
    }
    let south_deg = match part(0, 1)? {
        "N" | "n" if lat < 90.0 => lat,
        "S" | "s" if lat > 0.0 && lat <= 90.0 => -lat,
        _ => return None,
    };
    let west_deg = match part(3, 4)? {
        "E" | "e" if lon < 180.0 => lon,
        "W" | "w" if lon > 0.0 && lon <= 180.0 => -lon,
        _ => return None,
    };
    Some((south_deg, west_deg))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_name_tells_the_corner_and_a_wrong_one_does_not() {
        for (name, expect) in [
            ("N43E007.hgt", Some((43.0, 7.0))),
            ("s34w059.SRTMGL1.hgt", Some((-34.0, -59.0))),
            ("N00E000", Some((0.0, 0.0))),
            ("S01W180.hgt", Some((-1.0, -180.0))),
            ("S00E007.hgt", None),
            ("N90E007.hgt", None),
            ("N43E180.hgt", None),
            ("E007N43.hgt", None),
            ("N43E7.hgt", None),
            ("N4+E007.hgt", None),
            ("N43E0071.hgt", None),
            ("monaco.hgt", None),
            ("N4é0007.hgt", None),
            ("", None),
        ] {
            assert_eq!(corner(name), expect, "{name}");
        }
    }
}
