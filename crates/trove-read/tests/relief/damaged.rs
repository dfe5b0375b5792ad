//! What is wrong with a file is told; nothing takes long or much memory.

use proptest::prelude::*;
use trove_model::Report;

use crate::wire::{self, Tiff};
use crate::{Files, MIDDLE, SIDE, STEP, plane_rows};

fn error(name: &str, bytes: Vec<u8>) -> String {
    Files::new(&[(name, bytes)]).read(MIDDLE[0], MIDDLE[1], &Report::default()).unwrap_err().to_string()
}

#[test]
fn tiles_of_a_wrong_size_or_name_say_what_was_expected() {
    let tile = wire::hgt(|_, _| 3);
    let cut = tile[..tile.len() - 1].to_vec();
    for (name, bytes, expect) in [
        ("N49E006.hgt", cut.clone(), "2884802 bytes"),
        ("N49E006.hgt", Vec::new(), "0 bytes"),
        ("N91E006.hgt", tile.clone(), "south-west corner"),
        ("X49E006.hgt", tile.clone(), "south-west corner"),
        ("a.zip", wire::zip("N49E006.hgt", &cut, true), "2884801 bytes"),
        ("a.zip", wire::zip("tile.hgt", &tile, true), "south-west corner"),
        ("a.zip", wire::zip("N49E006.txt", b"no", true), "SRTM tile (.hgt), found none"),
        ("a.zip", wire::zip("N49E006.hgt", &tile, true)[..1000].to_vec(), "cut short"),
        ("a.zip", wire::zip("N49E006.hgt", &vec![0; 60 << 20], true), "25934403 bytes"),
        ("a.tif", b"not a picture".to_vec(), "another kind of file"),
    ] {
        let error = error(name, bytes);
        assert!(error.contains(name) && error.contains(expect), "{error}");
    }
}

#[test]
fn pictures_without_degrees_heights_or_an_end_say_what_to_do() {
    let (_, corner) = plane_rows();
    let samples = || vec![vec![0; (4 * SIDE * SIDE) as usize]];
    let tiff = || Tiff::new([SIDE, SIDE], 32, 3).placed(corner, [STEP, STEP]).strips(SIDE, samples());
    let whole = tiff().bytes();
    for (bytes, expect) in [
        (tiff().shorts(34735, &[1, 1, 0, 2, 1024, 0, 1, 1, 3072, 0, 1, 32632]).bytes(), "EPSG:32632"),
        (tiff().shorts(34735, &[1, 1, 0, 2, 1024, 0, 1, 1, 3072, 0, 1, 32632]).bytes(), "gdalwarp -t_srs EPSG:4326"),
        (tiff().shorts(34735, &[1, 1]).bytes(), "no coordinate system"),
        (tiff().shorts(277, &[3]).shorts(258, &[32, 32, 32]).bytes(), "3 bands"),
        (tiff().strips(SIDE, vec![vec![0; 400]]).bytes(), "gdal_translate"),
        (tiff().entry(256, 2, 1 << 30, vec![0; 5]).bytes(), "a text of 1073741824 bytes"),
        (whole[..300].to_vec(), "complete GeoTIFF"),
        (whole[..5].to_vec(), "complete GeoTIFF"),
    ] {
        let error = error("a.tif", bytes);
        assert!(error.contains("a.tif") && error.contains(expect), "{expect}: {error}");
    }
}

#[test]
fn a_header_that_asks_for_any_amount_of_memory_is_refused() {
    let size = [100_000, 100_000];
    let step = [1e-6, 1e-6];
    let corner = [MIDDLE[1] - 0.05, MIDDLE[0] + 0.05];
    let tiff = || Tiff::new(size, 32, 3).shorts(259, &[8]).placed(corner, step);
    let zeros = wire::deflated(&vec![0; 4 << 20]);
    // One huge strip; the same few bytes for every tile; a picture of which the place needs little.
    let all = tiff().strips(size[1], vec![zeros.clone()]);
    let mut tiles = tiff().tiles(1024, vec![Vec::new(); 98 * 98]);
    tiles = tiles.longs(324, &vec![8; 98 * 98]);
    for bytes in [all.bytes(), tiles.bytes()] {
        let error = error("bomb.tif", bytes);
        assert!(error.contains("bomb.tif"), "{error}");
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(96))]

    #[test]
    fn any_change_to_a_file_gives_heights_or_an_error(kind in 0..3, at in 0.0f64..1.0, byte: u8, cut in 0.0f64..1.3) {
        let (rows, corner) = plane_rows();
        let samples = rows.iter().flatten().flat_map(|&h| (h as f32).to_le_bytes()).collect();
        let (name, mut bytes) = match kind {
            0 => ("a.zip", wire::zip("N49E006.hgt", &[7; 3000], true)),
            1 => ("a.tif", Tiff::new([SIDE, SIDE], 32, 3).placed(corner, [STEP, STEP]).strips(SIDE, vec![samples]).bytes()),
            _ => ("N49E006.hgt", vec![byte; 3000]),
        };
        // The ends of both are where their structure is.
        let index = bytes.len() - 1 - ((at * at) * (bytes.len() - 1) as f64) as usize;
        bytes[index] = byte;
        bytes.truncate((cut * bytes.len() as f64) as usize);
        let read = Files::new(&[(name, bytes)]).read(MIDDLE[0], MIDDLE[1], &Report::default());
        if let Ok(Some(relief)) = read {
            prop_assert!(relief.nodes.data.iter().all(|z| !z.is_infinite()));
        }
    }
}
