//! Road rollers.

use glam::{Vec3, vec2, vec3};

use super::cabin::cabin;
use super::running::{axle, ladder, lugged};
use crate::shape::{Prism, Shape, rect};
use crate::vehicles::decal::{HAZARD, on_back, slanted, tiled};
use crate::vehicles::hull::{Section, lying};
use crate::vehicles::workshop::{Workshop, block};

/// A steel drum between the arms of a yoke.
fn drum(work: &mut Workshop, x: f32, radius: f32, width: f32) {
    let slots = work.slots;
    let profile = [
        (radius * 0.9, 0.0),
        (radius * 0.985, 0.0),
        (radius, 0.02),
        (radius, width - 0.02),
        (radius * 0.985, width),
        (radius * 0.9, width),
    ];
    let skin = Shape::lathe(&profile.map(|(r, y)| vec2(r, y)), 48).upright().moved(vec3(x, -width / 2.0, radius));
    work.add(slots.steel, skin);
    for side in [1.0, -1.0] {
        let disc = Shape::cylinder(radius * 0.91, 0.02, 40).upright().moved(vec3(
            x,
            side * (width / 2.0 - 0.07) - 0.01,
            radius,
        ));
        work.add(slots.paint, disc);
        let hub = Shape::cylinder(radius * 0.34, 0.12, 20).upright().moved(vec3(
            x,
            side * (width / 2.0 - 0.02) - 0.06,
            radius,
        ));
        work.add(slots.frame, hub);
        work.add(slots.paint, block([radius * 2.4, 0.1, 0.24], [x, side * (width / 2.0 + 0.06), radius * 1.02], 0.04));
    }
    for dx in [-1.0, 1.0] {
        let at = x + dx * (radius + 0.14);
        work.add(slots.paint, block([0.16, width + 0.22, 0.26], [at, 0.0, radius * 1.02], 0.04));
        work.add(slots.rubber, block([0.02, width, 0.1], [x + dx * (radius + 0.03), 0.0, radius * 1.05], 0.004));
    }
}

fn engine(work: &mut Workshop, sections: &[(f32, f32, f32, f32)]) {
    let slots = work.slots;
    let body: Vec<Section> =
        sections.iter().map(|&(x, z, y, up)| Section { x, z, half: vec2(y, up), corner: 0.13 }).collect();
    let mut body = lying(&body).slot(slots.paint);
    let (x, z) = (sections[0].0, sections[0].1);
    for k in 0..6 {
        let z = z - 0.15 + 0.06 * k as f32;
        body = body.mark(&Prism::front(&rect(-0.38, 0.38, z, z + 0.03), x - 0.1..=x + 0.3), slots.seam);
        body = body.mark_both(&Prism::side(&rect(x + 0.3, x + 0.95, z, z + 0.028), 0.2..=2.0), slots.seam);
    }
    work.model.add_marked(body);
    let hazard = slanted(&mut work.model, "hazard", HAZARD);
    work.add(hazard, tiled(on_back(vec3(x - 0.008, 0.0, z - 0.3), vec2(0.8, 0.12)), vec2(4.0, 0.6)));
    for side in [1.0, -1.0] {
        work.tail_lens(slots.red, vec3(x - 0.01, side * 0.38, z + 0.02), 0.05);
    }
}

/// One drum in front, two wheels behind.
pub(super) fn single(work: &mut Workshop) {
    drum(work, 1.55, 0.75, 2.05);
    lugged(work, 0.74, 0.56, vec3(-1.35, 0.78, 0.74));
    axle(work, -1.35, 0.74, 0.7);
    engine(
        work,
        &[(-2.35, 1.35, 0.5, 0.36), (-2.2, 1.35, 0.58, 0.44), (-1.0, 1.42, 0.62, 0.48), (-0.6, 1.4, 0.6, 0.46)],
    );
    let slots = work.slots;
    work.add(slots.paint, block([1.3, 1.25, 0.4], [-0.2, 0.0, 0.95], 0.08));
    work.add(slots.frame, Shape::cylinder(0.18, 0.6, 14).moved(vec3(0.5, 0.0, 0.5)));
    work.add(slots.frame, block([0.5, 0.5, 0.3], [0.5, 0.0, 0.78], 0.05));
    cabin(work, vec3(1.3, 1.4, 1.62), vec3(-0.1, 0.0, 1.2));
    ladder(work, -0.1, 0.82, 0.5, 1.05);
    work.number_plate(vec3(-2.37, 0.0, 1.22), false);
}

