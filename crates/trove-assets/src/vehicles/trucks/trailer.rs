//! Semi-trailers, alone on their legs or behind a tractor.

use glam::{Vec3, vec2, vec3};
use trove_model::{Asset, Kind};

use super::bed::Bed;
use super::chassis::Frame;
use super::paints::{BOXES, CANVAS, TANKS};
use crate::shape::Shape;
use crate::vehicles::coverings::metric;
use crate::vehicles::slots::COMMERCIAL;
use crate::vehicles::workshop::{Workshop, block};

/// What a trailer carries.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Kinds {
    Box(&'static str),
    Curtains(&'static str),
    Tank,
    Container,
    Flatbed,
}

/// A semi-trailer to build.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Trailer {
    pub(super) length_m: f32,
    /// Distances of the axles from its back.
    axles_m: &'static [f32],
    twin: bool,
    kind: Kinds,
}

impl Trailer {
    pub(super) const CURTAINS: Self =
        Self { length_m: 13.6, axles_m: &[4.0, 2.7, 1.4], twin: false, kind: Kinds::Curtains("TRANSALPIN") };
    pub(super) const LONG_BOX: Self =
        Self { length_m: 14.6, axles_m: &[2.75, 1.45], twin: true, kind: Kinds::Box("ATLAS LOGISTICS") };
    pub(super) const TANK: Self = Self { length_m: 12.2, axles_m: &[3.8, 2.5, 1.2], twin: false, kind: Kinds::Tank };
    const BOX: Self = Self { kind: Kinds::Box("NORDFRACHT"), ..Self::CURTAINS };
    const SHORT_BOX: Self = Self { length_m: 9.8, axles_m: &[1.9], twin: true, kind: Kinds::Box("") };
    const CONTAINER: Self = Self { length_m: 12.4, kind: Kinds::Container, ..Self::CURTAINS };
    const FLATBED: Self = Self { length_m: 12.6, kind: Kinds::Flatbed, ..Self::CURTAINS };

    /// Builds it from a distance behind the vehicle's front, alone on its legs or coupled.
    pub(super) fn build(&self, work: &mut Workshop, from_m: f32, top_m: f32, alone: bool) {
        let slots = work.slots;
        let (to, half, deck) = (from_m + self.length_m, 1.27, 1.16);
        let axles: Vec<f32> = self.axles_m.iter().map(|a| to - a).collect();
        let frame = Frame {
            from_m: from_m + if alone { 0.2 } else { 3.2 },
            to_m: to - 0.03,
            half_m: half - 0.03,
            deck_m: deck,
            wheel_m: 0.5,
            front_axles_m: &[],
            rear_axles_m: &axles,
            twin: self.twin,
            sides: false,
            hazard: false,
        };
        frame.build(work);
        let bed = Bed { from: from_m, to, half, deck, top: top_m };
        match self.kind {
            Kinds::Box(name) => bed.closed(work, name),
            Kinds::Curtains(name) => bed.curtains(work, name),
            Kinds::Tank => {
                let alu = slots.panel;
                bed.tank(work, alu);
            }
            Kinds::Container => self.container(work, &bed),
            Kinds::Flatbed => {
                bed.floor(work, slots.steel);
                bed.headboard(work, 1.3, slots.alu);
                bed.pipes(work, 0.3, 0.2);
                bed.drums(work, 0.2, 0.6);
                bed.pallets(work, 0.3, 1.2, 0.95);
            }
        }
        // Legs, guards along the sides.
        let leg = -from_m - 2.75;
        let foot = if alone { 0.0 } else { 0.42 };
        work.pair(slots.frame, block([0.14, 0.14, deck - foot], [leg, 0.78, (deck + foot) / 2.0], 0.015));
        work.pair(slots.steel, block([0.3, 0.26, 0.04], [leg, 0.78, foot + 0.02], 0.01));
        work.add(slots.frame, Shape::tube(&[vec3(leg, -0.78, deck - 0.35), vec3(leg, 0.78, deck - 0.35)], 0.03, 8));
        work.add(
            slots.steel,
            Shape::tube(
                &[vec3(leg - 0.05, 0.85, 0.75), vec3(leg - 0.05, 1.18, 0.75), vec3(leg - 0.05, 1.18, 0.55)],
                0.014,
                6,
            ),
        );
        let (start, end) = (leg - 0.35, -axles[0] + 0.68);
        for z in [0.5, 0.82] {
            work.pair(slots.alu, block([start - end, 0.025, 0.11], [(start + end) / 2.0, half - 0.03, z], 0.008));
        }
        let posts = ((start - end) / 1.3) as usize;
        for i in 0..=posts {
            let x = end + (start - end) * (i as f32 + 0.1) / (posts as f32 + 0.2);
            work.pair(slots.frame, block([0.05, 0.03, deck - 0.4], [x, half - 0.06, deck / 2.0 + 0.22], 0.005));
        }
        let spare = Shape::cylinder(0.48, 0.3, 24);
        work.add(slots.rubber, spare.moved(vec3((start + end) / 2.0, 0.0, deck - 0.62)));
        work.add(slots.trim, block([0.7, 0.5, 0.42], [(start + end) / 2.0 + 1.2, half - 0.34, deck - 0.46], 0.03));
    }

