//! Fills the field of light around an eye: what nodes see is traced once, and how light goes on from node to node is then
//! summed, time after time.

use std::f32::consts::PI;
use std::sync::LazyLock;

use glam::Vec3;
use rayon::prelude::*;
use trove_trace::field::{self, ByDirection, Node, PART_SR, PARTS, direction_in, part_of};
use trove_trace::{Basis, disk};

use super::wave;
use crate::PreparedScene;
use crate::accel::{Coherence, PACKET};
use crate::field::{Kernel, LightField, Site};
use crate::lookups::LOOKUPS;
use crate::ray::{Hit, Ray};
use crate::surface::surface;

/// Rays to the sun and to lamps that a node asks with.
const TO_SUN: usize = 8;
const TO_LAMPS: usize = PACKET;
/// Places along a ray where it gathers what the air sends on.
const IN_AIR: usize = 4;
/// Times that light goes on; what comes after is too little to see.
const ROUNDS: usize = 8;
/// A node of whose rays this share sees solids from within lies in one.
const INSIDE: f32 = 0.2;
/// Looks at the sky of a ray, and the radius, radians, over which they are spread: about that of the part that it stands for.
const AT_SKY: usize = 4;
const SPREAD_RAD: f32 = 0.22;
/// Surfaces that give less than this share of their light to a node are left out.
const HARDLY_SEEN: f32 = 1e-3;

/// Streams of random numbers of a node.
const DIRECTIONS: u64 = 0;
const LIGHTS: u64 = 1;
const WAYS: u64 = 2;

static SENT_ON: LazyLock<Kernel> = LazyLock::new(|| Kernel::new(1.0, |cos| LOOKUPS.broad.phase(cos)));
static IRRADIANCE: LazyLock<Kernel> = LazyLock::new(|| Kernel::new(PI, |cos| cos.max(0.0)));

/// What a node's ray meets.
struct Met {
    /// Light that does not come by way of nodes: the sky's, and the sun's over droplets and surfaces.
    fixed: Vec3,
    /// The node beside its surface, the part that the surface faces, and how much it sends on of the irradiance there.
    surface: Option<(u32, usize, Vec3)>,
    /// Nodes in the air, each with the same weight.
    air: [Option<u32>; IN_AIR],
    share: f32,
}

/// What a node sees.
struct Seen {
    /// One ray into each part, in another direction for each node.
    rays: [Ray; PARTS],
    hits: [Option<Hit>; PARTS],
    of_lamps: ByDirection,
    node: Node,
}

/// The field around eyes at a place.
pub(super) fn fill(scene: &PreparedScene, place: [i32; 3]) -> LightField {
    let sites: Vec<Site> = LightField::sites(place).collect();
    let seen: Vec<Seen> = sites.par_iter().map(|site| seen(scene, site)).collect();
    let nodes = seen.iter().map(|seen| seen.node).collect();
    let mut field = LightField::new(place, nodes);
    let met: Vec<Vec<Met>> =
        sites.par_iter().zip(&seen).map(|(site, seen)| met(scene, &field.view(), site, seen)).collect();
    for _ in 0..ROUNDS {
        let tables: Vec<_> = met
            .par_iter()
            .zip(&seen)
            .map(|(met, seen)| {
                let around = around(&field.view(), met, &seen.of_lamps);
                (SENT_ON.of(&around), IRRADIANCE.of(&around))
            })
            .collect();
        field.set(tables);
    }
    field
}

fn seen(scene: &PreparedScene, site: &Site) -> Seen {
    let mut random = site.random(DIRECTIONS);
    let rays: [Ray; PARTS] = std::array::from_fn(|part| {
        let way = direction_in(part, [random.unit() as f32, random.unit() as f32]);
        Ray { through_glass: true, ..Ray::new(site.point, way) }
    });
    let mut hits = [None; PARTS];
    for (rays, hits) in rays.chunks(PACKET).zip(hits.chunks_mut(PACKET)) {
        scene.closest(rays, Coherence::Incoherent, hits);
    }
    let from_within = |(hit, ray): (&Option<Hit>, &Ray)| {
        let Some(hit) = hit else { return false };
        let placed = scene.placed(hit.instance);
        !surface(placed, hit, ray).is_front && !scene.materials[placed.material(hit)].is_translucent()
    };
    let inside = hits.iter().zip(&rays).filter(|&of| from_within(of)).count();
    let (mut node, mut of_lamps) = (Node::default(), [Vec3::ZERO; PARTS]);
    node.is_open = (inside as f32) < INSIDE * PARTS as f32;
    if node.is_open {
        let mut random = site.random(LIGHTS);
        let mut unit = || random.unit() as f32;
        node.sun = share_of_sun(scene, site, &mut unit);
        of_lamps = from_lamps(scene, site, &mut unit);
    }
    Seen { rays, hits, of_lamps, node }
}

/// A place near a node's.
fn near(site: &Site, unit: &mut impl FnMut() -> f32) -> Vec3 {
    site.point + (Vec3::new(unit(), unit(), unit()) - 0.5) * (0.5 * site.step_m)
}

fn share_of_sun(scene: &PreparedScene, site: &Site, unit: &mut impl FnMut() -> f32) -> Vec3 {
    let (mut rays, lights) = (Vec::with_capacity(TO_SUN), scene.lights.view());
    for _ in 0..TO_SUN {
        let (from, u) = (near(site, unit), [unit(), unit()]);
        rays.extend(lights.sample_sun(u).map(|sun| Ray::new(from, sun.wi)));
    }
    let mut light = vec![Vec3::ONE; rays.len()];
    wave::light(scene, Coherence::Incoherent, &rays, &mut light);
    light.iter().sum::<Vec3>() / TO_SUN as f32
}

