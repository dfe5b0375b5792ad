//! How fast road users go and turn, and what they are seen to do.

use std::f64::consts::{PI, TAU};

use glam::DVec2;
use trove_model::{Cuboid, Kind, Posture, State};

use crate::between::Moments;

/// Poses at keyframes up to so long before and after a moment tell how fast something goes and turns, seconds …
const WINDOW_S: f64 = 0.75;
/// … and up to so long whether it slows down: the second difference of annotated places needs a longer base.
const BRAKING_WINDOW_S: f64 = 1.25;
/// Who turns farther than this meanwhile was annotated the wrong way round, radians.
const FLIP_RAD: f64 = 2.2;

/// How something moves; each part `None` where it is not known.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Movement {
    /// Metres per second over the ground.
    pub speed_mps: Option<f64>,
    /// Radians per second to the left.
    pub yaw_rate_radps: Option<f64>,
    /// Metres per second squared, positive for what slows down.
    pub slowing_mps2: Option<f64>,
}

/// A pose at a keyframe.
struct Known {
    time_s: f64,
    place: DVec2,
    heading_rad: f64,
}

/// How something moves at each moment that it has a box at, by those at keyframes; between two of these it is between.
pub(super) fn movements(boxes: &[(usize, Cuboid)], moments: Moments) -> Vec<Movement> {
    let known = |(moment, Cuboid { world_from_body, .. }): &(usize, Cuboid)| {
        let (place, heading_rad) = (world_from_body.translation.truncate(), world_from_body.yaw_rad());
        moments.keyframe(*moment).map(|_| Known { time_s: moments.time_s(*moment), place, heading_rad })
    };
    let known: Vec<Known> = boxes.iter().filter_map(known).collect();
    let at_known: Vec<Movement> = (0..known.len()).map(|i| Movement::at(&known, i)).collect();
    let movement = |(moment, _): &(usize, Cuboid)| {
        let now_s = moments.time_s(*moment);
        let next = known.partition_point(|known| known.time_s <= now_s);
        let Some(before) = next.checked_sub(1) else { return Movement::default() };
        match at_known.get(next) {
            Some(after) if known[before].time_s < now_s => {
                let share = (now_s - known[before].time_s) / (known[next].time_s - known[before].time_s);
                at_known[before].towards(after, share)
            }
            _ => at_known[before],
        }
    };
    boxes.iter().map(movement).collect()
}

impl Movement {
    /// At one of the poses that are known, by those around it.
    fn at(known: &[Known], i: usize) -> Self {
        // The farthest poses before and after that are near enough in time.
        let around = |window_s: f64| {
            let is_near = |other: &Known| (other.time_s - known[i].time_s).abs() <= window_s;
            let first = known[..i].iter().rposition(|other| !is_near(other)).map_or(0, |far| far + 1);
            let after = known[i..].iter().position(|other| !is_near(other)).map_or(known.len(), |far| i + far);
            (&known[first], &known[after - 1])
        };
        let (first, last) = around(WINDOW_S);
        let turn_rad = wrapped(last.heading_rad - first.heading_rad);
        let yaw_rate = (last.time_s > first.time_s).then(|| turn_rad / (last.time_s - first.time_s));
        let (early, late) = around(BRAKING_WINDOW_S);
        let slowing = speed_mps(early, &known[i]).zip(speed_mps(&known[i], late));
        Self {
            speed_mps: speed_mps(first, last),
            yaw_rate_radps: yaw_rate.filter(|_| turn_rad.abs() < FLIP_RAD),
            slowing_mps2: slowing.map(|(before, after)| 2.0 * (before - after) / (late.time_s - early.time_s)),
        }
    }

    fn towards(&self, other: &Self, share: f64) -> Self {
        let between = |of: fn(&Self) -> Option<f64>| of(self).zip(of(other)).map(|(a, b)| a + (b - a) * share);
        Self {
            speed_mps: between(|movement| movement.speed_mps),
            yaw_rate_radps: between(|movement| movement.yaw_rate_radps),
            slowing_mps2: between(|movement| movement.slowing_mps2),
        }
    }

    /// Whether a vehicle that moves so slows down by so much that it has to show it.
    pub(crate) fn brakes(&self) -> bool {
        let moves = self.speed_mps.is_some_and(|speed_mps| speed_mps >= State::STANDS_MPS);
        moves && self.slowing_mps2.is_some_and(|slowing_mps2| slowing_mps2 > State::BRAKES_MPS2)
    }

