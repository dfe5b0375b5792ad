//! What a shop shows to the street: signs, awnings, a stall riser.

use glam::{DVec2, DVec3};
use trove_model::{Fixtures, Random};

use super::ink::Ink;
use super::window::Hole;
use crate::buildings::shell::Slot;

/// Signs across and up in their texture, and a sign's size in metres.
const SIGNS: [usize; 2] = [2, 8];
const SIGN_M: DVec2 = DVec2::new(3.2, 0.6);

/// Over and before a shop's window; `top` is what the storey leaves.
pub(super) fn front(ink: &mut Ink<'_>, hole: &Hole<'_>, shares: &Fixtures, top: f64, random: &mut Random) {
    let mut has = |share: f32| share > 0.0 && random.chance(f64::from(share));
    let (signed, shaded, blade) = (has(shares.signs), has(shares.awnings), has(shares.blades));
    let (low, high) = (hole.low, hole.high);
    let which = random.index(SIGNS[0] * SIGNS[1]);
    // The stall riser.
    if low.y - hole.floor > 0.25 {
        ink.block(hole.frame, DVec3::new(low.x, hole.floor + 0.03, -0.02), DVec3::new(high.x, low.y - 0.07, 0.03));
    }
    let room_m = top - high.y;
    if signed && room_m > 0.45 {
        let tall = (room_m - 0.2).min(0.65);
        let (left, right) = (hole.bay_x[0] + 0.06, hole.bay_x[1] - 0.06);
        let foot = high.y + 0.12;
        let (from, to) = (DVec3::new(left, foot, -0.02), DVec3::new(right, foot + tall, 0.12));
        use super::ink::Side::{Bottom, Left, Right, Top};
        ink.sides(Slot::Iron, from, to, &[Left, Right, Bottom, Top]);
        ink.pane(Slot::Iron, from.truncate(), to.truncate(), from.z, false);
        sign(ink, which, [DVec2::new(left, foot), DVec2::new(right, foot + tall)].map(|p| p.extend(0.12)));
        sign_lamp(ink, [left, right], foot + tall);
    }
    if shaded && room_m > 0.2 {
        awning(ink, hole, random);
    }
    if blade {
        let (foot, tall) = (top + random.range(0.1, 0.5), random.range(1.6, 3.0));
        blade_sign(ink, (low.x + 0.3).max(0.3), [foot, foot + tall], which);
    }
}

/// A bar before a sign's upper edge that shines down on it.
fn sign_lamp(ink: &mut Ink<'_>, [left, right]: [f64; 2], top: f64) {
    let [low, high] = [DVec3::new(left + 0.1, top + 0.02, 0.2), DVec3::new(right - 0.1, top + 0.06, 0.26)];
    use super::ink::Side::{Front, Left, Right, Top};
    ink.sides(Slot::Zinc, low, high, &[Front, Left, Right, Top]);
    ink.pane(Slot::Zinc, low.truncate(), high.truncate(), low.z, false);
    let at = |x: f64, z: f64| DVec3::new(x, low.y, z);
    ink.face(Slot::SignLamp, &[at(low.x, low.z), at(high.x, low.z), at(high.x, high.z), at(low.x, high.z)]);
    for x in [low.x + 0.1, high.x - 0.1] {
        ink.bar(Slot::Zinc, DVec3::new(x, low.y + 0.02, 0.0), DVec3::new(x, low.y + 0.02, low.z + 0.01), 0.02);
    }
}

/// A cell of the signs' texture on an upright rectangle that looks out.
fn sign(ink: &mut Ink<'_>, which: usize, [low, high]: [DVec3; 2]) {
    let corner = DVec2::new((which % SIGNS[0]) as f64, (which / SIGNS[0]) as f64) * SIGN_M;
    // The cell's proportions are kept: of a narrower sign its ends are cut.
    let wide = ((high.x - low.x) / (high.y - low.y) * SIGN_M.y).min(SIGN_M.x);
    let uv = |x: f64, y: f64| corner + DVec2::new(SIGN_M.x / 2.0 + (x - 0.5) * wide, y * SIGN_M.y);
    let corners = [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)];
    let at = |(x, y): (f64, f64)| (low + (high - low) * DVec3::new(x, y, 0.0), uv(x, y));
    ink.mapped(Slot::Sign, &corners.map(at));
}

/// A sign that stands out into the street, its writing upright.
fn blade_sign(ink: &mut Ink<'_>, x: f64, y: [f64; 2], which: usize) {
    let (thick, near, wide) = (0.14, 0.15, 0.7);
    let corner = DVec2::new((which % SIGNS[0]) as f64, (which / SIGNS[0]) as f64) * SIGN_M;
    let (a, b) = (DVec3::new(x, y[0], near), DVec3::new(x + thick, y[1], near + wide));
    use super::ink::Side::{Bottom, Front, Top};
    ink.sides(Slot::Iron, a, b, &[Bottom, Top, Front]);
    ink.pane(Slot::Iron, a.truncate(), b.truncate(), near, false);
    let face = |x: f64, z: [f64; 2]| {
        let p = |y: f64, z: f64| DVec3::new(x, y, z);
        // Writing runs downwards.
        let (top, foot) = (corner, corner + DVec2::X * SIGN_M.x);
        let up = DVec2::Y * SIGN_M.y;
        [(p(y[0], z[0]), foot), (p(y[0], z[1]), foot + up), (p(y[1], z[1]), top + up), (p(y[1], z[0]), top)]
    };
    ink.mapped(Slot::Sign, &face(b.x, [b.z, a.z]));
    ink.mapped(Slot::Sign, &face(a.x, [a.z, b.z]));
    for y in [y[0] + 0.2, y[1] - 0.2] {
        ink.bar(Slot::Iron, DVec3::new(x + thick / 2.0, y, -0.01), DVec3::new(x + thick / 2.0, y, near + 0.02), 0.04);
    }
}

/// Striped cloth on two arms.
fn awning(ink: &mut Ink<'_>, hole: &Hole<'_>, random: &mut Random) {
    let (out, drop) = (random.range(0.9, 1.4), random.range(0.45, 0.8));
    let (top, z) = (hole.high.y + 0.1, 0.16);
    let (left, right) = (hole.low.x - 0.12, hole.high.x + 0.12);
    let stripes = ((right - left) / 0.22).round().max(2.0) as usize;
    let plain = random.chance(0.4);
    let p = |x: f64, y: f64, z: f64| DVec3::new(x, y, z);
    for i in 0..stripes {
        let x = |k: usize| left + (right - left) * k as f64 / stripes as f64;
        let (a, b) = (x(i), x(i + 1));
        let slot = if plain || i % 2 == 0 { Slot::Cloth } else { Slot::Stripe };
        let foot = top - drop;
        let faces = [
            [p(a, foot, z + out), p(b, foot, z + out), p(b, top, z), p(a, top, z)],
            [p(a, foot - 0.2, z + out), p(b, foot - 0.2, z + out), p(b, foot, z + out), p(a, foot, z + out)],
        ];
        for face in faces {
            ink.face(slot, &face);
            let below = face.map(|q| q - DVec3::new(0.0, 0.004, 0.003));
            ink.face(slot, &[below[3], below[2], below[1], below[0]]);
        }
    }
    for x in [left + 0.05, right - 0.05] {
        ink.bar(Slot::Zinc, p(x, top - drop - 0.02, 0.0), p(x, top - drop - 0.02, z + out - 0.02), 0.03);
    }
    ink.block(Slot::Zinc, p(left - 0.02, top - 0.02, -0.01), p(right + 0.02, top + 0.12, z + 0.02));
}
