//! Street lamps and utility poles; a lamp's arm reaches along x.

use std::sync::Arc;

use glam::{Quat, Vec2, Vec3, vec2, vec3};
use trove_model::{Asset, Class, Kind, Luminaire, Material, Role};

use super::finish::{
    bar, board, concrete, foot_plate, galvanised, glass, grey_timber, mast_of, painted, post, rubber, rust_at_foot,
};
use crate::shape::{Model, Shape};

const LUMINAIRES: &str = include_str!("../../plans/luminaires/luminaires.tsv");
const TABLES: [(&str, &str); 2] = [
    ("road", include_str!("../../plans/luminaires/road.ies")),
    ("lantern", include_str!("../../plans/luminaires/lantern.ies")),
];

pub(super) fn assets() -> Vec<Asset> {
    vec![curved(), straight(), cobra(), mast(), post_top(), historic(), wooden_pole(), concrete_pole()]
}

fn lamp(model: Model, name: &str) -> Asset {
    let asset = model.asset(&format!("lamp/{name}"), Kind::StreetLamp, Class::TrafficSign).tagged([name]);
    Asset { luminaire: luminaire(name).map(Arc::new), ..asset }
}

/// How a lamp of this name shines.
fn luminaire(name: &str) -> Option<Luminaire> {
    let mut cells = LUMINAIRES.lines().map(|line| line.split('\t')).find(|cells| cells.clone().next() == Some(name))?;
    let table = cells.nth(1)?;
    let (_, ies) = TABLES.into_iter().find(|(known, _)| *known == table)?;
    let mut number = || cells.next()?.parse().ok();
    Some(Luminaire { lumens: number()?, kelvin: number()?, ..Luminaire::from_ies(ies).ok()? })
}

fn lens() -> Material {
    Material { role: Some(Role::StreetLamp), ..Material::plain("lamp lens", vec3(0.62, 0.62, 0.58), 0.15) }
}

/// A straight pole with a bow beside it that swings out into the arm.
fn curved() -> Asset {
    let mut model = Model::default();
    let steel = model.slot(galvanised(), &[]);
    let head = model.slot(painted(Vec3::splat(0.25)), &[]);
    let lens = model.slot(lens(), &[]);
    model.add(steel, mast_of([0.1, 0.065], 8.0));
    foot_plate(&mut model, steel, 0.36);
    model.add(steel, bar(vec3(0.1, 0.0, 0.8), vec3(0.02, 0.12, 0.5)));
    // The bow leaves the pole, bends away behind it and comes over the top.
    let path: Vec<Vec3> = (0..=18)
        .map(|i| {
            let t = i as f32 / 18.0;
            let angle = -0.35 + t * 2.55;
            vec3(1.0 - 1.75 * angle.cos() + 0.55 * t * t, 0.0, 6.3 + 2.1 * angle.sin() + 0.45 * t)
        })
        .collect();
    let start = path[0];
    model.add(steel, Shape::tube(&path, 0.038, 10));
    model.add(steel, Shape::tube(&[vec3(0.0, 0.0, start.z - 0.9), start], 0.035, 10));
    let end = path[path.len() - 1];
    let tilt = Quat::from_rotation_y(0.12);
    model.add(head, Shape::ellipsoid(vec3(0.42, 0.15, 0.09), 20).moved(vec3(0.36, 0.0, 0.0)).turned(tilt).moved(end));
    model.add(lens, Shape::ellipsoid(vec3(0.26, 0.12, 0.07), 16).moved(vec3(0.42, 0.0, -0.04)).turned(tilt).moved(end));
    rust_at_foot(&mut model, steel, 0.12);
    lamp(model, "curved")
}

/// A slim modern lamp with a flat head.
fn straight() -> Asset {
    let mut model = Model::default();
    let grey = vec3(0.12, 0.125, 0.13);
    let paint = model.slot(painted(grey), &[grey, Vec3::splat(0.3), Vec3::splat(0.04)]);
    let lens = model.slot(lens(), &[]);
    model.add(paint, mast_of([0.085, 0.05], 8.0));
    foot_plate(&mut model, paint, 0.32);
    model.add(paint, Shape::tapered_tube(&[(vec3(0.0, 0.0, 7.95), 0.035), (vec3(1.4, 0.0, 8.15), 0.03)], 10));
    let turn = Quat::from_rotation_y(-0.12);
    model.add(paint, bar(Vec3::ZERO, vec3(0.66, 0.26, 0.07)).turned(turn).moved(vec3(1.65, 0.0, 8.18)));
    model.add(lens, bar(vec3(0.04, 0.0, -0.034), vec3(0.46, 0.2, 0.012)).turned(turn).moved(vec3(1.65, 0.0, 8.18)));
    lamp(model, "straight")
}

