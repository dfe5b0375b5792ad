//! Excavators on tracks and on wheels.

use glam::{Vec2, Vec3, vec2, vec3};

use super::arm::{beam, bucket, hoses, pin};
use super::cabin::cabin;
use super::running::{axle, ladder, lugged, tracks};
use crate::shape::{Prism, Shape, pane, rect};
use crate::vehicles::decal::{HAZARD, on_back, slanted, tiled};
use crate::vehicles::hull::{Hull, Row};
use crate::vehicles::workshop::{Workshop, block, cut_out, cylinder};

/// Where boom, stick and bucket are: joints (x, z) from the boom's foot on, in the plane of the arm.
struct Reach {
    elbow: Vec2,
    tip: Vec2,
    /// The bucket's back from its hinge to its lip.
    bucket: [Vec2; 6],
}

const FOLDED: Reach = Reach {
    elbow: vec2(4.35, 3.1),
    tip: vec2(3.55, 0.98),
    bucket: [vec2(3.6, 1.02), vec2(3.25, 1.1), vec2(2.82, 0.85), vec2(2.66, 0.45), vec2(2.85, 0.1), vec2(3.3, 0.03)],
};
const OUT: Reach = Reach {
    elbow: vec2(4.6, 3.35),
    tip: vec2(6.1, 1.3),
    bucket: [vec2(6.2, 1.28), vec2(6.42, 1.0), vec2(6.4, 0.55), vec2(6.05, 0.18), vec2(5.55, 0.1), vec2(5.25, 0.3)],
};

pub(super) fn tracked(work: &mut Workshop) {
    undercarriage(work);
    house(work, 0.0);
    arm(work, &FOLDED, 0.0);
}

pub(super) fn reaching(work: &mut Workshop) {
    undercarriage(work);
    house(work, 0.0);
    arm(work, &OUT, 0.0);
}

fn undercarriage(work: &mut Workshop) {
    let slots = work.slots;
    tracks(work, 1.4, 0.42, 1.05, 0.56);
    work.add(slots.frame, block([1.3, 1.5, 0.3], [0.0, 0.0, 0.6], 0.08));
    for x in [-0.7, 0.7] {
        let leg = beam(&[(0.0, 0.62, 0.3), (x, 0.5, 0.24)], 0.0, 0.4);
        work.pair(slots.frame, leg.moved(Vec3::Y * 0.7));
    }
    work.add(slots.frame, Shape::cylinder(0.62, 0.24, 28).moved(vec3(0.0, 0.0, 0.72)));
    work.add(slots.steel, Shape::cylinder(0.56, 0.3, 28).moved(vec3(0.0, 0.0, 0.7)));
}

