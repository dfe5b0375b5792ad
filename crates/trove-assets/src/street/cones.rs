//! Traffic cones and what else is set out on roads in their place.

use glam::{Quat, Vec3, vec2, vec3};
use serde::Deserialize;
use trove_model::{Asset, Class, Kind};

use super::finish::{plastic, reflective, rubber, upright};
use crate::measure::{Wrong, ordinary, within, wrong};
use crate::shape::{Model, Shape};

const ORANGE: Vec3 = vec3(0.82, 0.15, 0.025);
const PALE: Vec3 = vec3(0.72, 0.2, 0.07);
const WHITE: Vec3 = vec3(0.74, 0.74, 0.71);

/// A traffic cone: a `[[cone]]` of a file of plans. Lengths are metres, colours linear RGB.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct ConePlan {
    /// Unique in its library.
    pub(crate) id: String,
    /// Words that say what it is.
    #[serde(default)]
    tags: Vec<String>,
    #[serde(default = "ordinary")]
    commonness: f32,
    /// The first is the cone's as it is new, the others are those of faded ones.
    colors: Vec<[f32; 3]>,
    /// Side of the foot.
    foot_m: f32,
    /// The foot is of black rubber, not of the cone's plastic.
    #[serde(default)]
    has_rubber_foot: bool,
    height_m: f32,
    /// Below and above.
    radii_m: [f32; 2],
    /// White from and to, as shares of the height.
    #[serde(default)]
    bands: Vec<[f32; 2]>,
    /// A round reflector on a stem.
    #[serde(default)]
    has_disc: bool,
    /// How far its top is bent aside, for it was driven over.
    #[serde(default)]
    bent_m: f32,
}

impl ConePlan {
    /// The key of a value that no cone can have, with what was expected and what it is.
    pub(crate) fn check(&self) -> Result<(), Wrong> {
        within("commonness", "a number from 0 to 1000", 0.0..=1000.0, [&self.commonness])?;
        if self.colors.is_empty() {
            return wrong("colors", "at least one colour", &self.colors);
        }
        within("colors", "linear RGB from 0 to 1", 0.0..=1.0, self.colors.iter().flatten())?;
        within("foot_m", "metres from 0.1 to 1", 0.1..=1.0, [&self.foot_m])?;
        within("height_m", "metres from 0.2 to 3", 0.2..=3.0, [&self.height_m])?;
        within("radii_m", "metres from 0.02 to half the foot", 0.02..=self.foot_m / 2.0, &self.radii_m)?;
        within("bands", "shares from 0 to 1", 0.0..=1.0, self.bands.iter().flatten())?;
        if self.bands.len() > 10 || self.bands.iter().any(|[from, to]| from >= to) {
            return wrong("bands", "at most 10, each from a lower to a higher share", &self.bands);
        }
        within("bent_m", "metres from 0 to 0.5", 0.0..=0.5, [&self.bent_m])
    }
}

/// What else stands in the place of cones.
pub(super) fn others() -> Vec<Asset> {
    vec![tube(), drum(), panel()]
}

fn asset(model: Model, name: &str, commonness: f32) -> Asset {
    let asset = model.asset(&format!("cone/{name}"), Kind::TrafficCone, Class::TrafficCone);
    Asset { commonness, ..asset }.tagged([name])
}

