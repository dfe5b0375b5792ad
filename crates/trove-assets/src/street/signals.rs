//! Traffic signals: heads that look along x at the traffic that comes, on poles and arms, and for those who cross the
//! road beside them a head that looks over it.

use std::f32::consts::{FRAC_PI_2, PI};

use glam::{Quat, Vec2, Vec3, vec2, vec3};
use serde::Deserialize;
use trove_model::{Asset, Class, Kind, Material};

use super::finish::{bar, foot_plate, galvanised, mast_of, painted, plastic, polygon, post, rust_at_foot, upright};
use crate::measure::{Wrong, within};
use crate::shape::{Model, Shape};

/// How a signal is built: a `[[signal]]` of a file of plans.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct SignalPlan {
    /// Unique in its library, and what the ids of its models begin with.
    pub(crate) id: String,
    /// Words that say what it is.
    #[serde(default)]
    tags: Vec<String>,
    /// Reach of its arm, metres; 0 for heads on the pole alone.
    #[serde(default)]
    arm_m: f32,
    /// Heads lie along the arm, as in eastern Asia.
    #[serde(default)]
    is_lying: bool,
    /// A board behind every head.
    #[serde(default)]
    has_boards: bool,
    /// The head for pedestrians shows a hand, as in America.
    #[serde(default)]
    shows_hand: bool,
}

impl SignalPlan {
    /// The key of a value that no signal can have, with what was expected and what it is.
    pub(crate) fn check(&self) -> Result<(), Wrong> {
        if self.arm_m == 0.0 { Ok(()) } else { within("arm_m", "metres from 1 to 20, or 0", 1.0..=20.0, [&self.arm_m]) }
    }
}

/// All signals for both sides of traffic, with the traffic's lamp red or green: `signal/us-arm/right/red`. An arm reaches
/// to the middle of the road: towards −y where traffic keeps right.
pub(super) fn assets(signals: &[SignalPlan]) -> Vec<Asset> {
    let each = |plan: &SignalPlan| {
        [("right", 1.0), ("left", -1.0)].map(|(name, side)| {
            [Lamp::Red, Lamp::Green].map(|lit| {
                let state = if lit == Lamp::Red { "red" } else { "green" };
                let asset = signal(&format!("{}/{name}/{state}", plan.id), plan, side, lit);
                asset.tagged(&plan.tags).tagged([name, state])
            })
        })
    };
    signals.iter().flat_map(each).flatten().collect()
}

#[derive(Clone, Copy, PartialEq)]
enum Lamp {
    Red,
    Amber,
    Green,
}

impl Lamp {
    fn color(self) -> Vec3 {
        match self {
            Self::Red => vec3(0.6, 0.02, 0.012),
            Self::Amber => vec3(0.6, 0.27, 0.01),
            Self::Green => vec3(0.01, 0.45, 0.28),
        }
    }

    fn material(self, lit: bool) -> Material {
        lamp(self.color(), lit)
    }
}

/// A lit signal outshines a sunlit white wall about twofold.
fn lamp(color: Vec3, lit: bool) -> Material {
    if lit {
        Material { emission: color * 4.0, ..plastic(color) }
    } else {
        Material::plain("unlit lamp", color * 0.12 + 0.012, 0.2)
    }
}

struct Slots {
    black: u16,
    lamps: [u16; 3],
    rim: u16,
}

impl Slots {
    fn new(model: &mut Model, lit: Lamp) -> Self {
        let black = model.slot(painted(Vec3::splat(0.022)), &[]);
        let rim = model.slot(painted(vec3(0.5, 0.5, 0.48)), &[]);
        let lamps = [Lamp::Red, Lamp::Amber, Lamp::Green].map(|lamp| model.slot(lamp.material(lamp == lit), &[]));
        Self { black, lamps, rim }
    }
}

/// How a head is built.
#[derive(Clone, Copy)]
struct Head {
    is_lying: bool,
    has_board: bool,
}

