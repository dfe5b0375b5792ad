//! A vehicle under construction, and the small parts that several kinds of vehicles have.

use std::f32::consts::{FRAC_PI_2, TAU};

use glam::{Quat, Vec2, Vec3, vec2, vec3};
use trove_model::{Asset, Kind, Material};

use super::decal::{on_back, on_front};
use super::hull::Hull;
use super::plate::{self, PLATE_M};
use super::slots::{Paint, Slots};
use crate::people::{Figure, Outfit, Physique, Pose, Wardrobe};
use crate::shape::{Model, Prism, Shape, pane};

/// A model with the slots of vehicles and a number plate.
pub(crate) struct Workshop {
    pub(crate) model: Model,
    pub(crate) slots: Slots,
    id: String,
    /// Of the face of its number plates.
    pub(crate) plate: u16,
}

impl Workshop {
    /// A lorry, a bus, a machine: in plain paints, with any number plate.
    pub(crate) fn new(id: &str, paints: &[Vec3], second: &[Vec3]) -> Self {
        Self::with(id, paints, 0.0, second, plate::any(id))
    }

    /// A passenger car: in a paint of its plan, with a plate of its own.
    pub(crate) fn of_car(id: &str, paint: &Paint, plate: Material) -> Self {
        let colors: Vec<Vec3> = paint.colors.iter().copied().map(Vec3::from_array).collect();
        let mut work = Self::with(id, &colors, paint.flakes, &[], plate);
        work.model.paint_by_region(work.slots.paint, paint.by_region);
        work
    }

    pub(super) fn with(id: &str, paints: &[Vec3], flakes: f32, second: &[Vec3], plate: Material) -> Self {
        let mut model = Model::default();
        let slots = Slots::new(&mut model, paints, flakes, second);
        let plate = model.slot(plate, &[]);
        Self { model, slots, plate, id: id.into() }
    }

    pub(crate) fn add(&mut self, slot: u16, shape: Shape) {
        self.model.add(slot, shape);
    }

    /// A shape and its mirror image.
    pub(crate) fn pair(&mut self, slot: u16, shape: Shape) {
        self.model.add(slot, shape.both_sides());
    }

    pub(crate) fn asset(self, kind: Kind) -> Asset {
        self.model.asset(&self.id, kind, kind.class())
    }

    /// A number plate whose face is at x, read from the front or from behind.
    pub(crate) fn number_plate(&mut self, at: Vec3, is_front: bool) {
        let ahead = if is_front { 1.0 } else { -1.0 };
        let back = Shape::block(vec3(0.012, PLATE_M.x + 0.02, PLATE_M.y + 0.02));
        self.add(self.slots.trim, back.moved(at));
        let at = at + Vec3::X * 0.0075 * ahead;
        let face = if is_front { on_front(at, PLATE_M) } else { on_back(at, PLATE_M) };
        self.add(self.plate, face);
    }

    /// Lamps behind clear covers in the front of a hull, on both sides: an outline (y, z) and reflectors (y, z, radius).
    pub(crate) fn headlamps(
        &mut self,
        skin: Shape,
        hull: &Hull,
        outline: &[Vec2],
        reflectors: &[(f32, f32, f32)],
    ) -> Shape {
        let middle = outline.iter().sum::<Vec2>() / outline.len() as f32;
        let x = hull.front_at(middle.x, middle.y);
        let prism = Prism::front(&pane(outline, 0.04), x - 0.3..=x + 0.3);
        let mut skin = skin;
        for prism in [&prism, &prism.mirrored()] {
            let (cover, rest) = skin.split(prism);
            self.add(self.slots.seam, cover.clone().moved(Vec3::X * -0.1));
            self.add(self.slots.clear_lens, cover);
            skin = rest;
        }
        for &(y, z, radius) in reflectors {
            let at = vec3(hull.front_at(y, z) - 0.02, y, z);
            self.pair(self.slots.chrome, bowl(radius).moved(at));
            self.pair(
                self.slots.lamp,
                Shape::ellipsoid(Vec3::splat(radius * 0.35), 10).moved(at - Vec3::X * radius * 0.25),
            );
        }
        skin
    }

