//! What is pushed or pulled, and what lies about.

use glam::{Quat, Vec3, vec2, vec3};
use trove_model::{Asset, Class, Kind, Material, Seed};

use super::finish::{bar, cardboard, galvanised, painted, plastic, rubber};
use crate::shape::{Model, Shape};
use crate::surfaces;

pub(super) fn assets() -> Vec<Asset> {
    vec![wheelie_bin(), trolley(), suitcase(), boxes(), bags(), tyre(), branch()]
}

fn wheel(radius_m: f32, width_m: f32) -> Shape {
    Shape::cylinder(radius_m, width_m, 20)
        .moved(Vec3::Z * (-width_m / 2.0))
        .turned(Quat::from_rotation_x(std::f32::consts::FRAC_PI_2))
}

/// Rectangles at rising heights, each (length, width, z, x offset), as one closed body.
fn stacked(sections: &[(f32, f32, f32, f32)]) -> Shape {
    let ring = |&(length, width, z, x): &(f32, f32, f32, f32)| {
        super::finish::rounded(vec2(length, width), 0.045).into_iter().map(|p| vec3(p.x + x, p.y, z)).collect()
    };
    let rings: Vec<Vec<Vec3>> = sections.iter().map(ring).collect();
    Shape::loft(&rings)
}

fn wheelie_bin() -> Asset {
    let mut model = Model::default();
    let green = vec3(0.025, 0.075, 0.035);
    let paints = [green, vec3(0.03, 0.05, 0.12), Vec3::splat(0.05), vec3(0.1, 0.06, 0.03)];
    let body = model.slot(plastic(green), &paints);
    let black = model.slot(rubber(), &[]);
    model.add(
        body,
        stacked(&[
            (0.46, 0.44, 0.06, 0.0),
            (0.48, 0.46, 0.1, 0.0),
            (0.6, 0.55, 0.92, 0.0),
            (0.66, 0.58, 0.93, 0.0),
            (0.66, 0.58, 0.97, 0.0),
        ]),
    );
    model.add(body, stacked(&[(0.68, 0.6, 0.975, 0.02), (0.69, 0.61, 1.0, 0.02), (0.5, 0.45, 1.055, 0.02)]));
    model.add(body, Shape::tube(&[vec3(-0.37, -0.24, 0.97), vec3(-0.37, 0.24, 0.97)], 0.016, 8));
    for y in [-0.24, 0.24] {
        model.add(black, wheel(0.1, 0.05).moved(vec3(-0.26, y, 0.1)));
        model.add(body, bar(vec3(-0.345, y * 0.9, 0.965), vec3(0.08, 0.03, 0.03)));
    }
    model.asset("cart/wheelie-bin", Kind::PushablePullable, Class::Void).tagged(["wheelie-bin"])
}

/// A flat trolley with a bow to push and a load of boxes.
fn trolley() -> Asset {
    let mut model = Model::default();
    let blue = model.slot(painted(vec3(0.03, 0.08, 0.22)), &[]);
    let steel = model.slot(galvanised(), &[]);
    let black = model.slot(rubber(), &[]);
    let card = model.slot(cardboard(), &[]);
    model.add(blue, bar(vec3(0.0, 0.0, 0.2), vec3(0.92, 0.52, 0.05)));
    let bow = [
        vec3(-0.43, -0.22, 0.22),
        vec3(-0.48, -0.22, 0.9),
        vec3(-0.5, -0.16, 1.02),
        vec3(-0.5, 0.16, 1.02),
        vec3(-0.48, 0.22, 0.9),
        vec3(-0.43, 0.22, 0.22),
    ];
    model.add(steel, Shape::tube(&bow, 0.015, 10));
    for (x, y) in [(-0.36, -0.2), (-0.36, 0.2), (0.36, -0.2), (0.36, 0.2)] {
        model.add(black, wheel(0.075, 0.035).moved(vec3(x, y, 0.075)));
        model.add(steel, bar(vec3(x, y, 0.155), vec3(0.07, 0.06, 0.05)));
    }
    for (centre, size, turn) in [
        (vec3(0.1, 0.0, 0.385), vec3(0.52, 0.42, 0.32), 0.04),
        (vec3(0.05, 0.03, 0.67), vec3(0.4, 0.34, 0.25), -0.12),
        (vec3(-0.27, 0.0, 0.34), vec3(0.22, 0.36, 0.23), 0.0),
    ] {
        model.add(card, bar(Vec3::ZERO, size).turned(Quat::from_rotation_z(turn)).moved(centre));
    }
    model.asset("cart/trolley", Kind::PushablePullable, Class::Void).tagged(["trolley"])
}

fn suitcase() -> Asset {
    let mut model = Model::default();
    let navy = vec3(0.02, 0.03, 0.08);
    let shell = model.slot(plastic(navy), &[navy, vec3(0.3, 0.02, 0.03), Vec3::splat(0.03), Vec3::splat(0.35)]);
    let steel = model.slot(galvanised(), &[]);
    let black = model.slot(rubber(), &[]);
    model.add(shell, Shape::rounded_block(vec3(0.27, 0.44, 0.64), 0.06).moved(vec3(0.0, 0.0, 0.38)));
    for i in -2..=2 {
        model.add(shell, bar(vec3(0.0, i as f32 * 0.075, 0.38), vec3(0.285, 0.03, 0.56)));
    }
    let handle = [vec3(-0.1, -0.09, 0.68), vec3(-0.1, -0.09, 1.05), vec3(-0.1, 0.09, 1.05), vec3(-0.1, 0.09, 0.68)];
    model.add(steel, Shape::tube(&handle, 0.009, 8));
    model.add(black, bar(vec3(-0.1, 0.0, 1.06), vec3(0.03, 0.2, 0.03)));
    for (x, y) in [(-0.1, -0.18), (-0.1, 0.18), (0.1, -0.18), (0.1, 0.18)] {
        model.add(black, wheel(0.028, 0.025).moved(vec3(x, y, 0.028)));
    }
    model.asset("cart/suitcase", Kind::PushablePullable, Class::Void).tagged(["suitcase"])
}