/// Upper carriage: deck, engine behind, counterweight, cabin on the left.
fn house(work: &mut Workshop, lift: f32) {
    let slots = work.slots;
    let base = 0.98 + lift;
    // Deck plate and its skirt.
    work.add(slots.frame, block([3.0, 2.36, 0.16], [-0.42, 0.0, base + 0.02], 0.03));
    // Engine house with flaps, grilles and screens.
    let row = |z: f32, inset: f32| Row {
        z,
        front: -0.42 - inset,
        back: -1.95,
        half: 1.2 - inset,
        corner: [0.05, 0.05],
        bow: [0.0, 0.0],
    };
    let hull =
        Hull::new(vec![row(base + 0.08, 0.0), row(base + 0.78, 0.0), row(base + 0.9, 0.03), row(base + 0.96, 0.1)]);
    let mut engine = hull.skin().slot(slots.paint);
    for (a, b) in [(-1.08, -0.5), (-1.75, -1.14)] {
        engine = crate::vehicles::hull::gap(
            engine,
            &pane(&rect(a, b, base + 0.14, base + 0.76), 0.04),
            slots.paint,
            slots.seam,
        );
        for k in 0..6 {
            let z = base + 0.3 + 0.055 * k as f32;
            engine = engine.mark_both(&Prism::side(&rect(a + 0.1, b - 0.1, z, z + 0.024), 0.4..=3.0), slots.seam);
        }
    }
    work.model.add_marked(engine);
    // Counterweight: a round heavy tail.
    let tail = |z: f32, inset: f32| Row {
        z,
        front: -1.6,
        back: -2.42 + inset,
        half: 1.22 - inset * 0.6,
        corner: [0.05, 0.6],
        bow: [0.0, 0.12],
    };
    let weight = Hull::new(vec![
        tail(base - 0.02, 0.12),
        tail(base + 0.06, 0.02),
        tail(base + 0.3, 0.0),
        tail(base + 0.85, 0.0),
        tail(base + 0.95, 0.03),
        tail(base + 1.0, 0.12),
    ]);
    work.add(slots.paint, weight.skin());
    let hazard = slanted(&mut work.model, "hazard", HAZARD);
    for side in [1.0, -1.0] {
        let at = vec3(weight.back_at(0.45, base + 0.18) - 0.012, side * 0.42, base + 0.18);
        work.add(hazard, tiled(on_back(at, vec2(0.5, 0.16)), vec2(2.0, 0.65)));
        work.tail_lens(slots.red, vec3(weight.back_at(0.75, base + 0.6) - 0.004, side * 0.75, base + 0.6), 0.06);
    }
    work.add(
        slots.frame,
        Shape::tube(
            &[vec3(-1.35, -0.6, base + 0.9), vec3(-1.35, -0.6, base + 1.3), vec3(-1.42, -0.6, base + 1.38)],
            0.06,
            12,
        ),
    );
    work.add(slots.paint, block([0.7, 0.5, 0.14], [-1.1, 0.3, base + 0.98], 0.04));
    // Right front: tank and toolbox with steps and rails.
    work.add(slots.paint, block([1.5, 0.78, 0.62], [0.3, -0.78, base + 0.38], 0.05));
    work.add(slots.paint, block([0.7, 0.76, 0.34], [0.68, -0.78, base + 0.2], 0.05));
    work.add(slots.steel, block([1.4, 0.6, 0.02], [0.3, -0.78, base + 0.7], 0.004));
    let rail = [
        vec3(0.95, -1.1, base + 0.3),
        vec3(0.95, -1.1, base + 1.1),
        vec3(-0.3, -1.1, base + 1.3),
        vec3(-1.5, -1.1, base + 1.3),
        vec3(-1.5, -1.1, base + 0.95),
    ];
    work.add(slots.yellow, Shape::tube(&rail, 0.018, 6));
    cabin(work, vec3(1.55, 0.98, 1.78), vec3(0.3, 0.7, base + 0.08));
    work.mirror_one(vec3(1.05, 1.22, base + 1.1), vec3(0.96, 1.35, base + 1.3));
    work.mirror_one(vec3(0.95, -1.1, base + 1.0), vec3(0.95, -1.22, base + 1.2));
}

/// Boom, stick, bucket, their rams and hoses.
fn arm(work: &mut Workshop, reach: &Reach, lift: f32) {
    let slots = work.slots;
    let y = -0.08;
    let up = |p: Vec2| vec2(p.x, p.y + if p.y > 1.6 { lift } else { 0.0 });
    let (elbow, tip) = (up(reach.elbow), reach.tip);
    let foot = vec2(0.62, 1.22 + lift);
    let at = |p: Vec2| vec3(p.x, y, p.y);
    // The boom is a gooseneck.
    let knee = vec2(2.15, 3.25 + lift);
    let points = [
        (foot.x, foot.y, 0.26),
        (1.1, 2.05 + lift, 0.46),
        (1.6, 2.85 + lift, 0.56),
        (knee.x, knee.y, 0.58),
        (2.8, 3.38 + lift, 0.5),
        (3.6, (3.38 + lift + elbow.y) / 2.0 + 0.06, 0.38),
        (elbow.x - 0.05, elbow.y + 0.02, 0.26),
    ];
    work.add(slots.paint, beam(&points, y, 0.36));
    let outer = (tip - elbow).normalize_or(Vec2::X);
    let back = elbow - outer * 0.55 + vec2(0.06, 0.04);
    let stick = [back, elbow - outer * 0.05, elbow.lerp(tip, 0.3), tip].map(|p| (p.x, p.y));
    let depth = [0.16, 0.46, 0.4, 0.2];
    let stick: Vec<(f32, f32, f32)> = stick.iter().zip(depth).map(|(&(x, z), d)| (x, z, d)).collect();
    work.add(slots.paint, beam(&stick, y, 0.28));
    for (p, r) in [(foot, 0.1), (elbow, 0.09), (tip, 0.07)] {
        pin(work, at(p), r, 0.44);
    }
    // Rams: two lift the boom, one bends the stick, one turns the bucket.
    for side in [-0.26, 0.26] {
        let low = vec3(1.05, y + side, 1.0 + lift);
        cylinder(work, low, vec3(1.95, y + side, 2.95 + lift), 0.085, 0.55);
    }
    cylinder(work, vec3(2.2, y, 3.62 + lift), at(back), 0.08, 0.5);
    let perp = outer.perp() * if outer.x < 0.3 { -1.0 } else { 1.0 };
    let (start, link) = (elbow.lerp(tip, 0.12) - perp * -0.33, tip - outer * 0.34 + perp * 0.3);
    cylinder(work, at(start), at(link), 0.065, 0.5);
    let hinge = reach.bucket[0] + (reach.bucket[1] - reach.bucket[0]) * 0.7;
    for side in [-0.17, 0.17] {
        work.add(slots.frame, Shape::tube(&[at(link) + Vec3::Y * side, at(hinge) + Vec3::Y * side], 0.045, 8));
        work.add(
            slots.frame,
            Shape::tube(&[at(link) + Vec3::Y * side, at(tip - outer * 0.3) + Vec3::Y * side], 0.04, 8),
        );
    }
    let run: Vec<Vec3> = points[1..].iter().map(|&(x, z, d)| vec3(x, y + 0.03, z + d * 0.55)).collect();
    hoses(work, &run, 3);
    bucket(work, &reach.bucket, y, 1.05, 5);
    let ears: Vec<Vec2> =
        vec![reach.bucket[0] + outer * -0.05, hinge, reach.bucket[1] + (hinge - reach.bucket[1]) * 0.3, tip];
    for side in [-0.2, 0.2] {
        work.add(slots.frame, cut_out(&ears, 0.04).moved(Vec3::Y * (y + side)));
    }
    // A working lamp on the boom.
    work.add(slots.trim, block([0.1, 0.1, 0.1], [2.0, y + 0.26, 2.9 + lift], 0.02));
    work.add(slots.lamp, Shape::ellipsoid(vec3(0.02, 0.045, 0.045), 12).moved(vec3(2.055, y + 0.26, 2.9 + lift)));
}