    /// A round lens in a dark ring that looks backwards.
    pub(crate) fn tail_lens(&mut self, slot: u16, at: Vec3, radius_m: f32) {
        self.add(slot, Shape::ellipsoid(vec3(0.018, radius_m, radius_m), 10).moved(at));
        let ring: Vec<Vec3> = (0..=10)
            .map(|i| Vec2::from_angle(TAU * i as f32 / 10.0))
            .map(|p| at + vec3(0.0, p.x, p.y) * radius_m)
            .collect();
        self.add(self.slots.trim, Shape::tube(&ring, 0.008, 4));
    }

    /// Someone who sits at a steering wheel and is there when the vehicle is driven.
    pub(crate) fn driver(&mut self, hips: Vec3, wheel: Vec3) {
        let body = Physique::MAN;
        let hand = |side: f32| wheel + vec3(-0.07, 0.19 * side, 0.03);
        let foot = |side: f32| vec3(wheel.x + 0.08, hips.y + 0.12 * side, hips.z - 0.36);
        let pose = Pose {
            hips,
            lean_rad: -0.08,
            ankles: [foot(1.0), foot(-1.0)],
            toes_rad: [-0.2; 2],
            wrists: [hand(1.0), hand(-1.0)],
        };
        let slots = Wardrobe::new(&mut self.model, &[], &[]);
        let shape = Figure::new(body, pose).dressed(&Outfit::CASUAL, &slots);
        self.model.add_extra("driver", 1.0, true, shape);
    }

    /// A seat whose cushion's top is at a point below the hips of who sits on it.
    pub(crate) fn seat(&mut self, at: Vec3, width_m: f32) {
        let cushion = Shape::rounded_block(vec3(0.48, width_m, 0.13), 0.05).moved(at + vec3(0.08, 0.0, -0.06));
        let back = Shape::rounded_block(vec3(0.12, width_m, 0.66), 0.05).turned(Quat::from_rotation_y(-0.15));
        let head = Shape::rounded_block(vec3(0.09, width_m.min(0.28), 0.18), 0.04);
        self.add(
            self.slots.seat_cloth,
            Shape::join([cushion, back.moved(at + vec3(-0.2, 0.0, 0.3)), head.moved(at + vec3(-0.27, 0.0, 0.7))]),
        );
    }

    /// A steering wheel with its column.
    pub(crate) fn steering_wheel(&mut self, at: Vec3, radius_m: f32, tilt_rad: f32) {
        let ring: Vec<Vec3> =
            (0..=18).map(|i| Vec2::from_angle(TAU * i as f32 / 18.0).extend(0.0) * radius_m).collect();
        let spokes = Shape::block(vec3(0.04, radius_m * 1.9, 0.02)).and(Shape::cylinder(0.07, 0.04, 12));
        let column = Shape::tube(&[Vec3::ZERO, vec3(0.0, 0.0, -0.4)], 0.035, 8);
        let wheel = Shape::join([Shape::tube(&ring, 0.016, 6), spokes, column]);
        self.add(self.slots.interior, wheel.turned(Quat::from_rotation_y(-tilt_rad)).moved(at));
    }

    /// A mirror on an arm that is held at two points, on the left; its glass looks backwards.
    pub(crate) fn mirror(&mut self, holds: [Vec3; 2], at: Vec3, size: Vec3) {
        let up = Vec3::Z * size.z * 0.42;
        self.pair(self.slots.trim, Shape::rounded_block(size, size.min_element() * 0.45).moved(at));
        self.pair(self.slots.trim, Shape::tube(&[holds[0], at + up + Vec3::Z * 0.05, at + up], 0.014, 6));
        self.pair(self.slots.trim, Shape::tube(&[holds[1], at - up], 0.014, 6));
        let glass = Shape::block(vec3(0.006, size.y * 0.84, size.z * 0.88)).moved(at - Vec3::X * size.x * 0.5);
        self.pair(self.slots.mirror, glass);
    }

    /// An amber flashing light on its foot.
    pub(crate) fn beacon(&mut self, at: Vec3) {
        self.add(self.slots.trim, Shape::cylinder(0.075, 0.05, 14).moved(at));
        let dome = [vec2(0.065, 0.0), vec2(0.065, 0.09), vec2(0.045, 0.125), vec2(0.0, 0.13)];
        self.add(self.slots.amber, Shape::lathe(&dome, 12).moved(at + Vec3::Z * 0.05));
    }

