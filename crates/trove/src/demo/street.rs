//! The made-up crossing's measures, metres from its middle; x east, y north. Traffic keeps right.

use glam::DVec2;

/// The place's name in tables and map.
pub(super) const PLACE: &str = "trove-demo";
/// Where the made-up crossing lies on earth; only the sun takes notice.
pub(super) const LAT_DEG: f64 = 47.37;
pub(super) const LON_DEG: f64 = 8.54;
/// The crossing's position in the tables' global frame, metres.
pub(super) const CROSSING_M: [f64; 2] = [500.0, 500.0];
/// Half the main street (east–west): two lanes a direction and parking on both sides.
pub(super) const MAIN_HALF_M: f64 = 8.8;
/// Half the side street (north–south): one lane a direction.
pub(super) const SIDE_HALF_M: f64 = 4.2;
/// Width of the sidewalks.
pub(super) const SIDEWALK_M: f64 = 3.6;
/// The streets end this far from the crossing.
pub(super) const REACH_M: f64 = 280.0;
/// Radius of the kerb at the corners.
const CORNER_M: f64 = 5.0;

/// Middle of the driving lanes of the main street, eastbound: the inner and the outer one.
pub(super) const EASTBOUND_M: [f64; 2] = [-1.7, -5.0];
/// Westbound: the inner and the outer one.
pub(super) const WESTBOUND_M: [f64; 2] = [1.7, 5.0];
/// Middle of the parking lanes, south and north.
pub(super) const PARKING_M: [f64; 2] = [-7.7, 7.7];

/// Outline of the carriageway: a cross with rounded corners, counter-clockwise.
pub(super) fn carriageway() -> Vec<DVec2> {
    (0..4).flat_map(|quarter| kerb(quarter, 0.0)).collect()
}

/// Outlines of the four sidewalks, one around each corner.
pub(super) fn sidewalks() -> Vec<Vec<DVec2>> {
    let band = |quarter| kerb(quarter, 0.0).into_iter().chain(kerb(quarter, SIDEWALK_M).into_iter().rev()).collect();
    (0..4).map(band).collect()
}

/// Zebra crossings over the four arms.
pub(super) fn crossings() -> Vec<Vec<DVec2>> {
    let bar = |near: f64, far: f64, half: f64| {
        vec![DVec2::new(near, -half), DVec2::new(far, -half), DVec2::new(far, half), DVec2::new(near, half)]
    };
    let start = SIDE_HALF_M + CORNER_M + 0.5;
    let east = bar(start, start + 3.5, MAIN_HALF_M);
    let start = MAIN_HALF_M + CORNER_M + 0.5;
    let north = bar(start, start + 3.0, SIDE_HALF_M).into_iter().map(|p| p.perp()).collect::<Vec<_>>();
    let opposite = |ring: &[DVec2]| ring.iter().map(|p| -*p).collect();
    vec![opposite(&east), opposite(&north), east, north]
}

/// Lines between lanes: those between the directions, and those between lanes of one direction.
pub(super) fn dividers() -> (Vec<[DVec2; 2]>, Vec<[DVec2; 2]>) {
    let main = |y: f64, sign: f64| {
        let start = SIDE_HALF_M + CORNER_M + 5.0;
        [DVec2::new(sign * start, y), DVec2::new(sign * REACH_M, y)]
    };
    let side = |sign: f64| {
        let start = MAIN_HALF_M + CORNER_M + 5.0;
        [DVec2::new(0.0, sign * start), DVec2::new(0.0, sign * REACH_M)]
    };
    let between_directions = vec![main(0.0, -1.0), main(0.0, 1.0), side(-1.0), side(1.0)];
    let lanes = [-3.35, 3.35];
    let between_lanes = lanes.iter().flat_map(|&y| [main(y, -1.0), main(y, 1.0)]).collect();
    (between_directions, between_lanes)
}

/// Lanes as (centre line in driving direction, half width), the crossing's middle included.
pub(super) fn lanes() -> Vec<([DVec2; 2], f64)> {
    let east = EASTBOUND_M.map(|y| ([DVec2::new(-REACH_M, y), DVec2::new(REACH_M, y)], 1.65));
    let west = WESTBOUND_M.map(|y| ([DVec2::new(REACH_M, y), DVec2::new(-REACH_M, y)], 1.65));
    let north = ([DVec2::new(2.0, -REACH_M), DVec2::new(2.0, REACH_M)], 1.9);
    let south = ([DVec2::new(-2.0, REACH_M), DVec2::new(-2.0, -REACH_M)], 1.9);
    east.into_iter().chain(west).chain([north, south]).collect()
}

/// The kerb of a quarter, `margin_m` outside the carriageway, counter-clockwise around the crossing from the end of one
/// arm round the corner to the end of the next. The arms differ in width, so every other quarter is a mirror image.
fn kerb(quarter: usize, margin_m: f64) -> Vec<DVec2> {
    let centre = DVec2::new(SIDE_HALF_M + CORNER_M, MAIN_HALF_M + CORNER_M);
    let mut kerb = vec![DVec2::new(REACH_M, MAIN_HALF_M + margin_m)];
    for step in 0..=8 {
        let angle = std::f64::consts::FRAC_PI_2 * (3.0 - f64::from(step) / 8.0);
        kerb.push(centre + (CORNER_M - margin_m) * DVec2::from_angle(angle));
    }
    kerb.push(DVec2::new(SIDE_HALF_M + margin_m, REACH_M));
    match quarter {
        0 => kerb,
        1 => kerb.iter().rev().map(|p| DVec2::new(-p.x, p.y)).collect(),
        2 => kerb.iter().map(|p| -*p).collect(),
        _ => kerb.iter().rev().map(|p| DVec2::new(p.x, -p.y)).collect(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use trove_model::Polygon;

    #[test]
    fn the_carriageway_is_a_cross_and_the_sidewalks_lie_beside_it() {
        let road = Polygon::simple(carriageway());
        let arms = 2.0 * REACH_M * 2.0 * (MAIN_HALF_M + SIDE_HALF_M) - 4.0 * MAIN_HALF_M * SIDE_HALF_M;
        let corners = 4.0 * CORNER_M * CORNER_M * (1.0 - std::f64::consts::FRAC_PI_4);
        assert!((road.area_m2() - arms - corners).abs() < 1.0, "{} for {}", road.area_m2(), arms + corners);
        for sidewalk in sidewalks() {
            let sidewalk = Polygon::simple(sidewalk);
            assert!(sidewalk.area_m2() > 1500.0);
            assert!(!road.contains(sidewalk.centroid()));
        }
    }
}
