//! What is fixed to a wall: balconies, cages, air conditioners, laundry poles, pipes, lamps, dishes.

use glam::{DVec2, DVec3};
use trove_model::{Fixtures, Random};

use super::ink::Ink;
use super::window::Hole;
use crate::buildings::shell::Slot;

/// Between the bars of a railing.
const BARS_M: f64 = 0.12;
const RAIL_M: f64 = 1.0;

/// What stands in front of an opening of an upper storey.
pub(super) fn fixtures(ink: &mut Ink<'_>, hole: &Hole<'_>, shares: &Fixtures, random: &mut Random) {
    let mut has = |share: f32| share > 0.0 && random.chance(f64::from(share));
    let (barred, glazed) = (has(shares.balconies), has(shares.glass_balconies));
    let (caged, cooled, laundry) = (has(shares.cages), has(shares.conditioners), has(shares.laundry));
    if hole.opening.is_french() {
        if barred || glazed {
            balcony(ink, hole, glazed, random);
        }
        return;
    }
    if caged {
        cage(ink, hole);
    }
    if cooled {
        let x = hole.low.x + random.range(0.0, (hole.size_m().x - 0.85).max(0.05));
        conditioner(ink, DVec2::new(x, hole.low.y - 0.78));
    } else if laundry {
        poles(ink, hole, random);
    }
}

/// A slab with a railing, a step below the door.
fn balcony(ink: &mut Ink<'_>, hole: &Hole<'_>, glazed: bool, random: &mut Random) {
    let deep = random.range(0.8, 1.3);
    let margin = 0.3;
    let length_m = ink.frame.length_m;
    let (left, right) = ((hole.low.x - margin).max(0.05), (hole.high.x + margin).min(length_m - 0.05));
    let floor = hole.low.y - 0.02;
    ink.block(Slot::Slab, DVec3::new(left, floor - 0.13, -0.02), DVec3::new(right, floor, deep));
    let rail = if glazed { Slot::Zinc } else { Slot::Iron };
    let (a, b) = (DVec2::new(left + 0.04, deep - 0.05), DVec2::new(right - 0.04, deep - 0.05));
    let corners = [DVec2::new(a.x, 0.0), a, b, DVec2::new(b.x, 0.0)];
    for (k, pair) in corners.windows(2).enumerate() {
        let at = |p: DVec2, y: f64| DVec3::new(p.x, floor + y, p.y);
        // Rails at the sides end short of the one in front.
        let trim = |p: DVec2, q: DVec2| p + (q - p).normalize_or_zero() * if k == 1 { 0.0 } else { 0.022 };
        let (p, q) = (trim(pair[0], pair[1]), trim(pair[1], pair[0]));
        ink.bar(rail, at(p, RAIL_M), at(q, RAIL_M), 0.04);
        if glazed {
            let (p, q) = (p.lerp(q, 0.01), q.lerp(p, 0.01));
            ink.face(Slot::Balustrade, &[at(p, 0.06), at(q, 0.06), at(q, RAIL_M - 0.03), at(p, RAIL_M - 0.03)]);
            continue;
        }
        ink.bar(rail, at(p, 0.08), at(q, 0.08), 0.03);
        let count = (p.distance(q) / BARS_M).round().max(1.0) as usize;
        for i in 0..count {
            let foot = p.lerp(q, (i as f64 + 0.5) / count as f64);
            rod(ink, rail, DVec3::new(foot.x, floor + 0.09, foot.y), RAIL_M - 0.1, 0.014);
        }
    }
}

/// An upright rod of three sides.
fn rod(ink: &mut Ink<'_>, slot: Slot, foot: DVec3, high_m: f64, thick_m: f64) {
    let r = thick_m * 0.6;
    let ring = [DVec3::new(-r, 0.0, -r), DVec3::new(0.0, 0.0, r), DVec3::new(r, 0.0, -r)].map(|d| foot + d);
    let up = DVec3::Y * high_m;
    for k in 0..3 {
        let (a, b) = (ring[k], ring[(k + 1) % 3]);
        ink.face(slot, &[a, b, b + up, a + up]);
    }
}

