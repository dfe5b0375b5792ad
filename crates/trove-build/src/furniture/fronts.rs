//! Walls that look at a sidewalk.

use glam::DVec2;
use trove_model::Building;

use super::yard::Yard;
use crate::geometry::segments::SegmentIndex;

/// Further from the driven path than this no one sees what stands before a wall, metres.
const SEEN_M: f64 = 100.0;
/// Further from its wall than this a street is another's, metres.
const ROAD_M: f64 = 12.0;
/// Shorter walls are none to put something before, metres.
const SHORTEST_M: f64 = 4.8;

/// A wall, from its left end to its right one as the house sees them.
#[derive(Clone, Copy, Debug)]
pub(super) struct Front<'m> {
    pub building: &'m Building,
    from: DVec2,
    along: DVec2,
    pub length_m: f64,
}

impl Front<'_> {
    /// Away from the house.
    pub(super) fn outward(&self) -> DVec2 {
        -self.along.perp()
    }

    /// The place so far along it and so far before it, metres.
    pub(super) fn at(&self, along_m: f64, off_m: f64) -> DVec2 {
        self.from + self.along * along_m + self.outward() * off_m
    }
}

/// The longest wall of each building that looks at a street behind at least `sidewalk_m`, where it is seen.
pub(super) fn fronts<'m>(yard: &Yard<'_, 'm, '_>, sidewalk_m: f64) -> Vec<Front<'m>> {
    let place = yard.around.place;
    let path: Vec<DVec2> = place.drive.keyframes.iter().map(|k| k.world_from_ego.translation.truncate()).collect();
    let path = SegmentIndex::new([path.as_slice()]);
    let buildings = place.map.iter().flat_map(|m| &m.buildings).filter(|b| !b.part);
    let front = |building: &'m Building| {
        let footprint = building.footprint.clone().oriented();
        path.nearest(footprint.centroid(), SEEN_M)?;
        let walls = footprint.edges().map(|(from, to)| {
            let along = (to - from).normalize_or_zero();
            Front { building, from, along, length_m: from.distance(to) }
        });
        let looks_at_street = |front: &Front<'m>| {
            let road_m = yard.clearance.road_distance_m(front.at(front.length_m / 2.0, 0.5));
            front.length_m > SHORTEST_M && (sidewalk_m..ROAD_M).contains(&road_m)
        };
        walls.filter(looks_at_street).max_by(|a, b| a.length_m.total_cmp(&b.length_m))
    };
    buildings.filter_map(front).collect()
}
