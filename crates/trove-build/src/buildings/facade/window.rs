//! What closes an opening: frame, bars and panes with a room behind them, or a leaf.

use glam::{DVec2, DVec3};
use trove_model::{FacadeDesign, Filling, Interior, Opening, Random};

use super::ink::{Ink, ring};
use super::skin::{Cell, Row, Vertex, skin};
use crate::buildings::shell::Slot;

/// Frames stand this far in front of their glass.
const FRAME_FRONT_M: f64 = 0.035;
/// And this far behind it.
const FRAME_BACK_M: f64 = 0.02;
/// Between the glass and the inner face of the wall.
pub(super) const INNER_REVEAL_M: f64 = 0.08;
/// Panes hang askew by this at most, radians (0.3°): each mirrors another piece of the sky.
const ASKEW_RAD: f64 = 0.005;
/// A room's front and back are cut this far from their edges, metres: less than openings keep from them.
const SKIRT_M: f64 = 0.002;
/// Share of rooms with a light on, but for shops.
const LIT_SHARE: f64 = 0.3;
/// Lampshades, how far they hang below the ceiling, and how far they are apart; panels likewise, right below it.
const SHADE_M: DVec3 = DVec3::new(0.4, 0.25, 0.4);
const SHADE_BELOW_M: f64 = 0.25;
const SHADES_APART_M: f64 = 4.0;
const PANEL_M: DVec3 = DVec3::new(0.6, 0.0, 0.6);
const PANELS_APART_M: f64 = 2.4;
/// Rooms' pictures across and up in their texture, and its size in metres.
const BACKS: [usize; 2] = [4, 3];
const BACK_M: DVec2 = DVec2::new(3.2, 2.6);

/// The space behind openings.
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
    /// World height of its storey's floor.
    pub floor: f64,
    /// Ends of its bay.
    pub bay_x: [f64; 2],
    /// Of the wall around it.
    pub wall: Slot,
    pub frame: Slot,
}

impl Hole<'_> {
    pub(super) fn size_m(&self) -> DVec2 {
        self.high - self.low
    }
}

/// Closes an opening; behind glass a room has to follow.
pub(super) fn fill(ink: &mut Ink<'_>, hole: &Hole<'_>, design: &FacadeDesign, random: &mut Random) {
    let recess_m = f64::from(design.recess_m);
    match hole.opening.filling {
        Filling::Window | Filling::GlassDoor => {
            ink.tube([hole.wall; 4], hole.low, hole.high, [-recess_m - INNER_REVEAL_M, 0.0]);
            glazing(ink, hole, design, random);
        }
        Filling::Door => leaf(ink, hole, recess_m),
        Filling::Roller => {
            ink.tube([hole.wall; 4], hole.low, hole.high, [-recess_m, 0.0]);
            // Turned by a right angle, so that ribs lie across.
            let corner = |p: DVec2| (p.extend(-recess_m), DVec2::new(p.y, p.x));
            ink.mapped(Slot::Roller, &ring(hole.low, hole.high).map(corner));
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
        ink.face(Slot::Glass, &ring(corner - 0.004, corner + size + 0.004).map(at));
    }
}

/// The room behind glazed openings of one storey, from left to right, with what hangs and stands in them.
pub(super) fn room(ink: &mut Ink<'_>, holes: &[Hole<'_>], room: Room, design: &FacadeDesign, random: &mut Random) {
    let front_z = -f64::from(design.recess_m) - INNER_REVEAL_M;
    if room.depth_m <= 0.0 {
        for hole in holes {
            ink.pane(Slot::Dark, hole.low, hole.high, front_z, true);
        }
        return;
    }
    let back_z = front_z - room.depth_m;
    let is_shop = holes.iter().any(|h| h.opening.is_shop(design.interior));
    let interior = match design.interior {
        Interior::Shop if !is_shop => Interior::Home,
        interior => interior,
    };
    let lit = interior != Interior::Bare && random.chance(LIT_SHARE);
    let wall =
        if lit { Slot::RoomPale } else { *random.pick(&[Slot::RoomPale, Slot::RoomWarm]).unwrap_or(&Slot::Dark) };
    let cell = |i: usize| {
        let left = if i == 0 { room.low.x + SKIRT_M } else { (holes[i - 1].high.x + holes[i].low.x) / 2.0 };
        let next = holes.get(i + 1).map(|next| (holes[i].high.x + next.low.x) / 2.0);
        Cell { x: [left, next.unwrap_or(room.high.x - SKIRT_M)], hole: Some([holes[i].low, holes[i].high]) }
    };
    let front = [room.low, room.high];
    let row = Row { y: [room.low.y + SKIRT_M, room.high.y - SKIRT_M], cells: (0..holes.len()).map(cell).collect() };
    plane(ink, front, row, front_z, false, wall, |p, _| p);
    // Where the building's corner is near, the sides run towards its bisector.
    let [left, right] = room.back_x;
    let back = [DVec2::new(left, room.low.y), DVec2::new(right, room.high.y)];
    let rings = [(front, front_z), (back, back_z)].map(|([low, high], z)| ring(low, high).map(|p| p.extend(z)));
    for (k, slot) in [Slot::RoomFloor, wall, Slot::RoomPale, wall].into_iter().enumerate() {
        let next = (k + 1) % 4;
        ink.face(slot, &[rings[0][k], rings[0][next], rings[1][next], rings[1][k]]);
    }
    let pictures = ((right - left) / BACK_M.x).round().max(1.0);
    let wide = (right - left - 2.0 * SKIRT_M) / pictures;
    let cell = |i: usize| {
        let at = |i: usize| left + SKIRT_M + wide * i as f64;
        Cell { x: [at(i), at(i + 1)], hole: None }
    };
    let cells: Vec<Cell> = (0..pictures as usize).map(cell).collect();
    let row = Row { y: [room.low.y + SKIRT_M, room.high.y - SKIRT_M], cells };
    let bare = interior == Interior::Bare;
    let kind = match interior {
        Interior::Office => 1.0,
        Interior::Shop => 2.0,
        _ => 0.0,
    };
    let first = random.index(BACKS[0]);
    let high = room.high.y - room.low.y;
    let uv = |p: DVec2, middle: DVec2| {
        let picture = ((middle.x - left) / wide).floor().clamp(0.0, pictures - 1.0);
        let within = ((p.x - left) / wide - picture).clamp(0.0, 1.0);
        let column = ((first + picture as usize) % BACKS[0]) as f64;
        DVec2::new(column + within, kind + (p.y - room.low.y) / high) * BACK_M
    };
    let slot = if bare { wall } else { Slot::RoomBack };
    plane(ink, back, row, back_z, true, slot, uv);
    // Shops are lit in all of them while they are open.
    if lit || interior == Interior::Shop {
        lamps(ink, room, interior, [back_z, front_z]);
    }
    for hole in holes {
        hangings(ink, hole, room, interior, front_z - 0.05, random);
        if hole.opening.is_shop(design.interior) {
            display(ink, hole, room, front_z, random);
        }
    }
}

