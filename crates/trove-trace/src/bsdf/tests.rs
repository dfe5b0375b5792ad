use std::sync::LazyLock;
use std::{vec, vec::Vec};

use trove_model::{Random, Seed};

use super::*;

static LOBES: LazyLock<Lobes> = LazyLock::new(Lobes::new);

/// A surface that faces up, seen from an angle with cosine `cos`.
fn bsdf(cos: f32, p: &Parameters) -> Bsdf {
    seen_from(Vec3::new((1.0 - cos * cos).sqrt(), 0.0, cos), p)
}

fn seen_from(wo: Vec3, p: &Parameters) -> Bsdf {
    Bsdf::new(&LOBES, wo, Vec3::Z, Vec3::Z, p)
}

fn white(alpha: f32) -> Parameters {
    Parameters {
        base_color: Vec3::ONE,
        alpha,
        diffuse_roughness: 0.0,
        metalness: 0.0,
        f0: 0.04,
        coat: coat(0.0, 0.003),
        sheen: Vec3::ZERO,
        subsurface: 0.0,
        translucency: 0.0,
        transmission: 0.0,
        tint: Vec3::ONE,
    }
}

fn coat(share: f32, alpha: f32) -> Coat {
    Coat { normal: Vec3::Z, share, alpha, f0: 0.04 }
}

/// Every lobe, alone as far as it can be, and together with others.
fn all_sorts() -> Vec<(&'static str, Parameters)> {
    let mut all = Vec::new();
    for alpha in [ggx::ALPHA_MIN, 0.01, 0.1, 0.4, 1.0] {
        all.extend([
            ("Lambert under facets", white(alpha)),
            ("metal", Parameters { metalness: 1.0, ..white(alpha) }),
            ("grains", Parameters { diffuse_roughness: 1.0, ..white(alpha) }),
            ("cloudy body", Parameters { subsurface: 1.0, ..white(alpha) }),
            ("cloth", Parameters { sheen: Vec3::ONE, diffuse_roughness: 0.5, ..white(alpha) }),
            ("leaf", Parameters { translucency: 0.5, diffuse_roughness: 0.5, ..white(alpha) }),
            ("pane", Parameters { transmission: 1.0, f0: 0.077, ..white(alpha) }),
            ("lacquer", Parameters { coat: coat(1.0, 0.003), ..white(alpha) }),
            ("lacquer over flakes", Parameters { coat: coat(1.0, 0.003), metalness: 0.6, ..white(alpha) }),
            ("wet grains", Parameters { coat: coat(0.6, 0.3), diffuse_roughness: 0.5, ..white(alpha) }),
            (
                "everything",
                Parameters {
                    coat: coat(0.5, 0.1),
                    sheen: Vec3::splat(0.5),
                    diffuse_roughness: 0.4,
                    metalness: 0.3,
                    subsurface: 0.4,
                    translucency: 0.2,
                    transmission: 0.3,
                    ..white(alpha)
                },
            ),
        ]);
    }
    all
}

/// A direction on the side of the normal.
fn above(random: &mut Random) -> Vec3 {
    let z = random.range(0.2, 1.0) as f32;
    let (y, x) = (random.unit() as f32 * std::f32::consts::TAU).sin_cos();
    let r = (1.0 - z * z).sqrt();
    Vec3::new(r * x, r * y, z)
}

#[test]
fn white_surfaces_give_back_what_they_get() {
    let n = 96;
    for (name, p) in all_sorts() {
        for cos in [0.1, 0.3, 0.6, 1.0] {
            let bsdf = bsdf(cos, &p);
            let mut random = Seed(1).random();
            let mut sum = 0.0;
            for k in 0..n * n {
                let u = [random.unit() as f32, ((k % n) as f32 + 0.5) / n as f32, ((k / n) as f32 + 0.5) / n as f32];
                sum += bsdf.sample(u).map_or(0.0, |s| s.weight.x);
            }
            let albedo = sum / (n * n) as f32;
            assert!((0.94..1.02).contains(&albedo), "{name}: {albedo} at {cos}, α {}", p.alpha);
        }
    }
}

