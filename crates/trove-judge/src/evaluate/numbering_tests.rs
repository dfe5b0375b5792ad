//! How both sides' numbers are found out, and what becomes of them.

use image::{DynamicImage, GrayImage, ImageBuffer, Luma, RgbImage};
use trove_format::{FrameTable, GlassPolicy, LensModel, ObjectOrigin, ObjectRow, Projection};
use trove_model::{Kind, Role};

use super::*;

const WITHOUT: Settings =
    Settings { classes: None, predicted: None, truth: None, boundary: false, panoptic: false, seed: Seed(1) };

fn run(predicted: &Path, truth: &Path, settings: &Settings) -> Result<Evaluation, JudgeError> {
    evaluate(predicted, truth, settings, &|_, _| true)
}

fn within(name: &str) -> Settings {
    Settings { classes: ClassMap::named(name), ..WITHOUT }
}

fn write(path: &Path, picture: impl Into<DynamicImage>) {
    std::fs::create_dir_all(path.parent().unwrap()).unwrap();
    picture.into().save(path).unwrap();
}

fn greys(ids: &[u8]) -> GrayImage {
    GrayImage::from_raw(ids.len() as u32, 1, ids.to_vec()).unwrap()
}

fn wide(numbers: &[u16]) -> ImageBuffer<Luma<u16>, Vec<u16>> {
    ImageBuffer::from_raw(numbers.len() as u32, 1, numbers.to_vec()).unwrap()
}

/// One of our own frames, with objects of some kinds, numbered from 1.
fn frame(folder: &Path, ids: &[u8], instances: &[u16], kinds: &[Kind]) {
    write(&folder.join("class.png"), greys(ids));
    write(&folder.join("instance.png"), wide(instances));
    let object = |(id, kind): (u32, &Kind)| ObjectRow {
        id,
        class: kind.class(),
        class_id: kind.class().id(),
        kind: *kind,
        origin: ObjectOrigin::Scenery,
        category: String::new(),
        token: String::new(),
        track_token: String::new(),
        asset: String::new(),
        world_from_body: [[0.0; 4]; 4],
        size_m: [1.0; 3],
        world_from_asset: None,
        paint: None,
        velocity_mps: None,
        yaw_rate_radps: None,
        states: Vec::new(),
        visible_px: 1,
        amodal_px: 1,
        visible_box: None,
        amodal_box: None,
        truncation: 0.0,
        occlusion: 0.0,
        range_m: 9.0,
        keypoints: None,
        keypoints_world_m: None,
    };
    let table = FrameTable {
        scene: "scene".into(),
        dataset: "made".into(),
        place: String::new(),
        variation: 0,
        keyframe: 0,
        keyframe_token: String::new(),
        keyframe_time_ns: 0,
        recorded_keyframe: Some(0),
        view: "ego.A".into(),
        time_ns: 0,
        source_token: String::new(),
        source_image: String::new(),
        width_px: ids.len() as u32,
        height_px: 1,
        intrinsics: [[1.0; 3]; 3],
        lens_model: LensModel::Pinhole,
        distortion: Vec::new(),
        exposure_s: 0.0,
        readout_s: 0.0,
        drops: 0.0,
        world_from_camera: [[0.0; 4]; 4],
        world_from_camera_rotation_wxyz: [1.0, 0.0, 0.0, 0.0],
        world_from_camera_translation_m: [0.0; 3],
        world_from_camera_previous: None,
        world_from_camera_next: None,
        world_from_ego: None,
        carrier: None,
        carrier_track_token: String::new(),
        projection: Projection { origin_lat_deg: 0.0, origin_lon_deg: 0.0, anchor_m: [0.0; 2], metres_per_rad: None },
        glass: GlassPolicy::Glass,
        exposure_ev: None,
        spp: 1,
        denoised: false,
        seed: 0,
        objects: (1..).zip(kinds).map(object).collect(),
    };
    std::fs::write(folder.join(FrameTable::NAME), table.to_json()).unwrap();
}

