//! How high roads run that do not lie on the ground.

use std::collections::BTreeMap;

use glam::DVec2;
use trove_model::{Road, StreetMap};

use super::profiles::{Profiles, hangs};

/// A position farther than this from a road is not on it, metres.
const ON_ROAD_M: f64 = 3.0;

/// Bridges and tunnels over a relief: from one end to the other, whatever lies below or above.
#[derive(Clone, Debug, Default)]
pub(crate) struct Spans {
    /// By OpenStreetMap's id, pieces with the height of their ends.
    pieces: BTreeMap<i64, Vec<[(DVec2, f64); 2]>>,
}

impl Spans {
    pub(super) fn new(map: &StreetMap, profiles: &Profiles) -> Self {
        let mut pieces: BTreeMap<i64, Vec<_>> = BTreeMap::new();
        for piece in &profiles.pieces {
            let road = &map.roads[piece.road];
            if hangs(road) {
                let ends = piece.ends.map(|end| (profiles.points[end], profiles.heights_m[end]));
                pieces.entry(road.id).or_default().push(ends);
            }
        }
        Self { pieces }
    }

    /// Height in World of a bridge's or a tunnel's road where no crossing asks for another; `None` on other roads, and
    /// everywhere where there is no relief.
    pub(crate) fn height_m(&self, road: &Road, position: DVec2) -> Option<f64> {
        let nearest = self.pieces.get(&road.id)?.iter().map(|&[(a, from_m), (b, to_m)]| {
            let along = b - a;
            let t = ((position - a).dot(along) / along.length_squared().max(1e-9)).clamp(0.0, 1.0);
            (a.lerp(b, t).distance(position), from_m + t * (to_m - from_m))
        });
        nearest.min_by(|a, b| a.0.total_cmp(&b.0)).filter(|(off_m, _)| *off_m < ON_ROAD_M).map(|(_, height_m)| height_m)
    }
}
