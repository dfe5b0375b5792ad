//! Men, women and children, workers and police officers.

use glam::{Quat, Vec3, vec2, vec3};
use trove_model::{Asset, Kind, Material};

use super::{Figure, Hair, Leg, Outfit, Physique, Pose, Sleeve, Wardrobe};
use crate::shape::{Model, Prism, Shape};

/// Everyone on foot.
pub(crate) fn assets() -> Vec<Asset> {
    let man = Physique::MAN;
    let tall = Physique { height_m: 1.86, girth: 1.12, ..man };
    let stout = Physique { height_m: 1.73, girth: 1.28, ..man };
    let woman = Physique::WOMAN;
    let small = Physique { height_m: 1.58, ..woman };
    let child = Physique::CHILD;
    let teen = Physique { height_m: 1.45, head: 0.98, ..child };
    let casual = Outfit::CASUAL;
    let jacket = Outfit::JACKET;
    let shorts = Outfit { leg: Leg::Shorts, ..casual };
    let long = Outfit { hair: Hair::Long, ..casual };
    let dress = Outfit { leg: Leg::Skirt, hair: Hair::Bun, sleeve: Sleeve::None, ..casual };
    let coat = Outfit { hair: Hair::Tail, hem: 0.1, ..jacket };
    let adult = |id, body, pose, outfit, extra| person(id, Kind::Adult, body, pose, outfit, extra);
    let young = |id, body, pose, outfit| person(id, Kind::Child, body, pose, outfit, Extra::None);
    [
        adult("person/man-standing", man, Pose::standing(&man), casual, Extra::None),
        adult("person/man-walking", man, Pose::walking(&man, 0.4, true), casual, Extra::None),
        adult("person/man-walking-backpack", tall, Pose::walking(&tall, 0.36, false), jacket, Extra::Backpack),
        adult("person/man-jacket", tall, Pose::walking(&tall, 0.42, true), jacket, Extra::None),
        adult("person/man-shorts", stout, Pose::walking(&stout, 0.34, false), shorts, Extra::None),
        adult("person/man-stout-standing", stout, Pose::standing(&stout), jacket, Extra::None),
        adult("person/woman-standing", woman, Pose::standing(&woman), long, Extra::ShoulderBag),
        adult("person/woman-walking", woman, Pose::walking(&woman, 0.38, false), long, Extra::None),
        adult("person/woman-dress", small, Pose::walking(&small, 0.26, true), dress, Extra::ShoulderBag),
        adult("person/woman-coat", woman, Pose::walking(&woman, 0.4, true), coat, Extra::ShoulderBag),
        adult("person/woman-small", small, Pose::standing(&small), coat, Extra::Backpack),
        young("person/child-walking", child, Pose::walking(&child, 0.36, true), shorts),
        young("person/child-standing", teen, Pose::standing(&teen), long),
        person("person/child-schoolbag", Kind::Child, teen, Pose::walking(&teen, 0.34, false), casual, Extra::Backpack),
        person(
            "person/worker-standing",
            Kind::ConstructionWorker,
            man,
            Pose::standing(&man),
            jacket,
            Extra::HighVisibility,
        ),
        person(
            "person/worker-walking",
            Kind::ConstructionWorker,
            stout,
            Pose::walking(&stout, 0.36, true),
            jacket,
            Extra::HighVisibility,
        ),
        person(
            "person/police-officer",
            Kind::PoliceOfficer,
            tall,
            Pose::standing(&tall),
            Outfit { hem: 0.0, ..jacket },
            Extra::Police,
        ),
        person(
            "person/police-officer-walking",
            Kind::PoliceOfficer,
            woman,
            Pose::walking(&woman, 0.36, true),
            Outfit { hair: Hair::Tail, hem: 0.0, ..jacket },
            Extra::Police,
        ),
    ]
    .concat()
}

/// What someone has besides clothes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Extra {
    None,
    Backpack,
    ShoulderBag,
    /// Vest and helmet.
    HighVisibility,
    /// Cap, belt and badge.
    Police,
}

const NAVY: Vec3 = vec3(0.012, 0.018, 0.045);

/// Someone in an outfit, and in a warmer one where it is light.
fn person(id: &str, kind: Kind, body: Physique, pose: Pose, outfit: Outfit, extra: Extra) -> Vec<Asset> {
    outfit.in_all_weathers(id, |id, outfit| figure(id, kind, body, pose, outfit, extra))
}