fn names(found: &Evaluation) -> [&str; 3] {
    [&found.classes.name, &found.predicted.map.name, &found.truth.map.name].map(String::as_str)
}

fn iou(found: &Evaluation, name: &str) -> Option<f64> {
    let class = found.classes.counted().position(|class| class.name == name).unwrap();
    found.iou[class].map(|estimate| estimate.value)
}

/// Ours: void, sky, jeep, van, traffic sign (18), sidewalk, barrier (10).
const IDS: [u8; 7] = [0, 1, 4, 6, 18, 19, 10];

#[test]
fn our_own_frames_are_judged_in_the_papers_classes_without_options() {
    let folder = tempfile::tempdir().unwrap();
    let (p, t) = (folder.path().join("p"), folder.path().join("t"));
    frame(&t.join("k/ego.A"), &IDS, &[0; 7], &[]);
    frame(&p.join("k/ego.A"), &[1, 1, 2, 2, 17, 1, 0], &[0; 7], &[]);
    let found = run(&p, &t, &WITHOUT).unwrap();
    assert_eq!(names(&found), ["paper13", "trove20", "trove20"]);
    assert_eq!(found.truth.why, "class.png beside frame.json");
    // Jeeps and vans are cars, cones are poles; void and barriers do not count. Of six pixels the sidewalk is taken for sky.
    assert_eq!((iou(&found, "car"), iou(&found, "traffic_pole")), (Some(1.0), Some(1.0)));
    assert_eq!((iou(&found, "sky"), iou(&found, "sidewalk")), (Some(0.5), Some(0.0)));
    assert_eq!(found.accuracy.unwrap().value, 4.0 / 5.0);
    // Against themselves they are right, and in their own classes jeeps are no cars.
    assert_eq!(run(&t, &t, &WITHOUT).unwrap().miou.unwrap().value, 1.0);
    let fine = run(&p, &t, &within("trove20")).unwrap();
    assert_eq!((names(&fine), iou(&fine, "jeep")), (["trove20"; 3], Some(0.0)));
}

#[test]
fn plain_predictions_of_our_own_frames_are_in_the_classes_that_are_asked_for() {
    let folder = tempfile::tempdir().unwrap();
    let (p, t) = (folder.path().join("p"), folder.path().join("t"));
    frame(&t.join("k/ego.A"), &IDS, &[0; 7], &[]);
    write(&p.join("k/ego.A.png"), greys(&[0, 12, 1, 1, 9, 7, 0]));
    let found = run(&p, &t, &WITHOUT).unwrap();
    assert_eq!((names(&found), found.miou.unwrap().value), (["paper13", "paper13", "trove20"], 1.0));
    assert!(found.predicted.why.contains("default"), "{}", found.predicted.why);
    // The same in Cityscapes' training ids, and in our own if it is said that they are.
    write(&p.join("k/ego.A.png"), greys(&[255, 10, 13, 13, 7, 1, 255]));
    let found = run(&p, &t, &within("cityscapes-train")).unwrap();
    assert_eq!((names(&found), found.miou.unwrap().value), (["cityscapes-train", "cityscapes-train", "trove20"], 1.0));
    write(&p.join("k/ego.A.png"), greys(&IDS));
    let message = run(&p, &t, &WITHOUT).unwrap_err().to_string();
    assert!(message.contains("paper13's ids") && message.contains("18 at x 4, y 0"), "{message}");
    assert!(message.contains("--predicted-classes"), "{message}");
    let ours = Numbering { map: ClassMap::named("trove20").unwrap(), why: "--predicted-classes".into() };
    let found = run(&p, &t, &Settings { predicted: Some(ours), ..WITHOUT }).unwrap();
    assert_eq!((names(&found), found.miou.unwrap().value), (["paper13", "trove20", "trove20"], 1.0));
}

