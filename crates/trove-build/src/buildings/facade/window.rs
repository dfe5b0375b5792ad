//! What closes an opening: frame, bars and panes with a room behind them, or a leaf.

use glam::{DVec2, DVec3};
use trove_model::{FacadeDesign, Filling, Interior, Opening, Random};

use super::ink::Ink;
use crate::buildings::shell::Slot;

/// Frames stand this far in front of their glass.
const FRAME_FRONT_M: f64 = 0.035;
/// And this far behind it.
const FRAME_BACK_M: f64 = 0.02;
/// Between the glass and the inner face of the wall.
const INNER_REVEAL_M: f64 = 0.08;
/// Panes hang askew by this at most, radians (0.3°): each mirrors another piece of the sky.
const ASKEW_RAD: f64 = 0.005;
/// Shares of rooms with a light on.
const LIT_SHARE: f64 = 0.3;
/// Rooms' pictures across and up in their texture, and its size in metres.
const BACKS: [usize; 2] = [4, 3];
const BACK_M: DVec2 = DVec2::new(3.2, 2.6);

/// The space behind an opening.
#[derive(Clone, Copy, Debug)]
pub(super) struct Room {
    /// Its front, around the opening.
    pub low: DVec2,
    pub high: DVec2,
    /// How deep it is, metres; 0: there is no place for one.
    pub depth_m: f64,
    /// Its back's ends along the wall.
    pub back_x: [f64; 2],
}

/// An opening in its place.
#[derive(Clone, Copy, Debug)]
pub(super) struct Hole<'a> {
    pub opening: &'a Opening,
    pub low: DVec2,
    pub high: DVec2,
    pub room: Room,
    /// Of the wall around it.
    pub wall: Slot,
    pub frame: Slot,
}

impl Hole<'_> {
    pub(super) fn size_m(&self) -> DVec2 {
        self.high - self.low
    }
}

/// Closes an opening.
pub(super) fn fill(ink: &mut Ink<'_>, hole: &Hole<'_>, design: &FacadeDesign, random: &mut Random) {
    let recess_m = f64::from(design.recess_m);
    match hole.opening.filling {
        Filling::Window | Filling::GlassDoor if hole.room.depth_m > 0.0 => {
            glazing(ink, hole, design, random);
            room(ink, hole, design, random);
        }
        Filling::Window | Filling::GlassDoor => {
            ink.tube([hole.wall; 4], hole.low, hole.high, [-recess_m - 0.1, 0.0]);
            ink.pane(Slot::Dark, hole.low, hole.high, -recess_m - 0.1, true);
            glazing(ink, hole, design, random);
        }
        Filling::Door => leaf(ink, hole, recess_m),
        Filling::Roller => {
            ink.tube([hole.wall; 4], hole.low, hole.high, [-recess_m, 0.0]);
            // Turned by a right angle, so that ribs lie across.
            let corner = |p: DVec2| (p.extend(-recess_m), DVec2::new(p.y, p.x));
            ink.mapped(Slot::Roller, &super::ink::ring(hole.low, hole.high).map(corner));
        }
    }
}

