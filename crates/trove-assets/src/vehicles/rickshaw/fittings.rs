//! Wheels, steering, lamps, mirrors, plates.

use std::f32::consts::FRAC_PI_2;

use glam::{Quat, Vec3, vec2, vec3};

use super::body::Cowl;
use super::inside::BAR;
use super::measures::{FRONT_AXLE_M, REAR_AXLE_M, WHEEL_M};
use crate::shape::{Shape, arc};
use crate::vehicles::decal::on_front;
use crate::vehicles::plate::PLATE_M;
use crate::vehicles::wheel::{Rim, wheel};
use crate::vehicles::workshop::{Workshop, block, bowl};

pub(super) fn build(work: &mut Workshop, cowl: &Cowl, lamps_m: f32) {
    wheels(work);
    steering(work);
    headlamps(work, cowl, lamps_m);
    tail(work);
    mirrors(work);
}

fn wheels(work: &mut Workshop) {
    let slots = work.slots;
    let rear = wheel(&slots, WHEEL_M, 0.11, Rim::Steel);
    work.model.add_marked(rear.moved(vec3(-REAR_AXLE_M, 0.535, WHEEL_M)).both_sides());
    // Below the open body one sees the inside of the tyre on the other side.
    let inside = Shape::cylinder(WHEEL_M * 0.935, 0.02, 24).upright();
    work.pair(slots.rubber, inside.moved(vec3(-REAR_AXLE_M, 0.48, WHEEL_M)));
    // The front wheel shows its outside on both sides.
    let half = wheel(&slots, WHEEL_M, 0.06, Rim::Steel).moved(Vec3::Y * 0.026);
    work.model.add_marked(half.both_sides().moved(vec3(-FRONT_AXLE_M, 0.0, WHEEL_M)));
}

/// Mudguard, fork, column and handlebar.
fn steering(work: &mut Workshop) {
    let slots = work.slots;
    let axle = vec2(-FRONT_AXLE_M, WHEEL_M);
    let row = |y: f32, radius: f32| arc(axle, radius, 0.12, 2.6, 14, y);
    let radius = WHEEL_M + 0.045;
    let guard = [
        row(-0.095, radius - 0.055),
        row(-0.088, radius - 0.015),
        row(-0.04, radius),
        row(0.04, radius),
        row(0.088, radius - 0.015),
        row(0.095, radius - 0.055),
    ];
    work.add(slots.paint, Shape::sheet(&guard).inside_out().smooth(1.2).plate(0.005));
    let hub = vec3(axle.x, 0.0, axle.y);
    let crown = vec3(-0.42, 0.0, 0.52);
    work.pair(slots.frame, Shape::tube(&[hub + Vec3::Y * 0.078, crown + Vec3::Y * 0.078], 0.016, 8));
    work.add(slots.frame, Shape::tube(&[hub - Vec3::Y * 0.09, hub + Vec3::Y * 0.09], 0.022, 8));
    work.add(slots.frame, Shape::tube(&[crown, BAR - Vec3::Z * 0.02], 0.028, 8));
    work.add(slots.interior, block([0.1, 0.16, 0.09], [BAR.x + 0.02, 0.0, BAR.z], 0.03));
    let grip = BAR + vec3(-0.02, 0.3, 0.01);
    let inner = BAR + vec3(0.0, 0.17, 0.01);
    work.pair(slots.trim, Shape::tube(&[BAR, inner], 0.013, 8));
    work.pair(slots.rubber, Shape::tube(&[inner, grip], 0.018, 8));
}