/// A cage of bars around a window, with a little roof.
fn cage(ink: &mut Ink<'_>, hole: &Hole<'_>) {
    let out = 0.4;
    let (low, high) = (hole.low - 0.05, hole.high + 0.04);
    let p = |x: f64, y: f64, z: f64| DVec3::new(x, y, z);
    for y in [low.y, low.y + 0.45, (low.y + high.y) / 2.0 + 0.2, high.y] {
        ink.bar(Slot::Zinc, p(low.x, y, out), p(high.x, y, out), 0.025);
        for x in [low.x, high.x] {
            ink.bar(Slot::Zinc, p(x, y, 0.0), p(x, y, out - 0.014), 0.024);
        }
    }
    let count = ((high.x - low.x) / 0.13).round() as usize;
    for i in 0..=count {
        let x = low.x + (high.x - low.x) * i as f64 / count as f64;
        rod(ink, Slot::Zinc, p(x, low.y, out), high.y - low.y, 0.014);
    }
    ink.block(Slot::Slab, p(low.x + 0.02, low.y - 0.035, 0.0), p(high.x - 0.02, low.y - 0.014, out - 0.02));
}

/// The outside half of an air conditioner on brackets.
pub(super) fn conditioner(ink: &mut Ink<'_>, low: DVec2) {
    let (wide, high, near, out) = (0.82, 0.56, 0.1, 0.4);
    ink.solid(Slot::Zinc, low.extend(near), (low + DVec2::new(wide, high)).extend(out));
    // The fan's grille is a disk on the front.
    let centre = (low + DVec2::new(0.3, high / 2.0)).extend(out + 0.004);
    let disk: Vec<DVec3> = (0..10)
        .map(|i| {
            let turn = std::f64::consts::TAU * f64::from(i) / 10.0;
            centre + DVec3::new(turn.cos(), turn.sin(), 0.0) * 0.21
        })
        .collect();
    ink.face(Slot::Dark, &disk);
    for x in [0.1, wide - 0.14] {
        let foot = low + DVec2::new(x, -0.04);
        ink.block(Slot::Iron, foot.extend(-0.01), (foot + DVec2::new(0.04, 0.039)).extend(out - 0.02));
    }
    let pipe = low + DVec2::new(wide + 0.03, 0.1);
    ink.bar(Slot::Zinc, pipe.extend(0.03), (pipe + DVec2::Y * 0.9).extend(0.03), 0.04);
}

/// Poles with laundry.
fn poles(ink: &mut Ink<'_>, hole: &Hole<'_>, random: &mut Random) {
    let y = hole.low.y - 0.2;
    for i in 0..3 {
        let x = hole.low.x + 0.2 + f64::from(i) * 0.45;
        ink.bar(Slot::Zinc, DVec3::new(x, y, -0.01), DVec3::new(x, y + 0.1, 1.9), 0.03);
        let mut z = 0.25;
        while z < 1.6 && random.chance(0.85) {
            let (wide, long) = (random.range(0.25, 0.55), random.range(0.35, 0.8));
            let slot =
                *random.pick(&[Slot::Curtain, Slot::CurtainWarm, Slot::Cloth, Slot::Stripe]).unwrap_or(&Slot::Cloth);
            let top = y + 0.05 * z;
            let p = |z: f64, y: f64| DVec3::new(x + 0.02, y, z);
            ink.face(slot, &[p(z + wide, top - long), p(z, top - long), p(z, top), p(z + wide, top)]);
            z += wide + random.range(0.03, 0.2);
        }
    }
}

/// A pipe from the eaves to the ground, with sockets where its pieces meet.
pub(super) fn downpipe(ink: &mut Ink<'_>, x: f64, y: [f64; 2]) {
    let (r, z) = (0.05, 0.11);
    let tube = |ink: &mut Ink<'_>, r: f64, y: [f64; 2]| {
        let at = |i: usize, y: f64| {
            let turn = std::f64::consts::TAU * i as f64 / 8.0;
            DVec3::new(x + r * turn.cos(), y, z + r * turn.sin())
        };
        for i in 0..8 {
            ink.face(Slot::Pipe, &[at(i + 1, y[0]), at(i, y[0]), at(i, y[1]), at(i + 1, y[1])]);
        }
    };
    tube(ink, r, y);
    let mut socket = y[0] + 1.8;
    while socket < y[1] - 0.5 {
        tube(ink, r + 0.012, [socket, socket + 0.08]);
        ink.block(Slot::Pipe, DVec3::new(x - 0.015, socket + 0.02, 0.0), DVec3::new(x + 0.015, socket + 0.06, z - r));
        socket += 2.6;
    }
}

