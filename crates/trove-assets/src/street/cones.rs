//! Traffic cones.

use glam::{Vec3, vec2, vec3};
use trove_model::{Asset, Class, Kind};

use super::finish::{bar, plastic, reflective, rubber};
use crate::shape::{Model, Shape};

const ORANGE: Vec3 = vec3(0.66, 0.105, 0.02);
const WHITE: Vec3 = vec3(0.66, 0.66, 0.64);

struct Cone {
    id: &'static str,
    base_m: f32,
    height_m: f32,
    radii_m: [f32; 2],
    /// White from and to, as shares of the height.
    bands: &'static [[f32; 2]],
    black_base: bool,
}

pub(super) fn assets() -> Vec<Asset> {
    [
        Cone {
            id: "cone/standard",
            base_m: 0.42,
            height_m: 0.75,
            radii_m: [0.145, 0.03],
            bands: &[[0.32, 0.5], [0.66, 0.84]],
            black_base: true,
        },
        Cone {
            id: "cone/tall",
            base_m: 0.46,
            height_m: 1.05,
            radii_m: [0.15, 0.045],
            bands: &[[0.4, 0.55], [0.68, 0.8]],
            black_base: false,
        },
        Cone {
            id: "cone/small",
            base_m: 0.33,
            height_m: 0.56,
            radii_m: [0.11, 0.025],
            bands: &[[0.45, 0.75]],
            black_base: true,
        },
    ]
    .into_iter()
    .map(cone)
    .collect()
}

fn cone(make: Cone) -> Asset {
    let mut model = Model::default();
    let orange = model.slot(plastic(ORANGE), &[ORANGE, ORANGE * 0.8, vec3(0.6, 0.075, 0.03)]);
    let white = model.slot(reflective(WHITE), &[]);
    let base = model.slot(if make.black_base { rubber() } else { plastic(ORANGE * 0.85) }, &[]);
    let foot_m = 0.045;
    model.add(base, bar(vec3(0.0, 0.0, foot_m * 0.4), vec3(make.base_m, make.base_m, foot_m * 0.8)));
    model.add(base, bar(vec3(0.0, 0.0, foot_m * 0.75), vec3(make.base_m * 0.8, make.base_m * 0.8, foot_m)));
    let radius = |share: f32| make.radii_m[0] + (make.radii_m[1] - make.radii_m[0]) * share;
    let rise = make.height_m - foot_m;
    let point = |share: f32, more_m: f32| vec2(radius(share) + more_m, foot_m + rise * share);

    // A collar at the foot, the body, a rounded hole at the top.
    model.add(orange, Shape::lathe(&[vec2(make.radii_m[0] + 0.03, foot_m), point(0.04, 0.006)], 28));
    model.add(orange, Shape::lathe(&[point(0.04, 0.006), point(0.05, 0.0), point(1.0, 0.0)], 28));
    let (top, rim) = (make.height_m, make.radii_m[1]);
    let lip = [vec2(rim, top), vec2(rim - 0.006, top + 0.004), vec2(rim - 0.012, top), vec2(rim - 0.014, top - 0.08)];
    model.add(orange, Shape::lathe(&lip, 28));
    for &[from, to] in make.bands {
        let sleeve = [point(from, 0.0), point(from, 0.003), point(to, 0.003), point(to, 0.0)];
        model.add(white, Shape::lathe(&sleeve, 28));
    }
    model.asset(make.id, Kind::TrafficCone, Class::TrafficCone)
}
