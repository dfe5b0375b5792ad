//! Lawns, weeds, clover and dandelions.

use glam::{Vec2, Vec3, vec3};
use trove_model::{CoverKind, GroundCover, Material, Random, Seed, Slot};

use super::patch::{Blade, Patch, heading, point, varied};

/// Grass from above, from well watered to dried up.
const SHADES: [Vec3; 5] = [
    vec3(0.14, 0.235, 0.068),
    vec3(0.17, 0.242, 0.078),
    vec3(0.21, 0.252, 0.095),
    vec3(0.26, 0.265, 0.12),
    vec3(0.315, 0.275, 0.15),
];
/// What makes a fresh blade straw.
const STRAW: Vec3 = vec3(1.7, 1.15, 1.6);

/// How grass is seen from a distance.
struct Detail {
    kind: CoverKind,
    name: &'static str,
    blades_per_m2: f32,
    width_m: f32,
    /// Three triangles a blade, not one.
    bent: bool,
    /// Sides of its patches, metres, and how many different ones there are of each.
    sides_m: &'static [f32],
    variants: usize,
}

const DETAILS: [Detail; 3] = [
    Detail {
        kind: CoverKind::GrassNear,
        name: "grass-near",
        blades_per_m2: 1400.0,
        width_m: 0.0055,
        bent: true,
        sides_m: &[1.0, 0.5, 0.25],
        variants: 2,
    },
    Detail {
        kind: CoverKind::GrassMiddle,
        name: "grass-middle",
        blades_per_m2: 700.0,
        width_m: 0.011,
        bent: false,
        sides_m: &[2.0, 1.0, 0.5, 0.25],
        variants: 1,
    },
    Detail {
        kind: CoverKind::GrassFar,
        name: "grass-far",
        blades_per_m2: 176.0,
        width_m: 0.024,
        bent: false,
        sides_m: &[2.0, 1.0, 0.5],
        variants: 1,
    },
];

pub(super) fn covers() -> Vec<GroundCover> {
    let mut covers = Vec::new();
    for detail in &DETAILS {
        for &side_m in detail.sides_m {
            for variant in 0..detail.variants {
                let name = format!("{}-{side_m}-{variant}", detail.name);
                let mut random = Seed(31).child(&name).random();
                covers.push(lawn(detail, side_m, &mut random).cover(&name, detail.kind, side_m, living("grass")));
            }
        }
    }
    for variant in 0..3 {
        let name = format!("weeds-{variant}");
        let mut random = Seed(32).child(&name).random();
        covers.push(weeds(&mut random).cover(&name, CoverKind::Weeds, 0.3, living("weeds")));
    }
    for name in ["clover", "dandelions"] {
        let mut random = Seed(33).child(name).random();
        let patch = if name == "clover" { clover(&mut random) } else { dandelions(&mut random) };
        let material = blade_material(name, Vec3::ONE);
        covers.push(patch.cover(name, CoverKind::Flowers, 0.5, Slot::new(material, Vec::new())));
    }
    covers
}

fn blade_material(name: &str, color: Vec3) -> Material {
    Material { translucency: 0.35, ior: 1.35, ..Material::plain(name, color, 0.7) }
}

/// A blade's material, in all shades.
fn living(name: &str) -> Slot {
    Slot::new(blade_material(name, SHADES[0]), SHADES.to_vec())
}

fn lawn(detail: &Detail, side_m: f32, random: &mut Random) -> Patch {
    let mut patch = Patch::default();
    let count = (detail.blades_per_m2 * side_m * side_m).round() as usize;
    // Blades come in tufts that lean apart.
    let mut tuft = (Vec3::ZERO, Vec3::ONE);
    for i in 0..count {
        if i % 5 == 0 {
            tuft = (point(side_m, random), varied(Vec3::ONE, 0.16, random));
        }
        let out = heading(random) * 0.03 * random.unit().sqrt() as f32;
        let straw = random.chance(0.1);
        let tint = varied(if straw { STRAW } else { tuft.1 }, 0.2, random);
        patch.blade(
            &Blade {
                foot: tuft.0 + out.extend(0.0),
                towards: (out.normalize_or(Vec2::X) + heading(random)).normalize_or(Vec2::X),
                lean_rad: [random.range(0.1, 0.6) as f32, random.range(0.6, 1.3) as f32],
                length_m: random.range(0.035, 0.08) as f32,
                width_m: detail.width_m * random.range(0.7, 1.25) as f32,
                tint,
            },
            detail.bent,
        );
    }
    patch
}

