//! The canvas hood on its hoops, and the windscreen in its frame.

use glam::{Vec2, Vec3, vec2, vec3};

use crate::shape::{Prism, Shape, pane, rect};
use crate::vehicles::coverings::metric;
use crate::vehicles::workshop::Workshop;

/// A cross section of the hood: how far behind, its top, half its width, where its sides end, how much it slants
/// backwards towards its foot.
struct Hoop {
    x: f32,
    top: f32,
    half: f32,
    foot: f32,
    slant: f32,
}

const fn hoop(x: f32, top: f32, half: f32, foot: f32, slant: f32) -> Hoop {
    Hoop { x, top, half, foot, slant }
}

/// From the windscreen to the back: short above the doors, down to the tub behind them.
const HOOPS: [Hoop; 11] = [
    hoop(-0.49, 1.605, 0.5, 1.53, 0.0),
    hoop(-0.8, 1.645, 0.55, 1.53, 0.0),
    hoop(-1.15, 1.675, 0.6, 1.53, 0.0),
    hoop(-1.45, 1.69, 0.625, 1.53, 0.0),
    hoop(-1.66, 1.69, 0.64, 1.51, 0.0),
    hoop(-1.8, 1.687, 0.642, 0.93, 0.0),
    hoop(-2.05, 1.675, 0.642, 0.93, 0.0),
    hoop(-2.28, 1.65, 0.64, 0.93, 0.02),
    hoop(-2.42, 1.61, 0.635, 0.93, 0.06),
    hoop(-2.49, 1.57, 0.622, 0.93, 0.11),
    hoop(-2.525, 1.52, 0.6, 0.93, 0.12),
];

impl Hoop {
    /// From right to left over the top.
    fn ring(&self) -> Vec<Vec3> {
        let shoulder = (self.top - 0.17).max(self.foot + 0.005);
        let side = (0..4).map(|i| vec2(self.half, self.foot + (shoulder - self.foot) * i as f32 / 4.0));
        let round = (0..=6).map(|i| Vec2::from_angle(std::f32::consts::FRAC_PI_2 * i as f32 / 6.0).abs());
        let round = round.map(|p| vec2(self.half * p.x.powf(0.55), shoulder + (self.top - shoulder) * p.y.powf(0.9)));
        let left: Vec<Vec2> = side.chain(round).collect();
        let right = left[..left.len() - 1].iter().map(|p| vec2(-p.x, p.y));
        let place = |p: Vec2| vec3(self.x - self.slant * (self.top - p.y), p.x, p.y);
        right.chain(left.iter().rev().copied()).map(place).collect()
    }
}

pub(super) fn build(work: &mut Workshop) {
    canvas(work);
    windscreen(work);
}

fn canvas(work: &mut Workshop) {
    let slots = work.slots;
    let mut rows: Vec<Vec<Vec3>> = HOOPS.iter().map(Hoop::ring).collect();
    // The back is the last hoop filled in, a little bulged.
    let last = rows[rows.len() - 1].clone();
    let foot = (last[0] + last[last.len() - 1]) / 2.0;
    for (share, out) in [(0.96, 0.025), (0.86, 0.04), (0.6, 0.045), (0.3, 0.045), (0.0, 0.045)] {
        rows.push(last.iter().map(|p| foot + (*p - foot) * share - Vec3::X * out).collect());
    }
    let window = Prism::front(&pane(&rect(-0.27, 0.27, 1.2, 1.4), 0.05), -3.0..=-2.45);
    let skin = Shape::sheet(&rows).smooth(0.8).slot(slots.canvas).mark(&window, slots.glass).plate(0.01);
    work.model.add_marked(metric(skin));

    // Piping along its lower edge, the hoops under it, the rails that carry it.
    let edge: Vec<Vec3> = HOOPS.iter().map(|h| vec3(h.x - h.slant * (h.top - h.foot), h.half, h.foot)).collect();
    work.pair(slots.trim, Shape::tube(&edge[..6], 0.012, 6));
    let under = |h: &Hoop| -> Vec<Vec3> {
        h.ring().iter().map(|p| p - vec3(0.0, p.y.signum() * 0.024, 0.03)).filter(|p| p.z > 1.3).collect()
    };
    for i in [1, 3, 6, 8] {
        work.add(slots.trim, Shape::tube(&under(&HOOPS[i]), 0.011, 5));
    }
    work.add(slots.trim, Shape::tube(&HOOPS[0].ring(), 0.016, 6));
    // Posts before and behind the passengers' doors.
    let posts = [vec3(-1.3, 0.565, 0.3), vec3(-1.29, 0.572, 1.55)];
    work.pair(slots.trim, Shape::tube(&posts, 0.017, 6));
    let rear = [vec3(-1.72, 0.618, 0.95), vec3(-1.67, 0.605, 1.54)];
    work.pair(slots.trim, Shape::tube(&rear, 0.015, 6));
}

/// A flat pane that leans back, in a rubber seal and a painted frame.
fn windscreen(work: &mut Workshop) {
    let slots = work.slots;
    let outline = |by: f32| pane(&rect(-0.49 - by, 0.49 + by, 1.07 - by, 1.54 + by).map(narrowing), 0.09);
    let leaning = |p: Vec2| vec3(-0.45 - 0.12 * (p.y - 1.05), p.x, p.y);
    let around = |by: f32| -> Vec<Vec3> {
        let outline = outline(by);
        outline.iter().chain(&outline[..2]).map(|p| leaning(*p)).collect()
    };
    work.add(slots.glass, Shape::flat(&outline(0.0)).bent(|p| leaning(p.truncate())));
    work.add(slots.trim, Shape::tube(&around(0.0), 0.014, 6));
    work.add(slots.paint, Shape::tube(&around(0.024), 0.02, 6));
    // The wiper rests along the foot of the pane.
    let on = |y: f32, z: f32, lift: f32| leaning(vec2(y, z)) + Vec3::X * lift;
    let arm = [on(0.04, 1.055, 0.02), on(-0.1, 1.1, 0.04), on(-0.2, 1.13, 0.03)];
    let blade = [on(-0.02, 1.11, 0.015), on(-0.38, 1.15, 0.015)];
    work.add(slots.trim, Shape::tube(&arm, 0.008, 5).and(Shape::tube(&blade, 0.008, 4)));
}

/// The pane is narrower above.
fn narrowing(p: Vec2) -> Vec2 {
    vec2(p.x * (1.0 - 0.1 * (p.y - 1.07) / 0.49), p.y)
}