/// An aluminium pole with a truss arm and a flat oval head, as along American streets.
fn cobra() -> Asset {
    let mut model = Model::default();
    let steel = model.slot(galvanised(), &[]);
    let head = model.slot(painted(Vec3::splat(0.3)), &[]);
    let lens = model.slot(lens(), &[]);
    model.add(steel, mast_of([0.11, 0.065], 8.8));
    foot_plate(&mut model, steel, 0.4);
    model.add(steel, bar(vec3(-0.1, 0.0, 0.6), vec3(0.02, 0.12, 0.3)));
    let upper = |t: f32| vec3(2.4 * t, 0.0, 8.7 + 0.55 * (t * 1.4).sin());
    let lower = |t: f32| vec3(2.4 * t, 0.0, 8.1 + 1.14 * (t * 1.57).sin() - 0.1 * t);
    for side in [&upper as &dyn Fn(f32) -> Vec3, &lower] {
        let path: Vec<Vec3> = (0..=8).map(|i| side(i as f32 / 8.0)).collect();
        model.add(steel, Shape::tube(&path, 0.026, 9));
    }
    for t in [0.3, 0.55] {
        model.add(steel, Shape::tube(&[upper(t), lower(t)], 0.015, 6));
    }
    let end = upper(1.0);
    model.add(head, Shape::ellipsoid(vec3(0.4, 0.17, 0.1), 20).moved(end + vec3(0.3, 0.0, -0.01)));
    model.add(lens, Shape::ellipsoid(vec3(0.22, 0.14, 0.09), 16).moved(end + vec3(0.36, 0.0, -0.05)));
    lamp(model, "cobra")
}

/// A tall tapered mast with a long bare arm, as over wide roads.
fn mast() -> Asset {
    let mut model = Model::default();
    let steel = model.slot(galvanised(), &[]);
    let head = model.slot(painted(Vec3::splat(0.35)), &[]);
    let lens = model.slot(lens(), &[]);
    model.add(steel, mast_of([0.12, 0.06], 10.0));
    foot_plate(&mut model, steel, 0.4);
    model.add(steel, bar(vec3(0.105, 0.0, 0.75), vec3(0.02, 0.13, 0.5)));
    let arm = |t: f32| vec3(2.0 * t, 0.0, 9.9 + 0.35 * t);
    model.add(steel, Shape::tapered_tube(&[(arm(0.0), 0.045), (arm(1.0), 0.03)], 10));
    model.add(head, bar(arm(1.0) + vec3(0.25, 0.0, 0.02), vec3(0.62, 0.3, 0.09)));
    model.add(lens, bar(arm(1.0) + vec3(0.28, 0.0, -0.03), vec3(0.45, 0.24, 0.015)));
    rust_at_foot(&mut model, steel, 0.14);
    lamp(model, "mast")
}

/// A low post with its light on top, as in side streets and parks.
fn post_top() -> Asset {
    let mut model = Model::default();
    let grey = vec3(0.09, 0.095, 0.1);
    let paint = model.slot(painted(grey), &[grey, Vec3::splat(0.03), vec3(0.02, 0.05, 0.035)]);
    let lens = model.slot(lens(), &[]);
    model.add(
        paint,
        Shape::tapered_tube(
            &[(Vec3::ZERO, 0.07), (Vec3::Z * 1.1, 0.07), (Vec3::Z * 1.15, 0.045), (Vec3::Z * 4.6, 0.04)],
            14,
        ),
    );
    model.add(paint, bar(vec3(0.07, 0.0, 0.6), vec3(0.012, 0.08, 0.4)));
    let bowl = [(0.06, 4.6), (0.2, 4.68), (0.24, 4.95), (0.0, 4.95)];
    model.add(lens, Shape::lathe(&bowl.map(|(r, z)| vec2(r, z)), 20));
    let cap = [(0.0, 4.95), (0.36, 4.95), (0.34, 5.0), (0.12, 5.12), (0.0, 5.14)];
    model.add(paint, Shape::lathe(&cap.map(|(r, z)| vec2(r, z)), 24));
    lamp(model, "post-top")
}

