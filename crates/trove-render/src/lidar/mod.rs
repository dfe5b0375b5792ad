//! A LiDAR's sweep: beams fill cones, each surface in them sends back its share, and the detector tells some of it.
//!
//! A beam is seven rays of equal power, its middle and a ring about it. What they meet at one range is one echo; leaves and
//! edges leave several, and so does glass, which is met and passed. Fog takes of the light on both ways and sends some back.

mod air;
mod detector;
mod echo;
mod reflectance;

use glam::DVec3;
use rayon::prelude::*;
use trove_model::{LidarPoint, LidarShot, PointCloud, SensorRay};

use crate::PreparedScene;
use crate::accel::Coherence;
use crate::prepare::Carrier;
use crate::ray::Ray;
use crate::sight::{self, Seen};
use echo::Part;

/// Rays of a beam.
const RAYS: usize = 7;
/// Where the ring's rays are, in half the cone's angle: in the middle of areas as large as the central ray's.
const RING: f64 = 0.736;
/// Surfaces that a ray is followed through.
const LAYERS: usize = 4;
/// Share of a ray that is worth following.
const LEAST: f32 = 0.1;

/// Cosine between normals of surfaces that look the same way.
const SAME_SIDE: f64 = 0.999;

/// A ray of a beam on its way.
struct Way {
    ring: usize,
    is_middle: bool,
    exact: SensorRay,
    ray: Ray,
    /// Share of its light that panes have let pass, one way.
    left: f32,
}

/// Computed with the current thread pool; what a beam brings back depends on it alone.
pub(crate) fn sweep(scene: &PreparedScene, shot: &LidarShot) -> PointCloud {
    let carrier = Carrier::new(scene, shot.carrier);
    let columns = 0..shot.scanner.columns;
    let columns: Vec<_> = columns.into_par_iter().map(|column| points(scene, shot, &carrier, column)).collect();
    PointCloud { points: columns.concat() }
}

/// What is told of a column's beams.
fn points(scene: &PreparedScene, shot: &LidarShot, carrier: &Carrier, column: usize) -> Vec<LidarPoint> {
    let lidar_from_world = shot.world_from_lidar.inverse();
    let rings = shot.scanner.elevations_rad.len();
    let met = met(scene, shot, carrier, column);
    let mut points = Vec::with_capacity(rings);
    for (ring, parts) in met.into_iter().enumerate() {
        let middle = shot.ray(column, ring);
        let seed = shot.seed.nth((column * rings + ring) as u64);
        let of_fog = air::of_fog(scene, &shot.scanner, &middle, &parts, seed);
        let of_spray = air::of_spray(scene, &shot.scanner, &middle, &parts, seed);
        let mut echoes = echo::echoes(parts, shot.scanner.pulse_m);
        echoes.extend(of_fog.into_iter().chain(of_spray));
        echoes.sort_by(|a, b| a.range_m.total_cmp(&b.range_m));
        let told = detector::told(&shot.scanner, echoes, seed.random());
        points.extend((0..).zip(told).map(|(number, told)| LidarPoint {
            position_m: lidar_from_world.point(middle.origin + middle.direction * told.range_m),
            intensity: told.intensity,
            ring: ring as u16,
            number,
            time_s: middle.time_s,
            class: told.class,
            instance: told.instance,
        }));
    }
    points
}

/// What the rays of each beam of a column meet.
fn met(scene: &PreparedScene, shot: &LidarShot, carrier: &Carrier, column: usize) -> Vec<Vec<Part>> {
    let rings = shot.scanner.elevations_rad.len();
    let mut met: Vec<Vec<Part>> = (0..rings).map(|_| Vec::with_capacity(RAYS)).collect();
    let mut looks: Vec<Vec<Look>> = (0..rings).map(|_| Vec::new()).collect();
    let mut ways: Vec<Way> = Vec::with_capacity(rings * RAYS);
    for ring in 0..rings {
        let middle = shot.ray(column, ring);
        let cone = cone(middle.direction, shot.scanner.divergence_rad / 2.0);
        ways.extend(cone.into_iter().enumerate().map(|(i, direction)| {
            let exact = SensorRay { direction, ..middle };
            Way { ring, is_middle: i == 0, exact, ray: carrier.past(sight::single(&exact)), left: 1.0 }
        }));
    }
    for _ in 0..LAYERS {
        let rays: Vec<Ray> = ways.iter().map(|way| way.ray).collect();
        let mut hits = vec![None; rays.len()];
        scene.closest(&rays, Coherence::Coherent, &mut hits);
        let mut on = Vec::new();
        for (way, hit) in ways.into_iter().zip(hits) {
            let Some(hit) = hit else { continue };
            let seen = sight::exactly(scene, hit, way.ray, &way.exact);
            let share = backscattered(scene, shot, &seen, &mut looks[way.ring]);
            met[way.ring].push(part(scene, &way, &seen, share));
            let left = way.left * scene.opacity(&hit).straight_through(way.exact.direction.dot(seen.normal) as f32).x;
            if left > LEAST {
                on.push(Way { ray: Ray { t_min: hit.t * (1.0 + 1e-5) + 1e-4, ..way.ray }, left, ..way });
            }
        }
        if on.is_empty() {
            break;
        }
        ways = on;
    }
    met
}

/// What a beam has seen of a surface.
struct Look {
    instance: u32,
    material: usize,
    normal: DVec3,
    share: f32,
}

/// What of a ray's light comes back: rays of one beam that meet the same side of the same thing see the same.
fn backscattered(scene: &PreparedScene, shot: &LidarShot, seen: &Seen, looks: &mut Vec<Look>) -> f32 {
    let (instance, material) = (seen.hit.instance, scene.placed(seen.hit.instance).material(&seen.hit));
    let is_same = |look: &&Look| {
        look.instance == instance && look.material == material && look.normal.dot(seen.normal) > SAME_SIDE
    };
    if let Some(look) = looks.iter().find(is_same) {
        return look.share;
    }
    let (surface, of_surface) = scene.surface(&seen.hit, &seen.ray);
    let class = scene.instances[instance as usize].class;
    let width_m = (seen.range_m * shot.scanner.divergence_rad) as f32;
    let share = reflectance::backscattered(&surface, of_surface, class, width_m);
    looks.push(Look { instance, material, normal: seen.normal, share });
    share
}

fn part(scene: &PreparedScene, way: &Way, seen: &Seen, share: f32) -> Part {
    let class = scene.instances[seen.hit.instance as usize].class;
    let left = way.left * scene.seen(way.exact.origin.as_vec3(), way.ray.direction, seen.range_m as f32);
    Part {
        range_m: seen.range_m,
        // There and back through the same panes and the same air.
        power: share * left * left / RAYS as f32,
        point: way.exact.origin + way.exact.direction * seen.range_m,
        normal: seen.normal,
        is_middle: way.is_middle,
        class,
        instance: scene.placed(seen.hit.instance).id,
    }
}

/// Unit directions of a beam's rays, the middle first.
fn cone(middle: DVec3, half_rad: f64) -> [DVec3; RAYS] {
    let (u, v) = middle.any_orthonormal_pair();
    std::array::from_fn(|i| {
        if i == 0 {
            return middle;
        }
        let (sin, cos) = (std::f64::consts::TAU * i as f64 / (RAYS - 1) as f64).sin_cos();
        (middle + (u * cos + v * sin) * (RING * half_rad).tan()).normalize()
    })
}
