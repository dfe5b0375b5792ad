//! From the scene to what comes back of a scan's waves.

use std::f64::consts::PI;

use glam::DVec3;
use rayon::prelude::*;
use trove_model::{Class, InstanceId, RadarScan, RadarShot, SensorRay};

use super::scatter::Scatterer;
use crate::PreparedScene;
use crate::accel::Coherence;
use crate::prepare::Carrier;
use crate::ray::Ray;
use crate::sight::{self, Seen};

/// Rays of a scan, about.
const RAYS: f64 = 60_000.0;
/// Heights of the beam that rays fill.
const BEAMS: f64 = 1.5;
/// Surfaces that a ray is followed to.
const SURFACES: u8 = 4;
/// Share of a ray's power that is worth following.
const LEAST: f64 = 0.02;
/// Echoes weaker than this share of what is found alone do not matter.
const FAINT: f64 = 1e-5;
/// A target of which half of the looks are found at `reach_m`.
pub(super) const TARGET_M2: f64 = 10.0;
/// So far before and behind the moment positions are compared for their speeds, seconds.
const STEP_S: f64 = SensorRay::MOVING_S;

/// What comes back of one ray by one way.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Echo {
    /// Half of its way's length, metres.
    pub(super) range_m: f64,
    /// Sine of the angle from the plane in which the radar looks ahead and up, to its left.
    pub(super) sine: f64,
    /// How fast its range grows, metres a second.
    pub(super) radial_mps: f64,
    /// 1 is what is found in half of the looks.
    pub(super) signal: f64,
    pub(super) class: Class,
    pub(super) instance: InstanceId,
    pub(super) surfaces: u8,
}

/// A ray on its way.
struct Way {
    ray: SensorRay,
    /// Share of its power that has come so far.
    left: f64,
    /// From the sensor to the ray's origin, metres.
    far_m: f64,
    /// How fast that grows, as far as it does not depend on where the ray ends, metres a second.
    growing_mps: f64,
    /// How fast the ray's origin moves.
    velocity: DVec3,
    mirrors: u8,
}

/// In the order of the rays; computed with the current thread pool.
pub(super) fn echoes(scene: &PreparedScene, shot: &RadarShot, scan: &RadarScan) -> Vec<Echo> {
    let carrier = Carrier::new(scene, shot.carrier);
    let (half_width, half_height) = (scan.half_width_rad(), scan.elevation_rad * BEAMS / 2.0);
    let step = (4.0 * half_width * half_height / RAYS).sqrt();
    let columns = (2.0 * half_width / step).ceil().max(1.0) as usize;
    let rows = (2.0 * half_height / step).ceil().max(1.0) as usize;
    let (wide, high) = (2.0 * half_width / columns as f64, 2.0 * half_height / rows as f64);
    let view = View { scene, shot, scan, carrier, radar_from_world: shot.world_from_radar.inverse() };
    let rays = shot.seed.child("rays").child(&scan.name);
    let column = |column: usize| {
        let mut random = rays.nth(column as u64).random();
        let mut ways = Vec::with_capacity(rows);
        for row in 0..rows {
            // Somewhere in its part of the beam: no pattern of rays meets a pattern of the scene.
            let azimuth = half_width - wide * (column as f64 + random.unit());
            let elevation = -half_height + high * (row as f64 + random.unit());
            let (up, along) = elevation.sin_cos();
            let direction = DVec3::new(along * azimuth.cos(), along * azimuth.sin(), up);
            let ray = SensorRay {
                origin: shot.world_from_radar.translation,
                direction: shot.world_from_radar.vector(direction),
                time_s: 0.0,
            };
            let sent = Sent { azimuth, elevation, solid: wide * high * along };
            let way = Way { ray, left: 1.0, far_m: 0.0, growing_mps: 0.0, velocity: shot.velocity_mps, mirrors: 0 };
            ways.push((sent, way));
        }
        view.follow(ways)
    };
    let columns: Vec<Vec<Echo>> = (0..columns).into_par_iter().map(column).collect();
    columns.concat()
}

/// How a ray left.
#[derive(Clone, Copy)]
struct Sent {
    azimuth: f64,
    elevation: f64,
    /// Its part of the sphere, steradians.
    solid: f64,
}

struct View<'a> {
    scene: &'a PreparedScene,
    shot: &'a RadarShot,
    scan: &'a RadarScan,
    carrier: Carrier,
    radar_from_world: trove_model::Pose<trove_model::SensorFrame, trove_model::World>,
}

