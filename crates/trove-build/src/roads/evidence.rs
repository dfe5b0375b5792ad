//! What the recorded traffic tells about the street: where vehicles drove and parked, and where people walked.

use glam::{DVec2, DVec3};
use trove_model::{Class, Cuboid, Drive, Kind, Polygon};

/// Objects that move less than this stand still: annotations jitter.
const STANDING_M: f64 = 1.5;
/// Between boxes further apart than this nothing is known.
const LONGEST_STEP_M: f64 = 20.0;

/// A track over the ground and half of the width that it used.
pub(super) struct Trace {
    pub line: Vec<DVec2>,
    pub half_width_m: f64,
}

/// Where vehicles with four wheels or more drove, the recording one first.
pub(super) fn driven(drive: &Drive) -> Vec<Trace> {
    let path = drive.keyframes.iter().map(|k| k.world_from_ego.translation.truncate()).collect();
    let ego = Trace { line: path, half_width_m: drive.ego_body.size_m.y / 2.0 };
    std::iter::once(ego).chain(moving(drive, Kind::is_car)).collect()
}

/// Where people walked.
pub(super) fn walked(drive: &Drive) -> Vec<Trace> {
    moving(drive, |kind| kind.class() == Class::Human).collect()
}

/// Footprints of vehicles that never moved.
pub(super) fn parked(drive: &Drive) -> Vec<Polygon> {
    let standing = drive.tracks.iter().filter(|t| t.kind.is_car() && extent_m(&t.boxes) < STANDING_M);
    standing.filter_map(|t| t.boxes.get(t.boxes.len() / 2)).map(|(_, cuboid)| footprint(cuboid)).collect()
}

fn moving(drive: &Drive, wanted: impl Fn(Kind) -> bool) -> impl Iterator<Item = Trace> {
    let tracks = drive.tracks.iter().filter(move |t| wanted(t.kind) && extent_m(&t.boxes) >= STANDING_M);
    tracks.flat_map(|track| {
        let half_width_m = track.boxes.first().map_or(1.0, |(_, c)| c.size_m.y / 2.0);
        let mut lines: Vec<Vec<DVec2>> = Vec::new();
        for (_, cuboid) in &track.boxes {
            let at = cuboid.world_from_body.translation.truncate();
            match lines.last_mut() {
                Some(line) if line.last().is_some_and(|l| l.distance(at) < LONGEST_STEP_M) => line.push(at),
                _ => lines.push(vec![at]),
            }
        }
        lines.into_iter().map(move |line| Trace { line, half_width_m })
    })
}

/// How far apart a track's boxes lie.
fn extent_m(boxes: &[(usize, Cuboid)]) -> f64 {
    let at = |c: &Cuboid| c.world_from_body.translation.truncate();
    boxes.first().map_or(0.0, |(_, first)| boxes.iter().map(|(_, c)| at(c).distance(at(first))).fold(0.0, f64::max))
}

fn footprint(cuboid: &Cuboid) -> Polygon {
    let half = cuboid.size_m / 2.0;
    let corner = |x: f64, y: f64| cuboid.world_from_body.point(DVec3::new(x * half.x, y * half.y, 0.0)).truncate();
    Polygon::simple(vec![corner(-1.0, -1.0), corner(1.0, -1.0), corner(1.0, 1.0), corner(-1.0, 1.0)])
}
