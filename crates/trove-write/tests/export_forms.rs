//! Exports of a car at a known place, held against closed forms.
#![allow(clippy::unwrap_used)] // all of this is tests

mod made;

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

use exr::prelude::{
    AnyChannel, AnyChannels, Encoding, FlatSamples, Image, ImageAttributes, IntegerBounds, Layer, LayerAttributes,
    WritableImage,
};
use glam::{DMat3, DQuat, DVec3};
use made::{ANCHOR_M, CAR, CAR_M, EYE_M, FOCAL_PX, HEIGHT, Made, WIDTH, finished, rear_px};
use serde_json::{Value, json};
use trove_format::FrameFile;
use trove_write::{Choice, DatasetFormat, Exported, WriteError, export};

fn exported(name: &str, source: &Path, out: &Path) -> Result<Exported, WriteError> {
    let format = DatasetFormat::named(name).unwrap();
    export(source, out, format, &Choice::default(), &|_, _| true)
}

/// An export of these frames, and what was told of it.
fn of(name: &str, frames: &[Made]) -> (tempfile::TempDir, Exported) {
    let root = tempfile::tempdir().unwrap();
    finished(&root.path().join("run"), frames);
    let exported = exported(name, &root.path().join("run"), &root.path().join("out")).unwrap();
    (root, exported)
}

fn json(path: &Path) -> Value {
    serde_json::from_slice(&fs::read(path).unwrap()).unwrap()
}

fn numbers<const N: usize>(value: &Value) -> [f64; N] {
    let values: Vec<f64> = value.as_array().unwrap().iter().map(|v| v.as_f64().unwrap()).collect();
    values.try_into().unwrap()
}

fn close(a: &[f64], b: &[f64]) -> bool {
    a.len() == b.len() && a.iter().zip(b).all(|(a, b)| (a - b).abs() < 1e-9)
}

#[test]
fn a_frame_without_a_file_that_a_form_needs_names_the_entry_of_output_files() {
    for (name, missing) in [
        ("nuscenes", FrameFile::Rgb),
        ("nuimages", FrameFile::Instance),
        ("bop", FrameFile::Depth),
        ("hdf5", FrameFile::Class),
        ("mcap", FrameFile::Rgb),
        ("openlabel", FrameFile::Rgb),
        ("vkitti2", FrameFile::FlowForward),
    ] {
        let root = tempfile::tempdir().unwrap();
        let mut made = Made::new(0);
        made.files.retain(|file| *file != missing);
        finished(&root.path().join("run"), &[made]);
        let error = exported(name, &root.path().join("run"), &root.path().join("out")).unwrap_err().to_string();
        let entry = missing.name().split('.').next().unwrap();
        assert!(error.contains(&format!("name {entry} in the recipe's output.files")), "{name}: {error}");
        assert!(error.contains(missing.name()), "{name}: {error}");
    }
}

#[test]
fn a_frame_that_asks_for_more_than_its_files_hold_is_damaged() {
    let told = |form: &str, damage: &dyn Fn(&Path)| {
        let root = tempfile::tempdir().unwrap();
        finished(&root.path().join("run"), &[Made::new(0)]);
        damage(&root.path().join("run/scene-0001/v00/k000/ego.CAM_FRONT"));
        exported(form, &root.path().join("run"), &root.path().join("out")).unwrap_err().to_string()
    };
    let of_the_table = told("cityscapes", &|frame| {
        let text = fs::read_to_string(frame.join("frame.json")).unwrap();
        let damaged = text.replace(&format!("\"id\":{CAR}"), "\"id\":4000000000");
        assert_ne!(text, damaged);
        fs::write(frame.join("frame.json"), damaged).unwrap();
    });
    assert!(of_the_table.contains("found object 4000000000"), "{of_the_table}");
    let of_layers = told("kitti-depth", &|frame| {
        let size = (WIDTH as usize, HEIGHT as usize);
        let plane = || FlatSamples::F32(vec![1.0; size.0 * size.1]);
        let layer = |name: &str| {
            let channels = AnyChannels::sort([AnyChannel::new("Y", plane())].into_iter().collect());
            Layer::new(size, LayerAttributes::named(name), Encoding::FAST_LOSSLESS, channels)
        };
        let layers = vec![layer("one"), layer("two")];
        Image::from_layers(ImageAttributes::new(IntegerBounds::from_dimensions(size)), layers)
            .write()
            .to_file(frame.join("depth.exr"))
            .unwrap();
    });
    assert!(of_layers.contains("depth.exr") && of_layers.contains("2 layers instead of one"), "{of_layers}");
}

