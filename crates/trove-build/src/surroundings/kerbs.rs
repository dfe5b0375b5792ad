//! The edges of the carriageway: where lamps, signs and street trees stand along.

use std::collections::HashMap;

use glam::DVec2;
use trove_model::{Bounds, Drive, StreetMap};

use crate::geometry::plane_raster::bucket;
use crate::geometry::segments::SegmentIndex;
use crate::roads::{Footing, RoadSurfaces};

/// Distance of neighbouring kerb points, metres.
pub(crate) const KERB_STEP_M: f64 = 1.0;
/// What lies beyond the kerb is looked for at this distance from the carriageway, metres.
const BEYOND_M: f64 = 0.8;
/// A lane or one-way street within this tells the traffic's direction, metres.
const LANE_REACH_M: f64 = 6.0;

/// Side of a bucket, metres.
const BUCKET_M: f64 = 10.0;

/// A point on the edge of the carriageway.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct KerbPoint {
    /// On the edge.
    pub position: DVec2,
    /// Away from the carriageway, unit.
    pub outward: DVec2,
    /// Where the nearest traffic drives to, unit.
    pub traffic: DVec2,
    /// A sidewalk lies beyond it, not open land.
    pub sidewalk: bool,
}

/// All kerbs of a place.
#[derive(Clone, Debug, Default)]
pub(crate) struct Kerbs {
    /// Points in runs along the street, a metre apart; a run ends where there is no kerb.
    pub runs: Vec<Vec<KerbPoint>>,
    // Only ever looked up, so the order inside does not reach a result.
    buckets: HashMap<[i64; 2], Vec<KerbPoint>>,
}

impl Kerbs {
    /// The kerbs of the built carriageway.
    pub(crate) fn new(drive: &Drive, map: Option<&StreetMap>, surfaces: &RoadSurfaces, bounds: Bounds) -> Self {
        let runs = runs(drive, map, surfaces, bounds);
        let mut buckets: HashMap<[i64; 2], Vec<KerbPoint>> = HashMap::new();
        for point in runs.iter().flatten() {
            buckets.entry(bucket(point.position, BUCKET_M)).or_default().push(*point);
        }
        Self { runs, buckets }
    }

    /// Kerb points within `reach_m` of a position, the nearest first.
    pub(crate) fn near(&self, p: DVec2, reach_m: f64) -> Vec<KerbPoint> {
        let (low, high) = (bucket(p - reach_m, BUCKET_M), bucket(p + reach_m, BUCKET_M));
        let mut found: Vec<(f64, KerbPoint)> = (low[0]..=high[0])
            .flat_map(|x| (low[1]..=high[1]).map(move |y| [x, y]))
            .flat_map(|key| self.buckets.get(&key).into_iter().flatten())
            .map(|k| (k.position.distance(p), *k))
            .filter(|(distance_m, _)| *distance_m <= reach_m)
            .collect();
        found.sort_by(|a, b| a.0.total_cmp(&b.0));
        found.into_iter().map(|(_, k)| k).collect()
    }
}

fn runs(drive: &Drive, map: Option<&StreetMap>, surfaces: &RoadSurfaces, bounds: Bounds) -> Vec<Vec<KerbPoint>> {
    let lanes = drive.lane_map.iter().flat_map(|m| &m.lanes).map(|l| l.centreline.as_slice());
    let oneways = map.iter().flat_map(|m| &m.roads).filter(|r| r.oneway && r.kind.is_for_cars());
    let directed = SegmentIndex::new(lanes.chain(oneways.map(|r| r.centreline.as_slice())));
    let on_left = surfaces.driving_side.is_left();
    let inner = bounds.grown(-2.0 * BEYOND_M);

    let mut runs = Vec::new();
    for polygon in surfaces.carriageway.iter().map(|p| p.clone().oriented()) {
        for ring in polygon.rings() {
            let mut run = Vec::new();
            for (position, along) in walk(ring) {
                // Rings run with the carriageway on their left.
                let outward = -along.perp();
                let footing = surfaces.footing(position + outward * BEYOND_M);
                if !inner.contains(position) || matches!(footing, Footing::Carriageway | Footing::Water) {
                    runs.push(std::mem::take(&mut run));
                    continue;
                }
                let known = directed.nearest(position, LANE_REACH_M).map(|n| along * n.along.dot(along).signum());
                let traffic = known.unwrap_or(if on_left { -along } else { along });
                run.push(KerbPoint { position, outward, traffic, sidewalk: footing == Footing::Sidewalk });
            }
            runs.push(run);
        }
    }
    runs.retain(|run| !run.is_empty());
    runs
}

/// Positions and directions along a ring, a step apart.
fn walk(ring: &[DVec2]) -> Vec<(DVec2, DVec2)> {
    let mut points = Vec::new();
    let mut ahead_m = 0.0;
    for i in 0..ring.len() {
        let (a, b) = (ring[i], ring[(i + 1) % ring.len()]);
        let length_m = a.distance(b);
        let Some(along) = (b - a).try_normalize() else { continue };
        while ahead_m < length_m {
            points.push((a + along * ahead_m, along));
            ahead_m += KERB_STEP_M;
        }
        ahead_m -= length_m;
    }
    points
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing;
    use trove_model::HeightField;

    #[test]
    fn kerbs_look_away_from_the_road_and_know_their_traffic() {
        let drive = testing::drive();
        let bounds = crate::area(&drive).unwrap();
        let surfaces = testing::surfaces(&drive, &HeightField::flat(bounds, 0.0));
        let kerbs = Kerbs::new(&drive, None, &surfaces, bounds);
        assert_eq!(kerbs.near(DVec2::new(0.0, -10.0), 8.0)[0].position.x.abs().round(), 0.0);
        let points: Vec<KerbPoint> = kerbs.runs.into_iter().flatten().collect();
        let south: Vec<_> =
            points.iter().filter(|p| (p.position.y + 4.0).abs() < 0.3 && p.position.x.abs() < 200.0).collect();
        assert!(south.len() > 350);
        // The southern kerb is beside the lane to the east, although the place drives on the left.
        assert!(south.iter().all(|p| p.sidewalk && p.outward.y < -0.9 && p.traffic.x > 0.9));
        let north = points.iter().filter(|p| (p.position.y - 12.0).abs() < 0.3 && p.position.x.abs() < 200.0);
        assert!(north.clone().count() > 350);
        assert!(north.clone().all(|p| p.outward.y > 0.9));
    }
}
