//! Elevation files that the tests write, whole and damaged, and real ones.

#![allow(clippy::unwrap_used)] // all of this is tests

mod damaged;
mod real;
mod wire;

use std::path::PathBuf;

use glam::DVec2;
use tempfile::TempDir;
use trove_model::{Bounds, MapProjection, Relief, Report};
use trove_read::{ReadError, relief};
use wire::Tiff;

/// Files in a folder of their own.
struct Files {
    folder: TempDir,
    paths: Vec<PathBuf>,
}

impl Files {
    fn new(files: &[(&str, Vec<u8>)]) -> Self {
        let folder = tempfile::tempdir().unwrap();
        let path = |(name, bytes): &(&str, Vec<u8>)| {
            let path = folder.path().join(name);
            std::fs::write(&path, bytes).unwrap();
            path
        };
        let paths = files.iter().map(path).collect();
        Self { folder, paths }
    }

    fn read(&self, lat_deg: f64, lon_deg: f64, report: &Report) -> Result<Option<Relief>, ReadError> {
        assert!(self.folder.path().is_dir());
        let area = Bounds::square(DVec2::ZERO, 2000.0);
        relief::read(&self.paths, &projection(lat_deg, lon_deg), area, report)
    }
}

fn projection(origin_lat_deg: f64, origin_lon_deg: f64) -> MapProjection {
    MapProjection::spherical(origin_lat_deg, origin_lon_deg, DVec2::ZERO)
}

/// 500 m at the middle, rising 200 m a degree east and falling 400 m a degree north.
fn plane_m(lat_deg: f64, lon_deg: f64, middle_deg: [f64; 2]) -> f64 {
    500.0 + 200.0 * (lon_deg - middle_deg[1]) - 400.0 * (lat_deg - middle_deg[0])
}

/// Fails where the relief is not that plane, to `tolerance_m`, everywhere within 990 m.
fn assert_plane(relief: &Relief, middle_deg: [f64; 2], tolerance_m: f64) {
    let projection = projection(middle_deg[0], middle_deg[1]);
    for i in 0..400 {
        let p = DVec2::new(f64::from(i % 20), f64::from(i / 20)) / 19.0 * 1980.0 - 990.0;
        let (lat_deg, lon_deg) = projection.geo_from_world(p);
        let found = relief.height_m(p).unwrap_or(f64::NAN);
        let expect = plane_m(lat_deg, lon_deg, middle_deg);
        assert!((found - expect).abs() <= tolerance_m, "{p}: {found} is not {expect}");
    }
}

#[test]
fn a_tilted_plane_in_a_tile_comes_back_on_all_four_quarters_of_the_earth() {
    for (name, lat_deg, lon_deg) in [
        ("N43E007.hgt", 43.5, 7.5),
        ("S34E018.hgt", -33.5, 18.5),
        ("N37W123.hgt", 37.5, -122.5),
        ("s01w180.hgt", -0.5, -179.5),
    ] {
        let (south, west) = (lat_deg - 0.5, lon_deg - 0.5);
        let tile = wire::hgt(|x, y| plane_m(south + y, west + x, [lat_deg, lon_deg]).round() as i16);
        let report = Report::default();
        let relief = Files::new(&[(name, tile)]).read(lat_deg, lon_deg, &report).unwrap().unwrap();
        // Samples are whole metres.
        assert_plane(&relief, [lat_deg, lon_deg], 0.75);
        assert_eq!((relief.sources[0].source.as_str(), report.entries().len()), (name, 0));
        assert!(relief.sources[0].licence.contains("public domain"));
    }
}

#[test]
fn a_zipped_tile_is_the_tile() {
    let tile = wire::hgt(|x, y| (1000.0 * x * x + 700.0 * y) as i16);
    let read = |name: &str, bytes: Vec<u8>| {
        let relief = Files::new(&[(name, bytes)]).read(43.5, 7.5, &Report::default()).unwrap().unwrap();
        relief.nodes
    };
    let plain = read("N43E007.hgt", tile.clone());
    assert_eq!(read("tile.zip", wire::zip("dem/N43E007.hgt", &tile, true)), plain);
    assert_eq!(read("tile.zip", wire::zip("N43E007.HGT", &tile, false)), plain);
}

