//! What stands on pitched roofs: chimneys, dormers, skylights, solar panels.

use glam::{DVec2, DVec3};
use trove_model::{BuildingKind, Random, RoofShape};

use super::pitched::Pitched;
use crate::buildings::shell::{Shell, Slot};
use crate::buildings::volumes::{House, Volume};

/// Dormers and skylights are seen up to this distance from the driven path, metres.
const WINDOWS_SEEN_M: f64 = 150.0;
/// Rooms are built under a roof that rises this much, metres.
const ROOM_M: f64 = 2.6;
/// A dormer's width, its walls' height above the roof at its front, and its gable's height, metres.
const DORMER_M: [f64; 3] = [1.5, 1.35, 0.5];
/// From one dormer to the next, metres.
const DORMERS_APART_M: f64 = 3.2;
/// A skylight's width and height along the slope, metres.
const SKYLIGHT_M: [f64; 2] = [0.78, 1.2];

/// Puts on a roof what a house of its kind has there.
pub(super) fn fittings(shell: &mut Shell, roof: &Pitched, volume: &Volume<'_>, house: &House<'_>, random: &mut Random) {
    let is_shelter = |k: BuildingKind| {
        use BuildingKind as K;
        k.is_works() || k.is_canopy() || matches!(k, K::Garage | K::Shed | K::Greenhouse)
    };
    let is_lived_in = !house.building.kind.is_some_and(is_shelter);
    if is_lived_in && house.customs.chimneys && volume.top_m > 4.0 {
        chimneys(shell, roof, random);
    }
    if house.path_m > WINDOWS_SEEN_M || !is_lived_in || volume.is_canopy {
        return;
    }
    let style = random.unit();
    let wants_dormers = volume.roof == RoofShape::Mansard || style < 0.3;
    for (side, own) in roof.skeleton.sides.iter().enumerate() {
        if own.start > 0.0 || roof.skeleton.faces[side].len() < 3 {
            continue;
        }
        let has_room = volume.top_m - volume.eaves_m > ROOM_M
            && !house.building.kind.is_some_and(BuildingKind::is_house)
            || style < 0.2;
        if wants_dormers && has_room && dormers(shell, roof, side) {
            continue;
        }
        // Panels where the sun comes from.
        let faces_sun = own.along.perp().y > 0.4;
        if style > 0.9 && faces_sun {
            panels(shell, roof, side, random);
        } else if style > 0.3 && house.customs.chimneys {
            skylights(shell, roof, side, random);
        }
    }
}

/// One or two chimneys on the ridges, a little off them.
fn chimneys(shell: &mut Shell, roof: &Pitched, random: &mut Random) {
    let ridges: Vec<[DVec3; 2]> =
        roof.ridges().into_iter().filter(|[a, b]| (b.z - a.z).abs() < 0.2 && a.distance(*b) > 2.5).collect();
    for [a, b] in ridges.into_iter().take(4) {
        let axis = (b - a).truncate().normalize_or(DVec2::X);
        let count = 1 + usize::from(a.distance(b) > 9.0 && random.chance(0.6));
        for i in 0..count {
            let share = (i as f64 + random.range(0.25, 0.75)) / count as f64;
            let off_m = random.range(-0.9, 0.9);
            let foot = a.lerp(b, share) + (axis.perp() * off_m).extend(-1.6);
            let size = DVec3::new(random.range(0.5, 1.1), random.range(0.42, 0.6), 1.6 + random.range(0.7, 1.2));
            shell.block(Slot::Gable, foot, axis, size);
            shell.block(
                Slot::Trim,
                foot + DVec3::Z * (size.z - 0.03),
                axis,
                DVec3::new(size.x + 0.12, size.y + 0.12, 0.1),
            );
            for pot in 0..(size.x / 0.4) as usize {
                let along = (pot as f64 + 0.5) / (size.x / 0.4).floor() - 0.5;
                let at = foot + (axis * along * size.x * 0.8).extend(size.z + 0.05);
                shell.cylinder(Slot::Boards, at, [0.1, 0.085], 0.3, 8);
            }
        }
    }
}

