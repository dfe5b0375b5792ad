use image::GrayImage;

use super::*;

fn settings(set: &str) -> Settings {
    Settings { set: LabelSet::named(set).unwrap(), boundary: true, panoptic: false, seed: Seed(1) }
}

fn write(folder: &Path, name: &str, ids: &[u8], width: u32) {
    let path = folder.join(name);
    std::fs::create_dir_all(path.parent().unwrap()).unwrap();
    GrayImage::from_raw(width, ids.len() as u32 / width, ids.to_vec()).unwrap().save(path).unwrap();
}

#[test]
fn folders_are_compared_file_by_file_whatever_cityscapes_calls_them() {
    let folder = tempfile::tempdir().unwrap();
    let (p, t) = (folder.path().join("p"), folder.path().join("t"));
    write(&t, "aachen/aachen_000000_000019_gtFine_labelIds.png", &[7, 7, 8, 8], 2);
    write(&p, "aachen_000000_000019_leftImg8bit.png", &[7, 7, 7, 8], 2);
    write(&t, "ulm/ulm_000001_000019_gtFine_labelIds.png", &[0, 0, 23, 23], 2);
    write(&p, "ulm_000001_000019_leftImg8bit.png", &[23, 23, 23, 23], 2);
    let found = evaluate(&p, &t, &settings("cityscapes")).unwrap();
    let of = |name: &str| {
        let class = found.set.classes.iter().position(|c| c.name == name).unwrap();
        found.iou[class].map(|e| e.value)
    };
    assert_eq!((of("road"), of("sidewalk"), of("sky"), of("car")), (Some(2.0 / 3.0), Some(0.5), Some(1.0), None));
    assert_eq!(found.accuracy.unwrap().value, 5.0 / 6.0);
    let miou = found.miou.unwrap();
    assert!(miou.interval[0] <= miou.value && miou.value <= miou.interval[1], "{miou:?}");
    assert_eq!(found.pictures, 2);
}

#[test]
fn what_does_not_fit_together_is_named() {
    let folder = tempfile::tempdir().unwrap();
    let (p, t) = (folder.path().join("p"), folder.path().join("t"));
    write(&t, "a/class.png", &[1, 1], 2);
    write(&p, "b/class.png", &[1, 1], 2);
    let message = |e: Result<Evaluation, JudgeError>| e.unwrap_err().to_string();
    let missing = message(evaluate(&p, &t, &settings("trove13")));
    assert!(missing.contains("a prediction of a/class"), "{missing}");
    write(&p, "a/class.png", &[1, 1, 1], 3);
    let size = message(evaluate(&p, &t, &settings("trove13")));
    assert!(size.contains("2×1") && size.contains("3×1"), "{size}");
    image::RgbImage::new(2, 1).save(p.join("a/class.png")).unwrap();
    let colour = message(evaluate(&p, &t, &settings("trove13")));
    assert!(colour.contains("class id a pixel"), "{colour}");
    std::fs::write(p.join("a/class.png"), b"not a picture").unwrap();
    assert!(evaluate(&p, &t, &settings("trove13")).is_err());
    assert!(evaluate(&p, &folder.path().join("none"), &settings("trove13")).is_err());
}

#[test]
fn objects_beside_the_classes_give_panoptic_quality() {
    let folder = tempfile::tempdir().unwrap();
    let (p, t) = (folder.path().join("p"), folder.path().join("t"));
    for (side, objects) in [(&p, [1u16, 1, 2, 0]), (&t, [5, 5, 6, 0])] {
        write(side, "k/class.png", &[2, 2, 2, 9], 4);
        let numbers = image::ImageBuffer::<image::Luma<u16>, _>::from_raw(4, 1, objects.to_vec()).unwrap();
        DynamicImage::ImageLuma16(numbers).save(side.join("k/instance.png")).unwrap();
    }
    let found = evaluate(&p, &t, &Settings { panoptic: true, ..settings("trove20") }).unwrap();
    assert_eq!(found.panoptic.unwrap().mean(), Some(1.0));
}
