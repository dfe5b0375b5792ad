//! Buses and coaches.

mod body;
mod inside;
mod outside;
mod school;

use glam::{Vec3, vec3};
use trove_model::{Asset, Kind};

use super::workshop::Workshop;
use body::BusPlan;

/// Liveries of city buses: red, maroon, green, white, blue, yellow.
const CITY: [Vec3; 7] = [
    vec3(0.5, 0.015, 0.02),
    vec3(0.32, 0.015, 0.04),
    vec3(0.03, 0.25, 0.1),
    vec3(0.7, 0.7, 0.68),
    vec3(0.7, 0.7, 0.68),
    vec3(0.02, 0.08, 0.3),
    vec3(0.65, 0.42, 0.02),
];
/// The band along the skirt and the tail.
const BANDS: [Vec3; 4] = [vec3(0.7, 0.7, 0.68), vec3(0.05, 0.055, 0.06), vec3(0.4, 0.41, 0.42), vec3(0.02, 0.12, 0.26)];
const COACH: [Vec3; 6] = [
    vec3(0.74, 0.74, 0.72),
    vec3(0.74, 0.74, 0.72),
    vec3(0.4, 0.41, 0.42),
    vec3(0.03, 0.06, 0.2),
    vec3(0.3, 0.02, 0.03),
    vec3(0.02, 0.02, 0.022),
];

const CITY_BUS: BusPlan = BusPlan {
    length_m: 11.95,
    width_m: 2.5,
    height_m: 3.1,
    axles_m: &[2.7, 8.7],
    decks: &[(1.08, 2.5)],
    doors_m: &[(0.62, 1.2), (5.4, 1.25)],
    door_side: -1.0,
    front_low_m: 0.92,
    route: "12 CENTRAL STN",
    coach: false,
    wheel_m: 0.48,
};

/// Every bus.
pub(crate) fn assets() -> Vec<Asset> {
    let coach = BusPlan {
        length_m: 12.2,
        height_m: 3.65,
        axles_m: &[2.8, 9.0],
        decks: &[(1.82, 3.1)],
        doors_m: &[(0.55, 0.9)],
        front_low_m: 1.1,
        route: "AIRPORT",
        coach: true,
        wheel_m: 0.5,
        ..CITY_BUS
    };
    let coach_long = BusPlan { length_m: 13.4, axles_m: &[2.8, 8.9, 10.3], route: "TOURS", ..coach };
    let long = BusPlan {
        length_m: 12.9,
        axles_m: &[2.75, 9.2],
        doors_m: &[(0.62, 1.2), (5.2, 1.25), (9.95, 1.2)],
        route: "M29 HARBOUR",
        ..CITY_BUS
    };
    let midi = BusPlan {
        length_m: 8.6,
        width_m: 2.35,
        height_m: 2.98,
        axles_m: &[2.2, 6.2],
        doors_m: &[(0.62, 1.1), (3.6, 1.1)],
        route: "7 HILLSIDE",
        wheel_m: 0.43,
        ..CITY_BUS
    };
    let small = BusPlan {
        length_m: 7.0,
        width_m: 2.15,
        height_m: 2.75,
        axles_m: &[1.75, 5.15],
        decks: &[(1.15, 2.25)],
        doors_m: &[(2.35, 0.95)],
        front_low_m: 1.05,
        route: "SHUTTLE",
        wheel_m: 0.38,
        ..CITY_BUS
    };
    let double = BusPlan {
        length_m: 10.9,
        height_m: 4.35,
        axles_m: &[2.6, 8.0],
        decks: &[(1.15, 2.15), (2.72, 3.75)],
        doors_m: &[(0.62, 1.2), (5.0, 1.2)],
        door_side: 1.0,
        route: "24 OLD TOWN",
        ..CITY_BUS
    };
    let double_long = BusPlan { length_m: 12.0, axles_m: &[2.7, 8.1, 9.5], door_side: -1.0, ..double };
    let left = |plan: BusPlan| BusPlan { door_side: 1.0, ..plan };
    #[rustfmt::skip]
    let rigid: [(&str, BusPlan, &[Vec3]); 12] = [
        ("bus/city", CITY_BUS, &CITY),
        ("bus/city-left", left(CITY_BUS), &CITY),
        ("bus/city-long", long, &CITY),
        ("bus/coach", coach, &COACH),
        ("bus/coach-left", left(coach), &COACH),
        ("bus/coach-long", coach_long, &COACH),
        ("bus/double-decker", double, &CITY),
        ("bus/double-decker-long", double_long, &CITY),
        ("bus/midi", midi, &CITY),
        ("bus/midi-left", left(midi), &CITY),
        ("bus/small", small, &COACH),
        ("bus/small-left", left(small), &COACH),
    ];
    let rigid = rigid.map(|(id, plan, paints)| {
        let mut work = Workshop::new(id, paints, &BANDS);
        plan.build(&mut work);
        work.asset(Kind::Bus)
    });
    let bendy = [("bus/articulated", -1.0), ("bus/articulated-left", 1.0)].map(|(id, door_side)| {
        let mut work = Workshop::new(id, &CITY, &BANDS);
        articulated(&mut work, door_side);
        work.asset(Kind::ArticulatedBus)
    });
    rigid.into_iter().chain(bendy).chain(school::assets()).collect()
}

/// Two bodies with bellows between them.
fn articulated(work: &mut Workshop, door_side: f32) {
    let front = BusPlan {
        length_m: 10.3,
        axles_m: &[2.7, 8.4],
        doors_m: &[(0.62, 1.2), (5.2, 1.25)],
        door_side,
        route: "18 UNIVERSITY",
        ..CITY_BUS
    };
    let rear = BusPlan { length_m: 6.7, axles_m: &[4.1], doors_m: &[(1.3, 1.25)], ..front };
    front.piece(work, 0.0, [true, false]);
    rear.piece(work, -11.2, [false, true]);
    body::bellows(work, &front, -10.2, -11.3);
}
