//! Who is at the made-up crossing: where they are, how large, and how they move.

use glam::{DVec2, DVec3};

use super::street::{EASTBOUND_M, MAIN_HALF_M, PARKING_M, SIDE_HALF_M, WESTBOUND_M};

/// A road user of the demo.
pub(super) struct RoadUser {
    /// nuScenes' category.
    pub(super) category: &'static str,
    /// nuScenes' attribute; empty for none.
    pub(super) attribute: &'static str,
    /// Length, width, height.
    pub(super) size_m: DVec3,
    /// Where it is at the middle keyframe.
    pub(super) position: DVec2,
    /// Where it looks, counter-clockwise from east.
    pub(super) yaw_rad: f64,
    /// Speed in that direction.
    pub(super) speed_mps: f64,
    /// Height of its ground above the road: sidewalks are raised.
    pub(super) ground_m: f64,
}

const EAST: f64 = 0.0;
const NORTH: f64 = std::f64::consts::FRAC_PI_2;
const WEST: f64 = std::f64::consts::PI;
const SOUTH: f64 = -std::f64::consts::FRAC_PI_2;
/// Height of the kerb.
const SIDEWALK_UP_M: f64 = 0.12;

/// Everybody, at the middle keyframe.
pub(super) fn all() -> Vec<RoadUser> {
    let mut all = vehicles();
    all.extend(riders());
    all.extend(people());
    all.extend(work_site());
    all
}

fn vehicles() -> Vec<RoadUser> {
    let car = [4.6, 1.85, 1.5];
    let small = [3.95, 1.72, 1.48];
    let suv = [4.75, 1.93, 1.74];
    let van = [5.3, 2.0, 2.2];
    let moving = |category, size, x, y, yaw, speed| user(category, "vehicle.moving", size, x, y, yaw, speed);
    let parked = |size, x, y, yaw| user("vehicle.car", "vehicle.parked", size, x, y, yaw, 0.0);
    vec![
        moving("vehicle.car", car, -11.0, EASTBOUND_M[0], EAST, 4.0),
        moving("vehicle.car", suv, 34.0, EASTBOUND_M[1], EAST, 9.0),
        moving("vehicle.car", small, -19.0, WESTBOUND_M[0], WEST, 8.0),
        moving("vehicle.truck", [8.2, 2.5, 3.4], -43.0, WESTBOUND_M[1], WEST, 7.0),
        moving("vehicle.car", car, 26.0, WESTBOUND_M[0], WEST, 9.0),
        moving("vehicle.bus.rigid", [11.6, 2.55, 3.2], -2.0, 25.0, SOUTH, 0.0),
        moving("vehicle.car", van, -52.0, EASTBOUND_M[1], EAST, 8.0),
        user("vehicle.emergency.police", "vehicle.stopped", car, 2.0, -22.0, NORTH, 0.0),
        parked(small, -22.5, PARKING_M[0], EAST),
        parked(suv, -34.0, PARKING_M[0], EAST),
        parked(car, -40.5, PARKING_M[0], EAST),
        parked(van, -26.0, PARKING_M[1], WEST),
        parked(small, -32.5, PARKING_M[1], WEST),
        parked(car, -20.0, PARKING_M[1], WEST),
        parked(car, 22.0, PARKING_M[1], WEST),
        parked(suv, 24.0, PARKING_M[0], EAST),
    ]
}

fn riders() -> Vec<RoadUser> {
    vec![
        user("vehicle.bicycle", "cycle.with_rider", [1.75, 0.62, 1.78], -17.0, -6.3, EAST, 4.0),
        user("vehicle.motorcycle", "cycle.with_rider", [2.1, 0.8, 1.7], -33.0, WESTBOUND_M[1], WEST, 8.0),
        on_sidewalk(user("vehicle.bicycle", "cycle.without_rider", [1.7, 0.55, 1.1], -30.0, -11.6, EAST, 0.0)),
    ]
}

fn people() -> Vec<RoadUser> {
    let adult = [0.65, 0.65, 1.76];
    let walking = |size, x, y, yaw| user("human.pedestrian.adult", "pedestrian.moving", size, x, y, yaw, 1.3);
    let standing = |x, y, yaw| user("human.pedestrian.adult", "pedestrian.standing", adult, x, y, yaw, 0.0);
    let zebra_west = -SIDE_HALF_M - 7.2;
    vec![
        walking(adult, zebra_west, 3.4, SOUTH),
        walking([0.6, 0.6, 1.66], zebra_west - 0.8, 6.0, NORTH),
        walking([0.7, 0.7, 1.83], zebra_west + 0.6, 7.3, SOUTH),
        on_sidewalk(walking(adult, -20.0, -MAIN_HALF_M - 2.2, WEST)),
        on_sidewalk(walking([0.6, 0.6, 1.68], -16.0, MAIN_HALF_M + 2.4, EAST)),
        on_sidewalk(standing(-12.0, -MAIN_HALF_M - 1.5, NORTH)),
        on_sidewalk(standing(-34.0, MAIN_HALF_M + 2.8, SOUTH)),
        on_sidewalk(user(
            "human.pedestrian.child",
            "pedestrian.moving",
            [0.5, 0.5, 1.22],
            -20.6,
            -MAIN_HALF_M - 2.9,
            WEST,
            1.3,
        )),
        on_sidewalk(user(
            "human.pedestrian.stroller",
            "pedestrian.moving",
            [1.5, 0.65, 1.7],
            -37.0,
            -MAIN_HALF_M - 2.0,
            EAST,
            1.0,
        )),
        on_sidewalk(user("animal", "", [0.9, 0.3, 0.6], -21.6, -MAIN_HALF_M - 1.6, WEST, 1.3)),
        on_sidewalk(user("movable_object.pushable_pullable", "", [0.7, 0.6, 1.1], -24.0, MAIN_HALF_M + 3.0, EAST, 0.0)),
    ]
}

/// A lane closed by barriers and cones, with an excavator and workers.
fn work_site() -> Vec<RoadUser> {
    let barrier = |x: f64, y: f64, yaw| user("movable_object.barrier", "", [0.5, 2.1, 1.0], x, y, yaw, 0.0);
    let cone = |x: f64, y: f64| user("movable_object.trafficcone", "", [0.4, 0.4, 0.75], x, y, EAST, 0.0);
    let worker = |x, y, yaw| {
        user("human.pedestrian.construction_worker", "pedestrian.standing", [0.7, 0.7, 1.8], x, y, yaw, 0.0)
    };
    let mut site = vec![
        user("vehicle.construction", "vehicle.parked", [6.2, 2.4, 2.9], 33.0, 6.5, WEST, 0.0),
        worker(28.0, 5.2, SOUTH),
        worker(29.2, 7.0, WEST),
        barrier(40.0, 4.6, EAST),
        barrier(40.0, 6.9, EAST),
    ];
    site.extend((0..4).map(|i| barrier(27.0 + 2.4 * f64::from(i), 3.6, NORTH)));
    site.extend((0..5).map(|i| cone(16.5 + 2.0 * f64::from(i), 7.9 - 0.9 * f64::from(i))));
    site
}

fn user(
    category: &'static str,
    attribute: &'static str,
    size: [f64; 3],
    x: f64,
    y: f64,
    yaw_rad: f64,
    speed_mps: f64,
) -> RoadUser {
    let position = DVec2::new(x, y);
    RoadUser { category, attribute, size_m: DVec3::from_array(size), position, yaw_rad, speed_mps, ground_m: 0.0 }
}

fn on_sidewalk(user: RoadUser) -> RoadUser {
    RoadUser { ground_m: SIDEWALK_UP_M, ..user }
}
