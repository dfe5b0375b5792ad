//! Roofs.

use glam::{DVec2, DVec3};
use trove_model::{Outcome, Polygon, Random, Report, RoofShape};

use super::rectangle::base;
use super::shell::{Shell, Slot};
use super::volumes::{Volume, name};
use crate::ground::polygons_of_rings;
use crate::plane::grown;

/// Thickness of a parapet.
const PARAPET_THICK_M: f64 = 0.3;
/// A flat roof this large carries plant.
const PLANT_ROOF_M2: f64 = 250.0;
/// Rings of a dome.
const DOME_RINGS: usize = 6;

/// What a roof asks of the walls below it.
pub(super) enum WallTop {
    /// Level, metres above the building's floor.
    Level(f64),
    /// Rising from the first height to the second along a direction, between two positions on it.
    Sloped { direction: DVec2, from: f64, to: f64, low_m: f64, high_m: f64 },
}

impl WallTop {
    pub(super) fn at(&self, p: DVec2) -> f64 {
        match *self {
            Self::Level(z) => z,
            Self::Sloped { direction, from, to, low_m, high_m } => {
                low_m + (high_m - low_m) * ((p.dot(direction) - from) / (to - from)).clamp(0.0, 1.0)
            }
        }
    }
}

/// Puts a volume's roof on, its floor at `floor_m` in World, and says how high its walls must be there.
pub(super) fn roof(
    shell: &mut Shell,
    volume: &Volume<'_>,
    floor_m: f64,
    random: &mut Random,
    report: &Report,
) -> WallTop {
    let (eaves, top) = (floor_m + volume.eaves_m, floor_m + volume.top_m);
    let footprint = &volume.footprint;
    let built = match volume.roof {
        RoofShape::Flat => false,
        RoofShape::Skillion => return skillion(shell, footprint, eaves, top),
        RoofShape::Gabled | RoofShape::Gambrel | RoofShape::Round => ridge(shell, footprint, eaves, top, 0.0),
        RoofShape::HalfHipped => ridge(shell, footprint, eaves, top, 0.5),
        RoofShape::Hipped => ridge(shell, footprint, eaves, top, 1.0),
        RoofShape::Pyramidal | RoofShape::Cone => dome(shell, footprint, eaves, top, 1),
        RoofShape::Dome | RoofShape::Onion => dome(shell, footprint, eaves, top, DOME_RINGS),
        RoofShape::Mansard => mansard(shell, footprint, eaves, top),
    };
    if built {
        if matches!(volume.roof, RoofShape::Gambrel | RoofShape::Round | RoofShape::HalfHipped | RoofShape::Onion) {
            let what = format!("{:?} roof, built as its nearest plain form", volume.roof);
            report.note(Outcome::Substituted, &what, name(volume.building));
        }
        return WallTop::Level(eaves);
    }
    if volume.roof != RoofShape::Flat {
        let what = format!("{:?} roof on a footprint that cannot carry it, built flat", volume.roof);
        report.note(Outcome::Substituted, &what, name(volume.building));
    }
    flat(shell, footprint, floor_m + volume.bottom_m, top, random);
    WallTop::Level(top)
}

/// A deck behind a parapet, with plant on it where it is large.
fn flat(shell: &mut Shell, footprint: &Polygon, bottom: f64, top: f64, random: &mut Random) {
    let parapet_m = if top - bottom > 6.0 { random.range(0.4, 0.9) } else { random.range(0.15, 0.3) };
    let deck = top - parapet_m;
    let inner = grown(std::slice::from_ref(footprint), -PARAPET_THICK_M);
    if inner.is_empty() || deck <= bottom {
        shell.cover(Slot::FlatRoof, std::slice::from_ref(footprint), |_| top, true);
        return;
    }
    // The coping: the footprint less the deck, ring by ring so that walls and coping share their vertices.
    let reversed = inner.iter().flat_map(Polygon::rings).map(|r| r.iter().rev().copied().collect());
    let coping = polygons_of_rings(footprint.rings().cloned().chain(reversed).collect());
    shell.cover(Slot::Trim, &coping, |_| top, true);
    for (a, b) in inner.iter().flat_map(Polygon::edges) {
        shell.slope(Slot::Trim, &[b.extend(deck), a.extend(deck), a.extend(top), b.extend(top)]);
    }
    shell.cover(Slot::FlatRoof, &inner, |_| deck, true);
    let area_m2: f64 = inner.iter().map(Polygon::area_m2).sum();
    if area_m2 > PLANT_ROOF_M2 && top - bottom > 6.0 {
        plant(shell, &inner, deck, area_m2, random);
    }
}

/// Lift housings and air handlers, clear of the parapet and of each other.
fn plant(shell: &mut Shell, deck: &[Polygon], z: f64, area_m2: f64, random: &mut Random) {
    let Some(polygon) = deck.iter().max_by(|a, b| a.area_m2().total_cmp(&b.area_m2())) else { return };
    let Some(bounds) = polygon.bounds() else { return };
    let axis = base(polygon).map_or(DVec2::X, |b| b.axis);
    let wanted = 1 + (area_m2 / 400.0).min(5.0) as usize;
    let mut placed: Vec<(DVec2, f64)> = Vec::new();
    for _ in 0..wanted * 6 {
        if placed.len() == wanted {
            break;
        }
        let at = bounds.min + bounds.size_m() * DVec2::new(random.unit(), random.unit());
        // The first is the lift's and the stairs' housing.
        let size = if placed.is_empty() {
            DVec3::new(random.range(4.0, 7.0), random.range(3.0, 5.0), random.range(2.4, 3.4))
        } else {
            DVec3::new(random.range(1.5, 4.0), random.range(1.2, 2.5), random.range(1.0, 2.2))
        };
        let radius_m = size.truncate().length() / 2.0;
        let free = placed.iter().all(|(p, r)| p.distance(at) > r + radius_m + 0.5);
        if free && polygon.contains(at) && polygon.edge_distance_m(at) > radius_m + 0.8 {
            shell.block(Slot::Trim, at.extend(z), axis, size);
            placed.push((at, radius_m));
        }
    }
}