/// What a plan tells of.
pub(super) fn cone(plan: &ConePlan) -> Asset {
    let mut model = Model::default();
    let colors: Vec<Vec3> = plan.colors.iter().copied().map(Vec3::from_array).collect();
    let orange = model.slot(plastic(colors[0]), &colors);
    let white = model.slot(reflective(WHITE), &[WHITE, WHITE * 0.8, vec3(0.6, 0.58, 0.52)]);
    let base = model.slot(if plan.has_rubber_foot { rubber() } else { plastic(colors[0] * 0.85) }, &[]);
    let foot_m = 0.045;
    // A flat foot with rounded corners whose middle is raised.
    let slab = |size: f32, corner: f32, z: f32| -> Vec<Vec3> {
        super::finish::rounded(vec2(size, size), corner).into_iter().map(|p| p.extend(z)).collect()
    };
    let side = plan.foot_m;
    let sections = [
        (side - 0.012, 0.0),
        (side, 0.008),
        (side, 0.022),
        (side - 0.02, 0.028),
        (side * 0.82, 0.03),
        (side * 0.76, foot_m),
    ];
    model.add(base, Shape::loft(&sections.map(|(size, z)| slab(size, 0.045, z))));
    let rise = plan.height_m - foot_m;
    let radius = |share: f32| plan.radii_m[0] + (plan.radii_m[1] - plan.radii_m[0]) * share;
    let point = |share: f32, more_m: f32| vec2(radius(share) + more_m, foot_m + rise * share);
    let bend = |shape: Shape| {
        let bent_m = plan.bent_m;
        if bent_m == 0.0 {
            return shape;
        }
        shape.bent(|p| {
            let t = ((p.z - foot_m) / rise).max(0.0);
            let dent = 1.0 - 0.3 * (-((p.z - 0.4) / 0.12).powi(2)).exp() * f32::from(p.x > 0.0);
            vec3(p.x * dent + bent_m * t * t, p.y * (2.0 - dent) - 0.4 * bent_m * t, p.z - 0.35 * bent_m * t * t)
        })
    };

    // A collar at the foot, the body in rings, a rounded hole at the top.
    model.add(
        orange,
        Shape::lathe(&[vec2(plan.radii_m[0] + 0.03, foot_m - 0.002), point(0.03, 0.018), point(0.05, 0.003)], 28),
    );
    let body: Vec<_> = (0..=16).map(|i| point(0.05 + 0.95 * i as f32 / 16.0, 0.0)).collect();
    let (top, rim) = (plan.height_m, plan.radii_m[1]);
    let lip = [vec2(rim, top), vec2(rim - 0.005, top + 0.005), vec2(rim - 0.012, top), vec2(rim - 0.014, top - 0.08)];
    model.add(orange, bend(Shape::lathe(&[body.as_slice(), &lip].concat(), 28)));
    for &[from, to] in &plan.bands {
        let inner = (0..=4).map(|i| point(from + (to - from) * i as f32 / 4.0, 0.003));
        let sleeve: Vec<_> = std::iter::once(point(from, 0.0)).chain(inner).chain([point(to, 0.0)]).collect();
        model.add(white, bend(Shape::lathe(&sleeve, 28)));
    }
    if plan.has_disc {
        let disc = |radius: f32, thick: f32| upright(Shape::cylinder(radius, thick, 28));
        let amber = model.slot(reflective(vec3(0.85, 0.3, 0.02)), &[]);
        model.add(orange, Shape::tube(&[vec3(0.0, 0.0, top - 0.05), vec3(0.0, 0.0, top + 0.1)], 0.012, 8));
        model.add(orange, disc(0.105, 0.02).moved(vec3(-0.01, 0.0, top + 0.18)));
        model.add(amber, disc(0.092, 0.024).moved(vec3(-0.012, 0.0, top + 0.18)));
    }
    let asset = model.asset(&plan.id, Kind::TrafficCone, Class::TrafficCone);
    Asset { commonness: plan.commonness, ..asset }.tagged(&plan.tags)
}

/// An upright tube on a heavy foot, which divides lanes.
fn tube() -> Asset {
    let mut model = Model::default();
    let orange = model.slot(plastic(ORANGE), &[ORANGE, PALE, vec3(0.72, 0.5, 0.03)]);
    let white = model.slot(reflective(WHITE), &[]);
    let black = model.slot(rubber(), &[]);
    let foot = [(0.0, 0.0), (0.19, 0.0), (0.195, 0.02), (0.17, 0.05), (0.08, 0.075), (0.06, 0.1), (0.0, 0.1)];
    model.add(black, Shape::lathe(&foot.map(|(r, z)| vec2(r, z)), 8));
    let body = [
        (0.05, 0.08),
        (0.045, 0.12),
        (0.042, 0.9),
        (0.046, 0.95),
        (0.05, 1.0),
        (0.045, 1.035),
        (0.03, 1.05),
        (0.0, 1.055),
    ];
    model.add(orange, Shape::lathe(&body.map(|(r, z)| vec2(r, z)), 20));
    for z in [0.55, 0.75] {
        let band = [(0.0425, 0.0), (0.0455, 0.002), (0.0455, 0.1), (0.0425, 0.102)];
        model.add(white, Shape::lathe(&band.map(|(r, h)| vec2(r, z + h)), 20));
    }
    asset(model, "tube", 1.0)
}