/// A lamp on the wall, its lens downwards.
pub(super) fn lamp(ink: &mut Ink<'_>, at: DVec2) {
    ink.solid(Slot::Iron, (at - DVec2::new(0.05, 0.0)).extend(0.02), (at + DVec2::new(0.05, 0.06)).extend(0.2));
    let low = at - DVec2::new(0.06, 0.12);
    ink.solid(Slot::Lamp, low.extend(0.08), (at + DVec2::new(0.06, -0.002)).extend(0.2));
}

/// A box for meters on the wall, and a vent above it.
pub(super) fn meter_box(ink: &mut Ink<'_>, low: DVec2) {
    ink.block(Slot::Zinc, low.extend(-0.01), (low + DVec2::new(0.5, 0.7)).extend(0.14));
    ink.block(Slot::Dark, (low + DVec2::new(0.3, 0.25)).extend(0.135), (low + DVec2::new(0.42, 0.4)).extend(0.15));
    let vent = low + DVec2::new(0.1, 1.3);
    for k in 0..4 {
        let y = vent.y + 0.05 * f64::from(k);
        ink.block(Slot::Zinc, DVec3::new(vent.x, y, -0.01), DVec3::new(vent.x + 0.28, y + 0.03, 0.02));
    }
}

/// A dish that looks up to a satellite.
pub(super) fn dish(ink: &mut Ink<'_>, at: DVec2) {
    let centre = at.extend(0.45);
    let axis = DVec3::new(0.35, 0.55, 0.75).normalize();
    let side = axis.cross(DVec3::Y).normalize();
    let up = side.cross(axis);
    let rim = |i: usize| {
        let turn = std::f64::consts::TAU * i as f64 / 12.0;
        centre + (side * turn.cos() + up * turn.sin()) * 0.35 + axis * 0.09
    };
    for i in 0..12 {
        let (a, b) = (rim(i), rim(i + 1));
        ink.face(Slot::Zinc, &[centre, a, b]);
        ink.face(Slot::Zinc, &[centre - axis * 0.008, b - axis * 0.008, a - axis * 0.008]);
    }
    ink.bar(Slot::Zinc, at.extend(-0.01), centre - axis * 0.01, 0.03);
    ink.bar(Slot::Iron, centre - up * 0.33 + axis * 0.07, centre + axis * 0.34, 0.015);
    ink.bar(Slot::Iron, centre + axis * 0.33, centre + axis * 0.41, 0.05);
}

/// Platforms with railings and ladders between them, on the front of a wall from one floor up.
pub(super) fn fire_escape(ink: &mut Ink<'_>, x: [f64; 2], floors: &[f64]) {
    let deep = 1.0;
    let p = |x: f64, y: f64, z: f64| DVec3::new(x, y, z);
    for (k, &y) in floors.iter().enumerate() {
        for i in 0..9 {
            let z = 0.08 + (deep - 0.1) * f64::from(i) / 8.0;
            ink.bar(Slot::Iron, p(x[0], y, z), p(x[1], y, z), 0.03);
        }
        for end in x {
            ink.bar(Slot::Iron, p(end, y - 0.03, -0.01), p(end, y - 0.03, deep), 0.05);
            ink.bar(Slot::Iron, p(end, y - 0.6, 0.0), p(end, y - 0.06, deep - 0.15), 0.03);
            for up in [0.5, 0.95] {
                ink.bar(Slot::Iron, p(end, y + up, 0.0), p(end, y + up, deep - 0.02), 0.025);
            }
        }
        for up in [0.5, 0.95] {
            ink.bar(Slot::Iron, p(x[0], y + up, deep), p(x[1], y + up, deep), 0.03);
        }
        let posts = ((x[1] - x[0]) / 0.7).round().max(2.0) as usize;
        for i in 0..=posts {
            rod(ink, Slot::Iron, p(x[0] + (x[1] - x[0]) * i as f64 / posts as f64, y, deep), 0.95, 0.025);
        }
        let Some(&next) = floors.get(k + 1) else { continue };
        // A steep stair to the next platform, leaning the other way on every other floor.
        let (from, to) = if k % 2 == 0 { (x[0] + 0.5, x[1] - 0.6) } else { (x[1] - 0.5, x[0] + 0.6) };
        for z in [0.35, 0.75] {
            ink.bar(Slot::Iron, p(from, y, z), p(to, next, z), 0.06);
        }
        let steps = ((next - y) / 0.24).round().max(2.0) as usize;
        for i in 1..steps {
            let share = i as f64 / steps as f64;
            let (x, y) = (from + (to - from) * share, y + (next - y) * share);
            ink.bar(Slot::Iron, p(x, y, 0.38), p(x, y, 0.72), 0.04);
        }
    }
}
