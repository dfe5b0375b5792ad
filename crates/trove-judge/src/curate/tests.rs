use super::*;
use crate::LabelSet;
use image::GrayImage;

fn classes() -> [Option<u8>; 20] {
    LabelSet::named("trove20").unwrap().of_ours()
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
        let frame = format!(
            r#"{{"scene":"scene","place":"town","world_from_camera_translation_m":[{},0,1.5],"projection":{{"anchor_m":[0,0]}},
            "objects":[{{"id":2,"class_id":2,"visible_px":300,"distance_m":15.5}},{{"id":3,"class_id":7,"visible_px":0,"distance_m":5}}]}}"#,
            i * 60
        );
        std::fs::write(folder.join("frame.json"), frame).unwrap();
    }
}

#[test]
fn labels_alone_are_enough_to_choose_and_to_report() {
    let folder = tempfile::tempdir().unwrap();
    dataset(folder.path());
    let rules = Rules { count: 20, classes: classes(), min_classes: 6, duplicate_bits: 0 };
    let found = curate(folder.path(), rules, 0.3, Seed(1), &|_, _| ()).unwrap();
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
    let rules = Rules { count: 1, classes: classes(), min_classes: 1, duplicate_bits: 0 };
    let message = |root: &Path| curate(root, rules, 0.0, Seed(1), &|_, _| ()).unwrap_err().to_string();
    assert!(message(folder.path()).contains("frames of trove generate"));
    dataset(folder.path());
    let frame = folder.path().join("scene/v00/k000/ego.CAM_FRONT/frame.json");
    std::fs::write(&frame, "{").unwrap();
    assert!(message(folder.path()).contains("frame.json"));
}
