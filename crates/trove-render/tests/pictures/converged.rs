//! Small sets against converged pictures of them.
//!
//! The references lie in `references` and are written anew, after a change that is meant to change pictures, by
//! `TROVE_WRITE_REFERENCES=1 cargo test --release -p trove-render --test pictures -- --ignored the_references`.

use std::path::PathBuf;
use std::sync::LazyLock;

use trove_model::{Raster, Scene, Seed, Shot};
use trove_render::{KernelChoice, Renderer};

use crate::sets::{self, Set};
use crate::studio::{Picture, emulated, kernels, renderer, take};

/// Samples of the pictures that are judged.
const SPP: u32 = 64;
/// Pictures that a reference is the mean of, and their samples.
const PICTURES: u64 = 128;
const SPP_OF_LAMPS: u32 = 256;

/// What a set converges to.
struct Reference {
    mean: Picture,
    /// Variance of that mean.
    error: Picture,
    /// Variance of a picture of [`SPP`] samples.
    noise: Picture,
}

/// Pictures of every set with every kernel and by what a card runs, which differ in their seeds.
static TAKEN: LazyLock<Vec<(String, &'static str, Vec<Picture>)>> = LazyLock::new(|| {
    let mut taken = Vec::new();
    let by_kernel = kernels().map(|kernel| (format!("{kernel:?}"), renderer(kernel, 2)));
    for (by, renderer) in by_kernel.chain([("emulated".into(), emulated())]) {
        for Set { name, scene, shot } in sets::all() {
            let shots = (0..8).map(|seed| Shot { spp: SPP, seed: Seed(seed), ..shot.clone() });
            taken.push((by.clone(), name, shots.map(|shot| take(&renderer, &scene, &shot)).collect()));
        }
    }
    taken
});

#[test]
fn pictures_differ_from_converged_ones_by_their_noise() {
    let (mut far, mut all) = (0, 0);
    for (by, name, pictures) in &*TAKEN {
        let reference = Reference::read(name);
        let [mean, error, noise] =
            [&reference.mean, &reference.error, &reference.noise].map(|image| image.data.as_flattened());
        let n = pictures.len() as f32;
        let z: Vec<f64> = (0..mean.len())
            .map(|i| {
                let value = pictures.iter().map(|picture| picture.data.as_flattened()[i]).sum::<f32>() / n;
                // Beyond this rounding counts.
                let variance = (error[i] + noise[i] / n).max((1e-4 * mean[i]).powi(2));
                f64::from((value - mean[i]) / variance.sqrt())
            })
            .collect();
        let n = z.len() as f64;
        let (bias, squares) = (z.iter().sum::<f64>() / n, z.iter().map(|z| z * z).sum::<f64>() / n);
        (far, all) = (far + z.iter().filter(|z| z.abs() > 3.0).count(), all + z.len());
        assert!(bias.abs() < 0.3, "{by}, {name}: mean z = {bias}");
        assert!((0.6..1.4).contains(&squares), "{by}, {name}: mean z² = {squares}");
    }
    assert!(far * 100 < all, "{far} of {all} values are off by more than 3 σ");
}

#[test]
fn no_pixel_is_a_firefly() {
    for (by, name, pictures) in &*TAKEN {
        let mean = Reference::read(name).mean;
        for picture in pictures {
            for (i, (value, mean)) in picture.data.iter().zip(&mean.data).enumerate() {
                let [value, mean] = [value, mean].map(|rgb| rgb.iter().sum::<f32>());
                assert!(value < 20.0 * mean, "{by}, {name}: pixel {i} is {value} instead of {mean}");
            }
        }
    }
}

#[test]
fn asking_for_less_noise_gives_what_was_asked_for_and_leaves_the_sky_alone() {
    let Set { scene, shot, name } = sets::sun_and_shadow();
    let shot = Shot { noise: 0.04, spp: 4096, ..shot };
    let [one, two] = [1, 2].map(|threads| take(&renderer(KernelChoice::Obvhs, threads), &scene, &shot));
    assert!(one == two);
    let reference = Reference::read(name).mean;
    let brightness = |rgb: &[f32; 3]| rgb.iter().sum::<f32>() / 3.0;
    let pairs = || one.data.iter().map(brightness).zip(reference.data.iter().map(brightness));
    let error = pairs().map(|(a, b)| (a - b).abs()).sum::<f32>() / pairs().map(|(_, b)| b).sum::<f32>();
    // Stratified samples are up to twice as good as what two halves of them tell.
    assert!((0.02..0.05).contains(&error), "{error} instead of 0.04");

    let renderer = renderer(KernelChoice::Obvhs, 2);
    let prepared = renderer.prepare(&scene).unwrap();
    let samples = |shot: &Shot| renderer.render(&prepared, shot, true, &|_| false).unwrap().stats.spp;
    let shot = Shot { noise: 0.02, ..shot };
    let mut up = shot.clone();
    up.world_from_camera = crate::studio::shot(glam::DVec3::Z, glam::DVec3::Z * 2.0, 0.3).world_from_camera;
    let (of_the_sky, of_all) = (samples(&up), samples(&shot));
    assert!(of_the_sky < 10.0 && of_all > 2.0 * of_the_sky && of_all < 1000.0, "{of_the_sky}, {of_all}");
}

