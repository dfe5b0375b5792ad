use std::fs::File;
use std::time::{Duration, SystemTime};

use trove_model::Seed;

use super::*;

fn settings(method: Method, strength: f32) -> Settings {
    Settings { method, space: Space::Lab, strength, detail: false, target_labels: None }
}

fn run(source: &Path, target: &Path, out: &Path, settings: &Settings) -> Result<Recoloring, JudgeError> {
    recolor(source, target, out, settings, &|_, _| true)
}

/// Measures of what lies in a folder.
fn measures_below(folder: &Path, space: Space) -> Measures {
    Measures::joined(measured(&photographs(folder).unwrap(), space, &|_, _| true).unwrap().iter())
}

fn save(path: &Path, image: &RgbImage) {
    std::fs::create_dir_all(path.parent().unwrap()).unwrap();
    image.save(path).unwrap();
}

/// A picture whose three channels in a space are independent Gaussians, up to 8-bit codes.
fn gaussian(path: &Path, space: Space, mean: [f32; 3], deviation: [f32; 3], seed: u64) {
    let mut random = Seed(seed).random();
    let mut normal = || (-2.0 * (1.0 - random.unit()).ln()).sqrt() * (std::f64::consts::TAU * random.unit()).cos();
    let image = RgbImage::from_fn(120, 90, |_, _| {
        image::Rgb(space.to_srgb(std::array::from_fn(|c| mean[c] + deviation[c] * normal() as f32)))
    });
    save(path, &image);
}

#[test]
fn pairs_are_as_different_as_the_targets_pictures() {
    let folder = tempfile::tempdir().unwrap();
    let [s, t] = ["s", "t"].map(|name| folder.path().join(name));
    for i in 0..8u64 {
        gaussian(&s.join(format!("{i}/rgb.png")), Space::Lab, [50.0, 0.0, 0.0], [8.0, 2.0, 2.0], i);
    }
    for (i, lightness) in [30.0, 70.0].into_iter().enumerate() {
        gaussian(&t.join(format!("{i}.png")), Space::Lab, [lightness, 0.0, 0.0], [6.0, 2.0, 2.0], 20 + i as u64);
    }
    let out = folder.path().join("out");
    let done = run(&s, &t, &out, &settings(Method::Paired, 1.0)).unwrap();
    let lightness = |path: &PathBuf| measures_below(path.parent().unwrap(), Space::Lab).colors.mean()[0];
    let mut found: Vec<f64> = done.pictures.iter().map(|(after, _)| lightness(after)).collect();
    found.sort_by(f64::total_cmp);
    assert!(found.iter().all(|l| (l - 30.0).abs() < 0.5 || (l - 70.0).abs() < 0.5), "{found:?}");
    assert!(found[0] < 40.0 && found[7] > 60.0, "{found:?}");
}

#[test]
fn a_gaussian_becomes_the_gaussian_of_the_target_up_to_rounding() {
    let lab = (Space::Lab, [[45.0, 4.0, -6.0], [62.0, -3.0, 8.0]], [[6.0, 2.5, 2.0], [9.0, 3.0, 4.0]], 0.06);
    let opponent =
        (Space::LAlphaBeta, [[-1.5, 0.05, 0.0], [-0.9, -0.03, 0.01]], [[0.2, 0.03, 0.01], [0.14, 0.05, 0.015]], 2e-3);
    for (space, means, deviations, off) in [lab, opponent] {
        let folder = tempfile::tempdir().unwrap();
        let [s, t] = ["s", "t"].map(|name| folder.path().join(name));
        for i in 0..3u64 {
            gaussian(&s.join(format!("{i}/rgb.png")), space, means[0], deviations[0], 2 * i);
            gaussian(&t.join(format!("{i}.png")), space, means[1], deviations[1], 2 * i + 1);
        }
        for (method, strength) in [(Method::PerSet, 1.0), (Method::PerSet, 0.5), (Method::PerPicture, 1.0)] {
            let out = folder.path().join(format!("{method:?}{strength}"));
            let asked = Settings { space, ..settings(method, strength) };
            let measures = run(&s, &t, &out, &asked).unwrap().measures;
            assert_eq!(measures[2], measures_below(&out, space), "told is what was written");
            let [before, target, after] = measures.map(|measures| measures.colors);
            for c in 0..3 {
                let blend = |a: f64, b: f64| a + f64::from(strength) * (b - a);
                let mean = blend(before.mean()[c], target.mean()[c]);
                let deviation = blend(before.deviation()[c], target.deviation()[c]);
                assert!((after.mean()[c] - mean).abs() < off, "{space:?} {method:?} {strength} {c}");
                assert!(
                    (after.deviation()[c] - deviation).abs() < off,
                    "{space:?} {method:?} {strength} {c}: {} {deviation}",
                    after.deviation()[c]
                );
            }
        }
    }
}