const MIDDLE: [f64; 2] = [49.8, 6.1];
const STEP: f64 = 0.001;
const SIDE: u32 = 100;

/// Rows of samples of areas of the plane around the middle, from north to south, and where their corner is.
fn plane_rows() -> (Vec<Vec<f64>>, [f64; 2]) {
    let [lat, lon] = MIDDLE;
    let half = f64::from(SIDE) / 2.0 * STEP;
    let at = |i: u32| (f64::from(i) + 0.5) * STEP - half;
    let row = |y: u32| (0..SIDE).map(|x| plane_m(lat - at(y), lon + at(x), MIDDLE)).collect();
    ((0..SIDE).map(row).collect(), [lon - half, lat + half])
}

#[test]
fn a_tilted_plane_in_strips_and_tiles_of_whole_numbers_and_floats_comes_back() {
    let (rows, [west, north]) = plane_rows();
    let corner = [west, north];
    // 16 bits in strips of 7 rows, packed, with differences from the left.
    let mut before;
    let mut strips = Vec::new();
    for strip in rows.chunks(7) {
        let mut bytes = Vec::new();
        for row in strip {
            before = 0i16;
            for height_m in row {
                let value = height_m.round() as i16;
                bytes.extend(value.wrapping_sub(before).to_le_bytes());
                before = value;
            }
        }
        strips.push(wire::deflated(&bytes));
    }
    let whole = Tiff::new([SIDE, SIDE], 16, 2).shorts(259, &[8]).shorts(317, &[2]).placed(corner, [STEP, STEP]);
    let whole = whole.text(33432, "Somebody, CC BY 4.0").strips(7, strips).bytes();

    // Floats in tiles of 32, the outer ones of which reach beyond the picture.
    let tile = |tx: u32, ty: u32| {
        let at = |i: u32| i.min(SIDE - 1) as usize;
        let row = |y: u32| (0..32).map(|x| rows[at(32 * ty + y)][at(32 * tx + x)] as f32).collect::<Vec<f32>>();
        (0..32).map(row).collect::<Vec<_>>()
    };
    let tiles = |pack: fn(&[Vec<f32>]) -> Vec<u8>| {
        (0..4).flat_map(|ty| (0..4).map(move |tx| (tx, ty))).map(|(tx, ty)| pack(&tile(tx, ty))).collect::<Vec<_>>()
    };
    let floats = || Tiff::new([SIDE, SIDE], 32, 3).placed(corner, [STEP, STEP]);
    let predicted = floats().shorts(259, &[8]).shorts(317, &[3]);
    let predicted = predicted.tiles(32, tiles(|rows| wire::deflated(&wire::with_float_predictor(rows)))).bytes();
    let plain = floats().tiles(32, tiles(|rows| rows.iter().flatten().flat_map(|v| v.to_le_bytes()).collect())).bytes();

    for (bytes, tolerance_m, licence) in [
        (whole, 0.75, "Somebody, CC BY 4.0"),
        (predicted, 1e-3, "not stated in the file"),
        (plain, 1e-3, "not stated in the file"),
    ] {
        let report = Report::default();
        let relief = Files::new(&[("plane.tif", bytes)]).read(MIDDLE[0], MIDDLE[1], &report).unwrap().unwrap();
        assert_plane(&relief, MIDDLE, tolerance_m);
        assert_eq!((relief.sources[0].licence.as_str(), report.entries().len()), (licence, 0));
    }
}