#[test]
fn nuscenes_tables_put_the_car_where_it_projects_to_its_pixels() {
    let far = Made { car_m: [3.0, 30.0, 0.5], ..Made::new(1) };
    let stray = Made { view: "v1.CAM_FRONT", has_vehicle: false, ..Made::new(0) };
    let (root, exported) = of("nuscenes", &[Made::new(0), far, stray]);
    assert_eq!(
        exported.clipped,
        BTreeMap::from([("frames left out, whose camera has no vehicle with a known pose".into(), 1)])
    );
    let tables = root.path().join("out/v1.0-trove");
    let rows = |table: &str| json(&tables.join(format!("{table}.json"))).as_array().unwrap().clone();
    let (annotations, sensors) = (rows("sample_annotation"), rows("calibrated_sensor"));
    assert_eq!((rows("scene").len(), rows("sample").len(), annotations.len()), (1, 2, 2));
    let camera = sensors.iter().find(|row| row["camera_intrinsic"] != Value::Array(vec![])).unwrap();
    let transform = |row: &Value| {
        let [w, x, y, z] = numbers(&row["rotation"]);
        (DMat3::from_quat(DQuat::from_xyzw(x, y, z, w)), DVec3::from(numbers::<3>(&row["translation"])))
    };
    let ((ego_from_camera, camera_in_ego), k) = (transform(camera), &camera["camera_intrinsic"]);
    assert!(close(&camera_in_ego.to_array(), &[0.0, 0.0, EYE_M]), "{camera_in_ego}");
    let (plane_from_ego, ego) = transform(&rows("ego_pose")[0]);
    assert!(close(&ego.to_array(), &[ANCHOR_M[0], ANCHOR_M[1], 0.0]));
    for (annotation, car_m) in annotations.iter().zip([[0.0, 20.0, 0.5], [3.0, 30.0, 0.5]]) {
        let (plane_from_body, middle) = transform(annotation);
        assert!(close(&numbers::<3>(&annotation["size"]), &[CAR_M[1], CAR_M[0], CAR_M[2]]), "width, length, height");
        // The lower right corner of its rear, through all of the tables' transforms.
        let corner = middle + plane_from_body * DVec3::new(-CAR_M[0] / 2.0, -CAR_M[1] / 2.0, -CAR_M[2] / 2.0);
        let in_ego = plane_from_ego.transpose() * (corner - ego);
        let in_camera = ego_from_camera.transpose() * (in_ego - camera_in_ego);
        let pixel = [0, 1].map(|i| {
            let [a, b, c] = numbers::<3>(&k[i]);
            (a * in_camera.x + b * in_camera.y + c * in_camera.z) / in_camera.z
        });
        let [_, _, right, lower] = rear_px(car_m);
        assert!(close(&pixel, &[right, lower]), "{pixel:?} {right} {lower}");
        assert_eq!((&annotation["visibility_token"], &annotation["num_lidar_pts"]), (&"4".into(), &1.into()));
    }
    assert_eq!(annotations[0]["next"], annotations[1]["token"]);
    let attributes = rows("attribute");
    let moving = attributes.iter().find(|row| row["name"] == "vehicle.moving").unwrap();
    assert_eq!(annotations[0]["attribute_tokens"][0], moving["token"]);
    assert!(annotations.iter().all(|row| row["token"].as_str().unwrap().len() == 32));
    let splits = json(&tables.join("splits.json"));
    assert_eq!(splits["trove_train"][0], "scene-0001-v00");
}

#[test]
fn a_camera_that_no_vehicle_carries_has_no_scene_of_nuscenes() {
    let root = tempfile::tempdir().unwrap();
    finished(&root.path().join("run"), &[Made { has_vehicle: false, ..Made::new(0) }]);
    let error = exported("nuscenes", &root.path().join("run"), &root.path().join("out")).unwrap_err().to_string();
    assert!(error.contains("world_from_ego") && error.contains("kitti or coco"), "{error}");
}

