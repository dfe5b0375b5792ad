//! What wheels and feet have left of the snow on the ground.

use std::sync::Arc;

use rayon::prelude::*;
use trove_model::{Bounds, Polygon, Snow, SnowLeft};

use crate::geometry::plane::strip;
use crate::geometry::plane_raster::PlaneRaster;
use crate::roads::{Lane, LaneUse, RoadSurfaces};

/// Tracks of wheels are so wide; a large place has larger cells, metres.
const CELL_M: f64 = 0.2;
const MOST_CELLS: f64 = 25e6;
/// How far wheels run from the middle of their lane, outer and inner edge, metres: the track of cars, which sway.
const TRACKS_M: [f64; 2] = [1.1, 0.45];

/// Bits of what a place is.
const CARRIAGEWAY: u8 = 1;
const WALKWAY: u8 = 2;
const LANE: u8 = 4;
const TRACKS: u8 = 8;
const BETWEEN: u8 = 16;
const PARKING: u8 = 32;

/// Snow of a cover on the ground of a place; `None` for none.
pub(crate) fn lying(cover: f64, surfaces: &RoadSurfaces, bounds: Bounds) -> Option<Snow> {
    (cover > 0.0).then(|| Snow { cover, left: Some(Arc::new(left(surfaces, bounds))) })
}

fn left(surfaces: &RoadSurfaces, bounds: Bounds) -> SnowLeft {
    let cell_m = CELL_M.max((bounds.size_m().element_product() / MOST_CELLS).sqrt());
    let mut places = PlaneRaster::new(bounds, cell_m);
    places.mark(&surfaces.carriageway, CARRIAGEWAY);
    places.mark(&surfaces.plan.walkways, WALKWAY);
    let of_lane = |lane: &Lane| -> Vec<(Vec<Polygon>, u8)> {
        let whole = |bit| (strip(&lane.line, lane.width_m / 2.0), bit);
        let [outer, inner] = TRACKS_M.map(|off_m| strip(&lane.line, off_m));
        match lane.usage {
            LaneUse::Driving => vec![whole(LANE), (outer, TRACKS), (inner, BETWEEN)],
            LaneUse::Cycling => vec![whole(LANE)],
            LaneUse::Parking(_) => vec![whole(PARKING)],
        }
    };
    let areas: Vec<(Vec<Polygon>, u8)> = surfaces.lanes.par_iter().flat_map_iter(of_lane).collect();
    areas.iter().for_each(|(area, bit)| places.mark(area, *bit));
    let (origin, shares) = places.map(|bits| (share(bits) * 255.0).round() as u8);
    SnowLeft { origin, cell_m, shares }
}

/// What is left of snow after a day of traffic and no plough.
fn share(bits: u8) -> f64 {
    let is = |bit: u8| bits & bit != 0;
    match () {
        () if is(TRACKS) && !is(BETWEEN) => 0.08,
        () if is(BETWEEN) => 0.55,
        () if is(PARKING) => 0.97,
        () if is(LANE) => 0.75,
        // Where lanes cross, wheels have been everywhere.
        () if is(CARRIAGEWAY) => 0.35,
        () if is(WALKWAY) => 0.85,
        () => 1.0,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn wheels_clear_more_than_feet_and_where_nobody_was_all_of_it_lies() {
        let tracks = share(CARRIAGEWAY | LANE | TRACKS);
        let between = share(CARRIAGEWAY | LANE | TRACKS | BETWEEN);
        let order = [tracks, between, share(CARRIAGEWAY | LANE), share(CARRIAGEWAY | PARKING), share(0)];
        assert!(order.is_sorted() && tracks <= 0.1 && share(0) == 1.0, "{order:?}");
        assert!((0.5..0.9).contains(&share(WALKWAY)));
    }
}