#[test]
fn tiles_join_without_a_step_and_the_finer_file_comes_first_in_nothing_but_its_grid() {
    let middle = [43.5, 8.0];
    let tile = |west: f64| wire::hgt(move |x, y| plane_m(43.0 + y, west + x, middle).round() as i16);
    let files = Files::new(&[("N43E007.hgt", tile(7.0)), ("N43E008.hgt", tile(8.0))]);
    let report = Report::default();
    let relief = files.read(43.5, 8.0, &report).unwrap().unwrap();
    assert_plane(&relief, middle, 0.75);
    assert_eq!((relief.sources.len(), report.entries().len()), (2, 0));
}

#[test]
fn tiles_join_across_the_antimeridian() {
    let tile = |height_m: i16| wire::hgt(move |_, _| height_m);
    let files = Files::new(&[("N10E179.hgt", tile(10)), ("N10W180.hgt", tile(20))]);
    let relief = files.read(10.5, 179.9999, &Report::default()).unwrap().unwrap();
    let at = |x: f64| relief.height_m(DVec2::new(x, 3.0)).unwrap();
    assert!((at(-600.0) - 10.0).abs() < 0.1 && (at(600.0) - 20.0).abs() < 0.1, "{} {}", at(-600.0), at(600.0));
}

#[test]
fn voids_are_filled_from_around_them_and_reported() {
    let [lat, lon] = [43.5, 7.5];
    let is_void = |x: f64, y: f64| (x - 0.5).abs() < 0.003 && (y - 0.5).abs() < 0.002;
    let plane = |x: f64, y: f64| plane_m(43.0 + y, 7.0 + x, [lat, lon]).round() as i16;
    let tile = wire::hgt(|x, y| if is_void(x, y) { i16::MIN } else { plane(x, y) });
    let report = Report::default();
    let relief = Files::new(&[("N43E007.hgt", tile)]).read(lat, lon, &report).unwrap().unwrap();
    assert_plane(&relief, [lat, lon], 1.5);
    assert!(report.entries()[0].what.contains("filled from its neighbours"));
    assert_eq!(report.measurements()[0].value, 7.0 * 5.0);
}

#[test]
fn samples_that_are_no_heights_are_voids() {
    let (rows, corner) = plane_rows();
    for (void, nodata) in
        [(f32::NAN, None), (f32::INFINITY, None), (-32768.0, None), (1e30, None), (17.5, Some("17.5"))]
    {
        let sample = |(y, row): (usize, &Vec<f64>)| {
            let is_void = |x: usize| (45..55).contains(&x) && (45..55).contains(&y);
            let sample = |(x, h): (usize, &f64)| if is_void(x) { void } else { *h as f32 };
            row.iter().enumerate().map(sample).flat_map(f32::to_le_bytes).collect::<Vec<u8>>()
        };
        let strip = rows.iter().enumerate().flat_map(sample).collect();
        let tiff = Tiff::new([SIDE, SIDE], 32, 3).placed(corner, [STEP, STEP]).strips(SIDE, vec![strip]);
        let tiff = nodata.into_iter().fold(tiff, |tiff, text| tiff.text(42113, text));
        let report = Report::default();
        let relief = Files::new(&[("a.tif", tiff.bytes())]).read(MIDDLE[0], MIDDLE[1], &report).unwrap().unwrap();
        assert_plane(&relief, MIDDLE, 0.5);
        assert_eq!(report.measurements()[0].value, 100.0, "{void}");
    }
}

#[test]
fn files_of_another_place_are_reported_and_without_any_other_there_is_no_relief() {
    let far = || ("N43E007.hgt", wire::hgt(|_, _| 100));
    let here = ("S34E018.hgt", wire::hgt(|_, _| 7));
    let report = Report::default();
    let relief = Files::new(&[far(), here]).read(-33.5, 18.5, &report).unwrap().unwrap();
    assert!((relief.height_m(DVec2::ZERO).unwrap() - 7.0).abs() < 1e-6 && relief.sources.len() == 1);
    assert_eq!(report.entries()[0].examples, ["N43E007.hgt"]);
    let report = Report::default();
    assert_eq!(Files::new(&[far()]).read(-33.5, 18.5, &report).unwrap(), None);
    assert!(report.entries().iter().any(|e| e.what.contains("no elevation file covers the place")));
}