#[test]
fn bop_has_the_car_in_millimetres_and_depth_in_steps() {
    let with_masks = || {
        let mut made = Made::new(0);
        made.files.push(FrameFile::Masks);
        made
    };
    let (root, exported) = of("bop", &[with_masks()]);
    assert_eq!(exported.clipped, BTreeMap::new());
    let scene = root.path().join("out/train/000000");
    let pose = &json(&scene.join("scene_gt.json"))["0"][0];
    assert!(close(&numbers::<3>(&pose["cam_t_m2c"]), &[0.0, 1000.0 * (EYE_M - 0.5), 20_000.0]));
    // Body's x is the camera's z, its y (left) −x, its z (up) −y.
    assert!(close(&numbers::<9>(&pose["cam_R_m2c"]), &[0.0, -1.0, 0.0, 0.0, 0.0, -1.0, 1.0, 0.0, 0.0]));
    assert_eq!(pose["obj_id"], 1);
    let model = &json(&root.path().join("out/models/models_info.json"))["1"];
    assert_eq!([&model["size_x"], &model["size_y"], &model["size_z"]], [4000.0, 2000.0, 1000.0]);
    let depth = image::open(scene.join("depth/000000.png")).unwrap().into_luma16();
    // The sky, the car's rear 18 m away, and the lowest row of the road.
    assert_eq!((depth.get_pixel(0, 0).0[0], depth.get_pixel(WIDTH / 2, HEIGHT / 2 + 2).0[0]), (0, 1800));
    let road_m = FOCAL_PX * EYE_M / (f64::from(HEIGHT) / 2.0 - 0.5);
    assert_eq!(depth.get_pixel(0, HEIGHT - 1).0[0], (road_m * 100.0).round() as u16);
    let mask = image::open(scene.join("mask_visib/000000_000000.png")).unwrap().into_luma8();
    let info = &json(&scene.join("scene_gt_info.json"))["0"][0];
    assert_eq!(info["px_count_visib"], mask.pixels().filter(|p| p.0[0] == 255).count());
    // Nothing hides it.
    assert_eq!(image::open(scene.join("mask/000000_000000.png")).unwrap().into_luma8(), mask);
    let (root, _) = of("coco", &[with_masks()]);
    let car = &json(&root.path().join("out/annotations/instances_train.json"))["annotations"][0];
    assert_eq!((&car["a_segm"], &car["a_area"], &car["a_bbox"]), (&car["segmentation"], &car["area"], &car["bbox"]));
    assert!(car["a_segm"]["counts"].as_str().unwrap().len() > 4);
}

#[test]
fn depth_beyond_the_form_is_counted() {
    // A car 800 m away shows one pixel where its middle lies on the ray through that pixel's centre.
    let aside_m = 0.5 * 800.0 / FOCAL_PX;
    let made = || Made { car_m: [aside_m, 800.0 + CAR_M[0] / 2.0, EYE_M - aside_m], ..Made::new(0) };
    for (name, path, expected) in [
        ("bop", "train/000000/depth/000000.png", 0),
        ("vkitti2", "Scene01/v00/frames/depth/Camera_0/depth_00000.png", u16::MAX),
    ] {
        let (root, exported) = of(name, &[made()]);
        let mut clipped = exported.clipped;
        clipped.retain(|what, _| !what.contains("masks.json"));
        assert_eq!(clipped.into_values().collect::<Vec<_>>(), [1], "{name}");
        let depth = image::open(root.path().join("out").join(path)).unwrap().into_luma16();
        assert_eq!(depth.get_pixel(WIDTH / 2, HEIGHT / 2).0[0], expected, "{name}");
    }
}

