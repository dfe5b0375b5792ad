//! Roofs over an outline seen whole from its middle: pyramid, cone, dome, onion.

use glam::{DVec2, DVec3};
use trove_model::{Polygon, RoofShape};

use crate::buildings::shell::{Shell, Slot};

/// Rings of a dome.
const DOME_RINGS: usize = 7;
/// An onion's radius and height, from its foot to its tip (measured off photographs of Bavarian church towers).
const ONION: [[f64; 2]; 10] = [
    [1.0, 0.0],
    [1.14, 0.08],
    [1.2, 0.18],
    [1.14, 0.3],
    [0.92, 0.42],
    [0.62, 0.52],
    [0.34, 0.62],
    [0.16, 0.74],
    [0.07, 0.88],
    [0.0, 1.0],
];

/// Rings that shrink towards the middle; `false` where a part of the outline is hidden from it.
pub(super) fn rings(shell: &mut Shell, footprint: &Polygon, shape: RoofShape, eaves: f64, top: f64) -> bool {
    let middle = footprint.centroid();
    let is_seen = footprint.edges().all(|(a, b)| (b - a).perp_dot(middle - a) > 1e-3);
    if !footprint.holes.is_empty() || !is_seen {
        return false;
    }
    let profile: Vec<[f64; 2]> = match shape {
        RoofShape::Dome => (0..=DOME_RINGS)
            .map(|k| {
                let angle = std::f64::consts::FRAC_PI_2 * k as f64 / DOME_RINGS as f64;
                [if k == DOME_RINGS { 0.0 } else { angle.cos() }, angle.sin()]
            })
            .collect(),
        RoofShape::Onion => ONION.to_vec(),
        _ => vec![[1.0, 0.0], [0.0, 1.0]],
    };
    // At the foot the outline's own points, so that roof and walls share them.
    let at = |k: usize, p: DVec2| -> DVec3 {
        let [radius, rise] = profile[k];
        let plane = if k == 0 { p } else { middle.lerp(p, radius) };
        plane.extend(eaves + (top - eaves) * rise)
    };
    for (a, b) in footprint.edges() {
        for k in 0..profile.len() - 1 {
            let mut points = vec![at(k, a), at(k, b), at(k + 1, b)];
            if k + 2 < profile.len() {
                points.push(at(k + 1, a));
            }
            shell.slope(Slot::PitchedRoof, &points);
        }
    }
    true
}