/// Round ones in chromed rings, the indicators beside them.
fn headlamps(work: &mut Workshop, cowl: &Cowl, lamps_m: f32) {
    let slots = work.slots;
    let z = 0.76;
    let radius = 0.085;
    let ahead = Quat::from_rotation_y(FRAC_PI_2);
    let sides: &[f32] = if lamps_m > 0.0 { &[1.0, -1.0] } else { &[0.0] };
    for side in sides {
        // The ring stands upright before a cowl that leans back: it must clear its foremost place.
        let y = lamps_m * side;
        let at = vec3(cowl.at((y.abs() - radius).max(0.0), z - radius * 0.6) - 0.005, y, z);
        let turned = |shape: Shape| shape.turned(ahead).moved(at);
        let pod = [vec2(0.0, -0.16), vec2(radius * 0.9, -0.16), vec2(radius * 1.12, 0.0), vec2(radius * 1.12, 0.012)];
        work.add(slots.paint, turned(Shape::lathe(&pod, 20)));
        let ring = [
            vec2(radius * 1.12, 0.012),
            vec2(radius * 1.14, 0.026),
            vec2(radius * 1.05, 0.038),
            vec2(radius * 0.97, 0.03),
        ];
        work.add(slots.chrome, turned(Shape::lathe(&ring, 20)));
        work.add(slots.chrome, bowl(radius).moved(at + Vec3::X * 0.028));
        work.add(slots.lamp, Shape::ellipsoid(Vec3::splat(radius * 0.35), 10).moved(at + Vec3::X * 0.01));
        let lens = [vec2(radius * 0.98, 0.03), vec2(radius * 0.7, 0.043), vec2(0.0, 0.05)];
        work.add(slots.clear_lens, turned(Shape::lathe(&lens, 20)));
    }
    let blinker = vec3(cowl.at(0.44, 0.64), 0.44, 0.64);
    work.pair(slots.trim, Shape::ellipsoid(vec3(0.03, 0.045, 0.035), 12).moved(blinker));
    work.pair(slots.amber, Shape::ellipsoid(vec3(0.03, 0.036, 0.027), 12).moved(blinker + Vec3::X * 0.012));
    // The small plate over the mudguard.
    let at = vec3(cowl.at(0.0, 0.6), 0.0, 0.6);
    let face = on_front(at + Vec3::X * 0.014, PLATE_M * 0.62);
    work.add(slots.trim, Shape::block(vec3(0.012, 0.31, 0.085)).moved(at + Vec3::X * 0.006));
    work.add(work.plate, face);
}

fn tail(work: &mut Workshop) {
    let slots = work.slots;
    work.number_plate(vec3(-2.645, 0.0, 0.66), false);
    for side in [1.0, -1.0] {
        let lamp = |z: f32| vec3(-2.638, side * 0.43, z);
        work.tail_lens(slots.red, lamp(0.8), 0.045);
        work.tail_lens(slots.amber, lamp(0.69), 0.04);
        work.add(slots.red, Shape::ellipsoid(vec3(0.008, 0.025, 0.025), 10).moved(lamp(0.59)));
    }
    let bumper = [vec3(-2.5, 0.5, 0.34), vec3(-2.645, 0.44, 0.34), vec3(-2.65, 0.0, 0.34)];
    work.pair(slots.trim, Shape::tube(&bumper, 0.02, 6));
    let flap = vec3(-REAR_AXLE_M - WHEEL_M - 0.03, 0.535, 0.2);
    work.pair(slots.rubber, Shape::block(vec3(0.01, 0.14, 0.2)).moved(flap));
}

/// Mirrors on stalks, outside the width that counts.
fn mirrors(work: &mut Workshop) {
    let slots = work.slots;
    let at = vec3(-0.5, 0.64, 1.32);
    let stalk = [vec3(-0.5, 0.49, 1.22), vec3(-0.46, 0.58, 1.25), at - Vec3::Z * 0.06];
    let glass = Shape::ellipsoid(vec3(0.006, 0.052, 0.068), 14).moved(at - Vec3::X * 0.014);
    let shell = Shape::ellipsoid(vec3(0.02, 0.06, 0.077), 14).moved(at);
    let parts = [shell.slot(slots.trim), Shape::tube(&stalk, 0.008, 5).slot(slots.trim), glass.slot(slots.mirror)];
    work.model.add_extra("mirrors", 1.0, false, Shape::join(parts).both_sides());
}