/// Lamps are found by chance alone here, which is slow and as plain as can be.
#[test]
#[ignore = "writes the references, which takes minutes"]
fn the_references_are_written() {
    // Whoever runs all ignored tests does not mean this one.
    assert!(std::env::var_os("TROVE_WRITE_REFERENCES").is_some(), "set TROVE_WRITE_REFERENCES to write them anew");
    for Set { name, scene, shot } in sets::all() {
        let renderer = renderer(KernelChoice::Auto, 0);
        let (mean, noise) = statistics(&renderer, &scene, &Shot { spp: SPP, ..shot.clone() });
        let has_lamps = scene.materials.iter().any(|m| m.is_emitter());
        let reference = if has_lamps {
            let plain = Shot { spp: SPP_OF_LAMPS, ..shot };
            let (mean, variance) = statistics(&renderer, &without_light_sampling(scene), &plain);
            Reference { mean, error: divided(&variance), noise }
        } else {
            Reference { mean, error: divided(&noise), noise }
        };
        reference.write(name);
    }
}

/// The same scene, whose lamps are not sampled since cut-outs are not.
fn without_light_sampling(mut scene: Scene) -> Scene {
    scene.materials.iter_mut().filter(|m| m.is_emitter()).for_each(|m| m.alpha_cutoff = 0.5);
    scene
}

/// Mean and variance of pictures that differ in their seeds; none of them is the seed of the pictures that are judged.
fn statistics(renderer: &Renderer, scene: &Scene, shot: &Shot) -> (Picture, Picture) {
    let prepared = renderer.prepare(scene).unwrap();
    let mut sums = vec![[[0.0f64; 2]; 3]; 16 * 16];
    for seed in 0..PICTURES {
        let shot = Shot { seed: Seed(1000 + seed), ..shot.clone() };
        let picture = renderer.render(&prepared, &shot, true, &|_| false).unwrap().color.unwrap().radiance;
        for (sums, value) in sums.iter_mut().flatten().zip(picture.data.iter().flatten()) {
            let value = f64::from(*value);
            *sums = [sums[0] + value, sums[1] + value * value];
        }
    }
    let n = PICTURES as f64;
    let picture = |f: &dyn Fn([f64; 2]) -> f64| {
        let data = sums.iter().map(|rgb| rgb.map(|sums| f(sums) as f32)).collect();
        Raster { width: 16, height: 16, data }
    };
    (picture(&|[sum, _]| sum / n), picture(&|[sum, squares]| ((squares - sum * sum / n) / (n - 1.0)).max(0.0)))
}

fn divided(variance: &Picture) -> Picture {
    variance.map(|rgb| rgb.map(|v| v / PICTURES as f32))
}

impl Reference {
    fn path(name: &str) -> PathBuf {
        [env!("CARGO_MANIFEST_DIR"), "tests", "pictures", "references", &format!("{name}.f32")].iter().collect()
    }

    /// 3 images of 16×16×3 numbers, little-endian.
    fn read(name: &str) -> Self {
        let bytes = std::fs::read(Self::path(name)).unwrap();
        let numbers: Vec<f32> = bytes.chunks_exact(4).map(|b| f32::from_le_bytes(b.try_into().unwrap())).collect();
        let mut images = numbers.chunks_exact(16 * 16 * 3).map(|image| {
            let data = image.chunks_exact(3).map(|rgb| [rgb[0], rgb[1], rgb[2]]).collect();
            Raster { width: 16, height: 16, data }
        });
        let mut image = || images.next().unwrap();
        Self { mean: image(), error: image(), noise: image() }
    }

    fn write(&self, name: &str) {
        let images = [&self.mean, &self.error, &self.noise];
        let numbers = images.iter().flat_map(|image| image.data.iter().flatten());
        std::fs::write(Self::path(name), numbers.flat_map(|v| v.to_le_bytes()).collect::<Vec<u8>>()).unwrap();
    }
}
