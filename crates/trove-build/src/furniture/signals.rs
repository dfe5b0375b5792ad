//! Traffic signals on the corners of the junctions where the map has them.

use glam::DVec2;
use trove_model::{FurnitureKind, Kind};

use super::Wish;
use crate::kerbs::KerbPoint;
use crate::surroundings::Surroundings;

/// A junction's corners lie within this of the mapped signal, metres.
const CORNER_REACH_M: f64 = 18.0;
/// Signals stand this far apart, metres.
const SPACING_M: f64 = 8.0;
/// A mapped signal becomes at most so many poles.
const POLES: usize = 4;

/// Poles at the nearest kerbs to all sides of every mapped signal.
pub(super) fn wishes(around: &Surroundings) -> Vec<Wish> {
    let mut poles: Vec<DVec2> = Vec::new();
    let mut wishes = Vec::new();
    let furniture = around.map.iter().flat_map(|m| &m.furniture);
    for signal in furniture.filter(|f| f.kind == FurnitureKind::TrafficSignal && around.bounds.contains(f.position)) {
        let mut here = 0;
        for kerb in around.kerbs.near(signal.position, CORNER_REACH_M) {
            if here == POLES {
                break;
            }
            let apart = poles.iter().all(|p| p.distance(kerb.position) >= SPACING_M);
            if apart && towards(&kerb, signal.position) {
                poles.push(kerb.position);
                wishes.push(Wish::at_kerb(Kind::TrafficSignal, &kerb));
                here += 1;
            }
        }
    }
    wishes
}

/// Whether the traffic at a kerb still has the junction before it, or is in it.
fn towards(kerb: &KerbPoint, junction: DVec2) -> bool {
    (junction - kerb.position).dot(kerb.traffic) > -4.0
}