#[test]
fn a_finer_map_asks_for_the_kinds_of_our_objects() {
    let folder = tempfile::tempdir().unwrap();
    let (p, t) = (folder.path().join("p"), folder.path().join("t"));
    // Signs (18) that are a signal and a lamp, one of no object, and a sign; the wheel of a lorry that is a trailer.
    let kinds = [Kind::TrafficSignal, Kind::StreetLamp, Kind::TrafficSign, Kind::Trailer];
    frame(&t.join("k/ego.A"), &[18, 18, 18, 18, 5, 9], &[1, 2, 0, 3, 4, 4], &kinds);
    write(&p.join("k/ego.A.png"), greys(&[19, 17, 20, 20, 30, 7]));
    let found = run(&p, &t, &within("cityscapes")).unwrap();
    for class in ["traffic light", "pole", "traffic sign", "road"] {
        assert_eq!(iou(&found, class), Some(1.0), "{class}");
    }
    // Trailers are not judged in Cityscapes.
    assert_eq!(found.counts.confusion.pixels(13), 0);
    assert_eq!((found.accuracy.unwrap().value, iou(&found, "truck")), (1.0, None));
}

#[test]
fn a_finer_map_asks_for_the_parts_of_our_objects() {
    let folder = tempfile::tempdir().unwrap();
    let (p, t) = (folder.path().join("p"), folder.path().join("t"));
    // A cyclist and the bicycle, and a bicycle of another's model, which tells no parts.
    let riders = [Kind::BicycleWithRider; 2];
    frame(&t.join("k/ego.A"), &[12, 12, 12, 9], &[1, 1, 2, 0], &riders);
    write(&p.join("k/ego.A.png"), greys(&[25, 33, 25, 7]));
    let right = || run(&p, &t, &within("cityscapes")).map(|found| found.accuracy.unwrap().value);
    assert_eq!(right().unwrap(), 0.75);
    write(&t.join("k/ego.A/part.png"), greys(&[Role::Cyclist.id(), Role::Ridden.id(), 0, 0]));
    assert_eq!(right().unwrap(), 1.0);
    write(&t.join("k/ego.A/part.png"), greys(&[0; 3]));
    let message = right().unwrap_err().to_string();
    assert!(message.contains("part.png") && message.contains("4 pixels, like class.png"), "{message}");
}

#[test]
fn cityscapes_files_tell_their_numbers_by_their_names() {
    let folder = tempfile::tempdir().unwrap();
    let (p, t) = (folder.path().join("p"), folder.path().join("t"));
    write(&t.join("aachen/aachen_000000_000019_gtFine_labelIds.png"), greys(&[7, 26, 12, 5]));
    write(&t.join("aachen/aachen_000000_000019_gtFine_labelTrainIds.png"), greys(&[0, 13, 3, 255]));
    write(&p.join("aachen_000000_000019_labelTrainIds.png"), greys(&[0, 13, 0, 0]));
    let found = run(&p, &t, &WITHOUT).unwrap();
    assert_eq!(names(&found), ["cityscapes", "cityscapes-train", "cityscapes"]);
    assert_eq!((iou(&found, "road"), iou(&found, "wall")), (Some(0.5), Some(0.0)));
    // In the paper's classes walls do not count.
    let found = run(&p, &t, &within("paper13")).unwrap();
    assert_eq!((iou(&found, "road"), found.accuracy.unwrap().value), (Some(1.0), 1.0));
    // Wanted in training ids, those are read.
    assert_eq!(names(&run(&p, &t, &within("cityscapes-train")).unwrap()), ["cityscapes-train"; 3]);
    // Predictions that do not tell may be anything.
    std::fs::remove_dir_all(&p).unwrap();
    write(&p.join("aachen_000000_000019.png"), greys(&[7, 26, 12, 5]));
    let message = run(&p, &t, &WITHOUT).unwrap_err().to_string();
    assert!(message.contains("(cityscapes)") && message.contains("--predicted-classes"), "{message}");
    assert_eq!(run(&p, &t, &within("cityscapes")).unwrap().miou.unwrap().value, 1.0);
}