#[test]
fn a_rough_or_cloudy_layer_is_as_bright_as_its_colour() {
    for (roughness, subsurface, least) in [(0.0, 0.0, 0.999), (0.45, 0.0, 0.99), (1.0, 0.0, 0.98), (0.0, 1.0, 0.88)] {
        for color in [0.1, 0.5, 0.9] {
            // Cosine-weighted mean over all pairs of directions.
            let (mut sum, mut random, n) = (0.0, Seed(3).random(), 40_000);
            for _ in 0..n {
                let mut unit = || random.unit() as f32;
                let (o, i) = (cosine_hemisphere([unit(), unit()]), cosine_hemisphere([unit(), unit()]));
                let lobe = Diffuse::new(Vec3::splat(color), 1.0, roughness, subsurface, o.z.max(1e-3));
                sum += lobe.eval(i.z, o.dot(i)).x;
            }
            let share = sum / n as f32 / color;
            assert!((least..1.02).contains(&share), "{share} for {color}, {roughness}, {subsurface}");
        }
    }
}

#[test]
fn every_lobe_alone_takes_the_same_way_back() {
    // Alone, without what the layers above leave and what makes up for single reflection: both belong to the eye's
    // direction alone, and the tests below hold them.
    let [body, facets, fibres, coated] = [0, 1, 2, 3];
    let sorts = [
        ("Lambert", body, Parameters { f0: 0.0, ..white(1.0) }),
        ("grains", body, Parameters { diffuse_roughness: 0.8, ..white(1.0) }),
        ("cloudy body", body, Parameters { subsurface: 1.0, base_color: Vec3::splat(0.6), ..white(1.0) }),
        ("metal", facets, Parameters { base_color: Vec3::splat(0.4), metalness: 1.0, ..white(0.4) }),
        ("cloth", fibres, Parameters { sheen: Vec3::ONE, ..white(0.4) }),
        ("lacquer", coated, Parameters { coat: coat(1.0, 0.2), ..white(0.4) }),
    ];
    let mut random = Seed(5).random();
    for (name, kept, p) in sorts {
        let share = |lobe: i32| f32::from(u8::from(lobe == kept));
        let seen = |wo: Vec3, wi: Vec3| {
            let mut bsdf = seen_from(wo, &p);
            let Parameters { base_color, diffuse_roughness, subsurface, .. } = p;
            bsdf.diffuse = Diffuse::new(base_color, share(body), diffuse_roughness, subsurface, bsdf.cos_o);
            (bsdf.gain, bsdf.sheen) = (Vec3::splat(share(facets)), Vec3::splat(share(fibres)));
            bsdf.coat.share = share(coated);
            bsdf.eval(wi).0.x / wi.z
        };
        for _ in 0..400 {
            let (a, b) = (above(&mut random), above(&mut random));
            let (there, back) = (seen(a, b), seen(b, a));
            assert!(there > 0.0 && (there / back - 1.0).abs() < 2e-3, "{name}: {there}, {back} for {a} and {b}");
        }
    }
}

/// All that a surface reflects of light towards a direction, added up over the hemisphere; for lobes that are not narrow.
fn reflected(wo: Vec3, p: &Parameters) -> f32 {
    let (rows, columns) = (96, 192);
    let bsdf = seen_from(wo, p);
    let light = |i: usize| {
        // Cells of equal size in z and azimuth have equal solid angles.
        let z = ((i / columns) as f32 + 0.5) / rows as f32;
        let (y, x) = (((i % columns) as f32 + 0.5) / columns as f32 * std::f32::consts::TAU).sin_cos();
        let r = (1.0 - z * z).sqrt();
        bsdf.eval(Vec3::new(r * x, r * y, z)).0.x
    };
    (0..rows * columns).map(light).sum::<f32>() * std::f32::consts::TAU / (rows * columns) as f32
}

#[test]
fn what_is_below_a_layer_differs_there_and_back_by_what_the_layer_leaves() {
    // A body gets what the layers above reflect less of one of the two directions' light, and is reciprocal but for that;
    // what they reflect is added up here, not looked up.
    let layers = [
        ("facets", white(0.4)),
        ("rough facets", white(1.0)),
        ("thick lacquer", Parameters { coat: coat(1.0, 0.2), ..white(0.5) }),
        ("half wet", Parameters { coat: coat(0.6, 0.3), ..white(0.5) }),
        ("cloth", Parameters { sheen: Vec3::splat(0.5), ..white(0.7) }),
    ];
    let mut random = Seed(4).random();
    for (name, layer) in layers {
        for body in [[0.0, 0.0], [0.8, 0.0], [0.0, 1.0]] {
            let with = |base_color| Parameters { base_color, diffuse_roughness: body[0], subsurface: body[1], ..layer };
            let (black, white) = (with(Vec3::ZERO), with(Vec3::splat(0.6)));
            for _ in 0..12 {
                let (a, b) = (above(&mut random), above(&mut random));
                let below = |wo: Vec3, wi: Vec3| {
                    let seen = |p: &Parameters| seen_from(wo, p).eval(wi).0.x / wi.z;
                    (seen(&white) - seen(&black)) / (1.0 - reflected(wo, &black))
                };
                let ratio = below(a, b) / below(b, a);
                assert!((ratio - 1.0).abs() < 0.02, "{name} over {body:?}: {ratio} for {a} and {b}");
            }
        }
    }
}

