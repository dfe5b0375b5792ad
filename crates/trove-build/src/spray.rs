//! What wheels throw up from a wet road.

use glam::{DVec2, DVec3};
use trove_model::{Class, Cuboid, InstanceId, Puff, Seed};

/// Water on a road after heavy rain, metres; one that is less wet than the second of these has none that wheels could lift.
const DEEPEST_M: f64 = 1e-3;
const DAMP: f64 = 0.3;
/// Treads of tyres side by side, as a share of a vehicle's width.
const TREADS: f64 = 0.22;
/// Share of the water below them that becomes spray at a speed in m/s, by how much a car hides of what is before it on a
/// motorway; it grows with this power of the speed (Shearman, Hoare and Hutton 1998), to no more than half. The rest is
/// pressed aside.
const RAISED: f64 = 0.04;
const AT_MPS: f64 = 20.0;
const POWER: f64 = 2.8;
const MOST: f64 = 0.5;
/// Diameter of its droplets, metres, and how long they hang in the wake: until 1/e of them is left, seconds.
const DROPLET_M: f64 = 0.3e-3;
const HANGS_S: f64 = 0.8;
/// Older puffs are not there any more.
const OLDEST_S: f64 = 3.0 * HANGS_S;
/// Puffs stand so far apart, metres.
const APART_M: f64 = 0.5;
/// Spray that takes less of the light that runs along it is not seen.
const LEAST_DEPTH: f64 = 0.003;

/// Water on a road that is so wet, metres.
pub(crate) fn film_m(wetness: f64) -> f64 {
    DEEPEST_M * ((wetness - DAMP) / (1.0 - DAMP)).max(0.0)
}

/// Whether a class of road users is heavy and fast enough to throw water up.
pub(crate) fn has_tyres(class: Class) -> bool {
    matches!(class, Class::Car | Class::Jeep | Class::Van | Class::Truck | Class::Bus | Class::MotorcycleRider)
}

/// Spray behind a vehicle that drives straight on at a speed over a road with a film of water, newest puff first. As it drives
/// on its puffs stay where they are in World, but for the wind.
pub(crate) fn spray(film_m: f64, wind_mps: DVec2, id: InstanceId, cuboid: &Cuboid, speed_mps: f64) -> Vec<Puff> {
    let [length_m, width_m, height_m] = cuboid.size_m.to_array();
    let raised = (RAISED * (speed_mps / AT_MPS).powf(POWER)).min(MOST);
    let water_m3 = film_m * TREADS * width_m * raised * APART_M;
    // Droplets of a diameter d cover 3/2 d of their volume.
    let newest_m2 = 1.5 * water_m3 / DROPLET_M;
    let wake_m2 = width_m * height_m;
    if newest_m2 * speed_mps * HANGS_S / (APART_M * wake_m2) < LEAST_DEPTH {
        return Vec::new();
    }
    let forward = cuboid.world_from_body.vector(DVec3::X);
    let left = cuboid.world_from_body.vector(DVec3::Y);
    let rear_axle = cuboid.world_from_body.point(DVec3::new(-0.3 * length_m, 0.0, -0.5 * height_m));
    // Numbered along the way, so that each is the same one at the next moment.
    let along_m = rear_axle.dot(forward);
    let newest = (along_m / APART_M).floor();
    let count = (OLDEST_S * speed_mps / APART_M) as u32;
    let seed = Seed(u64::from(id.0)).child("spray");
    let puff = |i: u32| {
        let number = newest - f64::from(i);
        let behind_m = along_m - number * APART_M;
        let age_s = behind_m / speed_mps;
        let mut random = seed.nth(number as i64 as u64).random();
        let (aside, lift, share) = (random.range(-0.4, 0.4), random.range(0.7, 1.3), -(1.0 - random.unit()).ln());
        // The wake is as tall as the vehicle, and its droplets settle meanwhile.
        let up_m = (0.3 + 0.35 * height_m * age_s.min(1.0)) * lift;
        let radius_m = [0.45 * width_m + 0.5 * age_s, up_m + 0.15];
        let thrown = rear_axle - forward * behind_m + left * (aside * width_m) + DVec3::Z * up_m;
        let centre = thrown + (wind_mps * age_s).extend(0.0);
        Puff::covering(newest_m2 * share * (-age_s / HANGS_S).exp(), centre, radius_m)
    };
    (0..count).map(puff).collect()
}

#[cfg(test)]
mod tests {
    use trove_model::Pose;

    use super::*;

    fn car(x_m: f64) -> Cuboid {
        Cuboid { world_from_body: Pose::from_yaw(0.0, DVec3::new(x_m, 3.0, 0.75)), size_m: DVec3::new(4.4, 1.8, 1.5) }
    }

    /// What all of it takes of light that runs along it through its middle.
    fn depth(film_m: f64, speed_mps: f64) -> f64 {
        let puffs = spray(film_m, DVec2::ZERO, InstanceId(7), &car(0.0), speed_mps);
        puffs.iter().map(|puff| puff.optical_depth(DVec3::new(-200.0, 3.0, 0.6), DVec3::X, 400.0)).sum()
    }

    #[test]
    fn there_is_more_spray_the_faster_and_the_wetter_and_none_from_a_damp_road() {
        assert_eq!(depth(film_m(0.2), 30.0), 0.0);
        assert_eq!(depth(film_m(1.0), 0.0), 0.0);
        let wet = film_m(0.8);
        let [slow, town, motorway] = [6.0, 14.0, 28.0].map(|speed_mps| depth(wet, speed_mps));
        // At walking pace none, in town a haze; on a motorway it hides half of what is behind it.
        assert!(
            slow < 0.02 && (0.05..0.4).contains(&town) && (0.7..4.0).contains(&motorway),
            "{slow} {town} {motorway}"
        );
        assert!((depth(wet / 2.0, 28.0) / motorway - 0.5).abs() < 1e-9);
    }

    #[test]
    fn puffs_stay_where_they_are_while_the_vehicle_drives_on() {
        let (film_m, id) = (film_m(1.0), InstanceId(3));
        // Four metres are eight puffs.
        let seen = |wind_mps: DVec2| {
            let [now, later] = [0.1, 4.1].map(|x_m| spray(film_m, wind_mps, id, &car(x_m), 20.0));
            (now, later[8..].to_vec())
        };
        let (now, later) = seen(DVec2::ZERO);
        let moved = |(a, b): (&Puff, &Puff)| (b.centre - a.centre).truncate();
        assert!(now.iter().zip(&later).all(|pair| moved(pair).length() < 1e-9));
        let (before, after) = seen(DVec2::new(0.0, -5.0));
        assert!(before.iter().zip(&after).all(|pair| (moved(pair) - DVec2::new(0.0, -1.0)).length() < 1e-9));
        assert!(now.iter().zip(&later).all(|(a, b)| b.extinction_per_m < a.extinction_per_m));
        assert!(now.iter().all(|puff| puff.centre.x < 0.0 && puff.centre.z > 0.0));
    }
}