#[test]
fn panoptic_maps_of_kitti_step_tell_their_numbers_by_their_colours() {
    let folder = tempfile::tempdir().unwrap();
    let (p, t) = (folder.path().join("p"), folder.path().join("t"));
    let map = |pixels: &[[u8; 3]]| RgbImage::from_raw(pixels.len() as u32, 1, pixels.concat()).unwrap();
    write(&t.join("0002/000000.png"), map(&[[0, 0, 0], [13, 0, 7], [14, 0, 0], [255, 0, 0]]));
    write(&p.join("0002/000000.png"), map(&[[0, 0, 0], [13, 0, 9], [14, 0, 0], [0, 0, 0]]));
    let found = run(&p, &t, &Settings { panoptic: true, ..WITHOUT }).unwrap();
    assert_eq!(names(&found), ["kitti-step"; 3]);
    // Lorries are one segment a picture: only people and cars have numbers.
    assert_eq!((found.miou.unwrap().value, found.pq.unwrap().value), (1.0, 1.0));
    assert_eq!(found.counts.panoptic.quality(14).unwrap().rq, 1.0);
    frame(&p.join("ours"), &[9, 2, 5, 0], &[0, 3, 0, 0], &[]);
    std::fs::rename(p.join("ours"), p.join("0002/000000")).unwrap();
    std::fs::remove_file(p.join("0002/000000.png")).unwrap();
    let found = run(&p, &t, &WITHOUT).unwrap();
    assert_eq!((names(&found), found.miou.unwrap().value), (["paper13", "trove20", "kitti-step"], 1.0));
}

#[test]
fn pixels_with_class_and_object_are_taken_apart() {
    let folder = tempfile::tempdir().unwrap();
    let (p, t) = (folder.path().join("p"), folder.path().join("t"));
    // Waymo: road (20), lane marker (21), two cars (2), ego vehicle (1), sky (25).
    write(&t.join("a.png"), wide(&[20_000, 21_000, 2_001, 2_001, 2_002, 1_000, 25_000]));
    write(&p.join("a.png"), wide(&[20_000, 20_000, 2_005, 2_005, 2_005, 2_005, 25_000]));
    let found = run(&p, &t, &Settings { panoptic: true, ..within("waymo") }).unwrap();
    assert_eq!((iou(&found, "road"), iou(&found, "lane marker")), (Some(0.5), Some(0.0)));
    assert_eq!((iou(&found, "car"), found.accuracy.unwrap().value), (Some(1.0), 5.0 / 6.0));
    // The prediction covers two of three pixels of the first car, the ignored ego vehicle left out.
    let car = found.counts.panoptic.quality(0).unwrap();
    assert_eq!((car.sq, car.rq), (2.0 / 3.0, 1.0 / 1.5));
    assert_eq!(run(&t, &t, &within("waymo")).unwrap().miou.unwrap().value, 1.0);
    // In the paper's classes lane markers are road, against plain predictions in those.
    let waymo = Numbering { map: ClassMap::named("waymo").unwrap(), why: "class_map.toml".into() };
    write(&p.join("a.png"), greys(&[6, 6, 1, 1, 1, 1, 12]));
    let settings = Settings { truth: Some(waymo), ..within("paper13") };
    assert_eq!(run(&p, &t, &settings).unwrap().miou.unwrap().value, 1.0);
    write(&t.join("a.png"), wide(&[65_000, 29_000, 0, 0, 0, 0, 0]));
    let message = run(&p, &t, &settings).unwrap_err().to_string();
    assert!(message.contains("65 at x 0, y 0") && message.contains("waymo's ids"), "{message}");
}

#[test]
fn sides_that_have_no_classes_in_common_are_named() {
    let folder = tempfile::tempdir().unwrap();
    let (p, t) = (folder.path().join("p"), folder.path().join("t"));
    write(&t.join("a_000000_000001_labelIds.png"), greys(&[7]));
    write(&p.join("a_000000_000001.png"), greys(&[3]));
    let message = run(&p, &t, &within("camvid")).unwrap_err().to_string();
    assert!(message.contains("judged in camvid, found cityscapes (named …_labelIds.png)"), "{message}");
    assert!(message.contains("paper13"), "{message}");
}
