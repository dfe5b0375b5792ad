//! School buses: a bonnet, many small windows, rails along the sides, lamps that flash.

use glam::{Vec2, Vec3, vec2, vec3};
use trove_model::{Asset, Kind};

use crate::shape::{Prism, Shape, pane, rect, shrunk};
use crate::vehicles::decal::{on_back, on_front, writing};
use crate::vehicles::hull::{Hull, Row, arch};
use crate::vehicles::trucks::Cab;
use crate::vehicles::wheel::{Rim, wheel};
use crate::vehicles::workshop::{Workshop, block};

const YELLOW: [Vec3; 2] = [vec3(0.66, 0.33, 0.006), vec3(0.62, 0.34, 0.012)];

/// Length, rear axle.
const PLANS: [(&str, f32, f32); 2] = [("bus/school", 10.9, 7.9), ("bus/school-short", 8.2, 5.9)];

pub(super) fn assets() -> Vec<Asset> {
    let bus = |&(id, length_m, axle_m): &(&str, f32, f32)| {
        let mut work = Workshop::new(id, &YELLOW, &YELLOW);
        build(&mut work, length_m, axle_m);
        Asset { commonness: 0.4, ..work.asset(Kind::Bus) }
    };
    PLANS.iter().map(bus).collect()
}

fn build(work: &mut Workshop, length_m: f32, axle_m: f32) {
    let (half, top, floor, r) = (1.2, 3.12, 0.5, 0.48);
    let cab = Cab {
        length_m: 3.0,
        height_m: 2.72,
        width_m: 2.34,
        floor_m: 0.45,
        axle_m: 0.98,
        wheel_m: r,
        bonnet_m: 1.5,
        crew: false,
        plain: true,
        grille: (5, 1.0, true),
        driver_side: 1.0,
    };
    cab.build(work);
    let slots = work.slots;
    let front = 1.95;
    let row = |z: f32, inset: f32, over: f32| Row {
        z,
        front: -front - over,
        back: -length_m + over * 0.5,
        half: half - inset,
        corner: [0.12, 0.14],
        bow: [0.02, 0.05],
    };
    let hull = Hull::new(vec![
        row(floor, 0.0, 0.0),
        row(floor + 0.4, 0.0, 0.0),
        row(2.3, 0.02, 0.02),
        row(top - 0.42, 0.05, 0.03),
        row(top - 0.26, 0.12, 0.06),
        row(top - 0.12, 0.26, 0.14),
        row(top - 0.03, 0.52, 0.24),
        row(top, 0.85, 0.4),
    ]);
    let mut skin = hull.skin().slot(slots.paint);
    let side = |polygon: &[Vec2]| Prism::side(polygon, 0.4..=3.0);
    let (from, to) = (2.12, length_m - 0.35);
    let count = ((to - from) / 0.72).round();
    let step = (to - from) / count;
    for i in 0..count as usize {
        let (a, b) = (from + step * i as f32 + 0.04, from + step * (i + 1) as f32 - 0.04);
        let window = rect(-b, -a, 1.62, 2.3);
        skin = skin.mark_both(&side(&pane(&window, 0.05)), slots.trim);
        skin = skin.mark_both(&side(&pane(&shrunk(&window, 0.02), 0.04)), slots.glass);
        skin = skin.mark_both(&side(&rect(-b, -a, 1.97, 1.995)), slots.trim);
    }
    for z in [0.72, 1.02, 1.3] {
        work.pair(
            slots.trim,
            block([length_m - front - 1.1, 0.03, 0.07], [-(length_m + front + 0.9) / 2.0, half + 0.008, z], 0.012),
        );
    }
    // Rear: door with panes, lamps, words.
    let behind = |polygon: &[Vec2]| Prism::front(polygon, -length_m - 0.2..=-length_m + 0.4);
    for window in [rect(-0.42, 0.42, 1.7, 2.3), rect(-0.42, 0.42, 0.95, 1.45)] {
        skin = skin.mark(&behind(&pane(&window, 0.05)), slots.glass);
    }
    skin = skin.mark_both(&behind(&pane(&rect(0.55, 1.02, 1.68, 2.3), 0.05)), slots.glass);
    for x in [-0.52, 0.52] {
        skin = skin.mark(&behind(&rect(x - 0.005, x + 0.005, floor, 2.4)), slots.seam);
    }
    work.add(slots.trim, block([0.12, half * 1.9, 0.22], [-length_m - 0.02, 0.0, floor + 0.1], 0.04));
    let (slot, aspect) = writing(&mut work.model, "SCHOOL BUS", &[Vec3::splat(0.012)]);
    let height = 0.24;
    let z = top - 0.3;
    work.add(slot, on_back(vec3(hull.back_at(0.0, z) - 0.06, 0.0, z), vec2(height * aspect, height)));
    work.add(slots.paint, block([0.1, height * aspect, height], [hull.back_at(0.0, z), 0.0, z], 0.02));
    work.add(slots.paint, block([0.1, height * aspect, height], [hull.front_at(0.0, z), 0.0, z], 0.02));
    work.add(slot, on_front(vec3(hull.front_at(0.0, z) + 0.06, 0.0, z), vec2(height * aspect, height)));
    for y in [0.74, 0.98] {
        let slot = if y > 0.8 { slots.red } else { slots.amber };
        for end in [hull.front_at(y, z) + 0.02, hull.back_at(y, z) - 0.02] {
            work.pair(slots.trim, Shape::ellipsoid(vec3(0.04, 0.115, 0.115), 16).moved(vec3(end, y, z)));
            work.pair(slot, Shape::ellipsoid(vec3(0.06, 0.09, 0.09), 16).moved(vec3(end, y, z)));
        }
    }
    for y in [half - 0.2, half - 0.42] {
        for side in [1.0, -1.0] {
            let slot = if y > 0.9 { slots.red } else { slots.amber };
            work.tail_lens(slot, vec3(-length_m - 0.012, side * y, 1.2), 0.085);
        }
    }
    work.number_plate(vec3(-length_m - 0.085, 0.3, floor + 0.12), false);
    // The arm that stops traffic.
    work.add(slots.red, block([0.04, 0.02, 0.4], [-front - 0.95, half + 0.04, 1.28], 0.008));
    let (well, lip) = arch(&mut skin, vec2(-axle_m, r), r + 0.12, half, 0.6);
    work.add(slots.seam, well);
    work.add(slots.trim, lip);
    work.model.add_marked(skin);
    for axle in [0.98, axle_m] {
        let rim = if axle < 2.0 { Rim::Steel } else { Rim::DeepSteel };
        let tyre = wheel(&slots, r, 0.27, rim).moved(vec3(-axle, half - 0.2, r));
        work.model.add_marked(tyre.both_sides());
        work.add(slots.frame, Shape::tube(&[vec3(-axle, -half + 0.3, r), vec3(-axle, half - 0.3, r)], 0.08, 8));
    }
    work.pair(slots.frame, block([length_m - 0.9, 0.1, 0.25], [-length_m / 2.0 - 0.1, 0.42, 0.62], 0.01));
    // Inside.
    work.add(
        slots.interior,
        block([length_m - front - 0.3, half * 1.9, 0.05], [-(length_m + front) / 2.0, 0.0, 1.0], 0.01),
    );
    let rows = ((to - from - 0.3) / 0.72) as usize;
    for i in 0..rows {
        let x = -from - 0.5 - 0.72 * i as f32;
        let seat =
            block([0.42, 0.9, 0.14], [x, 0.64, 1.42], 0.05).and(block([0.12, 0.9, 0.66], [x - 0.2, 0.64, 1.75], 0.05));
        work.pair(slots.seat_cloth, seat);
    }
}