/// A lampshade here and there in a home, panels below other ceilings; `z` are the room's back and front.
fn lamps(ink: &mut Ink<'_>, room: Room, interior: Interior, z: [f64; 2]) {
    let is_home = interior == Interior::Home;
    let panel = if interior == Interior::Shop { Slot::ShopPanel } else { Slot::LightPanel };
    let size = if is_home { SHADE_M } else { PANEL_M };
    let pitch_m = if is_home { SHADES_APART_M } else { PANELS_APART_M };
    // Where the sides run towards each other they leave this in the middle of the room.
    let ends = [0, 1].map(|i| (room.back_x[i] + [room.low, room.high][i].x) / 2.0);
    let wide_m = ends[1] - ends[0];
    let drop_m = if is_home { SHADE_BELOW_M } else { 0.0 };
    let low = DVec3::new(-size.x / 2.0, room.high.y - 0.02 - drop_m - size.y, z[0].midpoint(z[1]) - size.z / 2.0);
    if wide_m < size.x + 0.2 || room.depth_m < size.z + 0.2 || low.y < room.low.y {
        return;
    }
    let count = (wide_m / pitch_m).round().max(1.0);
    for i in 0..count as usize {
        let low = low + DVec3::X * (ends[0] + wide_m * (i as f64 + 0.5) / count);
        if is_home {
            ink.solid(Slot::Lampshade, low, low + size);
        } else {
            let [near, far] = [low.z + size.z, low.z];
            let at = |x: f64, z: f64| DVec3::new(low.x + x, low.y, z);
            ink.face(panel, &[at(size.x, near), at(0.0, near), at(0.0, far), at(size.x, far)]);
        }
    }
}

/// A rectangle parallel to the wall, of a row of cells; the texture coordinates come from a point and from the middle of
/// the face that it is a corner of.
fn plane(
    ink: &mut Ink<'_>,
    [low, high]: [DVec2; 2],
    row: Row,
    z: f64,
    outwards: bool,
    slot: Slot,
    uv: impl Fn(DVec2, DVec2) -> DVec2,
) {
    let frame = ink.frame;
    let place = |p: DVec2| frame.world(p.extend(z));
    let corners = ring(low, high).map(|local| Vertex { world: place(local), local });
    let outline = [0, 1, 2, 3].map(|k| vec![corners[k], corners[(k + 1) % 4]]);
    skin(&outline, &[row], place, |face| {
        let middle = face.iter().map(|v| v.local).sum::<DVec2>() / face.len() as f64;
        let mut points: Vec<(DVec3, DVec2)> = face.iter().map(|v| (v.world, uv(v.local, middle))).collect();
        if !outwards {
            points.reverse();
        }
        ink.shell.face(slot, &points);
    });
}

/// Curtains at the sides or all across, or a blind some way down.
fn hangings(ink: &mut Ink<'_>, hole: &Hole<'_>, room: Room, interior: Interior, z: f64, random: &mut Random) {
    if room.depth_m < 0.3 {
        return;
    }
    let low = (hole.low - 0.06).max(room.low + 0.01);
    let high = (hole.high + 0.06).min(room.high - 0.01);
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
        // Nobody draws blinds in a lobby.
        Interior::Office if draw < 0.35 && hole.frame == Slot::Frame => {
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
        DVec3::new(x, y, z - if i.is_multiple_of(2) { 0.0 } else { 0.05 })
    };
    for i in 0..folds {
        ink.face(slot, &[at(i, low.y), at(i + 1, low.y), at(i + 1, high.y), at(i, high.y)]);
    }
}

/// Goods on plinths behind a shop's window.
fn display(ink: &mut Ink<'_>, hole: &Hole<'_>, room: Room, front_z: f64, random: &mut Random) {
    if room.depth_m < 1.4 {
        return;
    }
    let goods = [Slot::Blind, Slot::CurtainWarm, Slot::Door, Slot::Stripe, Slot::Zinc];
    let mut x = hole.low.x + 0.15;
    while x < hole.high.x - 0.5 {
        let wide = random.range(0.25, 0.5);
        let (near, deep) = (front_z - random.range(0.25, 0.5), random.range(0.3, 0.4));
        let foot = hole.low.y - 0.3_f64.min(hole.low.y - room.low.y - 0.01);
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
