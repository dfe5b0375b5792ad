//! What stands out of a wall: sills, lintels, surrounds, courses, piers, cornices, shutters.

use glam::DVec3;
use trove_model::{FacadeDesign, Filling, Random};

use super::ink::Ink;
use super::window::Hole;
use crate::buildings::shell::Slot;

/// Blocks start this far within the wall.
const ROOT_M: f64 = -0.02;
/// What is painted stands out this far, so that nothing is coplanar.
const PAINT_M: f64 = 0.004;
/// What has no mitre stays this far from the ends of its wall.
const END_M: f64 = 0.004;

/// What surrounds an opening; plain walls have their sills alone.
pub(super) fn surround(ink: &mut Ink<'_>, hole: &Hole<'_>, design: &FacadeDesign, plain: bool, random: &mut Random) {
    let (low, high) = (hole.low, hole.high);
    // They end with their wall, and their backs are closed: the next window may be behind them.
    let block = |ink: &mut Ink<'_>, x: [f64; 2], y: [f64; 2], out: f64| {
        let [from, to] = x.map(|x| x.clamp(END_M, (ink.frame.length_m - END_M).max(END_M)));
        if to > from {
            ink.solid(Slot::Stone, DVec3::new(from, y[0], ROOT_M), DVec3::new(to, y[1], out));
        }
    };
    let [wide, out] = design.surround_m.map(f64::from);
    let wide = if plain { 0.0 } else { wide };
    if wide > 0.0 {
        block(ink, [low.x - wide, low.x - 0.001], [low.y, high.y], out);
        block(ink, [high.x + 0.001, high.x + wide], [low.y, high.y], out);
        block(ink, [low.x - wide, high.x + wide], [high.y + 0.001, high.y + wide], out + 0.004);
    }
    let [thick, out] = design.lintel_m.map(f64::from);
    if thick > 0.0 && !plain {
        let y = high.y + wide + 0.002;
        block(ink, [low.x - 0.12, high.x + 0.12], [y, y + thick], out + 0.006);
        if out > 0.14 {
            // A hood on consoles.
            for x in [low.x - 0.1, high.x - 0.02] {
                block(ink, [x, x + 0.12], [y - 0.25, y + 0.01], out * 0.6);
            }
        }
    }
    let [thick, out] = design.sill_m.map(f64::from);
    if thick > 0.0 && hole.opening.filling == Filling::Window {
        // Its top lies a little below the reveal.
        block(ink, [low.x - 0.08, high.x + 0.08], [low.y - thick, low.y - 0.003], out + 0.01);
    }
    if let (Some(_), false, Filling::Window) = (design.shutters, plain, hole.opening.filling) {
        shutters(ink, hole, wide, random);
    }
}

/// Two leaves, open against the wall or closed.
fn shutters(ink: &mut Ink<'_>, hole: &Hole<'_>, surround_m: f64, random: &mut Random) {
    let (low, high) = (hole.low, hole.high);
    let wide = (high.x - low.x) / 2.0;
    let (closed, out) = (random.chance(0.15), f64::from(u8::from(surround_m > 0.0)) * 0.03);
    let ajar = random.range(0.0, 0.03);
    for (k, x) in [(0, low.x), (1, high.x)] {
        let inwards = if k == 0 { 1.0 } else { -1.0 };
        let side = if closed { inwards } else { -inwards };
        let [a, b] = if side > 0.0 { [x, x + wide] } else { [x - wide, x] };
        let (z0, z1) = if closed { (-0.06, -0.025) } else { (out + 0.015 + ajar, out + 0.05 + ajar) };
        let rim = 0.055;
        let (from, to) = (DVec3::new(a + 0.006, low.y + 0.01, z0), DVec3::new(b - 0.006, high.y - 0.01, z1 - 0.014));
        ink.block(Slot::Shutter, from, to);
        for x in [a + 0.004, b - rim - 0.004] {
            ink.block(Slot::Shutter, DVec3::new(x, low.y + 0.006, z0), DVec3::new(x + rim, high.y - 0.006, z1));
        }
        // Slats at an angle.
        let count = ((high.y - low.y) / 0.085) as usize;
        for i in 0..count {
            let y = low.y + 0.02 + (high.y - low.y - 0.04) * i as f64 / count as f64;
            let p = |x: f64, y: f64, z: f64| DVec3::new(x, y, z);
            let (xa, xb) = (a + rim, b - rim);
            let face =
                [p(xa, y, z1 - 0.002), p(xb, y, z1 - 0.002), p(xb, y + 0.07, z1 - 0.013), p(xa, y + 0.07, z1 - 0.013)];
            ink.face(Slot::Shutter, &face);
        }
    }
}

/// Bands along a storey whose floor is at `y`, drawn for a storey of `scale` times the design's height. Painted ones go
/// between the holes, given as ranges of x.
pub(super) fn courses(ink: &mut Ink<'_>, design: &FacadeDesign, y: f64, scale: f64, holes: &[[f64; 4]], plain: bool) {
    let length_m = ink.frame.length_m;
    for course in &design.courses {
        let [low, high] = course.between_m.map(|m| y + f64::from(m) * scale);
        let painted = course.out_m <= 0.0;
        if plain && !painted {
            continue;
        }
        let (slot, out) = if painted { (Slot::Band, PAINT_M) } else { (Slot::Stone, f64::from(course.out_m)) };
        let mut from = None;
        for hole in holes.iter().filter(|h| h[2] < high + 0.01 && h[3] > low - 0.01) {
            if hole[0] - 0.02 > from.unwrap_or(0.0) + 0.02 {
                ink.ledge(slot, [from, Some(hole[0] - 0.02)], [low, high - 0.002], out);
            }
            from = Some(hole[1] + 0.02);
        }
        if from.unwrap_or(0.0) + 0.02 < length_m {
            ink.ledge(slot, [from, None], [low, high - 0.002], out);
        }
    }
}

/// Piers at the borders of bays.
pub(super) fn piers(ink: &mut Ink<'_>, design: &FacadeDesign, borders: &[f64], y: [f64; 2], slot: Slot) {
    let [wide, out] = design.pier_m.map(f64::from);
    if wide <= 0.0 {
        return;
    }
    let length_m = ink.frame.length_m;
    for &x in borders {
        let (from, to) = ((x - wide / 2.0).max(END_M), (x + wide / 2.0).min(length_m - END_M));
        if to > from {
            ink.solid(slot, DVec3::new(from, y[0], ROOT_M), DVec3::new(to, y[1], out));
        }
    }
}

/// A cornice under the eaves, in two steps.
pub(super) fn cornice(ink: &mut Ink<'_>, design: &FacadeDesign, top: f64) {
    let [high, out] = design.cornice_m.map(f64::from);
    if high <= 0.0 {
        return;
    }
    for (from, to, out) in [(0.0, 0.45, out), (0.45, 0.75, out * 0.6), (0.75, 1.0, out * 0.25)] {
        ink.ledge(Slot::Stone, [None; 2], [top - 0.02 - high * to, top - 0.02 - high * from], out);
    }
}
