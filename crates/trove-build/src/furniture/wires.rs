//! Wires and their poles: along mapped power lines, over trams, and along side streets where the region has them.

use std::sync::Arc;

use glam::{DAffine3, DVec2, DVec3, Vec3};
use trove_model::{
    Asset, Class, FurnitureKind, Kind, LineKind, Material, Mesh, Outcome, Report, Road, RoadKind, Role, Seed,
};

use super::yard::{Source, Wish, Yard};
use crate::geometry::segments::SegmentIndex;
use crate::pieces::Piece;
use crate::surroundings::KERB_STEP_M;

/// Poles by rule are this far apart, metres.
const SPACING_M: f64 = 36.0;
/// Wires hang between poles this far apart, metres.
const SPAN_M: [f64; 2] = [6.0, 75.0];
/// Sag in the middle over the span: that of low-voltage lines.
const SAG: f64 = 0.018;
/// Nothing hangs lower than this over the ground, metres.
const CLEARANCE_M: f64 = 5.2;
/// No wire is nearer to a building, metres; wires on cross arms are up to 1.1 m beside the line.
const FROM_BUILDINGS_M: f64 = 1.6;
/// A wire's radius, metres; it is a prism of three sides with so many joints.
const RADIUS_M: f64 = 0.011;
const JOINTS: usize = 10;
/// Insulators' corners nearer than this belong to one, metres.
const INSULATOR_M: f32 = 0.15;
/// A tram's wire hangs this high over the track, its holders rise by so much to their poles, every so many metres; poles
/// stand within reach of the track, metres.
const TRAM_WIRE_M: f64 = 5.6;
const TRAM_RISE_M: f64 = 0.9;
const TRAM_SPAN_M: f64 = 25.0;
const TRAM_REACH_M: f64 = 14.0;
/// A kerb's road is at most this far from it, metres.
const ROAD_REACH_M: f64 = 12.0;

/// A pole that stands.
#[derive(Clone, Debug)]
struct Pole {
    foot_world: DVec3,
    yaw_rad: f64,
    /// Where wires hang, in the pole's frame.
    hooks: Vec<DVec3>,
}

/// Poles with their wires; the wires are one piece a line.
pub(super) fn place(yard: &mut Yard<'_, '_, '_>, seed: Seed, report: &Report) -> Vec<Piece> {
    let around = yard.around;
    let Some(map) = around.place.map else { return Vec::new() };
    let mut pieces = Vec::new();
    for line in map.lines.iter().filter(|l| l.kind == LineKind::PowerLine) {
        let at = |i: usize| line.line[i.min(line.line.len() - 1)];
        let poles = (0..line.line.len())
            .map(|i| pole(at(i), at(i + 1) - at(i.saturating_sub(1)), Source::Mapped, yard, report));
        let poles: Vec<Option<Pole>> = poles.collect();
        pieces.extend(strung(&poles, yard, report));
    }
    for line in map.lines.iter().filter(|l| l.kind == LineKind::Tram) {
        pieces.extend(over_track(&line.line, yard, report));
    }
    for thing in map.furniture.iter().filter(|f| f.kind == FurnitureKind::UtilityPole) {
        if !yard.has_near(Kind::UtilityPole, thing.position, 3.0) {
            let kerb = around.kerbs.near(thing.position, 20.0).first().copied();
            pole(thing.position, kerb.map_or(DVec2::X, |k| k.traffic), Source::Mapped, yard, report);
        }
    }
    if yard.locale.street.overhead_wires {
        pieces.extend(by_rule(yard, seed, report));
    }
    pieces
}

/// Along one side of residential streets.
fn by_rule(yard: &mut Yard<'_, '_, '_>, seed: Seed, report: &Report) -> Vec<Piece> {
    let around = yard.around;
    let roads: Vec<&Road> = around.place.map.iter().flat_map(|m| &m.roads).filter(|r| r.kind.is_for_cars()).collect();
    let index = SegmentIndex::new(roads.iter().map(|r| r.centreline.as_slice()));
    let mut pieces = Vec::new();
    for (i, run) in around.kerbs.runs.iter().enumerate() {
        let mut poles = Vec::new();
        let mut at_m = seed.nth(i as u64).random().range(4.0, SPACING_M);
        while let Some(kerb) = run.get((at_m / KERB_STEP_M) as usize) {
            at_m += SPACING_M;
            let road = index.nearest(kerb.position, ROAD_REACH_M).map(|n| roads[n.line]);
            // A row that runs on the other side already stays alone.
            let opposite = yard.has_near(Kind::UtilityPole, kerb.position, SPACING_M * 0.8);
            let wanted = road.is_some_and(|r| r.kind == RoadKind::Residential) && !opposite;
            let along = kerb.outward.perp();
            let spot = kerb.position + kerb.outward * 0.7;
            poles.push(wanted.then(|| pole(spot, along, Source::MadeUp, yard, report)).flatten());
        }
        pieces.extend(strung(&poles, yard, report));
    }
    pieces
}