fn weeds(random: &mut Random) -> Patch {
    let mut patch = Patch::default();
    for _ in 0..26 {
        let out = heading(random);
        let stalk = random.chance(0.25);
        let tint = varied(if stalk { STRAW } else { Vec3::ONE }, 0.25, random);
        patch.blade(
            &Blade {
                foot: out.extend(0.0) * 0.06 * random.unit() as f32,
                towards: out,
                lean_rad: [random.range(0.05, 0.3) as f32, random.range(0.3, 1.0) as f32],
                length_m: random.range(0.1, if stalk { 0.34 } else { 0.24 }) as f32,
                width_m: random.range(0.005, 0.011) as f32,
                tint,
            },
            true,
        );
    }
    // Broad leaves at the foot.
    for _ in 0..9 {
        let out = heading(random);
        let blade = Blade {
            foot: out.extend(0.0) * 0.02,
            towards: out,
            lean_rad: [random.range(0.7, 1.1) as f32, random.range(1.1, 1.5) as f32],
            length_m: random.range(0.07, 0.15) as f32,
            width_m: random.range(0.02, 0.035) as f32,
            tint: varied(vec3(0.85, 0.95, 0.9), 0.15, random),
        };
        patch.blade(&blade, true);
    }
    patch
}

/// Leaves in threes, and white heads above them.
fn clover(random: &mut Random) -> Patch {
    let mut patch = Patch::default();
    let green = vec3(0.06, 0.125, 0.04);
    for _ in 0..55 {
        let at = clustered(random) + Vec3::Z * random.range(0.025, 0.05) as f32;
        let (turn, tint) = (heading(random), varied(green, 0.2, random));
        for third in 0..3 {
            let out = Vec2::from_angle(std::f32::consts::TAU * third as f32 / 3.0).rotate(turn);
            patch.lying_leaf(at + out.extend(0.0) * 0.009, out, 0.017, 0.002, tint);
        }
    }
    for _ in 0..9 {
        let at = clustered(random);
        stem(&mut patch, at, 0.075, green);
        head(&mut patch, at + Vec3::Z * 0.08, 0.009, varied(vec3(0.62, 0.6, 0.5), 0.1, random));
    }
    patch
}

/// Rosettes, and yellow heads above them.
fn dandelions(random: &mut Random) -> Patch {
    let mut patch = Patch::default();
    for _ in 0..5 {
        let at = clustered(random);
        for _ in 0..8 {
            let blade = Blade {
                foot: at,
                towards: heading(random),
                lean_rad: [random.range(0.8, 1.2) as f32, random.range(1.2, 1.5) as f32],
                length_m: random.range(0.06, 0.12) as f32,
                width_m: 0.018,
                tint: varied(vec3(0.075, 0.14, 0.035), 0.2, random),
            };
            patch.blade(&blade, true);
        }
        for _ in 0..1 + random.index(3) {
            let foot = at + point(0.05, random);
            let high_m = random.range(0.05, 0.1) as f32;
            stem(&mut patch, foot, high_m, vec3(0.12, 0.16, 0.06));
            head(&mut patch, foot + Vec3::Z * high_m, 0.014, vec3(0.7, 0.45, 0.02));
        }
    }
    patch
}

/// Denser in the middle of a square of half a metre.
fn clustered(random: &mut Random) -> Vec3 {
    (point(0.4, random) + point(0.4, random)) / 2.0
}

fn stem(patch: &mut Patch, foot: Vec3, high_m: f32, tint: Vec3) {
    let blade = Blade { foot, towards: Vec2::X, lean_rad: [0.0, 0.1], length_m: high_m, width_m: 0.004, tint };
    patch.blade(&blade, false);
}

/// A flower's head: a low pyramid of five sides.
fn head(patch: &mut Patch, at: Vec3, radius_m: f32, tint: Vec3) {
    let top = patch.vertex(at + Vec3::Z * radius_m * 0.7, Vec3::Z, tint);
    let rim: Vec<u32> = (0..5)
        .map(|i| Vec2::from_angle(std::f32::consts::TAU * i as f32 / 5.0))
        .map(|out| patch.vertex(at + (out * radius_m).extend(0.0), out.extend(0.6), tint * 0.85))
        .collect();
    for i in 0..5 {
        patch.triangle(rim[i], rim[(i + 1) % 5], top);
    }
}