/// Three lamps under hoods, the middle one at a point: the red one on top, or towards `-side` where they lie.
fn head(model: &mut Model, slots: &Slots, make: Head, side: f32, at: Vec3) {
    // The body stands, or lies with its top to the side where red is.
    let lay = |shape: Shape| {
        if make.is_lying { shape.turned(Quat::from_rotation_x(side * FRAC_PI_2)) } else { shape }
    };
    if make.has_board {
        let board = upright(Shape::extruded(&super::finish::rounded(vec2(0.62, 1.32), 0.08), 0.012));
        let rim = upright(Shape::extruded(&super::finish::rounded(vec2(0.66, 1.36), 0.1), 0.006));
        model.add(slots.rim, lay(rim).moved(at + vec3(-0.012, 0.0, 0.0)));
        model.add(slots.black, lay(board).moved(at + vec3(-0.004, 0.0, 0.0)));
    }
    model.add(slots.black, lay(bar(Vec3::ZERO, vec3(0.22, 0.33, 1.02))).moved(at + vec3(-0.02, 0.0, 0.0)));
    for (i, &lamp) in slots.lamps.iter().enumerate() {
        let along = 0.32 * (1.0 - i as f32);
        let centre = at + if make.is_lying { vec3(0.09, -side * along, 0.0) } else { vec3(0.09, 0.0, along) };
        let lens = upright(Shape::lathe(&[vec2(0.105, 0.0), vec2(0.075, 0.02), vec2(0.0, 0.032)], 20));
        model.add(lamp, lens.moved(centre));
        let ring = upright(Shape::extruded(&polygon(20, 0.12, 0.0), 0.01));
        model.add(slots.black, ring.moved(centre - Vec3::X * 0.008));
        // The hood covers the upper three quarters and slants forward.
        let row = |x: f32, radius: f32| -> Vec<Vec3> {
            (0..=12)
                .map(|k| {
                    let angle = -0.7 + (PI + 1.4) * k as f32 / 12.0;
                    let reach = x * (0.55 + 0.45 * angle.sin().max(-0.6));
                    centre + vec3(reach, radius * angle.cos(), radius * angle.sin())
                })
                .collect()
        };
        model.add(slots.black, Shape::sheet(&[row(0.24, 0.118), row(0.0, 0.122)]));
    }
}

/// Flat parts of a sign for pedestrians, a height of about 0.2, seen along x.
fn figure(parts: &[[Vec2; 2]], width: f32) -> Shape {
    let limb = |&[a, b]: &[Vec2; 2]| {
        let side = (b - a).normalize_or(Vec2::Y).perp() * width / 2.0;
        upright(Shape::flat(&[a + side, a - side, b - side, b + side]))
    };
    Shape::join(parts.iter().map(limb))
}

fn man(walking: bool) -> Shape {
    let stride = if walking { 0.04 } else { 0.014 };
    let hip = vec2(0.0, -0.01);
    let limbs = [
        [hip, vec2(-stride, -0.095)],
        [hip, vec2(stride, -0.095)],
        [vec2(0.0, -0.015), vec2(0.0, 0.05)],
        [vec2(-stride, 0.0), vec2(0.0, 0.045)],
        [vec2(stride, 0.0), vec2(0.0, 0.045)],
    ];
    let head = upright(Shape::flat(&polygon(10, 0.018, 0.0))).moved(vec3(0.0, 0.0, 0.08));
    figure(&limbs, 0.024).and(head)
}

fn hand() -> Shape {
    let finger = |x: f32, top: f32| [vec2(x, 0.0), vec2(x, top)];
    let fingers = [finger(-0.04, 0.07), finger(-0.013, 0.09), finger(0.013, 0.085), finger(0.04, 0.065)];
    let thumb = [vec2(0.035, -0.04), vec2(0.075, 0.02)];
    let palm = upright(Shape::flat(&[vec2(-0.05, 0.0), vec2(-0.045, -0.09), vec2(0.045, -0.09), vec2(0.05, 0.0)]));
    figure(&[fingers.as_slice(), &[thumb]].concat(), 0.02).and(palm)
}