    /// A wiper at rest on the front of a hull: from its pivot across to where its blade ends.
    pub(crate) fn wiper(&mut self, hull: &Hull, pivot: Vec2, end: Vec2) {
        let on = |p: Vec2, lift: f32| vec3(hull.front_at(p.x, p.y) + lift, p.x, p.y);
        let middle = pivot.lerp(end, 0.6);
        let arm = Shape::tube(&[on(pivot, 0.01), on(pivot.lerp(middle, 0.5), 0.035), on(middle, 0.03)], 0.009, 5);
        let start = pivot.lerp(end, 0.22);
        let blade: Vec<Vec3> = (0..=5).map(|i| on(start.lerp(end, i as f32 / 5.0), 0.014)).collect();
        self.add(self.slots.trim, arm.and(Shape::tube(&blade, 0.009, 4)));
    }
}

/// The inside of a reflector that opens towards +x.
pub(super) fn bowl(radius_m: f32) -> Shape {
    let profile = [vec2(0.0, -0.6), vec2(0.45, -0.52), vec2(0.8, -0.3), vec2(1.0, 0.0)].map(|p| p * radius_m);
    Shape::lathe(&profile, 16).inside_out().turned(Quat::from_rotation_y(FRAC_PI_2))
}

/// A cylinder between two points with domed ends: tanks of air and fuel.
pub(crate) fn tank(from: Vec3, to: Vec3, radius_m: f32) -> Shape {
    let along = (to - from).normalize_or(Vec3::X) * radius_m;
    let dome = |end: Vec3, out: f32| [(end + along * 0.22 * out, 0.45), (end + along * 0.14 * out, 0.8), (end, 1.0)];
    let path: Vec<(Vec3, f32)> = dome(from, -1.0).into_iter().chain(dome(to, 1.0).into_iter().rev()).collect();
    Shape::tapered_tube(&path.iter().map(|&(p, r)| (p, r * radius_m)).collect::<Vec<_>>(), 18)
}

/// A straight bar of a rectangular cross section between two points that lie in a plane along x.
pub(crate) fn bar(from: Vec3, to: Vec3, width_m: f32, depth_m: f32) -> Shape {
    let along = to - from;
    let turn = Quat::from_rotation_arc(Vec3::X, along.normalize_or(Vec3::X));
    Shape::block(vec3(along.length(), width_m, depth_m)).turned(turn).moved(from.lerp(to, 0.5))
}

/// Edges rounded by less are not seen to be.
const SHARP_M: f32 = 0.0125;

/// A block with rounded edges about a point.
pub(crate) fn block(size: [f32; 3], at: [f32; 3], bevel_m: f32) -> Shape {
    let size = Vec3::from(size);
    let shape = if bevel_m < SHARP_M { Shape::block(size) } else { Shape::rounded_block(size, bevel_m) };
    shape.moved(Vec3::from(at))
}

/// A side view (x, z), either way round, made `width_m` thick about y = 0.
pub(crate) fn cut_out(outline_xz: &[Vec2], width_m: f32) -> Shape {
    // Put upright, what was y runs down.
    let mut outline: Vec<Vec2> = outline_xz.iter().map(|p| vec2(p.x, -p.y)).collect();
    let area: f32 = (0..outline.len()).map(|i| outline[i].perp_dot(outline[(i + 1) % outline.len()])).sum();
    if area < 0.0 {
        outline.reverse();
    }
    Shape::extruded(&outline, width_m).upright().moved(Vec3::Y * -width_m / 2.0)
}

/// A hydraulic cylinder: its barrel, its rod, and the eyes at both ends.
pub(crate) fn cylinder(work: &mut Workshop, from: Vec3, to: Vec3, radius_m: f32, extended: f32) {
    let middle = from.lerp(to, 1.0 - extended * 0.5);
    let along = (to - from).normalize_or(Vec3::X);
    work.add(work.slots.paint, Shape::tube(&[from, middle], radius_m, 14));
    work.add(work.slots.trim, Shape::tube(&[middle - along * 0.06, middle + along * 0.03], radius_m * 1.15, 14));
    work.add(work.slots.chrome, Shape::tube(&[middle, to], radius_m * 0.55, 12));
    for end in [from, to] {
        let eye = Shape::cylinder(radius_m * 0.95, radius_m * 1.6, 14).upright();
        work.add(work.slots.frame, eye.moved(end - Vec3::Y * radius_m * 0.8));
    }
}
