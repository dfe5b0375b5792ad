//! One path.

use glam::Vec3;
use trove_model::InstanceId;

use crate::PreparedScene;
use crate::accel::Ray;
use crate::material::Bsdf;
use crate::prepare::Surface;
use crate::sampling::{Sampler, power_heuristic};

/// Scattering events on a path; straight passages through glass do not count.
const MAX_BOUNCES: u32 = 6;
/// Panes and cut-outs that a path may pass straight.
const MAX_PASSAGES: u32 = 16;
/// From this bounce on paths end by chance, the likelier the less they carry.
const ROULETTE_FROM: u32 = 2;
/// Largest radiance that one sample may bring at the first bounce and after it, in units of what a white surface
/// has: rare paths that carry more would be speckles long before they are an average.
const MOST_DIRECT: f32 = 64.0;
const MOST_INDIRECT: f32 = 6.0;
/// Textures are looked up at this share of the pixel's width: the samples in the pixel do the rest.
const SHARPNESS: f32 = 0.5;

/// What a ray stands for: a cone that grows along it.
#[derive(Clone, Copy)]
pub(crate) struct Cone {
    /// At the origin.
    pub(crate) width_m: f32,
    pub(crate) spread_rad: f32,
}

/// One sample, or a mean of several.
#[derive(Clone, Copy, Default)]
pub(crate) struct Sample {
    pub(crate) radiance: Vec3,
    pub(crate) albedo: Vec3,
    pub(crate) normal: Vec3,
}

impl Sample {
    pub(crate) fn add(&mut self, other: &Self) {
        self.radiance += other.radiance;
        self.albedo += other.albedo;
        self.normal += other.normal;
    }

    pub(crate) fn divided(&self, n: f32) -> Self {
        Self { radiance: self.radiance / n, albedo: self.albedo / n, normal: self.normal / n }
    }
}

/// Light along a path, kept below what a sample may bring.
struct Gathered {
    radiance: Vec3,
    /// What a white surface has in this light.
    scale: f32,
}

impl Gathered {
    fn add(&mut self, light: Vec3, bounce: u32) {
        let most = self.scale * if bounce <= 1 { MOST_DIRECT } else { MOST_INDIRECT };
        let largest = light.max_element();
        // NaN would spread over the picture when it is filtered.
        if largest.is_finite() {
            self.radiance += if largest > most { light * (most / largest) } else { light };
        }
    }
}

/// Follows one path from the eye.
pub(crate) fn radiance(
    scene: &PreparedScene,
    mut ray: Ray,
    mut cone: Cone,
    carrier: Option<InstanceId>,
    sampler: &mut Sampler,
    rays: &mut u64,
) -> Sample {
    let mut gathered = Gathered { radiance: Vec3::ZERO, scale: scene.lights.scale() };
    let mut guide: Option<(Vec3, Vec3)> = None;
    let mut guide_filter = Vec3::ONE;
    let mut throughput = Vec3::ONE;
    // Where the path last scattered and the density of the direction it took; `None` before.
    let mut scattered: Option<(Vec3, f32)> = None;
    let (mut bounce, mut passages) = (0, 0);

    loop {
        *rays += 1;
        let found = if bounce == 0 { scene.intersect_past(&ray, carrier) } else { scene.intersect(&ray) };
        let Some(hit) = found else {
            // The sky, unless light sampling would have found it better.
            let weight = scattered.map_or(1.0, |(_, pdf)| power_heuristic(pdf, scene.lights.pdf(ray.direction)));
            gathered.add(throughput * scene.lights.radiance(ray.direction, cone.spread_rad) * weight, bounce);
            guide = guide.or(Some((guide_filter, Vec3::ZERO)));
            break;
        };
        let surface = Surface::new(scene, &hit, &ray);
        let material = scene.material_of(&hit);
        cone.width_m += cone.spread_rad * hit.t;

        if material.emission != Vec3::ZERO {
            let weight = scattered.map_or(1.0, |(from, pdf)| {
                let other = scene.lights.emitter_pdf(hit.instance, hit.triangle, from, surface.point);
                power_heuristic(pdf, other)
            });
            gathered.add(throughput * material.emission * weight, bounce);
        }

        let [l0, l1, l2, dither] = sampler.next4();
        let bsdf = material.shade(&surface, cone.width_m * SHARPNESS, dither);
        if guide.is_none() && (!bsdf.is_mirror || bounce >= 2) {
            guide = Some((guide_filter * bsdf.albedo, surface.shading));
        }

        gathered.add(throughput * direct(scene, &surface, &bsdf, [l0, l1, l2], rays), bounce + 1);

        let [u_lobe, u0, u1, u_roulette] = sampler.next4();
        let Some(next) = bsdf.sample([u_lobe, u0, u1]) else { break };
        let Some(pdf) = next.pdf else {
            // Straight through glass: the path goes on as if nothing had happened.
            passages += 1;
            if passages > MAX_PASSAGES {
                break;
            }
            throughput *= next.weight;
            if guide.is_none() {
                guide_filter *= next.weight.min(Vec3::ONE);
            }
            ray = Ray::new(surface.leave(next.wi), next.wi);
            continue;
        };

        bounce += 1;
        if bounce > MAX_BOUNCES {
            break;
        }
        throughput *= next.weight;
        if bounce >= ROULETTE_FROM {
            let survival = throughput.max_element().min(0.95);
            if u_roulette >= survival {
                break;
            }
            throughput /= survival;
        }
        scattered = Some((surface.point, pdf));
        cone.spread_rad += next.spread_rad;
        ray = Ray::new(surface.leave(next.wi), next.wi);
    }
    let (albedo, normal) = guide.unwrap_or((Vec3::ONE, Vec3::ZERO));
    Sample { radiance: gathered.radiance, albedo, normal }
}

/// Light that a surface sends on straight from a lamp, the sky or the sun, by one light sample.
fn direct(scene: &PreparedScene, surface: &Surface, bsdf: &Bsdf, u: [f32; 3], rays: &mut u64) -> Vec3 {
    let Some(light) = scene.lights.sample(surface.point, u) else { return Vec3::ZERO };
    let (f, pdf_bsdf) = bsdf.eval(light.wi);
    if f == Vec3::ZERO {
        return Vec3::ZERO;
    }
    *rays += 1;
    let t_max = if light.distance.is_finite() { light.distance * (1.0 - 1e-4) } else { f32::INFINITY };
    let share = scene.transmittance(&Ray { t_max, ..Ray::new(surface.leave(light.wi), light.wi) });
    if share == Vec3::ZERO {
        return Vec3::ZERO;
    }
    f * light.radiance * share * (power_heuristic(light.pdf, pdf_bsdf) / light.pdf)
}
