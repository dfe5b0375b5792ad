//! GeoTIFF with geographic coordinates: one band of heights in strips or tiles.

use std::fs::File;
use std::io::{BufReader, Seek};
use std::path::Path;

use tiff::TiffError;
use tiff::decoder::ifd::Value;
use tiff::decoder::{Decoder, DecodingResult, Limits};
use tiff::tags::Tag;
use trove_files::open_regular;
use trove_model::{Outcome, Raster, Report};

use super::geo_keys::{Fault, GeoTags};
use super::sheet::{Cut, Sheet, Window, plausible};
use super::texts;
use crate::ReadError;
use trove_files::Budget;

/// Larger strips and tiles are refused, bytes; GDAL's are 8 KiB to 1 MiB.
const LARGEST_CHUNK: usize = 128 << 20;
/// Longer texts are refused, bytes; GDAL's metadata are some kilobytes.
const LONGEST_TEXT: u64 = 16 << 20;
/// Where the file does not say.
const NO_LICENCE: &str = "not stated in the file";

/// The part of a file in a window, and its copyright.
pub(super) fn read(path: &Path, window: &Window, report: &Report) -> Result<Option<(Sheet, String)>, ReadError> {
    let io = |source| ReadError::io(path, source);
    let file = open_regular(path).map_err(io)?;
    let budget = Budget::of_file(file.metadata().map_err(io)?.len());
    read_from(file, window, &budget, &path.display().to_string(), report).map_err(|Fault(expected, found, remedy)| {
        let (path, place) = (path.to_owned(), "picture".into());
        ReadError::Format { path, place, expected: expected.into(), found, remedy: remedy.into() }
    })
}

fn read_from(
    file: File,
    window: &Window,
    budget: &Budget,
    name: &str,
    report: &Report,
) -> Result<Option<(Sheet, String)>, Fault> {
    let mut limits = Limits::default();
    limits.decoding_buffer_size = LARGEST_CHUNK;
    limits.intermediate_buffer_size = LARGEST_CHUNK;
    let mut file = BufReader::new(file);
    let longest = texts::longest(&mut file).map_err(damaged)?;
    if longest > LONGEST_TEXT {
        return Err(damaged(format!("a text of {longest} bytes")));
    }
    file.rewind().map_err(damaged)?;
    let mut tiff = Decoder::new(file).map_err(damaged)?.with_limits(limits);
    let (width, height) = tiff.dimensions().map_err(damaged)?;
    let bands = number(&mut tiff, Tag::SamplesPerPixel)?.unwrap_or(1.0);
    if bands != 1.0 {
        let remedy = "choose the band with heights: gdal_translate -b 1 IN.tif OUT.tif";
        return Err(Fault("one band of heights", format!("{bands} bands"), remedy));
    }
    let tags = GeoTags {
        size: [width, height],
        pixel_scale: numbers(&mut tiff, Tag::ModelPixelScaleTag)?,
        tiepoint: numbers(&mut tiff, Tag::ModelTiepointTag)?,
        transformation: numbers(&mut tiff, Tag::ModelTransformationTag)?,
        keys: numbers(&mut tiff, Tag::GeoKeyDirectoryTag)?.into_iter().map(|key| key as u16).collect(),
    };
    let georeference = tags.georeference()?;
    let Some(cut) = window.cut(&georeference.grid) else { return Ok(None) };
    if let Some(code) = georeference.foreign_crs {
        let what = "elevation file in a coordinate system that may lie some hundred metres from WGS84";
        report.note(Outcome::Warned, what, format!("{name}: EPSG:{code}"));
    }
    let too_much = |found: String| {
        Fault("heights that fit into memory", found, "cut it: gdalwarp -te WEST SOUTH EAST NORTH IN.tif OUT.tif")
    };
    let [columns, rows] = cut.size;
    let samples = columns as usize * rows as usize;
    let taken = budget.take(samples, size_of::<f32>());
    taken.map_err(|_| too_much(format!("{columns} × {rows} samples in the place")))?;
    let nodata = text(&mut tiff, Tag::GdalNodata)?.and_then(|text| text.trim().parse::<f64>().ok());
    let height_m = |sample: f64| {
        let is_void = nodata.is_some_and(|nodata| sample == nodata || sample as f32 == nodata as f32);
        if is_void { f32::NAN } else { plausible(sample * georeference.height_unit_m) }
    };
    let mut heights_m = Raster::filled(columns, rows, f32::NAN);
    let chunk = tiff.chunk_dimensions();
    let across = width.div_ceil(chunk.0.max(1));
    for (x, y) in chunks(cut, chunk) {
        // A bomb has the same few bytes unpacked for every chunk.
        let taken = budget.take((chunk.0 as usize).saturating_mul(chunk.1 as usize), size_of::<f64>());
        taken.map_err(|_| too_much(format!("strips or tiles of {} × {} samples", chunk.0, chunk.1)))?;
        let index =
            y.checked_mul(across).and_then(|row| row.checked_add(x)).ok_or_else(|| damaged("tiles beyond 2³²"))?;
        let samples = values(tiff.read_chunk(index).map_err(damaged)?)?;
        let (chunk_width, chunk_height) = tiff.chunk_data_dimensions(index);
        if (samples.len() as u64) < u64::from(chunk_width) * u64::from(chunk_height) {
            return Err(damaged("a strip or tile that is too short"));
        }
        let first = [x * chunk.0, y * chunk.1];
        let range = |axis: usize, length: u32| {
            let from = first[axis].max(cut.first[axis]);
            from..(first[axis] + length).min(cut.first[axis] + cut.size[axis])
        };
        for row in range(1, chunk_height) {
            for column in range(0, chunk_width) {
                let at = (row - first[1]) as usize * chunk_width as usize + (column - first[0]) as usize;
                *heights_m.at_mut(column - cut.first[0], row - cut.first[1]) = height_m(samples[at]);
            }
        }
    }
    let licence = text(&mut tiff, Tag::Copyright)?.map(|text| text.trim().to_owned()).filter(|text| !text.is_empty());
    let sheet = Sheet { grid: georeference.grid.cut(cut), heights_m };
    Ok(Some((sheet, licence.unwrap_or_else(|| NO_LICENCE.into()))))
}

