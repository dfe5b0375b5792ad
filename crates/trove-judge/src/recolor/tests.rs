use super::*;

fn settings(method: Method, strength: f32) -> Settings {
    Settings { method, space: Space::Lab, strength, target_labels: None }
}

/// A picture of gentle colours around a grey.
fn picture(path: &Path, middle: [u8; 3], contrast: f32) {
    let image = RgbImage::from_fn(64, 48, |x, y| {
        let wave = ((x as f32 * 0.4).sin() + (y as f32 * 0.3).cos()) * contrast;
        image::Rgb(middle.map(|m| (f32::from(m) + wave).clamp(0.0, 255.0) as u8))
    });
    std::fs::create_dir_all(path.parent().unwrap()).unwrap();
    image.save(path).unwrap();
}

#[test]
fn statistics_go_as_far_towards_the_target_as_was_asked() {
    let folder = tempfile::tempdir().unwrap();
    let (s, t, out) = (folder.path().join("s"), folder.path().join("t"), folder.path().join("o"));
    picture(&s.join("a/rgb.png"), [110, 100, 90], 18.0);
    picture(&s.join("b/rgb.png"), [90, 100, 120], 10.0);
    picture(&t.join("x.png"), [140, 130, 120], 25.0);
    picture(&t.join("y.png"), [150, 130, 110], 20.0);
    for (method, strength) in [(Method::PerSet, 1.0f32), (Method::PerSet, 0.5), (Method::PerPicture, 1.0)] {
        let done = recolor(&s, &t, &out, &settings(method, strength)).unwrap();
        assert_eq!(done.pictures[0].0, out.join("a/rgb.png"));
        let [before, target, after] = done.statistics;
        for c in 0..3 {
            let wanted = before.mean()[c] + f64::from(strength) * (target.mean()[c] - before.mean()[c]);
            assert!((after.mean()[c] - wanted).abs() < 1e-3, "{method:?} {strength}");
        }
        // What was written holds it too, up to the rounding of 8-bit codes.
        let written = set_statistics(&photographs(&out).unwrap(), Space::Lab).unwrap();
        assert!((written.mean()[0] - after.mean()[0]).abs() < 0.1);
    }
}

#[test]
fn a_set_that_is_its_own_target_stays_as_it_was() {
    let folder = tempfile::tempdir().unwrap();
    let (s, out) = (folder.path().join("s"), folder.path().join("o"));
    picture(&s.join("rgb.png"), [110, 100, 90], 18.0);
    recolor(&s, &s, &out, &settings(Method::PerSet, 1.0)).unwrap();
    let [a, b] = [&s, &out].map(|f| image::open(f.join("rgb.png")).unwrap().into_rgb8());
    assert!(a.iter().zip(b.iter()).all(|(a, b)| a.abs_diff(*b) <= 1));
}

#[test]
fn classes_take_the_colours_of_their_own_class() {
    let folder = tempfile::tempdir().unwrap();
    let (s, t, out) = (folder.path().join("s"), folder.path().join("t"), folder.path().join("o"));
    picture(&s.join("rgb.png"), [80, 80, 80], 10.0);
    picture(&t.join("pictures/x.png"), [150, 150, 150], 10.0);
    let half = image::GrayImage::from_fn(64, 48, |x, _| image::Luma([if x < 32 { 9 } else { 1 }]));
    half.save(s.join("class.png")).unwrap();
    std::fs::create_dir_all(t.join("labels")).unwrap();
    // All of the target is road: the sky has nothing to be matched with.
    image::GrayImage::from_pixel(64, 48, image::Luma([9])).save(t.join("labels/x.png")).unwrap();
    let histograms = Settings { target_labels: Some(t.join("labels")), ..settings(Method::HistogramPerClass, 1.0) };
    recolor(&s, &t.join("pictures"), &out, &histograms).unwrap();
    let mean = |x: std::ops::Range<u32>| {
        let picture = image::open(out.join("rgb.png")).unwrap().into_luma8();
        x.clone().map(|x| f64::from(picture.get_pixel(x, 20).0[0])).sum::<f64>() / x.len() as f64
    };
    assert!(
        (mean(0..32) - 150.0).abs() < 15.0 && (mean(32..64) - 80.0).abs() < 15.0,
        "{} {}",
        mean(0..32),
        mean(32..64)
    );
    let without = recolor(&s, &t.join("pictures"), &out, &settings(Method::HistogramPerClass, 1.0));
    assert!(without.unwrap_err().to_string().contains("labels"));
}