    /// A corrugated container with corner castings and doors.
    fn container(&self, work: &mut Workshop, bed: &Bed) {
        let slots = work.slots;
        let (low, high) = (bed.deck + 0.06, bed.top);
        let (a, b, h) = (-bed.to + 0.06, -bed.from - 0.06, 1.219);
        // Trapezoids 28 cm apart and 3.6 cm deep.
        let waves = ((b - a - 0.3) / 0.278).round();
        let pitch = (b - a - 0.3) / waves;
        let mut profile = vec![vec2(a + 0.02, 0.0), vec2(a + 0.15, 0.0)];
        for i in 0..waves as usize {
            let x = a + 0.15 + pitch * i as f32;
            profile.extend([(0.25, 0.0), (0.5, 0.036), (0.75, 0.036), (1.0, 0.0)].map(|(t, d)| vec2(x + pitch * t, d)));
        }
        profile.push(vec2(b - 0.02, 0.0));
        let row = |z: f32| profile.iter().map(|p| vec3(p.x, -(h - 0.012 - p.y), z)).collect::<Vec<Vec3>>();
        work.pair(slots.second, Shape::sheet(&[row(low + 0.1), row(high - 0.08)]).smooth(0.3));
        let across =
            (0..=16).map(|i| (-h + 0.06 + (h * 2.0 - 0.12) * i as f32 / 16.0, if i % 2 == 0 { 0.0 } else { 0.035 }));
        let front: Vec<Vec<Vec3>> = [low + 0.1, high - 0.08]
            .iter()
            .map(|&z| across.clone().map(|(y, d)| vec3(b - 0.02 - d, y, z)).collect())
            .collect();
        work.add(slots.second, Shape::sheet(&front).smooth(0.3));
        work.add(slots.second, block([b - a - 0.1, h * 1.96, 0.05], [(a + b) / 2.0, 0.0, high - 0.06], 0.01));
        for z in [low + 0.06, high - 0.05] {
            work.pair(slots.second, block([b - a - 0.2, 0.06, 0.12], [(a + b) / 2.0, h - 0.03, z], 0.01));
            for x in [a + 0.06, b - 0.06] {
                work.add(slots.second, block([0.07, h * 1.9, 0.12], [x, 0.0, z], 0.01));
                work.pair(slots.steel, block([0.18, 0.16, 0.12], [x.clamp(a + 0.085, b - 0.085), h - 0.078, z], 0.012));
            }
        }
        for x in [a + 0.07, b - 0.07] {
            work.pair(slots.second, block([0.12, 0.12, high - low - 0.1], [x, h - 0.06, (low + high) / 2.0], 0.012));
        }
        work.add(slots.second, block([0.04, h * 1.9, high - low - 0.2], [a + 0.08, 0.0, (low + high) / 2.0], 0.005));
        Bed { to: -a - 0.06, half: h, ..*bed }.doors(work, low + 0.14, high - 0.12);
        bed.marker_lamps(work, bed.deck - 0.02);
        work.add(slots.frame, metric(block([b - a, 2.3, 0.08], [(a + b) / 2.0, 0.0, bed.deck + 0.02], 0.01)));
        bed.name(work, "OCEANIC", ((low + high) / 2.0 + 0.55, 0.42));
    }
}

const CONTAINERS: [Vec3; 6] = [
    vec3(0.2, 0.03, 0.02),
    vec3(0.02, 0.07, 0.2),
    vec3(0.03, 0.13, 0.07),
    vec3(0.45, 0.14, 0.02),
    vec3(0.5, 0.5, 0.48),
    vec3(0.07, 0.08, 0.09),
];

/// Trailers without a tractor.
pub(super) fn assets() -> Vec<Asset> {
    let trailer = |id: &str, plan: Trailer, top_m: f32, second: &[Vec3]| {
        let mut work = Workshop::new(id, &COMMERCIAL, second);
        plan.build(&mut work, 0.0, top_m, true);
        work.asset(Kind::Trailer)
    };
    vec![
        trailer("trailer/box", Trailer::BOX, 4.0, &BOXES),
        trailer("trailer/box-short", Trailer::SHORT_BOX, 3.8, &BOXES),
        trailer("trailer/curtain", Trailer::CURTAINS, 4.0, &CANVAS),
        trailer("trailer/tanker", Trailer::TANK, 3.6, &TANKS),
        trailer("trailer/container", Trailer::CONTAINER, 3.85, &CONTAINERS),
        trailer("trailer/flatbed", Trailer::FLATBED, 2.5, &BOXES),
    ]
}