/// A pole whose cross arms stand across the line, where there is room for one.
fn pole(p: DVec2, along: DVec2, source: Source, yard: &mut Yard<'_, '_, '_>, report: &Report) -> Option<Pole> {
    let yaw_rad = along.to_angle();
    let wish = Wish { kind: Kind::UtilityPole, tags: &["utility-pole"], position: p, yaw_rad, source };
    if !yard.place(&wish, report) {
        if source == Source::Mapped {
            report.note(Outcome::Dropped, "mapped utility pole without room", format_args!("at {p:.0}"));
        }
        return None;
    }
    let placed = yard.placed.last()?;
    Some(Pole { foot_world: placed.foot_world, yaw_rad, hooks: hooks(placed.asset) })
}

/// Tops of a pole's insulators.
fn hooks(asset: &Asset) -> Vec<DVec3> {
    let slot = asset.slots.iter().position(|s| s.material.role == Some(Role::Insulator)).map(|s| s as u16);
    let mesh = &asset.mesh;
    let mut found: Vec<Vec3> = Vec::new();
    for (_, corners) in mesh.triangles.iter().enumerate().filter(|(t, _)| Some(mesh.slot(*t)) == slot) {
        for corner in corners.map(|i| mesh.positions[i as usize]) {
            let same = |p: &&mut Vec3| {
                p.truncate().distance(corner.truncate()) < INSULATOR_M && (p.z - corner.z).abs() < 2.0 * INSULATOR_M
            };
            match found.iter_mut().find(same) {
                Some(top) if corner.z > top.z => *top = corner,
                Some(_) => {}
                None => found.push(corner),
            }
        }
    }
    found.into_iter().map(Vec3::as_dvec3).collect()
}

/// The wires between neighbours in a row, as one piece.
fn strung(poles: &[Option<Pole>], yard: &Yard<'_, '_, '_>, report: &Report) -> Option<Piece> {
    let origin = poles.iter().flatten().next()?.foot_world;
    let mut mesh = Mesh::default();
    for pair in poles.windows(2) {
        let [Some(a), Some(b)] = pair else { continue };
        if !is_open(a.foot_world.truncate(), b.foot_world.truncate(), yard) {
            report.note(Outcome::Dropped, "wires blocked by a building", format_args!("at {:.0}", a.foot_world));
            continue;
        }
        let same_way = DVec2::from_angle(a.yaw_rad).dot(DVec2::from_angle(b.yaw_rad)) > 0.0;
        for (i, hook) in a.hooks.iter().enumerate() {
            let other = b.hooks.iter().position(|h| {
                (h.z - hook.z).abs() < 0.3 && (h.y - if same_way { hook.y } else { -hook.y }).abs() < 0.2
            });
            let Some(other) = other.or((i < b.hooks.len()).then_some(i)) else { continue };
            let ends = [(a, *hook), (b, b.hooks[other])].map(|(pole, hook)| {
                pole.foot_world + DVec2::from_angle(pole.yaw_rad).rotate(hook.truncate()).extend(hook.z)
            });
            let wire = catenary(ends[0], ends[1]);
            if wire.iter().all(|p| p.z - yard.around.stand.surface_m(p.truncate()) > CLEARANCE_M) {
                tube(&mut mesh, wire.iter().map(|p| (*p - origin).as_vec3()));
            }
        }
    }
    piece(mesh, origin)
}

/// Wires as stuff of no class: too thin to be counted; `None` without any.
fn piece(mesh: Mesh, origin: DVec3) -> Option<Piece> {
    (!mesh.triangles.is_empty()).then(|| Piece {
        mesh: Arc::new(mesh),
        world_from_mesh: DAffine3::from_translation(origin),
        class: Class::Void,
        materials: vec![Material::plain("wire", Vec3::splat(0.02), 0.6)],
        kind: None,
        asset: None,
    })
}