/// A drum with bands in a ring of rubber.
fn drum() -> Asset {
    let mut model = Model::default();
    let orange = model.slot(plastic(ORANGE), &[ORANGE, ORANGE * 0.85, PALE]);
    let white = model.slot(reflective(WHITE), &[]);
    let black = model.slot(rubber(), &[]);
    let ring = [(0.24, 0.0), (0.335, 0.0), (0.34, 0.03), (0.32, 0.075), (0.26, 0.09), (0.24, 0.08)];
    model.add(black, Shape::lathe(&ring.map(|(r, z)| vec2(r, z)), 32));
    let body = [
        (0.272, 0.03),
        (0.272, 0.16),
        (0.262, 0.175),
        (0.26, 0.33),
        (0.248, 0.345),
        (0.246, 0.52),
        (0.236, 0.535),
        (0.232, 0.7),
        (0.222, 0.715),
        (0.218, 0.88),
        (0.2, 0.91),
        (0.0, 0.915),
    ];
    model.add(orange, Shape::lathe(&body.map(|(r, z)| vec2(r, z)), 32));
    for (radius, z) in [(0.2625, 0.185), (0.2345, 0.54)] {
        let band = [(radius - 0.004, z), (radius, z + 0.002), (radius - 0.0025, z + 0.14), (radius - 0.006, z + 0.142)];
        model.add(white, Shape::lathe(&band.map(|(r, h)| vec2(r, h)), 32));
    }
    let handle: Vec<Vec3> = (0..=10)
        .map(|i| std::f32::consts::PI * i as f32 / 10.0)
        .map(|a| vec3(0.0, 0.11 * a.cos(), 0.9 + 0.12 * a.sin()))
        .collect();
    model.add(orange, Shape::tube(&handle, 0.016, 8));
    asset(model, "drum", 0.8)
}

/// A striped panel on a foot of recycled rubber.
fn panel() -> Asset {
    let mut model = Model::default();
    let stripes = [model.slot(reflective(vec3(0.55, 0.03, 0.02)), &[]), model.slot(reflective(WHITE), &[])];
    let back = model.slot(plastic(WHITE * 0.9), &[]);
    let black = model.slot(rubber(), &[]);
    let lamp = model.slot(plastic(vec3(0.75, 0.4, 0.03)), &[]);
    model.add(black, Shape::rounded_block(vec3(0.7, 0.36, 0.1), 0.025).moved(vec3(0.0, 0.0, 0.05)));
    model.add(back, Shape::rounded_block(vec3(0.035, 0.25, 1.0), 0.015).moved(vec3(0.0, 0.0, 0.6)));
    for side in [0.0, std::f32::consts::PI] {
        for i in 0..6 {
            let z = 0.13 + 0.16 * i as f32;
            let (low, high) = ((z - 0.06).max(0.12), (z + 0.02).max(0.12));
            let quad = [
                vec2(-0.115, low),
                vec2(0.115, high),
                vec2(0.115, (high + 0.16).min(1.08)),
                vec2(-0.115, (low + 0.16).min(1.08)),
            ];
            let face = upright(Shape::extruded(&quad, 0.004)).moved(vec3(0.0165, 0.0, 0.0));
            model.add(stripes[i % 2], face.turned(Quat::from_rotation_z(side)));
        }
    }
    model.add(lamp, upright(Shape::cylinder(0.085, 0.07, 20)).moved(vec3(-0.035, 0.0, 1.18)));
    model.add(back, Shape::rounded_block(vec3(0.09, 0.13, 0.06), 0.012).moved(vec3(0.0, 0.0, 1.11)));
    asset(model, "panel", 0.5)
}
