use super::*;
use image::GrayImage;
use trove_format::{FrameTable, GlassPolicy, LensModel, ObjectOrigin, ObjectRow, Projection};
use trove_model::{Class, ClassMap, Kind};

fn classes() -> [Option<u8>; 20] {
    ClassMap::named("trove20").unwrap().train_ids_of_ours()
}

/// A frame 60 m further on than the last, with a car in sight and a person behind something.
fn frame(i: u32) -> FrameTable {
    let object = |id, class: Class, kind, visible_px, range_m| ObjectRow {
        id,
        class,
        class_id: class.id(),
        kind,
        origin: ObjectOrigin::Recorded,
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
        visible_px,
        amodal_px: 300,
        visible_box: None,
        amodal_box: None,
        truncation: 0.0,
        occlusion: 0.0,
        range_m,
        keypoints: None,
        keypoints_world_m: None,
    };
    FrameTable {
        scene: "scene".into(),
        dataset: "made".into(),
        place: "town".into(),
        variation: 0,
        keyframe: i,
        keyframe_token: String::new(),
        keyframe_time_ns: 0,
        recorded_keyframe: Some(0),
        view: "ego.CAM_FRONT".into(),
        time_ns: 0,
        source_token: String::new(),
        source_image: String::new(),
        width_px: 72,
        height_px: 40,
        intrinsics: [[0.0; 3]; 3],
        lens_model: LensModel::Pinhole,
        distortion: vec![],
        exposure_s: 0.0,
        readout_s: 0.0,
        drops: 0.0,
        world_from_camera: [[0.0; 4]; 4],
        world_from_camera_rotation_wxyz: [1.0, 0.0, 0.0, 0.0],
        world_from_camera_translation_m: [60.0 * f64::from(i), 0.0, 1.5],
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
        objects: vec![object(2, Class::Car, Kind::Car, 300, 15.5), object(3, Class::Human, Kind::Adult, 0, 5.0)],
    }
}

/// A dataset of frames along a street, some of them poor, two alike.
fn dataset(root: &Path) {
    for i in 0..12u32 {
        let folder = root.join(format!("scene/v00/k{i:03}/ego.CAM_FRONT"));
        std::fs::create_dir_all(&folder).unwrap();
        let bands = if i == 3 { 1 } else { 8 };
        let shift = if i == 7 { 6 } else { i * u32::from(i != 3) };
        let labels =
            GrayImage::from_fn(72, 40, |x, y| image::Luma([1 + ((x * bands / 72 + y * shift / 20) % 19) as u8]));
        labels.save(folder.join("class.png")).unwrap();
        std::fs::write(folder.join(FrameTable::NAME), frame(i).to_json()).unwrap();
    }
}

#[test]
fn labels_alone_are_enough_to_choose_and_to_report() {
    let folder = tempfile::tempdir().unwrap();
    dataset(folder.path());
    let rules = Rules { count: 20, classes: classes(), weights: [1.0; 20], min_classes: 6, duplicate_bits: 0 };
    let found = curate(folder.path(), rules, 0.3, Seed(1), &|_, _| true).unwrap();
    assert_eq!((found.frames.len(), found.selection.poor, found.selection.duplicates), (12, 1, 1));
    assert_eq!(found.selection.kept.len(), 10);
    assert_eq!(found.frames[0].objects.len(), 1);
    assert!(found.splits.contains(&Split::Val) && found.splits.contains(&Split::Train));
    let page = report(folder.path(), &found).unwrap();
    assert_eq!(page.matches("<figure>").count(), 10);
    assert!(page.contains("car") && !page.contains("http"), "it needs nothing from elsewhere");
}

#[test]
fn what_is_no_dataset_is_named() {
    let folder = tempfile::tempdir().unwrap();
    let rules = Rules { count: 1, classes: classes(), weights: [1.0; 20], min_classes: 1, duplicate_bits: 0 };
    let message = |root: &Path| curate(root, rules, 0.0, Seed(1), &|_, _| true).unwrap_err().to_string();
    assert!(message(folder.path()).contains("frames of trove generate"));
    dataset(folder.path());
    let frame = folder.path().join("scene/v00/k000/ego.CAM_FRONT/frame.json");
    std::fs::write(&frame, "{\n\"scene\":7").unwrap();
    assert!(message(folder.path()).contains("frame.json:2:"), "{}", message(folder.path()));
    std::fs::write(folder.path().join(Manifest::NAME), r#"{"format": 1, "frames": []}"#).unwrap();
    let found = message(folder.path());
    assert!(found.contains("manifest.json: expected format 2, found format 1"), "{found}");
}