/// A plane that rises across the longest edge.
fn skillion(shell: &mut Shell, footprint: &Polygon, eaves: f64, top: f64) -> WallTop {
    let longest = footprint.edges().max_by(|a, b| (a.1 - a.0).length().total_cmp(&(b.1 - b.0).length()));
    let direction = longest.map_or(DVec2::X, |(a, b)| (b - a).normalize_or(DVec2::X).perp());
    let along = || footprint.exterior.iter().map(|p| p.dot(direction));
    let (from, to) = along().fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| (low.min(x), high.max(x)));
    let walls = WallTop::Sloped { direction, from, to: to.max(from + 0.1), low_m: eaves, high_m: top };
    shell.cover(Slot::FlatRoof, std::slice::from_ref(footprint), |p| walls.at(p), true);
    walls
}

/// Gabled (`hip` 0) to hipped (`hip` 1) on a footprint of four corners, the ridge along the longer sides.
fn ridge(shell: &mut Shell, footprint: &Polygon, eaves: f64, top: f64, hip: f64) -> bool {
    let corners = corners(footprint);
    let (true, &[p0, p1, p2, p3]) = (footprint.holes.is_empty(), corners.as_slice()) else { return false };
    let long_first = p0.distance(p1) + p2.distance(p3) >= p1.distance(p2) + p3.distance(p0);
    let [a, b, c, d] = if long_first { [p0, p1, p2, p3] } else { [p1, p2, p3, p0] };
    let (start, end) = ((d + a) / 2.0, (b + c) / 2.0);
    // Hips rise as steeply as the sides.
    let width_m = (a.distance(d) + b.distance(c)) / 2.0;
    let inset = (hip * width_m / 2.0 / start.distance(end).max(0.1)).min(0.48);
    let (r0, r1) = (start.lerp(end, inset).extend(top), end.lerp(start, inset).extend(top));
    let [a, b, c, d] = [a, b, c, d].map(|p| p.extend(eaves));
    shell.slope(Slot::PitchedRoof, &[a, b, r1, r0]);
    shell.slope(Slot::PitchedRoof, &[c, d, r0, r1]);
    let gable = if hip > 0.0 { Slot::PitchedRoof } else { Slot::Trim };
    shell.slope(gable, &[b, c, r1]);
    shell.slope(gable, &[d, a, r0]);
    true
}

/// The corners of an outline, points within a straight side left out.
fn corners(footprint: &Polygon) -> Vec<DVec2> {
    let ring = &footprint.exterior;
    let n = ring.len();
    let straight = |i: usize| {
        let (before, after) = (ring[i] - ring[(i + n - 1) % n], ring[(i + 1) % n] - ring[i]);
        before.angle_to(after).abs() < 0.12
    };
    (0..n).filter(|&i| !straight(i)).map(|i| ring[i]).collect()
}

/// Rings that shrink towards the middle: one makes a pyramid or a cone, several a dome.
fn dome(shell: &mut Shell, footprint: &Polygon, eaves: f64, top: f64, rings: usize) -> bool {
    let middle = footprint.centroid();
    let seen_from_middle = footprint.edges().all(|(a, b)| (b - a).perp_dot(middle - a) > 0.0);
    if !footprint.holes.is_empty() || !seen_from_middle {
        return false;
    }
    let ring = |k: usize, p: DVec2| -> DVec3 {
        let angle = std::f64::consts::FRAC_PI_2 * k as f64 / rings as f64;
        let share = if k == rings { 0.0 } else { angle.cos() };
        middle.lerp(p, share).extend(eaves + (top - eaves) * angle.sin())
    };
    for (a, b) in footprint.edges() {
        for k in 0..rings {
            let mut points = vec![ring(k, a), ring(k, b), ring(k + 1, b)];
            if k + 1 < rings {
                points.push(ring(k + 1, a));
            }
            shell.slope(Slot::PitchedRoof, &points);
        }
    }
    true
}

/// Steep sides and a flat top.
fn mansard(shell: &mut Shell, footprint: &Polygon, eaves: f64, top: f64) -> bool {
    let inner = grown(std::slice::from_ref(footprint), -((top - eaves) * 0.4).max(0.3));
    if inner.is_empty() {
        return false;
    }
    let reversed = inner.iter().flat_map(Polygon::rings).map(|r| r.iter().rev().copied().collect());
    let sides = polygons_of_rings(footprint.rings().cloned().chain(reversed).collect());
    let outer: Vec<DVec2> = footprint.rings().flatten().copied().collect();
    shell.cover(Slot::PitchedRoof, &sides, |p| if outer.contains(&p) { eaves } else { top }, true);
    shell.cover(Slot::FlatRoof, &inner, |_| top, true);
    true
}