/// A cast-iron post with a lantern.
fn historic() -> Asset {
    let mut model = Model::default();
    let iron = model.slot(painted(vec3(0.018, 0.025, 0.02)), &[]);
    let pane = model.slot(glass(), &[]);
    let bulb = model.slot(lens(), &[]);
    let profile = [
        (0.0, 0.0),
        (0.19, 0.0),
        (0.19, 0.18),
        (0.15, 0.22),
        (0.13, 0.75),
        (0.15, 0.8),
        (0.09, 0.9),
        (0.065, 1.1),
        (0.05, 2.9),
        (0.08, 2.95),
        (0.05, 3.02),
        (0.045, 3.3),
        (0.1, 3.38),
        (0.0, 3.4),
    ];
    model.add(iron, Shape::lathe(&profile.map(|(r, z)| vec2(r, z)), 20));
    model.add(iron, Shape::tube(&[vec3(-0.3, 0.0, 2.95), vec3(0.3, 0.0, 2.95)], 0.018, 8));
    for x in [-0.3, 0.3] {
        model.add(iron, Shape::ellipsoid(Vec3::splat(0.032), 10).moved(vec3(x, 0.0, 2.95)));
    }
    // Four sloping panes between bars, a roof with a finial.
    let corner = |k: usize, z: f32| {
        let half = if z > 3.6 { 0.2 } else { 0.12 };
        let (x, y) = [(1.0, 1.0), (-1.0, 1.0), (-1.0, -1.0), (1.0, -1.0)][k % 4];
        vec3(x * half, y * half, z)
    };
    for k in 0..4 {
        let (a, b) = (corner(k, 3.4), corner(k, 3.9));
        model.add(iron, Shape::tube(&[a, b], 0.014, 6));
        model.add(iron, Shape::tube(&[b, corner(k + 1, 3.9)], 0.014, 6));
        model.add(iron, Shape::tube(&[a, corner(k + 1, 3.4)], 0.014, 6));
        let rows = [vec![a, corner(k + 1, 3.4)], vec![b, corner(k + 1, 3.9)]];
        model.add(pane, Shape::sheet(&rows));
    }
    let roof =
        [(0.29, 3.9), (0.29, 3.92), (0.14, 4.08), (0.1, 4.1), (0.1, 4.16), (0.03, 4.22), (0.03, 4.3), (0.0, 4.36)];
    model.add(iron, Shape::lathe(&roof.map(|(r, z)| vec2(r, z)), 16));
    model.add(bulb, Shape::ellipsoid(vec3(0.06, 0.06, 0.11), 14).moved(vec3(0.0, 0.0, 3.62)));
    lamp(model, "historic")
}

/// What wires hang on.
fn insulator(material: Material) -> Material {
    Material { name: "insulator".into(), role: Some(Role::Insulator), ..material }
}

fn pole(model: Model, name: &str) -> Asset {
    model.asset(&format!("utility-pole/{name}"), Kind::UtilityPole, Class::TrafficSign).tagged([name])
}

/// A timber pole with cross arms, insulators and a transformer.
fn wooden_pole() -> Asset {
    let mut model = Model::default();
    let wood = model.slot(grey_timber(), &[]);
    let steel = model.slot(galvanised(), &[]);
    let clay = model.slot(insulator(painted(vec3(0.14, 0.06, 0.035))), &[]);
    model.add(wood, mast_of([0.16, 0.1], 10.0).laid(Vec3::Z, Vec2::ZERO));
    for z in [9.6, 8.7] {
        model.add(wood, board(vec3(0.12, 0.0, z), vec3(0.1, 2.3, 0.12)));
        for y in [-1.05, -0.6, 0.6, 1.05] {
            let insulator = [(0.0, 0.0), (0.03, 0.0), (0.05, 0.05), (0.03, 0.09), (0.045, 0.12), (0.0, 0.16)];
            let shape = Shape::lathe(&insulator.map(|(r, z)| vec2(r, z)), 10);
            model.add(clay, shape.moved(vec3(0.12, y, z + 0.06)));
        }
        for y in [-0.55, 0.55] {
            model.add(steel, Shape::tube(&[vec3(0.15, y, z - 0.06), vec3(0.14, 0.0, z - 0.55)], 0.014, 6));
        }
    }
    model.add(steel, post(vec3(-0.34, 0.0, 7.2), 0.22, 0.8, 18));
    model.add(steel, bar(vec3(-0.14, 0.0, 7.6), vec3(0.1, 0.14, 0.5)));
    pole(model, "timber")
}

