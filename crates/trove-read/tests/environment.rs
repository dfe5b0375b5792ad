//! Pictures of skies, made up, damaged and real.
#![allow(clippy::unwrap_used)]

use std::path::{Path, PathBuf};

use proptest::prelude::*;
use trove_read::environment::read;

/// Left to right: red, green, blue, white; the lower row half as bright.
fn pixel(x: usize, y: usize) -> [f32; 3] {
    let color = [[4.0, 0.0, 0.0], [0.0, 4.0, 0.0], [0.0, 0.0, 4.0], [4.0; 3]][x % 4];
    color.map(|c: f32| if y == 0 { c } else { c / 2.0 })
}

fn exr(path: &Path, width: usize, height: usize, pixel: impl Fn(usize, usize) -> [f32; 3] + Sync) {
    exr::prelude::write_rgb_file(path, width, height, |x, y| pixel(x, y).into()).unwrap();
}

fn hdr(width: usize, height: usize) -> Vec<u8> {
    let mut bytes = format!("#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y {height} +X {width}\n").into_bytes();
    for (x, y) in (0..height).flat_map(|y| (0..width).map(move |x| (x, y))) {
        // 8 bits of mantissa each and a common exponent: v = m / 256 · 2^(e − 128).
        let rgb = pixel(x, y).map(|v| (v * 256.0 / 8.0) as u8);
        bytes.extend([rgb[0], rgb[1], rgb[2], 131]);
    }
    bytes
}

#[test]
fn rows_run_down_and_columns_clockwise_as_in_the_file() {
    let dir = tempfile::tempdir().unwrap();
    let (exr_path, hdr_path) = (dir.path().join("sky.exr"), dir.path().join("sky.hdr"));
    exr(&exr_path, 4, 2, pixel);
    std::fs::write(&hdr_path, hdr(4, 2)).unwrap();
    for path in [exr_path, hdr_path] {
        let map = read(&path).unwrap();
        assert_eq!((map.width, map.height), (4, 2));
        let expected: Vec<[f32; 3]> = (0..8).map(|i| pixel(i % 4, i / 4)).collect();
        assert_eq!(map.rgb, expected);
        assert_eq!(map.name, path.file_name().unwrap().to_string_lossy());
    }
}

#[test]
fn what_is_no_radiance_is_repaired() {
    let dir = tempfile::tempdir().unwrap();
    let path = dir.path().join("sky.exr");
    let row = [[2.0, 1.0, 1.0], [f32::NAN, -1.0, f32::INFINITY], [1.0; 3], [1.0; 3]];
    exr(&path, 4, 2, |x, _| row[x]);
    assert_eq!(read(&path).unwrap().rgb[1], [2.0, 0.0, 2.0]);
}

#[test]
fn pictures_of_another_shape_are_refused_with_a_remedy() {
    let dir = tempfile::tempdir().unwrap();
    let path = dir.path().join("sky.exr");
    exr(&path, 4, 4, pixel);
    let error = read(&path).unwrap_err().to_string();
    assert!(error.contains("sky.exr") && error.contains("4×4") && error.contains("equirectangular"), "{error}");
    std::fs::write(&path, b"\x89PNG").unwrap();
    assert!(read(&path).unwrap_err().to_string().contains("convert it"));
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(200) })]

    #[test]
    fn damaged_bytes_never_panic(
        as_exr in any::<bool>(),
        damage in prop::collection::vec((any::<prop::sample::Index>(), any::<u8>()), 1..6),
        cut in prop::option::of(any::<prop::sample::Index>()),
    ) {
        let dir = tempfile::tempdir().unwrap();
        let path = dir.path().join("sky");
        if as_exr {
            exr(&path, 8, 4, pixel);
        } else {
            std::fs::write(&path, hdr(8, 4)).unwrap();
        }
        let mut bytes = std::fs::read(&path).unwrap();
        for (index, byte) in damage {
            let i = index.index(bytes.len());
            bytes[i] = byte;
        }
        if let Some(cut) = cut {
            bytes.truncate(cut.index(bytes.len()));
        }
        std::fs::write(&path, bytes).unwrap();
        let _ = read(&path);
    }
}

#[test]
#[ignore = "needs TROVE_TEST_DATA"]
fn real_skies_are_read() {
    let root = PathBuf::from(std::env::var_os("TROVE_TEST_DATA").expect("TROVE_TEST_DATA")).join("hdri");
    for entry in std::fs::read_dir(root).unwrap() {
        let map = read(&entry.unwrap().path()).unwrap();
        let mean = |rows: std::ops::Range<usize>| {
            let pixels = &map.rgb[rows.start * map.width as usize..rows.end * map.width as usize];
            pixels.iter().flatten().map(|&v| f64::from(v)).sum::<f64>() / (3 * pixels.len()) as f64
        };
        let half = map.height as usize / 2;
        assert!(map.width == 2 * map.height && mean(0..half) > 0.0, "{}", map.name);
    }
}