#[test]
fn facets_are_given_what_single_reflection_loses() {
    for alpha in [0.2, 0.5, 1.0] {
        let metal = |f0: f32| Parameters { base_color: Vec3::splat(f0), metalness: 1.0, ..white(alpha) };
        let plastic = Parameters { base_color: Vec3::ZERO, ..white(alpha) };
        for cos in [0.2f32, 0.4, 0.7, 1.0] {
            let wo = Vec3::new((1.0 - cos * cos).sqrt(), 0.0, cos);
            let gain = |p: &Parameters| seen_from(wo, p).gain.x;
            // What white facets reflect once is added up here, not looked up.
            let lost = gain(&metal(1.0)) / reflected(wo, &metal(1.0)) - 1.0;
            for (p, f0) in [(&metal(1.0), 1.0), (&metal(0.5), 0.5), (&plastic, plastic.f0)] {
                let given = (gain(p) - 1.0) / f0;
                assert!((given - lost).abs() < 0.02, "{given} for {lost}, f0 {f0}, α {alpha} at {cos}");
            }
        }
    }
}

#[test]
fn directions_are_drawn_with_the_density_that_is_claimed() {
    let sorts = all_sorts().into_iter().filter(|(_, p)| p.alpha == 0.4 || (p.alpha == 0.1 && p.metalness == 1.0));
    // Narrow coats would need finer bins.
    let sorts = sorts.map(|(name, mut p)| {
        p.coat.alpha = p.coat.alpha.max(0.2);
        (name, p)
    });
    for (name, p) in sorts {
        let bsdf = bsdf(0.7, &p);
        let (side, draws) = (16usize, 60_000);
        let bin = |d: Vec3| {
            let azimuth = (d.y.atan2(d.x) / std::f32::consts::TAU + 0.5).clamp(0.0, 0.999_999);
            let z = (d.z * 0.5 + 0.5).clamp(0.0, 0.999_999);
            (z * side as f32) as usize * side + (azimuth * side as f32) as usize
        };
        let mut expected = vec![0.0f64; side * side];
        let (rows, columns) = (640, 640);
        for i in 0..rows * columns {
            let z = ((i / columns) as f32 + 0.5) / rows as f32 * 2.0 - 1.0;
            let (y, x) = (((i % columns) as f32 + 0.5) / columns as f32 * std::f32::consts::TAU).sin_cos();
            let r = (1.0 - z * z).sqrt();
            let d = Vec3::new(r * x, r * y, z);
            let solid_angle = 4.0 * std::f64::consts::PI / f64::from(rows * columns);
            expected[bin(d)] += f64::from(bsdf.eval(d).1) * solid_angle * f64::from(draws);
        }
        let mut random = Seed(2).random();
        let mut drawn = vec![0.0f64; side * side];
        for _ in 0..draws {
            let u = [random.unit() as f32, random.unit() as f32, random.unit() as f32];
            if let Some(sample) = bsdf.sample(u).filter(|s| s.pdf.is_some()) {
                drawn[bin(sample.wi)] += 1.0;
            }
        }
        let bins: Vec<_> = expected.iter().zip(&drawn).filter(|(e, _)| **e > 5.0).collect();
        let chi2: f64 = bins.iter().map(|(e, n)| (*n - **e).powi(2) / **e).sum();
        // 99.99 % of as many degrees of freedom, by Wilson and Hilferty's approximation: 11 sorts are tested.
        let df = bins.len() as f64;
        let limit = df * (1.0 - 2.0 / (9.0 * df) + 3.72 * (2.0 / (9.0 * df)).sqrt()).powi(3);
        assert!(chi2 < limit, "{name}: χ² = {chi2} over {limit}");
    }
}
