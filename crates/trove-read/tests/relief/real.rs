//! The real files of `TROVE_TEST_DATA`.

use std::path::PathBuf;

use glam::DVec2;
use trove_model::{Bounds, Relief, Report};
use trove_read::relief;

use crate::projection;

fn read(name: &str, lat_deg: f64, lon_deg: f64, side_m: f64, report: &Report) -> Relief {
    let data = PathBuf::from(std::env::var_os("TROVE_TEST_DATA").expect("TROVE_TEST_DATA"));
    let paths = [data.join("relief").join(name)];
    let area = Bounds::square(DVec2::ZERO, side_m);
    relief::read(&paths, &projection(lat_deg, lon_deg), area, report).unwrap().unwrap()
}

#[test]
#[ignore = "needs TROVE_TEST_DATA"]
fn real_monaco_rises_from_the_harbour_to_mont_agel_and_its_voids_are_filled() {
    let (lat_deg, lon_deg) = (43.7347, 7.4206);
    let report = Report::default();
    let relief = read("N43E007.hgt.zip", lat_deg, lon_deg, 16_000.0, &report);
    let at = |lat: f64, lon: f64| relief.height_m(projection(lat_deg, lon_deg).world_from_geo(lat, lon)).unwrap();
    let (harbour, rock, mont_agel) = (at(43.7347, 7.4270), at(43.73167, 7.4250), at(43.7752, 7.4222));
    assert!(harbour.abs() < 5.0, "{harbour}");
    assert!((58.0..68.0).contains(&rock), "{rock}");
    assert!((1115.0..1140.0).contains(&mont_agel), "{mont_agel}");
    assert!(relief.nodes.data.iter().all(|z| z.is_finite()));
}

#[test]
#[ignore = "needs TROVE_TEST_DATA"]
fn real_luxembourg_is_read_with_its_nodata_left_out() {
    let report = Report::default();
    let relief = read("luxembourg.tif", 49.8, 6.1, 8000.0, &report);
    assert!((relief.cell_m.y - 927.0).abs() < 2.0, "{}", relief.cell_m);
    let (low, high) = relief.nodes.data.iter().fold((f32::MAX, f32::MIN), |(l, h), &z| (l.min(z), h.max(z)));
    assert!((140.0..350.0).contains(&low) && (300.0..548.0).contains(&high), "{low} {high}");
}