/// Cardboard boxes, one of them open.
fn boxes() -> Asset {
    let mut model = Model::default();
    let card = model.slot(cardboard(), &[]);
    let tape = model.slot(Material::plain("tape", vec3(0.35, 0.25, 0.13), 0.35), &[]);
    let size = vec3(0.5, 0.4, 0.34);
    model.add(card, bar(vec3(0.0, 0.0, 0.17), size));
    model.add(tape, Shape::block(vec3(0.502, 0.05, 0.342)).moved(vec3(0.0, 0.0, 0.17)));
    for (y, lean) in [(0.2f32, 0.9), (-0.2, -1.2)] {
        let flap = Shape::block(vec3(0.48, 0.18, 0.004)).moved(vec3(0.0, 0.09 * y.signum(), 0.0));
        model.add(card, flap.turned(Quat::from_rotation_x(lean)).moved(vec3(0.0, y, 0.342)));
    }
    let turn = Quat::from_rotation_z(0.5);
    model.add(card, bar(Vec3::ZERO, vec3(0.34, 0.28, 0.22)).turned(turn).moved(vec3(0.5, 0.12, 0.11)));
    model.asset("debris/boxes", Kind::Debris, Class::Void).tagged(["boxes"])
}

/// Filled black bags, tied at the top.
fn bags() -> Asset {
    let mut model = Model::default();
    let film = Material::plain("plastic film", Vec3::splat(0.02), 0.28);
    let sack = model.slot(film, &[Vec3::splat(0.02), vec3(0.05, 0.09, 0.16), Vec3::splat(0.4)]);
    for (i, (at, size)) in [(vec3(0.0, 0.0, 0.0), 0.33), (vec3(0.42, 0.2, 0.0), 0.27), (vec3(0.12, 0.48, 0.0), 0.3)]
        .into_iter()
        .enumerate()
    {
        let profile = [(0.0, 0.0), (0.75, 0.02), (0.98, 0.3), (1.0, 0.7), (0.8, 1.15), (0.4, 1.5), (0.12, 1.62)]
            .into_iter()
            .chain([(0.08, 1.68), (0.25, 1.85), (0.0, 1.8)]);
        let points: Vec<_> = profile.map(|(r, z)| vec2(r, z) * size).collect();
        let crumpled = Shape::lathe(&points, 26).bent(|p| {
            let angle = p.y.atan2(p.x);
            let fold = (angle * 5.0 + p.z * 9.0 + i as f32).sin() * 0.05 + (angle * 11.0 - p.z * 14.0).sin() * 0.03;
            p * vec3(1.0 + fold, 1.0 + fold, 1.0 + 0.08 * (angle * 2.0 + i as f32).sin())
        });
        model.add(sack, crumpled.moved(at));
    }
    model.asset("debris/bags", Kind::Debris, Class::Void).tagged(["bags"])
}

fn tyre() -> Asset {
    let mut model = Model::default();
    let black = model.slot(rubber(), &[]);
    let section = [(0.2, 0.02), (0.29, 0.0), (0.315, 0.03), (0.315, 0.16), (0.29, 0.19), (0.2, 0.17), (0.19, 0.14)];
    let closed = section.into_iter().chain([(0.27, 0.13), (0.28, 0.06), (0.19, 0.05), (0.2, 0.02)]);
    let points: Vec<_> = closed.map(|(r, z)| vec2(r, z)).collect();
    model.add(black, Shape::lathe(&points, 36));
    model.asset("debris/tyre", Kind::Debris, Class::Void).tagged(["tyre"])
}

/// A fallen branch with its twigs.
fn branch() -> Asset {
    let mut model = Model::default();
    let bark = model.slot(surfaces::set("wood/bark"), &[]);
    let mut random = Seed(5).child("branch").random();
    let spine: Vec<Vec3> = (0..9)
        .map(|i| vec3(i as f32 * 0.16, 0.1 * (i as f32 * 0.9).sin(), 0.06 + 0.03 * (i as f32 * 1.7).cos()))
        .collect();
    let tapered: Vec<(Vec3, f32)> = spine.iter().enumerate().map(|(i, &p)| (p, 0.032 - 0.003 * i as f32)).collect();
    model.add(bark, Shape::tapered_tube(&tapered, 9));
    for (i, &from) in spine.iter().enumerate().skip(2) {
        let side = if i % 2 == 0 { 1.0 } else { -1.0 };
        let reach = random.range(0.2, 0.5) as f32;
        let lift = random.range(-0.02, 0.25) as f32;
        let to = from + vec3(reach * 0.7, side * reach, lift.max(0.03 - from.z));
        let bend = from.lerp(to, 0.5) + vec3(0.0, 0.0, 0.04);
        model.add(bark, Shape::tapered_tube(&[(from, 0.012), (bend, 0.009), (to, 0.003)], 6));
    }
    model.asset("debris/branch", Kind::Debris, Class::Void).tagged(["branch"])
}
