//! Elevation models (SRTM `.hgt`, plain or zipped, and GeoTIFF) → `Relief`.
//!
//! A file becomes a `Sheet`: heights on a grid of latitudes and longitudes, of which only what the place needs is kept.
//! Since the map's projection is linear in both, sheets are grids in World too, and those of several files are laid on
//! the finest one's.

mod fill;
mod geo_keys;
mod geotiff;
mod hgt;
mod sheet;
mod texts;
mod zip;

use std::ffi::OsStr;
use std::io::Read;
use std::path::Path;

use glam::{DVec2, UVec2};
use trove_files::open_regular;
use trove_model::{Bounds, MapProjection, Outcome, Provenance, Raster, Relief, Report};

use crate::ReadError;
use sheet::{Sheet, Window};

/// More nodes than this are thinned out.
const MOST_NODES: f64 = 4e6;

/// Reads what the files know of `area`; heights that they lack within it are filled from their neighbours. `None` where
/// no file covers any of it; that is reported, as are files of other places and what had to be filled.
///
/// # Errors
/// A file that cannot be read, is none of these formats, is damaged, or has coordinates that are not geographic.
pub fn read(
    paths: &[impl AsRef<Path>],
    projection: &MapProjection,
    area: Bounds,
    report: &Report,
) -> Result<Option<Relief>, ReadError> {
    let window = Window::around(projection, area);
    let mut sheets = Vec::new();
    let mut sources = Vec::new();
    for path in paths.iter().map(AsRef::as_ref) {
        let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
        match read_sheet(path, &window, report)? {
            Some((sheet, licence)) => {
                sheets.push(sheet.relief(projection));
                sources.push(Provenance { source: name, licence });
            }
            None => report.note(Outcome::Warned, "elevation file of another place, not used", name),
        }
    }
    let Some(mut relief) = laid_together(&sheets, area) else {
        report.note(Outcome::Warned, "no elevation file covers the place: its ground is flat", format!("{window}"));
        return Ok(None);
    };
    let is_covered = |p: DVec2| sheets.iter().any(|s| s.bounds().grown(1e-3).contains(p));
    let filled = fill::fill(&mut relief, is_covered);
    report.measure("relief.voids", filled as f64);
    if filled > 0 {
        let example = format!("{filled} of {} samples around {window}", relief.nodes.data.len());
        report.note(Outcome::Substituted, "void in the elevation model, filled from its neighbours", example);
    }
    relief.sources = sources;
    Ok(Some(relief).filter(|relief| relief.nodes.data.iter().any(|z| z.is_finite())))
}

/// What a file knows of a window, and its licence; `None` where that is nothing.
fn read_sheet(path: &Path, window: &Window, report: &Report) -> Result<Option<(Sheet, String)>, ReadError> {
    let io = |source| ReadError::io(path, source);
    let mut magic = Vec::new();
    open_regular(path).map_err(io)?.take(4).read_to_end(&mut magic).map_err(io)?;
    match &magic[..] {
        b"PK\x03\x04" => {
            let (name, bytes) = zip::elevation(path)?;
            hgt::parse(path, &name, &bytes, window).map(|sheet| sheet.map(|s| (s, hgt::LICENCE.into())))
        }
        [b'I', b'I', 42 | 43, 0] | [b'M', b'M', 0, 42 | 43] => geotiff::read(path, window, report),
        _ if path.extension().and_then(OsStr::to_str).is_some_and(|e| e.eq_ignore_ascii_case("hgt")) => {
            let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
            let bytes = trove_files::read_regular(path, hgt::LARGEST).map_err(io)?;
            hgt::parse(path, &name, &bytes, window).map(|sheet| sheet.map(|s| (s, hgt::LICENCE.into())))
        }
        _ => Err(ReadError::Format {
            path: path.to_owned(),
            place: "byte 0".into(),
            expected: "an SRTM tile (.hgt, or a .zip with one) or a GeoTIFF".into(),
            found: "another kind of file".into(),
            remedy: "download one of these, or convert it with GDAL: gdal_translate IN OUT.tif".into(),
        }),
    }
}

/// All sheets on the lattice of the finest, over as much of `area` as its nodes can span; the first that knows a node
/// tells its height.
fn laid_together(sheets: &[Relief], area: Bounds) -> Option<Relief> {
    let finest = sheets.iter().min_by(|a, b| a.cell_m.element_product().total_cmp(&b.cell_m.element_product()))?;
    let wanted = area.size_m() / finest.cell_m + 3.0;
    let thinned = (wanted.element_product() / MOST_NODES).sqrt().ceil().max(1.0);
    let cell_m = finest.cell_m * thinned;
    let origin = finest.origin + ((area.min - finest.origin) / cell_m).floor() * cell_m;
    let size: UVec2 = (((area.max - origin) / cell_m).ceil() + 1.0).as_uvec2();
    let node = |x: u32, y: u32| {
        let p = origin + DVec2::new(f64::from(x), f64::from(y)) * cell_m;
        sheets.iter().find_map(|sheet| sheet::at(sheet, p)).map_or(f32::NAN, |height_m| height_m as f32)
    };
    Some(Relief { origin, cell_m, nodes: Raster::from_fn(size.x, size.y, node), sources: Vec::new() })
}