/// Noise of so much contrast that is smoothed so many times, so that its fine detail is gone.
fn noise(path: &Path, contrast: f32, smoothings: usize, seed: u64) {
    let mut random = Seed(seed).random();
    let mut image =
        RgbImage::from_fn(160, 120, |_, _| image::Rgb([(128.0 + contrast * (random.unit() as f32 - 0.5)) as u8; 3]));
    for _ in 0..smoothings {
        image = image::imageops::blur(&image, 0.6);
    }
    save(path, &image);
}

#[test]
fn detail_becomes_as_sharp_as_the_targets_by_every_method_and_colors_as_without() {
    let folder = tempfile::tempdir().unwrap();
    let [s, t] = ["s", "t"].map(|name| folder.path().join(name));
    for i in 0..4u64 {
        noise(&s.join(format!("{i}/rgb.png")), 100.0, 1, i);
        // The target's have another contrast; half of them are sharper, the others softer.
        noise(&t.join(format!("{i}.png")), 150.0, i as usize % 2 * 2, 10 + i);
    }
    for method in [Method::PerSet, Method::PerPicture, Method::Paired] {
        let [plain, sharp] = [false, true].map(|detail| {
            let out = folder.path().join(format!("{method:?}{detail}"));
            run(&s, &t, &out, &Settings { detail, ..settings(method, 1.0) }).unwrap()
        });
        let finest = |measures: &Measures| measures.detail.sharpness().unwrap()[0];
        let [before, target, after] = sharp.measures.map(|measures| finest(&measures));
        assert!(
            (before / target - 1.0).abs() > 0.3 && (finest(&plain.measures[2]) / before - 1.0).abs() < 0.05,
            "{method:?}"
        );
        let colors = [&plain, &sharp].map(|done| done.measures[2].colors.mean()[0]);
        assert!((colors[0] - colors[1]).abs() < 0.3, "{method:?}: {colors:?}");
        if method != Method::Paired {
            assert!((after / target - 1.0).abs() < 0.12, "{method:?}: {before} {target} {after}");
            continue;
        }
        // Each is as sharp as the one that it is drawn towards.
        for (path, from) in &sharp.pictures {
            let towards = t.join(format!("{}.png", drawn(from.strip_prefix(&s).unwrap(), 4)));
            let of = |path: &Path| finest(&measures(&read(path).unwrap().into_rgb8(), Space::Lab));
            assert!((of(path) / of(&towards) - 1.0).abs() < 0.12, "{}: {} {}", path.display(), of(path), of(&towards));
        }
    }
}