pub(super) fn wheeled(work: &mut Workshop) {
    let slots = work.slots;
    let lift = 0.32;
    for x in [1.3, -1.3] {
        lugged(work, 0.52, 0.5, vec3(x, 0.98, 0.52));
        axle(work, x, 0.55, 0.9);
    }
    work.add(slots.paint, block([3.3, 0.9, 0.5], [0.0, 0.0, 0.82], 0.1));
    work.add(slots.paint, block([0.9, 1.9, 0.36], [0.0, 0.0, 0.8], 0.08));
    work.add(slots.frame, Shape::cylinder(0.58, 0.3, 28).moved(vec3(0.0, 0.0, 1.02)));
    ladder(work, 0.0, 1.0, 0.5, 0.9);
    // Blade in front, outriggers behind.
    let blade: Vec<Vec2> = [(2.25, 0.12), (2.12, 0.35), (2.12, 0.6), (2.22, 0.78)].map(|(x, z)| vec2(x, z)).to_vec();
    let row = |y: f32| blade.iter().map(|p| vec3(p.x, y, p.y)).collect::<Vec<_>>();
    work.add(slots.paint, Shape::sheet(&[row(-1.22), row(1.22)]).plate(-0.04));
    for y in [-0.4, 0.4] {
        work.add(slots.frame, block([0.7, 0.12, 0.2], [1.85, y, 0.5], 0.03));
        let leg = beam(&[(-1.75, 0.8, 0.24), (-2.1, 0.62, 0.2)], y * 1.6, 0.16);
        work.add(slots.paint, leg);
        work.add(slots.frame, block([0.46, 0.5, 0.07], [-2.12, y * 2.2, 0.42], 0.02));
        work.add(slots.chrome, Shape::tube(&[vec3(-2.12, y * 2.2, 0.45), vec3(-2.1, y * 2.0, 0.85)], 0.06, 10));
    }
    house(work, lift);
    arm(work, &Reach { elbow: vec2(4.35, 3.1), ..FOLDED }, lift * 0.9);
}

impl Workshop {
    /// A mirror on a bar, on one side.
    fn mirror_one(&mut self, hold: Vec3, at: Vec3) {
        self.add(self.slots.trim, Shape::tube(&[hold, at], 0.014, 6));
        self.add(self.slots.trim, Shape::rounded_block(vec3(0.06, 0.16, 0.26), 0.025).moved(at));
        self.add(self.slots.mirror, Shape::block(vec3(0.006, 0.13, 0.22)).moved(at - Vec3::X * 0.03));
    }
}