impl View<'_> {
    /// What comes back of rays, and of what surfaces mirror and let pass of them.
    fn follow(&self, mut ways: Vec<(Sent, Way)>) -> Vec<Echo> {
        let mut echoes = Vec::new();
        for number in 1..=SURFACES {
            let rays: Vec<Ray> = ways.iter().map(|(_, way)| self.carrier.past(sight::single(&way.ray))).collect();
            let mut hits = vec![None; rays.len()];
            let coherence = if number == 1 { Coherence::Coherent } else { Coherence::Incoherent };
            self.scene.closest(&rays, coherence, &mut hits);
            let mut on = Vec::new();
            for ((hit, ray), (sent, way)) in hits.into_iter().zip(rays).zip(ways) {
                let Some(hit) = hit else { continue };
                let seen = sight::exactly(self.scene, hit, ray, &way.ray);
                if way.far_m + seen.range_m <= self.scan.farthest_m {
                    on.extend(self.meet(sent, way, &seen, &mut echoes).map(|way| (sent, way)));
                }
            }
            if on.is_empty() {
                break;
            }
            ways = on;
        }
        echoes
    }

    /// What comes back of a surface, and how the ray goes on.
    fn meet(&self, sent: Sent, way: Way, seen: &Seen, echoes: &mut Vec<Echo>) -> Option<Way> {
        let (surface, material) = self.scene.surface(&seen.hit, &seen.ray);
        let class = self.scene.instances[seen.hit.instance as usize].class;
        let is_pane = self.scene.opacity(&seen.hit).is_pane();
        let kind = self.shot.radar.surfaces.of(class, material.is_metal(&surface), is_pane);
        let towards = -way.ray.direction;
        let shading = if surface.is_front { surface.shading } else { -surface.shading }.as_dvec3();
        let normal = if shading.dot(towards) > 0.0 { shading.normalize_or(seen.normal) } else { seen.normal };
        let scatterer = Scatterer { surface: kind, towards, normal };
        let point = way.ray.origin + way.ray.direction * seen.range_m;
        let velocity = self.velocity(seen, point);
        let out_m = way.far_m + seen.range_m;
        let out_mps = way.growing_mps + (velocity - way.velocity).dot(way.ray.direction);
        let found = Found { class, instance: self.scene.placed(seen.hit.instance).id, surfaces: way.mirrors + 1 };

        // Back by the way that it came: from a mirror the radar is as far away as the ray has gone.
        let power = sent.solid * way.left * way.left * scatterer.towards(towards) / (out_m * out_m);
        echoes.extend(self.echo(found, (out_m, out_mps), power, sent, (sent.azimuth, sent.elevation)));
        if way.mirrors > 0 {
            self.straight_back(sent, &way, &scatterer, (point, velocity), (out_m, out_mps), found, echoes);
        }

        let mirrored = scatterer.mirrored(self.shot.radar.wavelength_m);
        let passes = kind.passes > mirrored;
        let left = way.left * if passes { kind.passes } else { mirrored };
        if left < LEAST {
            return None;
        }
        let direction = if passes { way.ray.direction } else { scatterer.mirror().normalize() };
        // A shading normal may send the mirror's ray into the surface.
        if !passes && direction.dot(seen.normal) <= 0.0 {
            return None;
        }
        let away = if passes { -seen.normal } else { seen.normal } * (1e-4 * out_m.max(1.0));
        Some(Way {
            ray: SensorRay { origin: point + away, direction, time_s: 0.0 },
            left,
            far_m: out_m,
            growing_mps: out_mps,
            velocity,
            mirrors: way.mirrors + u8::from(!passes),
        })
    }

    /// What a surface that was met by mirrors sends straight to the radar: the third side of a triangle.
    #[expect(clippy::too_many_arguments, reason = "all of it is of one meeting")]
    fn straight_back(
        &self,
        sent: Sent,
        way: &Way,
        scatterer: &Scatterer<'_>,
        (point, velocity): (DVec3, DVec3),
        (out_m, out_mps): (f64, f64),
        found: Found,
        echoes: &mut Vec<Echo>,
    ) {
        let back = self.shot.world_from_radar.translation - point;
        let (back_m, direction) = (back.length(), back.normalize_or_zero());
        let local = self.radar_from_world.vector(-direction);
        let arrives = (local.y.atan2(local.x), local.z.clamp(-1.0, 1.0).asin());
        let power = sent.solid * way.left * scatterer.towards(direction) / (back_m * back_m);
        let range = ((out_m + back_m) / 2.0, (out_mps + (velocity - self.shot.velocity_mps).dot(-direction)) / 2.0);
        let Some(echo) = self.echo(found, range, power, sent, arrives) else { return };
        // To the radar and not beyond; the carrier is in nobody's way.
        let start = point + direction * (1e-4 * back_m.max(1.0));
        let ray = SensorRay { origin: start, direction, time_s: 0.0 };
        let ray = Ray { t_max: (back_m * (1.0 - 1e-3)) as f32, past: self.shot.carrier, ..sight::single(&ray) };
        let mut hits = [None];
        self.scene.closest(&[ray], Coherence::Incoherent, &mut hits);
        echoes.extend(hits[0].is_none().then_some(echo));
    }

    /// An echo of so much power that comes from a direction, if it matters.
    fn echo(
        &self,
        found: Found,
        (range_m, radial_mps): (f64, f64),
        power: f64,
        sent: Sent,
        (azimuth, elevation): (f64, f64),
    ) -> Option<Echo> {
        let (out, back) = (self.scan.at(sent.azimuth)?, self.scan.at(azimuth)?);
        // The radar equation: a target of σ gives σ / (4π r⁴) of this power.
        let at_reach = 4.0 * PI / TARGET_M2 * out.reach_m.powi(2) * back.reach_m.powi(2);
        let beam = (self.scan.elevation_gain(sent.elevation) * self.scan.elevation_gain(elevation)).sqrt();
        let signal = power * at_reach * beam;
        let is_told = (self.scan.nearest_m..=self.scan.farthest_m).contains(&range_m);
        let Found { class, instance, surfaces } = found;
        let sine = azimuth.sin();
        (is_told && signal > FAINT).then_some(Echo { range_m, sine, radial_mps, signal, class, instance, surfaces })
    }

    /// How a point of what was met moves, World, metres a second.
    fn velocity(&self, seen: &Seen, point: DVec3) -> DVec3 {
        let motion = &self.scene.instances[seen.hit.instance as usize].world_from_mesh;
        let Some([before, after]) = motion.ends else { return DVec3::ZERO };
        let point_mesh = motion.middle.inverse().transform_point3(point);
        (after.transform_point3(point_mesh) - before.transform_point3(point_mesh)) / (2.0 * STEP_S)
    }
}

/// What was met.
#[derive(Clone, Copy)]
struct Found {
    class: Class,
    instance: InstanceId,
    surfaces: u8,
}
