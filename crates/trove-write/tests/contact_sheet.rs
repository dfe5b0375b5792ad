//! The contact sheet, made from frames' files.
#![allow(clippy::unwrap_used)]

use std::fs;
use std::path::Path;

use exr::prelude::{WritableImage, f16};
use serde_json::json;
use trove_write::WriteError;
use trove_write::contact_sheet::{Frame, write};

const W: u32 = 64;
const H: u32 = 36;

/// A frame's folder as far as the sheet looks at it, all in one colour and one class.
fn frame(root: &Path, name: &str, class: u8, rgb: Option<[u8; 3]>) -> Frame {
    let dir = root.join(name);
    fs::create_dir_all(&dir).unwrap();
    let table = json!({
        "scene": "s", "dataset": "d", "keyframe": 0, "keyframe_time_ns": 0, "view": "ego.A", "time_ns": 0,
        "width_px": W, "height_px": H, "intrinsics": [[50, 0, 32], [0, 50, 18], [0, 0, 1]], "lens_model": "pinhole",
        "world_from_camera": [[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]],
        "world_from_camera_rotation_wxyz": [1, 0, 0, 0], "world_from_camera_translation_m": [0, 0, 0],
        "projection": { "origin_lat_deg": 0, "origin_lon_deg": 0, "anchor_m": [0, 0] },
        "spp": 1, "denoised": false, "seed": 7, "objects": [],
    });
    fs::write(dir.join("frame.json"), table.to_string()).unwrap();
    if let Some(rgb) = rgb {
        image::RgbImage::from_pixel(W, H, image::Rgb(rgb)).save(dir.join("rgb.png")).unwrap();
    }
    image::GrayImage::from_pixel(W, H, image::Luma([class])).save(dir.join("class.png")).unwrap();
    let ids = image::ImageBuffer::<image::Luma<u16>, Vec<u16>>::from_pixel(W, H, image::Luma([700]));
    ids.save(dir.join("instance.png")).unwrap();
    let size = (W as usize, H as usize);
    let depth = exr::prelude::SpecificChannels::build().with_channel("Y").with_pixel_fn(|_| (f32::INFINITY,));
    exr::prelude::Image::from_channels(size, depth).write().to_file(dir.join("depth.exr")).unwrap();
    let normal = |_, _| (f16::ZERO, f16::ZERO, f16::NEG_ONE);
    exr::prelude::write_rgb_file(dir.join("normal.exr"), size.0, size.1, normal).unwrap();
    Frame { name: name.into(), dir }
}

fn sheet(root: &Path, frames: &[Frame]) -> Vec<u8> {
    let path = root.join("contact_sheet.png");
    write(&path, frames).unwrap();
    fs::read(path).unwrap()
}

#[test]
fn the_sheet_is_the_same_whatever_order_frames_come_in() {
    let root = tempfile::tempdir().unwrap();
    let mut frames: Vec<Frame> =
        (0..7).map(|i| frame(root.path(), &format!("k{i:03}"), 2 + i as u8, Some([30 * i as u8, 90, 120]))).collect();
    let bytes = sheet(root.path(), &frames);
    frames.reverse();
    frames.push(frames[2].clone());
    assert_eq!(sheet(root.path(), &frames), bytes);
}

#[test]
fn a_frame_shows_picture_classes_instances_and_depth() {
    let root = tempfile::tempdir().unwrap();
    let bytes = sheet(root.path(), &[frame(root.path(), "a", 9, Some([200, 100, 50]))]);
    let picture = image::load_from_memory(&bytes).unwrap().into_rgb8();
    let tile = |i: u32| picture.get_pixel(6 + i * 322 + 160, 6 + 14 + 80).0;
    assert_eq!(tile(0), [200, 100, 50]);
    // Road is (128, 64, 128) in the class table; a third is the picture's brightness.
    assert_eq!(tile(1), [(256 + 118) / 3, (128 + 118) / 3, (256 + 118) / 3].map(|c| c as u8));
    assert!(tile(2).iter().any(|&c| c > 100), "an instance is colourful");
    assert_eq!(tile(3), [0; 3], "the sky is black");
}

#[test]
fn labels_alone_show_normals_in_the_pictures_place() {
    let root = tempfile::tempdir().unwrap();
    let bytes = sheet(root.path(), &[frame(root.path(), "a", 9, None)]);
    let picture = image::load_from_memory(&bytes).unwrap().into_rgb8();
    assert_eq!(picture.get_pixel(100, 100).0, [127, 127, 255], "towards the camera is blue");
}

#[test]
fn many_frames_are_thinned_and_none_is_no_error() {
    let root = tempfile::tempdir().unwrap();
    assert!(!sheet(root.path(), &[]).is_empty());
    let one = frame(root.path(), "one", 9, Some([1, 2, 3]));
    let many: Vec<Frame> = (0..1000).map(|i| Frame { name: format!("{i:04}"), ..one.clone() }).collect();
    let picture = image::load_from_memory(&sheet(root.path(), &many)).unwrap();
    assert!(picture.height() < 3000, "{} rows of pixels", picture.height());
}

#[test]
fn a_damaged_frame_is_named() {
    let root = tempfile::tempdir().unwrap();
    let damaged = frame(root.path(), "a", 9, Some([1, 2, 3]));
    let path = root.path().join("sheet.png");
    fs::write(damaged.dir.join("class.png"), b"no picture").unwrap();
    let error = write(&path, std::slice::from_ref(&damaged)).unwrap_err();
    assert!(matches!(error, WriteError::Damaged { .. }) && error.to_string().contains("class.png"), "{error}");
    assert!(!path.exists());
}

#[test]
fn a_frame_shows_what_it_has() {
    let root = tempfile::tempdir().unwrap();
    let few = frame(root.path(), "a", 9, Some([200, 100, 50]));
    for name in ["depth.exr", "instance.png", "normal.exr"] {
        fs::remove_file(few.dir.join(name)).unwrap();
    }
    let picture = image::load_from_memory(&sheet(root.path(), &[few])).unwrap().into_rgb8();
    let tile = |i: u32| picture.get_pixel(6 + i * 322 + 160, 6 + 14 + 80).0;
    assert_eq!((tile(0), tile(1)[1]), ([200, 100, 50], (128 + 118) / 3));
    let without = frame(root.path(), "b", 9, None);
    for name in ["depth.exr", "instance.png", "normal.exr", "class.png"] {
        fs::remove_file(without.dir.join(name)).unwrap();
    }
    assert!(!sheet(root.path(), &[without]).is_empty());
}
