//! Splashes: what large drops throw up where they strike.

use std::f64::consts::TAU;

use glam::{DVec2, DVec3, IVec2, Vec3};
use rayon::prelude::*;
use trove_model::{Precipitation, Seed, Shot};

use super::streak::{REACH_M, Streak};
use crate::PreparedScene;
use crate::accel::{Coherence, PACKET};
use crate::motion::MIDDLE;
use crate::placed::Sort;
use crate::ray::Ray;

/// Smaller drops hardly splash.
const SMALLEST_M: f64 = 1.5e-3;
/// For so long a crown of water stands where one struck, seconds; a ball of so many of the drop's diameters covers as much.
const CROWN_S: f64 = 0.025;
const CROWN: f64 = 1.6;
/// Droplets of a splash, of so much of the drop's diameter.
const DROPLETS: u32 = 7;
const DROPLET: f64 = 0.3;
/// How fast they fly off, as a share of the drop's speed, and how steeply, radians.
const SPEED: [f64; 2] = [0.05, 0.12];
const STEEP_RAD: [f64; 2] = [0.8, 1.4];
/// None of them flies longer, seconds.
const FLIGHT_S: f64 = 0.23;
const GRAVITY_MPS2: f64 = 9.81;
/// They are seen so near, metres, in squares of this side.
const SEEN_M: f64 = 10.0;
const SQUARE_M: f64 = 1.0;
/// Rain comes from this high above the camera, metres, and splashes on what faces up by as much.
const ABOVE_M: f64 = 300.0;
const FACES_UP: f32 = 0.5;

/// A droplet under way, or a crown.
struct Droplet {
    /// From where the drop struck.
    from_it: DVec3,
    velocity_mps: DVec3,
    diameter_m: f64,
}

/// What the splashes around a camera draw.
pub(super) fn streaks(scene: &PreparedScene, shot: &Shot, rain: Precipitation) -> Vec<Streak> {
    let eye = shot.world_from_camera.translation;
    let (middle, around) = ((eye.truncate() / SQUARE_M).floor().as_ivec2(), (SEEN_M / SQUARE_M) as i32);
    let seed = Seed(shot.time_ns as u64).child("splashes");
    let squares: Vec<IVec2> =
        (-around..around).flat_map(|y| (-around..around).map(move |x| IVec2::new(x, y))).collect();
    let in_square = |square: &IVec2| -> Vec<Streak> {
        let square = middle + *square;
        let mut random = square.to_array().into_iter().fold(seed, |seed, part| seed.nth(part as u64)).random();
        // Those that struck while droplets may still fly.
        let per_m2_s = rain.pieces_per_m3(SMALLEST_M) * rain.speed_mps(2.0 * SMALLEST_M);
        let count = (per_m2_s * FLIGHT_S * SQUARE_M * SQUARE_M + random.unit()) as usize;
        let mut streaks = Vec::new();
        let struck: Vec<DVec2> =
            (0..count).map(|_| (square.as_dvec2() + DVec2::new(random.unit(), random.unit())) * SQUARE_M).collect();
        for group in struck.chunks(PACKET) {
            for place in ground(scene, eye.z + ABOVE_M, group).into_iter().take(group.len()) {
                let diameter_m = rain.diameter_m(SMALLEST_M, random.unit());
                let droplets =
                    splash(diameter_m, rain.speed_mps(diameter_m), FLIGHT_S * random.unit(), || random.unit());
                let Some(place) = place.filter(|place| place.distance(eye) > REACH_M[0]) else { continue };
                streaks.extend(droplets.iter().filter_map(|droplet| {
                    Streak::new(shot, place + droplet.from_it, droplet.diameter_m, droplet.velocity_mps)
                }));
            }
        }
        streaks
    };
    squares.par_iter().flat_map_iter(in_square).collect()
}

/// Where drops strike something that splashes.
fn ground(scene: &PreparedScene, from_z: f64, drops: &[DVec2]) -> [Option<DVec3>; PACKET] {
    let down = |place: &DVec2| Ray { time: MIDDLE, ..Ray::new(place.extend(from_z).as_vec3(), Vec3::NEG_Z) };
    let mut rays = [Ray::new(Vec3::ZERO, Vec3::NEG_Z); PACKET];
    rays.iter_mut().zip(drops).for_each(|(ray, place)| *ray = down(place));
    let mut hits = [None; PACKET];
    scene.closest(&rays[..drops.len()], Coherence::Coherent, &mut hits[..drops.len()]);
    std::array::from_fn(|i| {
        let hit = hits[i]?;
        let placed = scene.placed(hit.instance);
        let splashes = placed.sort != Sort::Loose && placed.normal(&hit, MIDDLE).z.abs() > FACES_UP;
        splashes.then(|| drops[i].extend(from_z - f64::from(hit.t)))
    })
}

/// What is still in the air some time after a drop has struck.
fn splash(diameter_m: f64, speed_mps: f64, age_s: f64, mut unit: impl FnMut() -> f64) -> Vec<Droplet> {
    let mut droplet = |_| {
        let within = |[low, high]: [f64; 2], u: f64| low + (high - low) * u;
        let (turn, steep_rad) = (TAU * unit(), within(STEEP_RAD, unit()));
        let off_mps = speed_mps * within(SPEED, unit());
        let aside = DVec2::from_angle(turn) * steep_rad.cos();
        let thrown_mps = aside.extend(steep_rad.sin()) * off_mps;
        let falls_mps = DVec3::NEG_Z * (GRAVITY_MPS2 * age_s);
        Droplet {
            from_it: (thrown_mps + falls_mps / 2.0) * age_s,
            velocity_mps: thrown_mps + falls_mps,
            diameter_m: diameter_m * DROPLET * (0.6 + 0.8 * unit()),
        }
    };
    let crown_m = CROWN * diameter_m;
    let crown = Droplet { from_it: DVec3::Z * crown_m / 2.0, velocity_mps: DVec3::ZERO, diameter_m: crown_m };
    let droplets = (0..DROPLETS).map(&mut droplet).filter(|droplet| droplet.from_it.z >= 0.0);
    (age_s < CROWN_S).then_some(crown).into_iter().chain(droplets).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_crown_rises_and_droplets_fly_up_fall_back_and_are_gone() {
        let mut random = Seed(3).random();
        let mut at = |age_s: f64| splash(3e-3, 8.0, age_s, || random.unit());
        let [fresh, flying, late] = [1e-4, 0.04, FLIGHT_S].map(&mut at);
        let (crown, droplets) = fresh.split_first().unwrap();
        assert!(crown.velocity_mps == DVec3::ZERO && droplets.len() == DROPLETS as usize);
        assert!(droplets.iter().all(|d| d.velocity_mps.z > 0.0 && d.from_it.length() < 1e-3));
        assert!(!flying.is_empty() && flying.iter().all(|d| d.velocity_mps != DVec3::ZERO && d.from_it.z < 0.2));
        assert!(late.is_empty());
        let volume = |d: &Droplet| d.diameter_m.powi(3);
        assert!(droplets.iter().map(volume).sum::<f64>() < 3e-3f64.powi(3), "more water than came down");
    }
}