/// Frame, bars and panes.
fn glazing(ink: &mut Ink<'_>, hole: &Hole<'_>, design: &FacadeDesign, random: &mut Random) {
    let (glass_z, frame_m, bar_m) =
        (-f64::from(design.recess_m), f64::from(design.frame_m), f64::from(design.bar_m.max(0.02)));
    let frame_m = frame_m.min(hole.size_m().min_element() / 4.0);
    let (low, high) = (hole.low + frame_m, hole.high - frame_m);
    ink.frame(hole.frame, [hole.low, hole.high], [low, high], glass_z + FRAME_FRONT_M, true);
    ink.tube([hole.frame; 4], low, high, [glass_z - FRAME_BACK_M, glass_z + FRAME_FRONT_M]);
    let [across, up] = hole.opening.panes.map(|n| n.max(1) as usize);
    let size = (high - low) / DVec2::new(across as f64, up as f64);
    // Crossing bars are not flush, nor is either with the frame.
    for i in 1..across {
        let x = low.x + size.x * i as f64;
        let z = [glass_z - FRAME_BACK_M + 0.004, glass_z + FRAME_FRONT_M - 0.005];
        let (from, to) = (DVec3::new(x - bar_m / 2.0, low.y, z[0]), DVec3::new(x + bar_m / 2.0, high.y, z[1]));
        ink.block(hole.frame, from, to);
    }
    for k in 1..up {
        let y = low.y + size.y * k as f64;
        let z = [glass_z - FRAME_BACK_M + 0.008, glass_z + FRAME_FRONT_M - 0.01];
        let (from, to) = (DVec3::new(low.x, y - bar_m / 2.0, z[0]), DVec3::new(high.x, y + bar_m / 2.0, z[1]));
        ink.block(hole.frame, from, to);
    }
    let many = across * up > 8;
    let (across, up, size) = if many { (1, 1, high - low) } else { (across, up, size) };
    for i in 0..across * up {
        let corner = low + size * DVec2::new((i % across) as f64, (i / across) as f64);
        let tilt = DVec2::new(random.range(-1.0, 1.0), random.range(-1.0, 1.0)) * ASKEW_RAD;
        let at = |p: DVec2| {
            let bend = tilt.dot(p - corner - size / 2.0).clamp(-0.012, 0.012);
            p.extend(glass_z + bend)
        };
        ink.face(Slot::Glass, &super::ink::ring(corner - 0.004, corner + size + 0.004).map(at));
    }
}

/// The room behind a window, with what hangs in the window.
fn room(ink: &mut Ink<'_>, hole: &Hole<'_>, design: &FacadeDesign, random: &mut Random) {
    let room = hole.room;
    let front_z = -f64::from(design.recess_m) - INNER_REVEAL_M;
    let back_z = front_z - room.depth_m;
    let interior = if hole.opening.is_shop(design.interior) { Interior::Shop } else { design.interior };
    let lit = interior != Interior::Bare && random.chance(LIT_SHARE);
    let wall = if lit { Slot::LitRoom } else { *random.pick(&[Slot::RoomPale, Slot::RoomWarm]).unwrap_or(&Slot::Dark) };
    let ceiling = if lit { Slot::LitRoom } else { Slot::RoomPale };
    ink.tube([hole.wall; 4], hole.low, hole.high, [front_z, 0.0]);
    ink.frame(wall, [room.low, room.high], [hole.low, hole.high], front_z, false);
    // Where the building's corner is near, the sides run towards its bisector.
    let front = super::ink::ring(room.low, room.high).map(|p| p.extend(front_z));
    let [left, right] = room.back_x;
    let back = super::ink::ring(DVec2::new(left, room.low.y), DVec2::new(right, room.high.y)).map(|p| p.extend(back_z));
    for (k, slot) in [Slot::RoomFloor, wall, ceiling, wall].into_iter().enumerate() {
        let next = (k + 1) % 4;
        ink.face(slot, &[front[k], front[next], back[next], back[k]]);
    }
    if interior == Interior::Bare || (lit && interior == Interior::Home) {
        ink.face(wall, &back);
    } else {
        let row = match interior {
            Interior::Office => 1,
            Interior::Shop => 2,
            _ => 0,
        };
        let cell = DVec2::new(random.index(BACKS[0]) as f64, f64::from(row)) * BACK_M;
        let size = back[2] - back[0];
        let uv = |p: DVec3| cell + ((p - back[0]).truncate() / size.truncate().max(DVec2::splat(0.01))) * BACK_M;
        ink.mapped(Slot::RoomBack, &back.map(|p| (p, uv(p))));
    }
    hangings(ink, hole, interior, front_z - 0.05, random);
    if interior == Interior::Shop {
        display(ink, hole, front_z, random);
    }
}

/// Curtains at the sides or all across, or a blind some way down.
fn hangings(ink: &mut Ink<'_>, hole: &Hole<'_>, interior: Interior, z: f64, random: &mut Random) {
    if hole.room.depth_m < 0.3 {
        return;
    }
    let low = (hole.low - 0.06).max(hole.room.low + 0.01);
    let high = (hole.high + 0.06).min(hole.room.high - 0.01);
    let draw = random.unit();
    match interior {
        Interior::Home if draw < 0.3 => {
            let down = random.unit() * random.unit();
            ink.pane(Slot::Blind, DVec2::new(low.x, high.y - (high.y - low.y) * (0.15 + 0.85 * down)), high, z, true);
        }
        Interior::Home if draw < 0.8 => {
            let closed = random.chance(0.2);
            let share = if closed { 0.5 } else { random.range(0.1, 0.3) };
            let cloth = if random.chance(0.6) { Slot::Curtain } else { Slot::CurtainWarm };
            let wide = (high.x - low.x) * share;
            for x in [low.x, high.x - wide] {
                pleats(ink, cloth, DVec2::new(x, low.y), DVec2::new(x + wide, high.y), z);
            }
        }
        Interior::Office if draw < 0.45 => {
            let down = random.unit() * random.unit();
            ink.pane(Slot::Blind, DVec2::new(low.x, high.y - (high.y - low.y) * (0.1 + 0.9 * down)), high, z, true);
        }
        _ => {}
    }
}

