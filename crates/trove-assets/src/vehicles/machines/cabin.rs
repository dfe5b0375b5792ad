//! Cabins with glass all around.

use glam::{Vec2, Vec3, vec2, vec3};

use crate::shape::{Prism, Shape, pane, rect, shrunk};
use crate::vehicles::hull::{Hull, Row};
use crate::vehicles::workshop::{Workshop, block};

/// A cabin that stands on a point, with a seat, levers, a driver, and a lamp that flashes on its roof.
pub(super) fn cabin(work: &mut Workshop, size: Vec3, foot: Vec3) {
    let slots = work.slots;
    let (l, half, h) = (size.x / 2.0, size.y / 2.0, size.z);
    let row = |z: f32, front: f32, inset: f32| Row {
        z,
        front: l - front,
        back: -l + inset,
        half: half - inset,
        corner: [0.1, 0.09],
        bow: [0.03, 0.0],
    };
    let hull = Hull::new(vec![
        row(0.0, 0.1, 0.02),
        row(0.05, 0.06, 0.0),
        row(h * 0.3, 0.0, 0.0),
        row(h * 0.55, 0.01, 0.0),
        row(h * 0.9, 0.14, 0.03),
        row(h * 0.93, 0.1, 0.0),
        row(h * 0.97, 0.12, 0.02),
        row(h * 0.995, 0.2, 0.08),
        row(h, 0.32, 0.2),
    ]);
    let mut skin = hull.skin().slot(slots.paint);
    let side = |polygon: &[Vec2]| Prism::side(polygon, 0.2..=3.0);
    let window = |skin: Shape, outline: &[Vec2], inset: f32, make: &dyn Fn(&[Vec2]) -> Prism| {
        let skin = skin
            .mark(&make(&pane(outline, 0.09)), slots.trim)
            .mark(&make(&pane(&shrunk(outline, inset), 0.08)), slots.glass);
        skin.mark(&make(&pane(outline, 0.09)).mirrored(), slots.trim)
            .mark(&make(&pane(&shrunk(outline, inset), 0.08)).mirrored(), slots.glass)
    };
    // Door and rear quarter, front in one pane, back.
    let door =
        [vec2(-l * 0.18, h * 0.1), vec2(l - 0.14, h * 0.16), vec2(l - 0.24, h * 0.88), vec2(-l * 0.18, h * 0.88)];
    skin = window(skin, &door, 0.03, &side);
    let quarter = rect(-l + 0.1, -l * 0.24, h * 0.42, h * 0.88);
    skin = window(skin, &quarter, 0.03, &side);
    let front = rect(-half + 0.06, half - 0.06, h * 0.2, h * 0.885);
    skin = window(skin, &front, 0.03, &|p| Prism::front(p, 0.05..=3.0));
    let back = rect(-half + 0.09, half - 0.09, h * 0.45, h * 0.86);
    skin = window(skin, &back, 0.03, &|p| Prism::front(p, -3.0..=-0.05));
    skin = skin.mark(&Prism::top(&rect(-3.0, 3.0, -3.0, 3.0), h * 0.91..=h + 0.1), slots.trim);
    work.model.add_marked(skin.moved(foot));
    let handle = block([0.03, 0.02, 0.2], [-l * 0.1, half + 0.012, h * 0.42], 0.008);
    work.pair_at(slots.trim, handle, foot);
    let grip = [
        vec3(l - 0.1, half + 0.03, h * 0.2),
        vec3(l - 0.1, half + 0.06, h * 0.25),
        vec3(l - 0.16, half + 0.06, h * 0.75),
        vec3(l - 0.16, half + 0.03, h * 0.8),
    ];
    work.pair_at(slots.trim, Shape::tube(&grip, 0.014, 6), foot);
    let wiper = [vec3(l + 0.01, 0.1, h * 0.24), vec3(l, 0.14, h * 0.5), vec3(l - 0.06, 0.16, h * 0.72)];
    work.add(slots.trim, Shape::tube(&wiper, 0.01, 5).moved(foot));
    for y in [-half * 0.7, half * 0.7] {
        let lamp = foot + vec3(l - 0.06, y, h * 0.945);
        work.add(slots.trim, block([0.07, 0.16, 0.09], lamp.to_array(), 0.02));
        work.add(slots.lamp, Shape::ellipsoid(vec3(0.02, 0.065, 0.035), 12).moved(lamp + Vec3::X * 0.035));
    }
    work.beacon(foot + vec3(-l * 0.5, half * 0.4, h - 0.01));
    // Inside.
    let hips = foot + vec3(-0.12, 0.0, h * 0.42);
    work.seat(hips - Vec3::Z * 0.1, 0.48);
    for side in [1.0, -1.0] {
        work.add(slots.interior, block([0.4, 0.12, 0.16], (hips + vec3(0.14, side * 0.31, -0.02)).to_array(), 0.04));
        let stick = [hips + vec3(0.32, side * 0.31, 0.05), hips + vec3(0.34, side * 0.29, 0.2)];
        work.add(slots.trim, Shape::tube(&stick, 0.02, 6));
    }
    work.add(slots.interior, block([size.x * 0.8, size.y * 0.9, 0.04], (foot + vec3(0.0, 0.0, 0.06)).to_array(), 0.01));
    work.add(slots.interior, block([0.1, 0.3, 0.3], (foot + vec3(l - 0.3, half * 0.5, h * 0.4)).to_array(), 0.03));
    work.driver(hips, hips + vec3(0.4, 0.0, 0.2));
}

impl Workshop {
    /// A shape and its mirror image about a place that is not on the middle line.
    pub(super) fn pair_at(&mut self, slot: u16, shape: Shape, at: Vec3) {
        self.add(slot, shape.both_sides().moved(at));
    }
}