/// A row of dormers above a side; `false` where none has room.
fn dormers(shell: &mut Shell, roof: &Pitched, side: usize) -> bool {
    let own = roof.skeleton.sides[side];
    let length_m = roof.length_m(side);
    let [width_m, wall_m, gable_m] = DORMER_M;
    let count = ((length_m - 1.6) / DORMERS_APART_M).floor();
    let front = 0.55;
    let peak = roof.level(front) + wall_m + gable_m;
    // Where the roof comes up to the dormer's ridge.
    let Some(back) = (1..80).map(|i| front + 0.12 * f64::from(i)).find(|&t| roof.level(t) > peak + 0.1) else {
        return false;
    };
    let mut found = false;
    for i in 0..count.max(0.0) as usize {
        let middle = length_m / 2.0 + (i as f64 - (count - 1.0) / 2.0) * DORMERS_APART_M;
        let reach = width_m / 2.0 + 0.35;
        if ![(-reach, 0.05), (reach, 0.05), (-reach, back), (reach, back)]
            .iter()
            .all(|(s, t)| roof.face_contains(side, DVec2::new(middle + s, *t)))
        {
            continue;
        }
        found = true;
        let inward = own.along.perp();
        let foot = own.from + own.along * middle;
        let low = roof.level(front) - 0.25;
        let ring = |run: f64| {
            let at = |s: f64, z: f64| (foot + inward * run + own.along * s).extend(z);
            let half = width_m / 2.0;
            [at(-half, low), at(half, low), at(half, peak - gable_m), at(0.0, peak), at(-half, peak - gable_m)]
        };
        let slots = [Slot::Gable, Slot::Gable, Slot::PitchedRoof, Slot::PitchedRoof, Slot::Gable];
        shell.sweep(slots, &[ring(front), ring(back)]);
        let sill = roof.level(front) + 0.3;
        let window = (foot + inward * front).extend(sill);
        let frame = DVec3::new(width_m - 0.3, 0.1, wall_m - 0.4);
        shell.block(Slot::Boards, window, own.along, frame);
        for sash in [-1.0, 1.0] {
            let at = window + (own.along * sash * (frame.x / 4.0 - 0.01)).extend(0.06);
            let pane = DVec3::new(frame.x / 2.0 - 0.09, 0.12, frame.z - 0.12);
            shell.block(Slot::Glazing, at, own.along, pane);
        }
    }
    found
}

/// A few windows that lie in the slope.
fn skylights(shell: &mut Shell, roof: &Pitched, side: usize, random: &mut Random) {
    let count = (roof.length_m(side) / 5.0 * random.unit()) as usize;
    let height = random.range(0.35, 0.6);
    for _ in 0..count.min(6) {
        let at = DVec2::new(roof.length_m(side) * random.unit(), roof.run_of(side) * height);
        slab(shell, roof, side, at, SKYLIGHT_M, Slot::Metal);
        slab(shell, roof, side, at, [SKYLIGHT_M[0] - 0.14, SKYLIGHT_M[1] - 0.14], Slot::Glazing);
    }
}

/// Solar panels over the middle of a slope.
fn panels(shell: &mut Shell, roof: &Pitched, side: usize, random: &mut Random) {
    let length_m = roof.length_m(side);
    let (across, up) = ((length_m * random.range(0.3, 0.6) / 1.05).floor(), 2.0);
    let size = [across * 1.05, up * 1.7];
    if across >= 2.0 {
        slab(shell, roof, side, DVec2::new(length_m / 2.0, roof.run_of(side) * 0.5), size, Slot::Glazing);
    }
}

/// A thin body on a slope, its middle at a place of the face; left out where the face is too small for it.
fn slab(shell: &mut Shell, roof: &Pitched, side: usize, at: DVec2, size_m: [f64; 2], slot: Slot) {
    let own = roof.skeleton.sides[side];
    let up = (own.along.perp().extend(roof.slope_at_eaves())).normalize_or(DVec3::Z);
    let run = up.truncate().length();
    let half = DVec2::new(size_m[0] / 2.0, size_m[1] / 2.0 * run);
    let corners = [DVec2::new(-1.0, -1.0), DVec2::new(1.0, -1.0), DVec2::new(1.0, 1.0), DVec2::new(-1.0, 1.0)];
    let is_straight = roof.breaks().iter().all(|&t| t > at.y + half.y);
    if !is_straight || !corners.iter().all(|c| roof.face_contains(side, at + *c * (half + 0.25))) {
        return;
    }
    let normal = own.along.extend(0.0).cross(up);
    let [low, high] = if slot == Slot::Glazing { [-0.03, 0.075] } else { [-0.05, 0.06] };
    let ring = |height_m: f64| {
        corners.map(|c| {
            let p = at + c * half;
            (own.from + own.along * p.x + own.along.perp() * p.y).extend(roof.level(p.y)) + normal * height_m
        })
    };
    shell.sweep([slot; 4], &[ring(low), ring(high)]);
}

impl Pitched {
    pub(super) fn length_m(&self, side: usize) -> f64 {
        let chain = self.chain(side);
        chain.last().map_or(0.0, |end| end.distance(self.skeleton.sides[side].from))
    }

    /// How far a face reaches in from its side, metres.
    fn run_of(&self, side: usize) -> f64 {
        self.skeleton.faces[side].iter().map(|&n| self.skeleton.nodes[n].time).fold(0.0, f64::max)
    }

    /// Whether a place, along the side and inwards, lies on its face.
    fn face_contains(&self, side: usize, p: DVec2) -> bool {
        let ring = self.skeleton.faces[side].iter().map(|&n| self.skeleton.in_face(side, n)).collect();
        trove_model::Polygon::simple(ring).contains(p)
    }
}