#[test]
fn vkitti2_places_the_car_by_its_lower_side_with_y_down() {
    let (root, _) = of("vkitti2", &[Made::new(0), Made { car_m: [3.0, 30.0, 0.5], ..Made::new(1) }]);
    let folder = root.path().join("out/Scene01/v00");
    let text = fs::read_to_string(folder.join("pose.txt")).unwrap();
    let rows: Vec<Vec<f64>> =
        text.lines().skip(1).map(|line| line.split(' ').map(|v| v.parse().unwrap()).collect()).collect();
    let names: Vec<&str> = text.lines().next().unwrap().split(' ').collect();
    assert_eq!(names.len(), rows[0].len());
    let of = |row: usize, name: &str| rows[row][names.iter().position(|n| *n == name).unwrap()];
    for (row, [x, y, _]) in [(0, [0.0, 20.0, 0.5]), (1, [3.0, 30.0, 0.5])] {
        // Camera: right, down, forward; the road is the eye's height below.
        let camera = ["X", "Y", "Z"].map(|axis| of(row, &format!("camera_space_{axis}")));
        assert!(close(&camera, &[x, EYE_M, y]), "{camera:?}");
        let world = ["X", "Y", "Z"].map(|axis| of(row, &format!("world_space_{axis}")));
        assert!(close(&world, &[x, 0.0, y]), "{world:?}");
        // It drives away: a quarter turn from the camera's right to its front.
        let angles = ["y", "x", "z"].map(|axis| of(row, &format!("rotation_camera_space_{axis}")));
        assert!(close(&angles, &[-std::f64::consts::FRAC_PI_2, 0.0, 0.0]), "{angles:?}");
        assert!(close(&[of(row, "alpha")], &[-std::f64::consts::FRAC_PI_2 - x.atan2(y)]));
    }
    let shown = image::open(folder.join("frames/instanceSegmentation/Camera_0/instancegt_00000.png")).unwrap();
    assert_eq!(shown.into_luma8().get_pixel(WIDTH / 2, HEIGHT / 2 + 2).0[0], 1, "track 0");
    let flow = image::open(folder.join("frames/forwardFlow/Camera_0/flow_00000.png")).unwrap().into_rgb16();
    let [r, g, b] = flow.get_pixel(WIDTH / 2, HEIGHT - 1).0;
    let decoded = |v: u16, side: u32| (2.0 * f64::from(v) / 65_535.0 - 1.0) * f64::from(side - 1);
    assert!((decoded(r, WIDTH) - 1.5).abs() < 0.001 && (decoded(g, HEIGHT) + 0.25).abs() < 0.001);
    assert_eq!((b, flow.get_pixel(0, 0).0), (u16::MAX, [0; 3]));
    let depth = image::open(folder.join("frames/depth/Camera_0/depth_00000.png")).unwrap().into_luma16();
    assert_eq!((depth.get_pixel(0, 0).0[0], depth.get_pixel(WIDTH / 2, HEIGHT / 2 + 2).0[0]), (65_535, 1800));
}

#[test]
fn openlabel_has_ten_numbers_a_cuboid() {
    let (root, _) = of("openlabel", &[Made::new(3), Made::new(4)]);
    let file = json(&root.path().join("out/train/scene-0001_v00_ego.CAM_FRONT.json"));
    let label = &file["openlabel"];
    let half = 0.5f64.sqrt();
    let data = &label["frames"]["1"]["objects"][CAR.to_string()]["object_data"];
    let cuboid = numbers::<10>(&data["cuboid"][0]["val"]);
    assert!(close(&cuboid, &[0.0, 20.0, 0.5, 0.0, 0.0, half, half, 4.0, 2.0, 1.0]), "{cuboid:?}");
    let intervals = &label["objects"][CAR.to_string()]["frame_intervals"];
    assert_eq!((&intervals[0]["frame_start"], &intervals[0]["frame_end"]), (&0.into(), &1.into()));
}

#[test]
fn webdataset_shards_are_the_frames_files() {
    let (root, _) = of("webdataset", &[Made::new(0), Made::new(1)]);
    let mut shard = tar::Archive::new(fs::File::open(root.path().join("out/train-00000000.tar")).unwrap());
    let names: Vec<String> =
        shard.entries().unwrap().map(|e| e.unwrap().path().unwrap().to_string_lossy().into_owned()).collect();
    assert_eq!(names.len(), 2 * 11, "{names:?}");
    assert!(names.contains(&"00000001.json".into()) && names[0].starts_with("00000000."));
}

#[test]
fn a_box_outside_of_its_picture_is_an_error() {
    let root = tempfile::tempdir().unwrap();
    let (run, out) = (root.path().join("run"), root.path().join("out"));
    finished(&run, &[Made::new(0)]);
    let path = run.join("scene-0001/v00/k000/ego.CAM_FRONT/frame.json");
    let mut table = json(&path);
    table["objects"][0]["visible_box"] = serde_json::json!([60, 40, WIDTH, HEIGHT]);
    fs::write(&path, table.to_string()).unwrap();
    for name in ["nuimages", "bop"] {
        let error = exported(name, &run, &out.join(name)).unwrap_err().to_string();
        assert!(error.contains("frame.json") && error.contains("object 300 with a box"), "{error}");
    }
}

#[test]
fn an_export_gives_the_same_bytes_again() {
    for name in ["nuscenes", "nuimages", "bop", "hdf5", "webdataset", "mcap", "openlabel", "vkitti2"] {
        let root = tempfile::tempdir().unwrap();
        finished(&root.path().join("run"), &[Made::new(0), Made::new(1)]);
        let bytes = |out: &str| {
            exported(name, &root.path().join("run"), &root.path().join(out)).unwrap();
            contents(&root.path().join(out))
        };
        let (first, second) = (bytes("a"), bytes("b"));
        assert!(first.len() > 1 && first == second, "{name}");
    }
}