/// A concrete pole with a cable clamp and a box.
fn concrete_pole() -> Asset {
    let mut model = Model::default();
    let body = model.slot(concrete(), &[]);
    let steel = model.slot(galvanised(), &[]);
    let black = model.slot(insulator(rubber()), &[]);
    model.add(body, mast_of([0.17, 0.1], 9.0));
    for z in [8.3, 8.7] {
        model.add(steel, post(vec3(0.0, 0.0, z), 0.125, 0.05, 16));
        for y in [-0.2, 0.2] {
            model.add(black, Shape::ellipsoid(vec3(0.04, 0.09, 0.04), 10).moved(vec3(0.0, y, z)));
        }
    }
    model.add(steel, bar(vec3(0.24, 0.0, 2.2), vec3(0.2, 0.34, 0.5)));
    model.add(steel, Shape::tube(&[vec3(0.2, 0.0, 2.4), vec3(0.14, 0.0, 8.3)], 0.02, 6));
    pole(model, "concrete")
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Into an angle from the kerb line towards the road and one from the nadir.
    fn toward(street_deg: f32, gamma_deg: f32) -> Vec3 {
        let (s, g) = (street_deg.to_radians(), gamma_deg.to_radians());
        vec3(s.sin() * g.sin(), s.cos() * g.sin(), -g.cos())
    }

    /// Whatever the table, per 1000 lm, it is what its file says that it is computed by.
    fn is_as_computed(name: &str, computed: impl Fn(f32, f32) -> f32) {
        let Luminaire { intensity, .. } = luminaire(name).unwrap();
        assert!((intensity.flux() / 1000.0 - 1.0).abs() < 0.01, "{name}: {} lm", intensity.flux());
        let unit = intensity.share(Vec3::NEG_Z) / computed(0.0, 0.0);
        for street_deg in (-90..=90).step_by(15).map(|s| s as f32) {
            for gamma_deg in (5..180).step_by(5).map(|g| g as f32) {
                let expected = unit * computed(street_deg, gamma_deg);
                for side in [Vec3::ONE, vec3(1.0, -1.0, 1.0)] {
                    let found = intensity.share(toward(street_deg, gamma_deg) * side);
                    assert!((found - expected).abs() < 0.3, "{name}, {street_deg}°, {gamma_deg}°: {found} {expected}");
                }
            }
        }
    }

    #[test]
    fn the_built_in_tables_are_what_they_say() {
        let cut = |gamma_deg: f32, from_deg: f32, to_deg: f32| {
            let way = ((gamma_deg - from_deg) / (to_deg - from_deg)).clamp(0.0, 1.0);
            (way * std::f32::consts::FRAC_PI_2).cos().powi(2)
        };
        is_as_computed("straight", |street_deg, gamma_deg| {
            let behind = street_deg.min(0.0).to_radians().sin().powi(2);
            let most = (1.0 - 0.7 * behind) * (1.0 + 2.5 * (-((street_deg - 15.0) / 30.0).powi(2)).exp());
            let lobe = (-((gamma_deg - 66.0) / 22.0).powi(2)).exp();
            (1.0 + (most - 1.0) * lobe) * cut(gamma_deg, 72.0, 88.0)
        });
        is_as_computed("historic", |_, gamma_deg| {
            (0.4 + 0.6 * gamma_deg.to_radians().sin().powi(2)) * cut(gamma_deg, 80.0, 150.0)
        });
    }

    #[test]
    fn road_lamps_throw_their_light_along_the_road_and_none_above_the_horizon() {
        for name in ["cobra", "curved", "straight", "mast"] {
            let Luminaire { intensity, lumens, .. } = luminaire(name).unwrap();
            let at = |street_deg: f32, gamma_deg: f32| intensity.share(toward(street_deg, gamma_deg));
            let brightest = (0..90).max_by(|&a, &b| at(15.0, a as f32).total_cmp(&at(15.0, b as f32))).unwrap();
            assert!((60..=72).contains(&brightest), "{name}: {brightest}°");
            assert!(at(15.0, 66.0) > 2.0 * at(90.0, 66.0) && at(90.0, 66.0) > 2.0 * at(-90.0, 66.0), "{name}");
            assert_eq!((at(15.0, 90.0), at(15.0, 120.0)), (0.0, 0.0), "{name}");
            assert!((5000.0..20_000.0).contains(&lumens), "{name}: {lumens}");
        }
    }

    #[test]
    fn every_built_in_lamp_has_its_luminaire() {
        for asset in assets() {
            assert_eq!(asset.luminaire.is_some(), asset.kind == Kind::StreetLamp, "{}", asset.id);
        }
    }
}