/// Cloth in folds.
fn pleats(ink: &mut Ink<'_>, slot: Slot, low: DVec2, high: DVec2, z: f64) {
    let folds = ((high.x - low.x) / 0.09).ceil().clamp(2.0, 12.0) as usize;
    let at = |i: usize, y: f64| {
        let x = low.x + (high.x - low.x) * i as f64 / folds as f64;
        DVec3::new(x, y, z - if i % 2 == 0 { 0.0 } else { 0.05 })
    };
    for i in 0..folds {
        ink.face(slot, &[at(i, low.y), at(i + 1, low.y), at(i + 1, high.y), at(i, high.y)]);
    }
}

/// Goods on plinths behind a shop's window.
fn display(ink: &mut Ink<'_>, hole: &Hole<'_>, front_z: f64, random: &mut Random) {
    if hole.room.depth_m < 1.4 {
        return;
    }
    let goods = [Slot::Blind, Slot::CurtainWarm, Slot::Door, Slot::Stripe, Slot::Zinc];
    let mut x = hole.low.x + 0.15;
    while x < hole.high.x - 0.5 {
        let wide = random.range(0.25, 0.5);
        let (near, deep) = (front_z - random.range(0.25, 0.5), random.range(0.3, 0.4));
        let foot = hole.low.y - 0.3_f64.min(hole.low.y - hole.room.low.y - 0.01);
        let plinth = foot + random.range(0.3, 0.6);
        let top = plinth + random.range(0.2, 0.7);
        ink.block(Slot::RoomPale, DVec3::new(x, foot, near - deep), DVec3::new(x + wide, plinth, near));
        let slot = *random.pick(&goods).unwrap_or(&Slot::Blind);
        ink.block(slot, DVec3::new(x + 0.04, plinth, near - deep), DVec3::new(x + wide - 0.06, top, near - 0.06));
        x += wide + random.range(0.1, 0.4);
    }
}

/// A door of panels in its frame, with a step before it.
fn leaf(ink: &mut Ink<'_>, hole: &Hole<'_>, recess_m: f64) {
    let (low, high) = (hole.low, hole.high);
    ink.tube([Slot::Stone, hole.wall, hole.wall, hole.wall], low, high, [-recess_m, 0.0]);
    ink.pane(Slot::Door, low, high, -recess_m, true);
    let frame_m = 0.07;
    let (inner_low, inner_high) = (low + frame_m, high - frame_m);
    ink.frame(hole.frame, [low, high], [inner_low, inner_high], -recess_m + 0.05, true);
    ink.tube([hole.frame; 4], inner_low, inner_high, [-recess_m + 0.001, -recess_m + 0.05]);
    // Panels, two across where the door has two leaves.
    let leaves = if inner_high.x - inner_low.x > 1.15 { 2 } else { 1 };
    let wide = (inner_high.x - inner_low.x) / f64::from(leaves);
    for k in 0..leaves {
        let x = inner_low.x + wide * f64::from(k);
        for [from, to] in [[0.06, 0.4], [0.46, 0.94]] {
            let y = |share: f64| inner_low.y + (inner_high.y - inner_low.y) * share;
            let low = DVec3::new(x + 0.12, y(from), -recess_m);
            ink.block(Slot::Door, low, DVec3::new(x + wide - 0.12, y(to), -recess_m + 0.02));
        }
        let knob = DVec3::new(x + if k == 0 { wide - 0.09 } else { 0.05 }, inner_low.y + 0.95, -recess_m);
        ink.block(Slot::Zinc, knob, knob + DVec3::new(0.04, 0.14, 0.06));
    }
}