/// The contact wire over a tram's track, held between poles on both sides of the street where there is room for them.
fn over_track(track: &[DVec2], yard: &mut Yard<'_, '_, '_>, report: &Report) -> Option<Piece> {
    let around = yard.around;
    let places: Vec<DVec2> =
        spaced(track, TRAM_SPAN_M).into_iter().filter(|p| around.place.bounds.contains(*p)).collect();
    let over = |p: &DVec2| p.extend(around.stand.surface_m(*p) + TRAM_WIRE_M);
    let origin = over(places.first()?);
    let mut mesh = Mesh::default();
    for pair in places.windows(2) {
        if !is_open(pair[0], pair[1], yard) {
            continue;
        }
        tube(&mut mesh, [over(&pair[0]), over(&pair[1])].into_iter().map(|p| (p - origin).as_vec3()));
        let across = (pair[1] - pair[0]).normalize_or_zero().perp();
        let kerbs = around.kerbs.near(pair[0], TRAM_REACH_M);
        let sides = [across, -across].map(|side| {
            let kerb = kerbs.iter().find(|k| (k.position - pair[0]).normalize_or_zero().dot(side) > 0.95)?;
            let position = kerb.position + kerb.outward * 0.8;
            pole(position, across.perp(), Source::MadeUp, yard, report)
        });
        let [Some(left), Some(right)] = sides else { continue };
        let ends = [left, right].map(|pole| pole.foot_world + DVec3::Z * (TRAM_WIRE_M + TRAM_RISE_M));
        let held = [ends[0], over(&pair[0]) + DVec3::Z * TRAM_RISE_M / 2.0, ends[1]];
        tube(&mut mesh, held.into_iter().map(|p| (p - origin).as_vec3()));
    }
    piece(mesh, origin)
}

/// Places along a line, the first at its start.
fn spaced(line: &[DVec2], step_m: f64) -> Vec<DVec2> {
    let (mut places, mut ahead_m) = (Vec::new(), 0.0);
    for pair in line.windows(2) {
        let length_m = pair[0].distance(pair[1]);
        while ahead_m < length_m {
            places.push(pair[0].lerp(pair[1], ahead_m / length_m));
            ahead_m += step_m;
        }
        ahead_m -= length_m;
    }
    places
}

/// Whether a span is of a usual length and passes no building.
fn is_open(a: DVec2, b: DVec2, yard: &Yard<'_, '_, '_>) -> bool {
    let length_m = a.distance(b);
    let steps = length_m.ceil().max(1.0) as usize;
    let mut along = (1..steps).map(|i| a.lerp(b, i as f64 / steps as f64));
    (SPAN_M[0]..SPAN_M[1]).contains(&length_m)
        && along.all(|p| yard.clearance.building_distance_m(p) > FROM_BUILDINGS_M)
}

/// A hanging wire: the catenary with a sag of [`SAG`] of its span, sheared to ends of different heights.
fn catenary(a: DVec3, b: DVec3) -> Vec<DVec3> {
    let span_m = a.truncate().distance(b.truncate());
    // Its parameter, for a sag that is small against the span: span² / (8 sag).
    let parameter_m = (span_m / (8.0 * SAG)).max(1e-3);
    let low = (span_m / 2.0 / parameter_m).cosh();
    (0..=JOINTS)
        .map(|i| {
            let t = i as f64 / JOINTS as f64;
            let sag_m = parameter_m * (low - ((t - 0.5) * span_m / parameter_m).cosh());
            a.lerp(b, t) - DVec3::Z * sag_m
        })
        .collect()
}

/// Adds a thin prism along a path.
fn tube(mesh: &mut Mesh, path: impl Iterator<Item = Vec3>) {
    let path: Vec<Vec3> = path.collect();
    let Some(along) = path.last().map(|end| (*end - path[0]).normalize_or(Vec3::X)) else { return };
    let side = along.cross(Vec3::Z).normalize_or(Vec3::Y);
    let up = side.cross(along);
    let base = mesh.positions.len() as u32;
    for p in &path {
        for k in 0..3 {
            let angle = std::f32::consts::TAU * k as f32 / 3.0;
            let out = side * angle.cos() + up * angle.sin();
            mesh.positions.push(*p + out * RADIUS_M as f32);
            mesh.normals.push(out);
        }
    }
    for i in 1..path.len() as u32 {
        for k in 0..3 {
            let [a, b] = [base + 3 * (i - 1) + k, base + 3 * (i - 1) + (k + 1) % 3];
            mesh.triangles.extend([[a, a + 3, b], [b, a + 3, b + 3]]);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_wire_hangs_from_end_to_end_and_sags_in_the_middle() {
        let (a, b) = (DVec3::new(0.0, 0.0, 9.0), DVec3::new(40.0, 0.0, 8.0));
        let wire = catenary(a, b);
        assert!(wire[0].distance(a) < 1e-9 && wire[JOINTS].distance(b) < 1e-9);
        let sag_m = 8.5 - wire[JOINTS / 2].z;
        assert!((sag_m - 40.0 * SAG).abs() < 0.01, "{sag_m}");
    }

    #[test]
    fn a_wire_is_a_prism_that_looks_outwards() {
        let mut mesh = Mesh::default();
        tube(&mut mesh, [Vec3::ZERO, Vec3::X * 5.0].into_iter());
        assert_eq!(mesh.defect(), None);
        for t in &mesh.triangles {
            let [a, b, c] = t.map(|i| mesh.positions[i as usize]);
            let middle = (a + b + c) / 3.0;
            assert!((b - a).cross(c - a).dot(middle - Vec3::X * middle.x) > 0.0);
        }
    }
}