/// All files of a dataset.
fn contents(root: &Path) -> BTreeMap<String, Vec<u8>> {
    let mut found = BTreeMap::new();
    let mut folders = vec![root.to_owned()];
    while let Some(folder) = folders.pop() {
        for entry in fs::read_dir(folder).unwrap().flatten() {
            let path = entry.path();
            if path.is_dir() {
                folders.push(path);
            } else if !path.components().any(|part| part.as_os_str() == ".trove") {
                found.insert(path.strip_prefix(root).unwrap().to_string_lossy().into_owned(), fs::read(&path).unwrap());
            }
        }
    }
    found
}

#[test]
fn openlane_has_lines_where_its_loaders_put_them_and_tells_what_hides_them() {
    let root = tempfile::tempdir().unwrap();
    finished(&root.path().join("run"), &[Made::new(0)]);
    // North along World's y: 2 m to the left, and below the car that stands 18 to 22 m ahead.
    let line = |id: u32, x: f64, paint: &str, pattern: &str| json!({ "id": id, "paint": paint, "pattern": pattern, "width_m": 0.15, "points_m": [[x, 60.0, 0.0], [x, -5.0, 0.0]] });
    let projection = json!({ "origin_lat_deg": 0.0, "origin_lon_deg": 0.0, "anchor_m": [0.0, 0.0] });
    let lines = [line(3, -2.0, "white", "dashed"), line(5, 0.5, "yellow", "solid_dashed")];
    // The carriageway is on the left of kerbs.
    let kerbs = [([-4.0, 60.0, 0.0], [-4.0, 1.0, 0.0]), ([4.0, 1.0, 0.0], [4.0, 60.0, 0.0])];
    let kerbs = [6, 7].iter().zip(kerbs).map(|(id, (from, to))| json!({ "id": id, "points_m": [from, to] }));
    let kerbs = kerbs.collect::<Vec<_>>();
    let lanes =
        json!({ "scene": "s", "dataset": "d", "projection": projection, "lanes": [], "lines": lines, "kerbs": kerbs });
    fs::write(root.path().join("run/scene-0001/v00/lanes.json"), lanes.to_string()).unwrap();
    exported("openlane", &root.path().join("run"), &root.path().join("out")).unwrap();
    let frame = "training/segment-scene-0001_v00_ego.CAM_FRONT/000";
    let file = json(&root.path().join(format!("out/lane3d_1000/{frame}.json")));
    assert_eq!(file["file_path"], format!("{frame}.jpg"));
    assert!(root.path().join(format!("out/images/{frame}.jpg")).is_file());
    let rows = file["lane_lines"].as_array().unwrap();
    let told = |key: &str| rows.iter().map(|row| row[key].as_u64().unwrap()).collect::<Vec<_>>();
    // Both run southward, away from the camera's view, so that the sides of a pattern change.
    let expected = (vec![3, 5, 6, 7], vec![1, 11, 20, 21], vec![2, 3, 1, 4]);
    assert_eq!((told("track_id"), told("category"), told("attribute")), expected);
    for (row, x) in rows.iter().zip([-2.0, 0.5]) {
        let list = |value: &Value| value.as_array().unwrap().iter().map(|v| v.as_f64().unwrap()).collect::<Vec<_>>();
        let [xyz, uv] = ["xyz", "uv"].map(|key| row[key].as_array().unwrap().iter().map(list).collect::<Vec<_>>());
        let visibility = list(&row["visibility"]);
        assert!(visibility.len() == xyz[0].len() && visibility.len() == uv[1].len() && visibility.len() > 50);
        for i in 0..visibility.len() {
            // Waymo's camera: forward, left, up.
            let [ahead, left, up] = [xyz[0][i], xyz[1][i], xyz[2][i]];
            assert!((left + x).abs() < 1e-4 && (up + EYE_M).abs() < 1e-4);
            let [u, v] =
                [f64::from(WIDTH) / 2.0 + FOCAL_PX * x / ahead, f64::from(HEIGHT) / 2.0 + FOCAL_PX * EYE_M / ahead];
            assert!((uv[0][i] - u).abs() < 1e-3 && (uv[1][i] - v).abs() < 1e-3);
            if x < 0.0 || ahead < 15.0 {
                assert_eq!(visibility[i], 1.0, "{x} {ahead}");
            } else if (22.0..27.0).contains(&ahead) {
                assert_eq!(visibility[i], 0.0, "{x} {ahead}");
            }
        }
    }
}