/// Radiance that comes straight from lamps.
fn from_lamps(scene: &PreparedScene, site: &Site, unit: &mut impl FnMut() -> f32) -> ByDirection {
    let (mut rays, mut light) = (Vec::with_capacity(TO_LAMPS), Vec::with_capacity(TO_LAMPS));
    let lights = scene.lights.view();
    for i in 0..TO_LAMPS {
        let (from, u) = (near(site, unit), [(i as f32 + unit()) / TO_LAMPS as f32, unit(), unit()]);
        let drawn = lights.rest(from, Vec3::ZERO).draw(u);
        if let Some(lamp) = drawn.filter(|light| light.distance.is_finite()) {
            let clear = scene.clear(from, lamp.wi, lamp.distance, LOOKUPS.broad);
            rays.push(Ray { t_max: lamp.reach(from), ..Ray::new(from, lamp.wi) });
            light.push(lamp.radiance * (clear / (lamp.pdf * TO_LAMPS as f32)));
        }
    }
    wave::light(scene, Coherence::Incoherent, &rays, &mut light);
    let mut all = [Vec3::ZERO; PARTS];
    for (light, ray) in light.iter().zip(&rays) {
        all[part_of(ray.direction)] += *light / PART_SR;
    }
    all
}

/// What each ray of a node meets; nothing where it is of no use.
fn met(scene: &PreparedScene, field: &field::LightField<'_>, site: &Site, seen: &Seen) -> Vec<Met> {
    if !seen.node.is_open {
        return Vec::new();
    }
    let (mut random, lights) = (site.random(WAYS), scene.lights.view());
    let mut unit = || random.unit() as f32;
    let (mut all, mut rays, mut light, mut whose) = (Vec::new(), Vec::new(), Vec::new(), Vec::new());
    for (i, (ray, hit)) in seen.rays.iter().zip(&seen.hits).enumerate() {
        let free = hit.map_or(f32::INFINITY, |hit| hit.t);
        let clear = scene.clear(site.point, ray.direction, free, LOOKUPS.broad);
        let mut met = in_air(scene, field, ray, free, clear, &mut unit);
        match hit {
            None => {
                let basis = Basis::about(ray.direction);
                for _ in 0..AT_SKY {
                    let [x, y] = disk([unit(), unit()]).map(|c| c * SPREAD_RAD);
                    let way = basis.to_world(Vec3::new(x, y, 1.0)).normalize();
                    met.fixed += lights.sky.radiance(way, SPREAD_RAD) * (clear / AT_SKY as f32);
                }
            }
            Some(hit) if clear > HARDLY_SEEN => {
                let (surface, material) = scene.surface(hit, ray);
                let sends = material.shade(&surface, 2.0 * SPREAD_RAD * hit.t, unit()).albedo * (clear / PI);
                let beside = surface.point + surface.shading * (0.25 * site.step_m).min(0.5 * hit.t);
                let node = field.nearest(beside, unit()).one(unit());
                met.surface = node.map(|node| (node, part_of(surface.shading), sends));
                let sun = lights.sample_sun([unit(), unit()]);
                if let Some(sun) = sun.filter(|sun| surface.shading.dot(sun.wi) > 0.0) {
                    let clear = scene.clear(surface.point, sun.wi, f32::INFINITY, LOOKUPS.broad);
                    rays.push(Ray::new(surface.leave(sun.wi), sun.wi));
                    light.push(sends * sun.radiance * (surface.shading.dot(sun.wi) * clear / sun.pdf));
                    whose.push(i);
                }
            }
            Some(_) => {}
        }
        all.push(met);
    }
    for (rays, light) in rays.chunks(PACKET).zip(light.chunks_mut(PACKET)) {
        wave::light(scene, Coherence::Incoherent, rays, light);
    }
    whose.into_iter().zip(light).for_each(|(i, light)| all[i].fixed += light);
    all
}

/// Nodes along a ray that is free so far, and the sun's light that droplets send on there.
fn in_air(
    scene: &PreparedScene,
    field: &field::LightField<'_>,
    ray: &Ray,
    free: f32,
    clear: f32,
    unit: &mut impl FnMut() -> f32,
) -> Met {
    let (share, lights) = ((1.0 - clear) / IN_AIR as f32, scene.lights.view());
    let mut met = Met { fixed: Vec3::ZERO, surface: None, air: [None; IN_AIR], share };
    let Some(fog) = scene.fog.map(|fog| fog.scattering(LOOKUPS.broad)) else { return met };
    for (k, node) in met.air.iter_mut().enumerate() {
        let Some(t) = fog.met(ray.origin, ray.direction, free, share * (k as f32 + unit())) else { continue };
        let point = ray.origin + ray.direction * t;
        let nearest = field.nearest(point, unit());
        *node = nearest.one(unit());
        if let Some(sun) = lights.sample_sun([unit(), unit()]) {
            let clear = fog.transmittance(point, sun.wi, f32::INFINITY);
            let phase = LOOKUPS.broad.phase(ray.direction.dot(sun.wi));
            met.fixed += field.sun(&nearest) * sun.radiance * (share * clear * phase / sun.pdf);
        }
    }
    met
}

/// Radiance around a node, of what its rays met and of lamps.
fn around(field: &field::LightField<'_>, met: &[Met], of_lamps: &ByDirection) -> ByDirection {
    let mut around = *of_lamps;
    for (part, (met, light)) in met.iter().zip(&mut around).enumerate() {
        let in_air: Vec3 = met.air.iter().flatten().map(|&node| field.nodes[node as usize].sent_on[part]).sum();
        let on_surface = met
            .surface
            .map_or(Vec3::ZERO, |(node, facing, sends)| sends * field.nodes[node as usize].irradiance[facing]);
        *light += met.fixed + met.share * in_air + on_surface;
    }
    around
}