#[test]
fn a_second_run_keeps_what_stands_and_another_target_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let [s, t, out] = ["s", "t", "o"].map(|name| folder.path().join(name));
    for name in ["a", "b", "c"] {
        picture(&s.join(name).join("rgb.png"), [110, 100, 90], 18.0);
    }
    picture(&t.join("x.png"), [140, 130, 120], 25.0);
    let asked = settings(Method::PerPicture, 1.0);
    // A run that fails at the last picture leaves the others, and they stay.
    let whole = std::fs::read(s.join("c/rgb.png")).unwrap();
    std::fs::write(s.join("c/rgb.png"), b"torn").unwrap();
    assert!(run(&s, &t, &out, &asked).unwrap_err().to_string().contains("c/rgb.png"));
    std::fs::write(s.join("c/rgb.png"), whole).unwrap();
    let there = photographs(&out).unwrap().len();
    let done = run(&s, &t, &out, &asked).unwrap();
    assert_eq!((done.kept, done.pictures.len()), (there, 3));
    assert_eq!(done.pictures[0], (out.join("a/rgb.png"), s.join("a/rgb.png")));
    let bytes = || ["a", "b", "c"].map(|name| std::fs::read(out.join(name).join("rgb.png")).unwrap());
    let first = bytes();
    let again = run(&s, &t, &out, &asked).unwrap();
    assert_eq!((again.kept, again.measures, bytes()), (3, done.measures, first));
    // A source that was made anew is recoloured anew.
    let later = SystemTime::now() + Duration::from_secs(60);
    File::options().append(true).open(s.join("b/rgb.png")).unwrap().set_modified(later).unwrap();
    assert_eq!(run(&s, &t, &out, &asked).unwrap().kept, 2);
    let stronger = run(&s, &t, &out, &settings(Method::PerPicture, 0.5)).unwrap_err().to_string();
    assert!(stronger.contains("strength") && stronger.contains("another --out"), "{stronger}");
    let sharper = run(&s, &t, &out, &Settings { detail: true, ..asked.clone() }).unwrap_err().to_string();
    assert!(sharper.contains("detail") && sharper.contains("another --out"), "{sharper}");
    assert!(run(&s, &t, &s.join("within"), &asked).unwrap_err().to_string().contains("outside"));
    assert!(run(&s, &t, &t, &asked).unwrap_err().to_string().contains("outside"));
    let foreign = folder.path().join("f");
    picture(&foreign.join("mine.png"), [1; 3], 0.0);
    assert!(run(&s, &t, &foreign, &asked).unwrap_err().to_string().contains("other files"));
}

/// A picture of gentle colours around a grey.
fn picture(path: &Path, middle: [u8; 3], contrast: f32) {
    let image = RgbImage::from_fn(64, 48, |x, y| {
        let wave = ((x as f32 * 0.4).sin() + (y as f32 * 0.3).cos()) * contrast;
        image::Rgb(middle.map(|m| (f32::from(m) + wave).clamp(0.0, 255.0) as u8))
    });
    save(path, &image);
}

#[test]
fn a_set_that_is_its_own_target_stays_as_it_was() {
    let folder = tempfile::tempdir().unwrap();
    let (s, out) = (folder.path().join("s"), folder.path().join("o"));
    picture(&s.join("rgb.png"), [110, 100, 90], 18.0);
    run(&s, &s, &out, &settings(Method::PerSet, 1.0)).unwrap();
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
    // All of the target is CamVid's road: the sky has nothing to be matched with.
    image::GrayImage::from_pixel(64, 48, image::Luma([3])).save(t.join("labels/x.png")).unwrap();
    let labels = Some((t.join("labels"), ClassMap::named("camvid").unwrap()));
    let histograms = Settings { target_labels: labels, ..settings(Method::HistogramPerClass, 1.0) };
    run(&s, &t.join("pictures"), &out, &histograms).unwrap();
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
    let small = t.join("labels/x.png");
    image::GrayImage::new(32, 48).save(&small).unwrap();
    let message = run(&s, &t.join("pictures"), &out, &histograms).unwrap_err().to_string();
    assert!(message.contains("64×48") && message.contains("32×48"), "{message}");
    let without = run(&s, &t.join("pictures"), &out, &settings(Method::HistogramPerClass, 1.0));
    assert!(without.unwrap_err().to_string().contains("labels"));
}
