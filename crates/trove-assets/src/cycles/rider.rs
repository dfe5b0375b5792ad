//! Who rides.

use glam::{Quat, Vec3, vec2, vec3};
use trove_model::Material;

use super::parts::Parts;
use crate::people::{Figure, Outfit, Physique, Pose, Wardrobe};
use crate::shape::{Blend, Limb, Model, Prism, Shape, rect};

/// What is on the head.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Helmet {
    None,
    /// A cyclist's, with slots for air.
    Open,
    /// A rider's that leaves the face free.
    Jet,
    /// A rider's with a visor.
    Full,
}

/// Someone on a cycle.
#[derive(Clone, Copy, Debug)]
pub(super) struct Rider {
    pub(super) body: Physique,
    pub(super) pose: Pose,
    pub(super) outfit: Outfit,
    pub(super) helmet: Helmet,
    /// A cube for meals on the back.
    pub(super) bag: bool,
}

const HELMETS: [Vec3; 6] = [
    vec3(0.02, 0.02, 0.022),
    vec3(0.02, 0.02, 0.022),
    vec3(0.7, 0.7, 0.69),
    vec3(0.4, 0.02, 0.02),
    vec3(0.03, 0.1, 0.3),
    vec3(0.55, 0.5, 0.04),
];

impl Rider {
    /// Adds the person to a model.
    pub(super) fn sit(&self, model: &mut Model, parts: &Parts) {
        let slots = Wardrobe::new(model, &[], &[]);
        let figure = Figure::new(self.body, self.pose);
        model.add_marked(figure.dressed(&self.outfit, &slots));
        model.shows(figure.keypoints());
        let lean = Quat::from_rotation_y(self.pose.lean_rad * 0.25);
        let place = |s: Shape| s.turned(lean).moved(figure.head);
        if self.helmet != Helmet::None {
            let shell = model.slot(Material { coat: 1.0, ..Material::plain("helmet", HELMETS[0], 0.35) }, &HELMETS);
            let helmet = match self.helmet {
                Helmet::Open => open(parts, shell),
                Helmet::Jet => jet(parts, shell),
                _ => full(parts, shell),
            };
            model.add_marked(place(helmet));
        }
        if self.bag {
            let trunk = figure.trunk();
            let cube = Shape::rounded_block(vec3(0.36, 0.42, 0.44), 0.04).moved(vec3(-0.3, 0.0, 0.42));
            let cube = cube.slot(parts.case).mark(&Prism::top(&rect(-2.0, 2.0, -2.0, 2.0), 0.56..=0.575), parts.black);
            let straps = [0.11, -0.11].map(|y| {
                Shape::tube(
                    &[vec3(-0.12, y, 0.56), vec3(0.0, y, 0.56), vec3(0.125, y * 0.9, 0.4), vec3(0.0, y * 1.5, 0.22)],
                    0.016,
                    6,
                )
            });
            let strip = Shape::block(vec3(0.004, 0.3, 0.03)).moved(vec3(-0.482, 0.0, 0.36)).slot(parts.lamp);
            let bag = Shape::join([cube, Shape::join(straps).slot(parts.black), strip]);
            model.add_marked(bag.turned(trunk).moved(self.pose.hips));
        }
    }
}

/// Ridges over a shell with dark slots between.
fn open(parts: &Parts, shell: u16) -> Shape {
    let dome = Limb::new(vec3(-0.045, 0.0, 0.055), vec3(0.025, 0.0, 0.06), 0.098, 0.088).wide(Vec3::Y, 0.95);
    let tail = Limb::new(vec3(-0.1, 0.0, 0.05), vec3(-0.13, 0.0, 0.04), 0.06, 0.04);
    let mut body = Blend::new(vec![dome, tail], 0.04);
    body.floor_m = 0.045;
    let mut helmet = body.surface(0.028).slot(shell);
    for (y, half) in [(0.0, 0.013), (0.04, 0.011), (-0.04, 0.011), (0.075, 0.009), (-0.075, 0.009)] {
        for x in [-0.1, 0.005] {
            let slot = [
                vec2(x, y - half),
                vec2(x + 0.075, y - half),
                vec2(x + 0.085, y),
                vec2(x + 0.075, y + half),
                vec2(x, y + half),
            ];
            helmet = helmet.mark(&Prism::top(&slot, 0.07..=0.3), parts.black);
        }
    }
    let strap = [vec3(0.02, 0.078, 0.04), vec3(0.015, 0.07, -0.05), vec3(0.04, 0.0, -0.1)];
    let straps = Shape::tube(&strap, 0.005, 4).both_sides();
    helmet.and(straps.slot(parts.black))
}

/// A round shell with a peak, cut away in front of the face.
fn jet(parts: &Parts, shell: u16) -> Shape {
    let round = Shape::ellipsoid(vec3(0.142, 0.125, 0.145), 20).moved(vec3(-0.008, 0.0, 0.025));
    let face = Prism::front(&rect(-0.085, 0.085, -0.3, 0.052), 0.02..=0.4);
    let below = Prism::top(&rect(-1.0, 1.0, -1.0, 1.0), -1.0..=-0.075);
    let peak =
        Shape::ellipsoid(vec3(0.07, 0.1, 0.008), 16).turned(Quat::from_rotation_y(0.12)).moved(vec3(0.12, 0.0, 0.06));
    let visor = Shape::ellipsoid(vec3(0.15, 0.128, 0.12), 20).moved(vec3(-0.006, 0.0, 0.01));
    let (visor, _) = visor.split(&Prism::front(&rect(-0.1, 0.1, -0.06, 0.06), 0.05..=0.4));
    Shape::join([round.without(&face).without(&below).slot(shell), peak.slot(parts.black), visor.slot(parts.glass)])
}

/// A closed shell with a chin and a dark visor.
fn full(parts: &Parts, shell: u16) -> Shape {
    let limbs = vec![
        Limb::new(vec3(-0.025, 0.0, 0.04), vec3(0.01, 0.0, 0.045), 0.125, 0.12).wide(Vec3::Y, 1.0),
        Limb::new(vec3(0.0, 0.0, -0.05), vec3(0.07, 0.0, -0.06), 0.1, 0.075).wide(Vec3::Y, 1.08),
    ];
    let mut body = Blend::new(limbs, 0.05);
    body.floor_m = -0.125;
    let helmet = body.surface(0.03).slot(shell);
    let visor =
        [vec2(-0.12, 0.0), vec2(0.12, 0.0), vec2(0.12, 0.06), vec2(0.06, 0.085), vec2(-0.06, 0.085), vec2(-0.12, 0.06)];
    let helmet = helmet.mark(&Prism::front(&visor, 0.02..=0.4), parts.visor);
    let vent = rect(-0.03, 0.03, -0.085, -0.065);
    helmet.mark(&Prism::front(&vent, 0.05..=0.4), parts.black)
}