/// A drum in front and one behind, an open stand with a roof between.
pub(super) fn tandem(work: &mut Workshop) {
    drum(work, 1.5, 0.6, 1.65);
    drum(work, -1.5, 0.6, 1.65);
    let slots = work.slots;
    engine(
        work,
        &[(-2.1, 1.32, 0.48, 0.22), (-1.95, 1.34, 0.62, 0.3), (-0.75, 1.36, 0.66, 0.32), (-0.6, 1.36, 0.62, 0.28)],
    );
    let front = lying(&[
        Section { x: 0.55, z: 1.34, half: vec2(0.62, 0.28), corner: 0.12 },
        Section { x: 1.8, z: 1.32, half: vec2(0.6, 0.28), corner: 0.14 },
        Section { x: 2.0, z: 1.28, half: vec2(0.5, 0.2), corner: 0.12 },
    ]);
    work.add(slots.paint, front);
    for x in [1.5, -1.5] {
        work.add(slots.paint, block([0.36, 0.5, 0.4], [x, 0.0, 1.12], 0.08));
        work.add(slots.paint, block([0.3, 1.86, 0.12], [x, 0.0, 1.25], 0.04));
        work.pair(slots.paint, block([0.3, 0.1, 0.75], [x, 0.9, 0.9], 0.04));
    }
    work.add(slots.paint, block([1.5, 1.2, 0.42], [0.0, 0.0, 1.0], 0.08));
    work.add(slots.steel, block([1.2, 1.3, 0.03], [0.0, 0.0, 1.22], 0.008));
    // Posts, roof, seat, wheel.
    for x in [-0.6, 0.6] {
        work.pair(slots.frame, Shape::tube(&[vec3(x, 0.62, 1.2), vec3(x, 0.62, 2.72)], 0.035, 8));
    }
    let roof = lying(&[
        Section { x: -0.85, z: 2.76, half: vec2(0.66, 0.03), corner: 0.028 },
        Section { x: -0.7, z: 2.78, half: vec2(0.72, 0.05), corner: 0.045 },
        Section { x: 0.7, z: 2.78, half: vec2(0.72, 0.05), corner: 0.045 },
        Section { x: 0.85, z: 2.76, half: vec2(0.66, 0.03), corner: 0.028 },
    ]);
    work.add(slots.paint, roof);
    work.beacon(vec3(-0.4, 0.4, 2.82));
    let hips = vec3(-0.25, 0.1, 1.75);
    work.seat(hips - Vec3::Z * 0.1, 0.48);
    work.add(slots.interior, block([0.34, 0.4, 0.4], [-0.2, 0.1, 1.4], 0.04));
    work.steering_wheel(hips + vec3(0.45, 0.0, 0.26), 0.19, 0.4);
    work.add(slots.interior, block([0.2, 0.7, 0.6], [0.45, 0.1, 1.5], 0.05));
    work.driver(hips, hips + vec3(0.45, 0.0, 0.26));
    let rail = [vec3(0.6, 0.64, 1.3), vec3(0.6, 0.64, 1.95), vec3(-0.6, 0.64, 1.95)];
    work.pair(slots.yellow, Shape::tube(&rail, 0.018, 6));
    for y in [-0.4, 0.4] {
        work.add(slots.lamp, Shape::ellipsoid(vec3(0.02, 0.07, 0.05), 12).moved(vec3(1.99, y, 1.32)));
    }
}