fn figure(id: &str, kind: Kind, body: Physique, pose: Pose, outfit: &Outfit, extra: Extra) -> Asset {
    let figure = Figure::new(body, pose);
    let mut model = Model::default();
    let (tops, bottoms): (&[Vec3], &[Vec3]) = match extra {
        Extra::Police => (&[NAVY], &[NAVY]),
        Extra::HighVisibility => (&[vec3(0.75, 0.2, 0.01), vec3(0.5, 0.68, 0.02)], &[]),
        _ => (&[], &[]),
    };
    let slots = Wardrobe::new(&mut model, tops, bottoms);
    model.add_marked(figure.dressed(outfit, &slots));
    model.shows(figure.keypoints());
    let h = body.height_m;
    match extra {
        Extra::None => {}
        Extra::Backpack => {
            let paints =
                [vec3(0.015, 0.015, 0.017), vec3(0.02, 0.035, 0.09), vec3(0.25, 0.03, 0.03), vec3(0.06, 0.08, 0.05)];
            let cloth = model.slot(Material::plain("backpack", paints[0], 0.8), &paints);
            let bag = Shape::rounded_block(vec3(0.095, 0.165, 0.26) * h, 0.035 * h);
            model.add(cloth, bag.turned(figure.trunk()).moved(figure.at_trunk(-0.125, 0.0, 0.17)));
            let pocket = Shape::rounded_block(vec3(0.03, 0.12, 0.11) * h, 0.012 * h);
            model.add(cloth, pocket.turned(figure.trunk()).moved(figure.at_trunk(-0.18, 0.0, 0.11)));
            for side in [1.0, -1.0] {
                let strap = [
                    (-0.09, 0.075, 0.29),
                    (-0.01, 0.075, 0.325),
                    (0.05, 0.074, 0.29),
                    (0.078, 0.08, 0.23),
                    (0.05, 0.1, 0.14),
                    (-0.07, 0.09, 0.09),
                ];
                let path: Vec<Vec3> = strap.iter().map(|&(x, y, z)| figure.at_trunk(x, side * y, z)).collect();
                model.add(cloth, Shape::tube(&path, 0.011 * h, 6));
            }
        }
        Extra::ShoulderBag => {
            let paints =
                [vec3(0.02, 0.015, 0.012), vec3(0.2, 0.09, 0.035), vec3(0.4, 0.32, 0.24), vec3(0.015, 0.015, 0.017)];
            let leather = model.slot(Material::plain("bag", paints[0], 0.5), &paints);
            let side = body.shoulder + 0.075;
            let bag =
                Shape::rounded_block(vec3(0.17, 0.05, 0.13) * h, 0.02 * h).moved(figure.at_trunk(-0.01, side, 0.0));
            model.add(leather, bag);
            let strap = [(0.05, side, 0.05), (0.02, side * 0.8, 0.31), (-0.02, side * 0.8, 0.315), (-0.07, side, 0.05)];
            let path: Vec<Vec3> = strap.iter().map(|&(x, y, z)| figure.at_trunk(x, y, z)).collect();
            model.add(leather, Shape::tube(&path, 0.006 * h, 6));
        }
        Extra::HighVisibility => {
            let silver = model.slot(Material::plain("reflective band", Vec3::splat(0.72), 0.35), &[]);
            let yellow = model.slot(
                Material { coat: 0.6, ..Material::plain("helmet", vec3(0.72, 0.5, 0.02), 0.4) },
                &[vec3(0.72, 0.5, 0.02), vec3(0.74, 0.74, 0.72), vec3(0.7, 0.2, 0.01)],
            );
            for (low, high) in [(0.09, 0.115), (0.19, 0.215)] {
                let band = Prism::between(figure.at_trunk(-1.0, -1.0, low), figure.at_trunk(1.0, 1.0, high));
                model.mark(&band, slots.top, silver);
            }
            let brace = |z: [f32; 2]| {
                [vec2(0.045 * h, z[0]), vec2(0.065 * h, z[0]), vec2(0.065 * h, z[1]), vec2(0.045 * h, z[1])]
            };
            let heights = [figure.at_trunk(0.0, 0.0, 0.215).z, figure.at_trunk(0.0, 0.0, 0.4).z];
            model.mark_both(&Prism::front(&brace(heights), -1.0..=1.0), slots.top, silver);
            model.add_marked(helmet(&figure, yellow));
        }
        Extra::Police => {
            let cap = Shape::lathe(
                &[
                    vec2(0.098, 0.0),
                    vec2(0.1, 0.035),
                    vec2(0.135, 0.06),
                    vec2(0.125, 0.075),
                    vec2(0.06, 0.085),
                    vec2(0.0, 0.085),
                ],
                20,
            );
            let visor = Shape::ellipsoid(vec3(0.09, 0.085, 0.012), 16).moved(vec3(0.06, 0.0, 0.0));
            let cap =
                Shape::join([cap, visor]).turned(Quat::from_rotation_y(0.1)).moved(figure.head + vec3(0.0, 0.0, 0.07));
            model.add(slots.dark, cap);
            let metal = model.slot(Material { metalness: 1.0, ..Material::plain("badge", Vec3::splat(0.6), 0.3) }, &[]);
            model.add(
                metal,
                Shape::rounded_block(vec3(0.01, 0.04, 0.05), 0.004).moved(figure.at_trunk(0.078, 0.045, 0.24)),
            );
            model.add(
                metal,
                Shape::rounded_block(vec3(0.012, 0.03, 0.035), 0.004).moved(figure.head + vec3(0.1, 0.0, 0.1)),
            );
            let belt = Prism::between(figure.at_trunk(-1.0, -1.0, 0.03), figure.at_trunk(1.0, 1.0, 0.055));
            model.mark(&belt, slots.top, slots.dark);
            let holster = Shape::rounded_block(vec3(0.06, 0.05, 0.15), 0.02);
            model.add(slots.dark, holster.moved(figure.at_trunk(0.0, -0.105, -0.01)));
        }
    }
    model.asset(id, kind, kind.class())
}

/// A hard hat.
fn helmet(figure: &Figure, slot: u16) -> Shape {
    let shell =
        [vec2(0.14, 0.0), vec2(0.128, 0.012), vec2(0.122, 0.05), vec2(0.1, 0.1), vec2(0.055, 0.128), vec2(0.0, 0.136)];
    let shell = Shape::lathe(&shell, 20).scaled(vec3(1.08, 0.92, 1.0));
    let rim = Shape::lathe(&[vec2(0.0, 0.0), vec2(0.14, 0.0)], 20).scaled(vec3(1.08, 0.92, 1.0)).inside_out();
    let peak = Shape::ellipsoid(vec3(0.08, 0.08, 0.01), 14).moved(vec3(0.1, 0.0, 0.003));
    Shape::join([shell, rim, peak]).moved(figure.head + vec3(-0.005, 0.0, 0.04)).slot(slot)
}