/// The head for those who cross while this traffic waits, its back at a point; it looks along `turn`.
fn walkers(model: &mut Model, black: u16, shows_hand: bool, may_walk: bool, at: Vec3, turn: Quat) {
    let [stand, walk] = if shows_hand {
        [vec3(0.6, 0.16, 0.01), vec3(0.5, 0.5, 0.5)]
    } else {
        [Lamp::Red.color(), Lamp::Green.color()]
    };
    let [stand, walk] = [(stand, !may_walk), (walk, may_walk)].map(|(c, lit)| model.slot(lamp(c, lit), &[]));
    let waiting = if shows_hand { hand() } else { man(false) };
    for (z, slot, sign) in [(0.14, stand, waiting), (-0.14, walk, man(true))] {
        let place = |shape: Shape| shape.turned(turn).moved(at + Vec3::Z * z);
        model.add(black, place(bar(vec3(0.1, 0.0, 0.0), vec3(0.18, 0.29, 0.275))));
        model.add(black, place(bar(vec3(0.23, 0.0, 0.13), vec3(0.12, 0.28, 0.012))));
        model.add(slot, place(sign.moved(Vec3::X * 0.192)));
    }
}

/// A pole with a head and a push button, and an arm over the road with one or two heads.
fn signal(id: &str, plan: &SignalPlan, side: f32, lit: Lamp) -> Asset {
    let mut model = Model::default();
    let steel = model.slot(galvanised(), &[]);
    let slots = Slots::new(&mut model, lit);
    let long = plan.arm_m > 0.0;
    let (radius_m, height_m) = if long { (0.13, 6.3) } else { (0.06, 3.4) };
    model.add(steel, mast_of([radius_m, radius_m * 0.75], height_m));
    foot_plate(&mut model, steel, 0.2 + 2.0 * radius_m);
    rust_at_foot(&mut model, steel, 0.1);
    for z in [2.5, 3.0] {
        model.add(steel, bar(vec3(0.09 + radius_m / 2.0, 0.0, z), vec3(0.16, 0.05, 0.05)));
    }
    let standing = Head { is_lying: false, has_board: plan.has_boards && !long };
    head(&mut model, &slots, standing, side, vec3(0.19 + radius_m, 0.0, 2.75));
    let amber = model.slot(plastic(vec3(0.55, 0.33, 0.02)), &[]);
    let over_road = Quat::from_rotation_z(-side * FRAC_PI_2);
    let button = over_road * vec3(radius_m + 0.03, 0.0, 0.0);
    model.add(amber, bar(button + vec3(0.0, 0.0, 1.1), vec3(0.1, 0.1, 0.19)));
    let at = over_road * vec3(radius_m, 0.0, 0.0) + Vec3::Z * 2.6;
    walkers(&mut model, slots.black, plan.shows_hand, lit == Lamp::Red, at, over_road);
    if long {
        let bend = |t: f32| vec3(0.0, -side * (0.4 + (plan.arm_m - 0.4) * t), 5.75 + 0.4 * (t * 1.6).sin());
        let arm: Vec<(Vec3, f32)> = std::iter::once((vec3(0.0, 0.0, 5.6), 0.085))
            .chain((0..=8).map(|i| i as f32 / 8.0).map(|t| (bend(t), 0.08 - 0.035 * t)))
            .collect();
        model.add(steel, Shape::tapered_tube(&arm, 12));
        model.add(steel, post(vec3(0.0, 0.0, height_m), 0.1, 0.03, 16));
        let places: &[f32] = if plan.arm_m > 8.0 { &[0.55, 0.95] } else { &[0.93] };
        for &t in places {
            let at = bend(t);
            model.add(steel, bar(at + vec3(0.07, 0.0, 0.0), vec3(0.14, 0.06, 0.06)));
            let make = Head { is_lying: plan.is_lying, has_board: plan.has_boards };
            head(&mut model, &slots, make, side, at + vec3(0.18, 0.0, 0.0));
        }
    }
    model.asset(id, Kind::TrafficSignal, Class::TrafficSign)
}