    /// What someone of a kind does who moves so: people what their posture shows, vehicles what they do on the road.
    pub(crate) fn states(&self, kind: Kind, posture: Option<Posture>, is_parked: Option<bool>) -> Vec<State> {
        let mut states = Vec::new();
        if let Some(posture) = posture {
            states.push(match posture {
                Posture::Standing => State::Standing,
                Posture::Walking { .. } => State::Walking,
                Posture::Running { .. } => State::Running,
                Posture::Sitting => State::Sitting,
            });
        } else if kind.is_vehicle() {
            let stands = self.speed_mps.map(|speed_mps| speed_mps < State::STANDS_MPS);
            match (stands, is_parked) {
                (Some(true) | None, Some(true)) => states.push(State::Parked),
                (Some(true), _) => states.push(State::Stopped),
                (Some(false), _) => states.push(State::Moving),
                (None, _) => {}
            }
            if self.brakes() {
                states.push(State::Braking);
            }
        }
        if matches!(kind, Kind::BicycleWithRider | Kind::MotorcycleWithRider) {
            states.push(State::Riding);
        }
        states.sort_unstable();
        states
    }
}

fn speed_mps(from: &Known, to: &Known) -> Option<f64> {
    (to.time_s > from.time_s).then(|| to.place.distance(from.place) / (to.time_s - from.time_s))
}

/// An angle from −π to π.
fn wrapped(angle_rad: f64) -> f64 {
    (angle_rad + PI).rem_euclid(TAU) - PI
}

#[cfg(test)]
mod tests {
    use super::*;

    fn known(count: usize, apart_s: f64, at: impl Fn(f64) -> (DVec2, f64)) -> Vec<Known> {
        let pose = |i: usize| {
            let time_s = i as f64 * apart_s;
            let (place, heading_rad) = at(time_s);
            Known { time_s, place, heading_rad: wrapped(heading_rad) }
        };
        (0..count).map(pose).collect()
    }

    #[test]
    fn a_circle_is_driven_at_its_yaw_rate_and_even_slowing_is_told() {
        // 8 m/s to the right on a circle of 20 m, through the heading where angles jump.
        let circle = known(12, 0.5, |t| {
            let angle = 3.0 - 0.4 * t;
            (DVec2::new(angle.sin(), -angle.cos()) * 20.0, angle)
        });
        for i in 0..12 {
            let movement = Movement::at(&circle, i);
            assert!((movement.yaw_rate_radps.unwrap() + 0.4).abs() < 1e-9);
            assert!((movement.speed_mps.unwrap() - 8.0).abs() < 0.06, "{movement:?}");
        }
        // From 10 m/s, by 2 m/s² a second, at keyframes of nuScenes and of Waymo.
        for apart_s in [0.5, 0.1] {
            let braking = known(40, apart_s, |t: f64| (DVec2::X * (10.0 * t - t * t).min(25.0), 0.0));
            let i = (2.0 / apart_s) as usize;
            let movement = Movement::at(&braking, i);
            assert!((movement.slowing_mps2.unwrap() - 2.0).abs() < 1e-9);
            assert!((movement.speed_mps.unwrap() - 6.0).abs() < 1e-9);
            let states = movement.states(Kind::Car, None, Some(false));
            assert_eq!(states, [State::Moving, State::Braking]);
        }
    }

    #[test]
    fn what_is_not_known_is_not_told() {
        let alone = Movement::at(&known(1, 0.5, |_| (DVec2::ZERO, 0.0)), 0);
        assert_eq!(alone, Movement::default());
        assert!(alone.states(Kind::Car, None, None).is_empty());
        assert_eq!(alone.states(Kind::Car, None, Some(true)), [State::Parked]);
        assert_eq!(alone.states(Kind::BicycleWithRider, None, None), [State::Riding]);
        assert_eq!(alone.states(Kind::Adult, Some(Posture::Standing), None), [State::Standing]);
        let stands = Movement { speed_mps: Some(0.0), ..alone };
        assert_eq!(stands.states(Kind::Bus, None, None), [State::Stopped]);
        assert!(stands.states(Kind::TrafficCone, None, None).is_empty());
        // Annotated as parked, and driving.
        let drives = Movement { speed_mps: Some(5.0), ..alone };
        assert_eq!(drives.states(Kind::Car, None, Some(true)), [State::Moving]);
        let turned = known(3, 0.5, |t| (DVec2::X * t, if t > 0.4 { PI } else { 0.0 }));
        assert_eq!(Movement::at(&turned, 0).yaw_rate_radps, None);
    }
}
