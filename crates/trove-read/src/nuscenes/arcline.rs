//! Lane centre lines as the map expansion has them: three arcs or straights one after the other (Dubins paths).

use glam::DVec2;
use serde::Deserialize;

use super::poses::FARTHEST_M;

/// Distance of the vertices along an arc, metres.
const STEP_M: f64 = 1.0;
/// No piece of a lane is longer, metres.
const LONGEST_M: f64 = 5_000.0;

/// One piece of a lane's centre line, in the map's coordinates.
#[derive(Deserialize)]
pub(super) struct Arcline {
    /// x, y in metres and heading in radians.
    start_pose: [f64; 3],
    /// A letter a segment: left, straight or right.
    shape: String,
    /// Of the arcs, metres.
    radius: f64,
    /// Metres.
    segment_length: [f64; 3],
}

/// Vertices along some pieces; empty where one of them is no path.
pub(super) fn vertices(pieces: &[Arcline]) -> Vec<DVec2> {
    let mut line = Vec::new();
    for piece in pieces {
        if piece.append(&mut line).is_none() {
            return Vec::new();
        }
    }
    // Pieces begin where the one before ends.
    line.dedup_by(|b, a| a.distance(*b) < 0.01);
    if line.len() < 2 { Vec::new() } else { line }
}

impl Arcline {
    fn append(&self, line: &mut Vec<DVec2>) -> Option<()> {
        let [x, y, mut heading_rad] = self.start_pose;
        let mut position = DVec2::new(x, y);
        if position.abs().max_element() > FARTHEST_M {
            return None;
        }
        line.push(position);
        for (turn, &length_m) in self.shape.chars().zip(&self.segment_length) {
            let curvature = match turn {
                'L' => 1.0 / self.radius,
                'R' => -1.0 / self.radius,
                'S' => 0.0,
                _ => return None,
            };
            if curvature.abs() > 1e3 || !(0.0..LONGEST_M).contains(&length_m) {
                return None;
            }
            let steps = if curvature == 0.0 { 1 } else { (length_m / STEP_M).ceil().max(1.0) as usize };
            for _ in 0..steps {
                // A chord of an arc points along the mean of its ends' headings.
                let turn_rad = curvature * length_m / steps as f64;
                let half_rad = turn_rad / 2.0;
                let shortening = if half_rad == 0.0 { 1.0 } else { half_rad.sin() / half_rad };
                let chord_m = length_m / steps as f64 * shortening;
                position += DVec2::from_angle(heading_rad + half_rad) * chord_m;
                heading_rad += turn_rad;
                line.push(position);
            }
        }
        Some(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::FRAC_PI_2;

    #[test]
    fn a_left_turn_ends_a_radius_ahead_and_a_radius_to_the_left() {
        let piece = |shape: &str, segment_length| Arcline {
            start_pose: [10.0, 20.0, 0.0],
            shape: shape.to_owned(),
            radius: 8.0,
            segment_length,
        };
        let line = vertices(&[piece("LSR", [8.0 * FRAC_PI_2, 5.0, 0.0])]);
        assert!(line.last().unwrap().distance(DVec2::new(18.0, 33.0)) < 1e-9);
        let arc = &line[..line.len() - 1];
        assert!(arc.iter().all(|p| (p.distance(DVec2::new(10.0, 28.0)) - 8.0).abs() < 1e-9));
        assert!(vertices(&[piece("LXR", [1.0; 3])]).is_empty());
        assert!(vertices(&[piece("LSR", [f64::MAX, 1.0, 1.0])]).is_empty());
    }
}