/// Columns and rows of the chunks that a cut touches.
fn chunks(cut: Cut, (width, height): (u32, u32)) -> impl Iterator<Item = (u32, u32)> {
    let range = |axis: usize, side: u32| {
        let side = side.max(1);
        cut.first[axis] / side..=(cut.first[axis] + cut.size[axis] - 1) / side
    };
    let columns = range(0, width);
    range(1, height).flat_map(move |y| columns.clone().map(move |x| (x, y)))
}

/// Samples of any type.
fn values(chunk: DecodingResult) -> Result<Vec<f64>, Fault> {
    let wide = |samples: Vec<i64>| samples.into_iter().map(|v| v as f64).collect();
    Ok(match chunk {
        DecodingResult::U8(v) => v.into_iter().map(f64::from).collect(),
        DecodingResult::U16(v) => v.into_iter().map(f64::from).collect(),
        DecodingResult::U32(v) => v.into_iter().map(f64::from).collect(),
        DecodingResult::U64(v) => v.into_iter().map(|v| v as f64).collect(),
        DecodingResult::I8(v) => v.into_iter().map(f64::from).collect(),
        DecodingResult::I16(v) => v.into_iter().map(f64::from).collect(),
        DecodingResult::I32(v) => v.into_iter().map(f64::from).collect(),
        DecodingResult::I64(v) => wide(v),
        DecodingResult::F32(v) => v.into_iter().map(f64::from).collect(),
        DecodingResult::F64(v) => v,
        DecodingResult::F16(_) => {
            let remedy = "convert it: gdal_translate -ot Float32 IN.tif OUT.tif";
            return Err(Fault("integers or floats of 32 or 64 bits", "floats of 16 bits".into(), remedy));
        }
    })
}

type Reader = Decoder<BufReader<File>>;

fn numbers(tiff: &mut Reader, tag: Tag) -> Result<Vec<f64>, Fault> {
    match tiff.find_tag(tag).map_err(damaged)? {
        None => Ok(Vec::new()),
        Some(value @ (Value::Double(_) | Value::Float(_))) => Ok(vec![value.into_f64().map_err(damaged)?]),
        Some(Value::List(values)) => values.into_iter().map(|value| as_f64(value).map_err(damaged)).collect(),
        Some(value) => Ok(vec![as_f64(value).map_err(damaged)?]),
    }
}

fn as_f64(value: Value) -> Result<f64, TiffError> {
    match value {
        Value::Double(_) | Value::Float(_) => value.into_f64(),
        other => other.into_u32().map(f64::from),
    }
}

fn number(tiff: &mut Reader, tag: Tag) -> Result<Option<f64>, Fault> {
    Ok(numbers(tiff, tag)?.first().copied())
}

fn text(tiff: &mut Reader, tag: Tag) -> Result<Option<String>, Fault> {
    // Text that is none says nothing.
    Ok(tiff.find_tag(tag).map_err(damaged)?.and_then(|value| value.into_string().ok()))
}

fn damaged(found: impl ToString) -> Fault {
    Fault("a complete GeoTIFF", found.to_string(), "download it again, or rewrite it: gdal_translate IN.tif OUT.tif")
}
