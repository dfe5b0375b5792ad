use image::{DynamicImage, GrayImage};

use super::*;

fn settings(set: &str) -> Settings {
    let classes = Some(ClassMap::named(set).unwrap());
    Settings { classes, predicted: None, truth: None, boundary: true, panoptic: false, seed: Seed(1) }
}

fn run(predicted: &Path, truth: &Path, settings: &Settings) -> Result<Evaluation, JudgeError> {
    evaluate(predicted, truth, settings, &|_, _| true)
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
    write(&t, "aachen/aachen_000000_000019_gtFine_color.png", &[1; 4], 2);
    write(&p, "aachen_000000_000019_leftImg8bit.png", &[7, 7, 7, 8], 2);
    write(&t, "ulm/ulm_000001_000019_gtFine_labelIds.png", &[0, 0, 23, 23], 2);
    write(&p, "ulm_000001_000019_leftImg8bit.png", &[23, 23, 23, 23], 2);
    write(&p, "bonn_000001_000019_leftImg8bit.png", &[23], 1);
    let found = run(&p, &t, &settings("cityscapes")).unwrap();
    let of = |name: &str| {
        let class = found.classes.counted().position(|c| c.name == name).unwrap();
        found.iou[class].map(|e| e.value)
    };
    assert_eq!((of("road"), of("sidewalk"), of("sky"), of("car")), (Some(2.0 / 3.0), Some(0.5), Some(1.0), None));
    assert_eq!(found.accuracy.unwrap().value, 5.0 / 6.0);
    let miou = found.miou.unwrap();
    assert!(miou.interval[0] <= miou.value && miou.value <= miou.interval[1], "{miou:?}");
    assert_eq!((found.pictures, found.unused), (2, 1));
}

#[test]
fn an_interval_is_the_bootstrap_s() {
    let folder = tempfile::tempdir().unwrap();
    let (p, t) = (folder.path().join("p"), folder.path().join("t"));
    // Of 50 pictures of one pixel 40 are right: the share is binomial, with a deviation of √(0.8·0.2/50) = 0.0566.
    for i in 0..50u8 {
        write(&t, &format!("{i}.png"), &[1], 1);
        write(&p, &format!("{i}.png"), &[if i < 40 { 1 } else { 2 }], 1);
    }
    let found = run(&p, &t, &settings("trove13")).unwrap();
    let Estimate { value, interval: [low, high] } = found.accuracy.unwrap();
    assert_eq!(value, 0.8);
    assert!((low - 0.68).abs() <= 0.02 && (high - 0.9).abs() <= 0.02, "{low} {high}");
    assert_eq!(run(&p, &t, &settings("trove13")).unwrap().accuracy, found.accuracy);
}

#[test]
fn what_does_not_fit_together_is_named() {
    let folder = tempfile::tempdir().unwrap();
    let (p, t) = (folder.path().join("p"), folder.path().join("t"));
    let message = || run(&p, &t, &settings("trove13")).unwrap_err().to_string();
    let check = |found: String, parts: &[&str]| {
        assert!(parts.iter().all(|part| found.contains(part)), "{parts:?} in {found}");
    };
    write(&t, "a/class.png", &[1, 1], 2);
    write(&p, "b/class.png", &[1, 1], 2);
    check(message(), &["a prediction of", "a/class.png", "none of that name"]);
    write(&p, "a/class.png", &[1, 1, 1], 3);
    check(message(), &["2×1", "3×1", "nearest"]);
    image::RgbImage::from_pixel(2, 1, image::Rgb([70, 130, 180])).save(p.join("a/class.png")).unwrap();
    check(message(), &["class id per pixel", "instead of colours"]);
    write(&p, "a/class.png", &[1, 17], 2);
    check(message(), &["paper13's ids", "17 at x 1, y 0", "--classes"]);
    std::fs::write(p.join("a/class.png"), b"not a picture").unwrap();
    check(message(), &["a/class.png", "write the file again"]);
    write(&t, "x_000000_000001_a.png", &[1], 1);
    std::fs::remove_dir_all(t.join("a")).unwrap();
    write(&t, "x_000000_000001_b.png", &[1], 1);
    check(message(), &["one image of x_000000_000001", "remove one"]);
    std::fs::remove_dir_all(&t).unwrap();
    check(message(), &["check its name"]);
    std::fs::create_dir(&t).unwrap();
    check(message(), &["label images", "none"]);
    std::fs::remove_dir(&t).unwrap();
    std::fs::write(&t, b"").unwrap();
    check(message(), &["two files or two folders"]);
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
    let panoptic = Settings { panoptic: true, ..settings("trove20") };
    let found = run(&p, &t, &panoptic).unwrap();
    assert_eq!(found.pq.unwrap().value, 1.0);
    assert_eq!(run(&p, &t, &settings("trove20")).unwrap().pq, None);
    std::fs::remove_file(p.join("k/instance.png")).unwrap();
    let message = run(&p, &t, &panoptic).unwrap_err().to_string();
    assert!(message.contains("instance.png") && message.contains("omit --panoptic"), "{message}");
}

#[test]
fn a_panoptic_map_of_kitti_step_has_classes_and_objects() {
    let folder = tempfile::tempdir().unwrap();
    let (p, t) = (folder.path().join("p"), folder.path().join("t"));
    let map = |side: &Path, pixels: &[[u8; 3]]| {
        let path = side.join("0002/000000.png");
        std::fs::create_dir_all(path.parent().unwrap()).unwrap();
        image::RgbImage::from_raw(4, 2, pixels.concat()).unwrap().save(path).unwrap();
    };
    // Road, two cars whose numbers differ in the high byte only, a car of a crowd, void.
    let (road, first, second, crowd, void) = ([0, 0, 0], [13, 0, 7], [13, 1, 7], [13, 0, 0], [255, 0, 0]);
    map(&t, &[road, road, first, first, second, second, crowd, void]);
    map(&p, &[road, road, second, second, first, first, first, road]);
    let panoptic = Settings { panoptic: true, ..settings("cityscapes-train") };
    let found = run(&p, &t, &panoptic).unwrap();
    let car = found.classes.counted().position(|class| class.name == "car").unwrap();
    let quality = found.counts.panoptic.quality(car).unwrap();
    // The second true car and the one that covers the crowd too share two of three pixels.
    assert_eq!((quality.rq, quality.sq), (1.0, (1.0 + 2.0 / 3.0) / 2.0));
    assert_eq!((found.accuracy.unwrap().value, found.iou[car].unwrap().value), (1.0, 1.0));
    // The same in Cityscapes' own numbers; nobody says what they are in CamVid's.
    assert_eq!(run(&p, &t, &settings("cityscapes")).unwrap().iou[car].unwrap().value, 1.0);
    assert!(run(&p, &t, &settings("camvid")).unwrap_err().to_string().contains("judged in camvid, found kitti-step"));
}
