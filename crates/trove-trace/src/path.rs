//! One path and what happens at its vertices: unidirectional path tracing with light sampling.

use glam::Vec3;

use crate::bsdf::Bsdf;
use crate::field::LightField;
use crate::fog::{Fog, MATT_EVENTS, Scattering};
use crate::light::{LightSample, Lights, Rest};
use crate::lookups::Lookups;
use crate::material::Material;
use crate::ray::{Hit, Ray};
use crate::sampler::Sampler;
use crate::sampling::power_heuristic;
use crate::spray::Spray;
use crate::surface::Surface;
use crate::texture::Map;

/// Times that a path goes on from a surface that it meets, so that light comes over one surface more; straight passages
/// through glass do not count.
const MAX_BOUNCES: u32 = 6;
/// Panes and cut-outs that a path may pass straight.
const MAX_PASSAGES: u32 = 16;
/// Droplets that a path may meet.
const MAX_DROPLETS: u32 = 64;
/// Paths that carry less than one over this end by chance, the likelier the less they carry. On streets 3 instead of 2 takes a
/// tenth to a seventh more time for a sixth less square error, and for 2 to 10 % less after denoising.
const ROULETTE: f32 = 3.0;
/// The same at droplets.
const ROULETTE_IN_AIR: f32 = 2.0;
/// The same of paths from the first surface on where light of the air is read: most of its light comes by this way.
const ROULETTE_TO_AIR: f32 = 8.0;
/// Largest radiance that one sample may bring at the first bounce and after it, in units of what a white surface
/// has: rare paths that carry more would be speckles long before they are an average.
const MOST_DIRECT: f32 = 64.0;
const MOST_INDIRECT: f32 = 6.0;
/// Of droplets, the light that shadow rays ask for by chance, as [`Lights::faint`] is for surfaces: most of the noise in fog
/// is not theirs, and a fifth of the time was.
const FAINT_IN_AIR: f32 = 0.2;
/// Textures are looked up at this share of the pixel's width: the samples in the pixel do the rest.
const SHARPNESS: f32 = 0.5;
/// Paths of which droplets that are not met leave less than this end by chance.
const HARDLY: f32 = 0.05;

/// Most that the sun's light seen around its disk is brighter by for coming in at a slant.
const MOST_ASLANT: f32 = 3.0;

/// What a ray stands for: a cone that grows along it.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
pub struct Cone {
    /// At the origin.
    pub width_m: f32,
    /// By which it grows for each metre.
    pub spread_rad: f32,
}

/// One sample, or a mean of several.
#[derive(Clone, Copy, Debug, Default)]
#[repr(C)]
pub struct Sample {
    /// What it brought.
    pub radiance: Vec3,
    /// What the first surface that is no mirror reflects of white light; 1 for the sky.
    pub albedo: Vec3,
    /// That surface's shading normal, World; 0 for the sky.
    pub normal: Vec3,
}

impl Sample {
    /// Adds another one to a sum.
    pub fn add(&mut self, other: &Self) {
        self.radiance += other.radiance;
        self.albedo += other.albedo;
        self.normal += other.normal;
    }

    /// The mean of a sum of so many.
    pub fn divided(&self, n: f32) -> Self {
        Self { radiance: self.radiance / n, albedo: self.albedo / n, normal: self.normal / n }
    }
}

/// Where paths go.
pub trait World {
    /// What holds textures.
    type Map: Map;

    /// What is looked up.
    fn lookups(&self) -> &Lookups;

    /// All lights.
    fn lights(&self) -> &Lights<'_, Self::Map>;

    /// The surface at a ray's hit, and its material.
    fn surface(&self, hit: &Hit, ray: &Ray) -> (Surface, &Material<Self::Map>);

    /// A direction of World in the coordinates of the mesh of an instance, at the moment of the labels.
    fn direction_mesh(&self, instance: u32, direction: Vec3) -> Vec3;

    /// Droplets of the air, if there are any.
    fn fog(&self) -> Option<&Fog>;

    /// From where light is read that droplets send on to a path which has scattered; without it they are met one by one.
    fn field(&self) -> Option<&LightField<'_>>;

    /// Spray, if there is any.
    fn spray(&self) -> Option<&Spray<'_>>;
}

/// Where a path begins.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(16))]
pub struct Start {
    /// From the eye.
    pub ray: Ray,
    /// As in [`Path`].
    pub past: u32,
    /// What the ray stands for.
    pub cone: Cone,
    /// The path's numbers.
    pub sampler: Sampler,
}

/// A path under way.
#[derive(Clone, Copy)]
#[repr(C)]
pub struct Path {
    /// Where it goes.
    pub ray: Ray,
    /// The object that it passes through as if it were not there: what carries the sensor; 0 for none.
    pub past: u32,
    cone: Cone,
    sampler: Sampler,
    throughput: Vec3,
    /// Times that it has scattered.
    pub bounce: u32,
    passages: u32,
    droplets: u32,
    /// Scattering events that part it from the eye, as `Scattering::after` counts them.
    events: u32,
    /// Where it last scattered; `None` before.
    scattered: Option<Scattered>,
    radiance: Vec3,
    guide: Option<(Vec3, Vec3)>,
    guide_filter: Vec3,
}

impl Path {
    /// From the eye.
    pub fn new(start: Start) -> Self {
        let Start { ray, past, cone, sampler } = start;
        Self {
            ray,
            past,
            cone,
            sampler,
            throughput: Vec3::ONE,
            bounce: 0,
            passages: 0,
            droplets: 0,
            events: 0,
            scattered: None,
            radiance: Vec3::ZERO,
            guide: None,
            guide_filter: Vec3::ONE,
        }
    }

    /// Adds light that came over `bounce` surfaces, kept below what a sample may bring where a white surface has `scale`.
    pub fn gather(&mut self, light: Vec3, bounce: u32, scale: f32) {
        let most = scale * if bounce <= 1 { MOST_DIRECT } else { MOST_INDIRECT };
        let largest = light.max_element();
        // NaN would spread over the picture when it is filtered.
        if largest.is_finite() {
            self.radiance += if largest > most { light * (most / largest) } else { light };
        }
    }

    /// Lets it end by chance and returns the chance of going on; `None` where it has ended.
    fn survives(&mut self, u: f32, roulette: f32) -> Option<f32> {
        let chance = chance(self.throughput, roulette);
        self.throughput /= chance;
        (u < chance).then_some(chance)
    }

    /// Sends it on from where it has scattered, and through nothing any more.
    #[inline(always)]
    fn go_on(&mut self, origin: Vec3, direction: Vec3) {
        (self.ray, self.past) = (self.ray.then(origin, direction), 0);
    }

    /// What it brought, once it has ended.
    pub fn sample(&self) -> Sample {
        let (albedo, normal) = self.guide.unwrap_or((Vec3::ONE, Vec3::ZERO));
        Sample { radiance: self.radiance, albedo, normal }
    }
}

/// Chance of a path to go on that carries so much: the less it is against one over `roulette`, the smaller.
fn chance(carries: Vec3, roulette: f32) -> f32 {
    (carries.max_element() * roulette).min(0.95)
}

/// The last vertex at which a path scattered.
#[derive(Clone, Copy)]
struct Scattered {
    point: Vec3,
    /// The side that light was asked for, as for `Lights::rest`.
    lit_side: Vec3,
    /// Density of going on in the direction that it took: roulette has its share, since light sampling has to make up for
    /// what ends there.
    pdf: f32,
}

/// Light that reaches a path if nothing is in the way.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
pub struct Shadow {
    /// What must not meet anything.
    pub ray: Ray,
    /// What then reaches the path.
    pub light: Vec3,
    /// Surfaces over which it comes.
    pub bounce: u32,
}

/// What comes of a vertex.
#[derive(Clone, Copy, Debug, Default)]
#[repr(C)]
pub struct Turn {
    /// Whether the path goes on.
    pub goes_on: bool,
    /// Light that it asked for.
    pub shadows: Shadows,
}

/// Rays that ask for light.
#[derive(Clone, Copy, Debug, Default)]
#[repr(C)]
pub struct Shadows {
    /// To the sun, all of them in nearly the same direction.
    pub to_sun: Option<Shadow>,
    /// To the sky and to lamps.
    pub to_rest: Option<Shadow>,
}

/// Where a path has arrived.
#[derive(Clone, Copy)]
#[repr(C)]
#[expect(clippy::large_enum_variant, reason = "each lies in a table, with room for the largest")]
pub enum Arrival {
    /// Where it ends.
    End,
    /// At a droplet of the air, so many metres along its ray.
    Droplet(f32),
    /// At a surface.
    Surface(Vertex),
}

/// A surface that a path has arrived at.
#[derive(Clone, Copy)]
#[repr(C)]
pub struct Vertex {
    surface: Surface,
    bsdf: Bsdf,
    /// As for `Lights::rest`.
    lit_side: Vec3,
    /// By which it parts the path from the eye, as `Scattering::after` counts them.
    events: u32,
    /// Draws among lights.
    u_light: f32,
}

/// Where a path's ray has arrived: gathers light, asks for more behind shadow rays, and sends it on.
#[inline(always)]
pub fn advance<W: World>(world: &W, path: &mut Path, hit: Option<Hit>) -> Turn {
    match arrive(world, path, hit) {
        Arrival::End => Turn::default(),
        Arrival::Droplet(t) => scatter(world, path, t, hit),
        Arrival::Surface(vertex) => {
            let shadows = ask(world, path, &vertex);
            Turn { shadows, goes_on: send(world, path, &vertex) }
        }
    }
}

/// Gathers the light that reaches a path where its ray has arrived.
#[inline(always)]
pub fn arrive<W: World>(world: &W, path: &mut Path, hit: Option<Hit>) -> Arrival {
    At::new(world).arrive(path, hit)
}

/// Sends a path on from a droplet `t` metres along its ray, before what that meets.
#[inline(always)]
pub fn scatter<W: World>(world: &W, path: &mut Path, t: f32, hit: Option<Hit>) -> Turn {
    At::new(world).scatter(path, t, hit)
}

/// The light that a path asks for at a surface.
#[inline(always)]
pub fn ask<W: World>(world: &W, path: &mut Path, vertex: &Vertex) -> Shadows {
    At::new(world).ask(path, vertex)
}

/// Sends a path on from a surface where it has asked for light; false where it ends.
#[inline(always)]
pub fn send<W: World>(world: &W, path: &mut Path, vertex: &Vertex) -> bool {
    At::new(world).send(path, vertex)
}

/// Vertices of paths in a world.
struct At<'a, W: World> {
    world: &'a W,
    lights: &'a Lights<'a, W::Map>,
}

impl<'a, W: World> At<'a, W> {
    fn new(world: &'a W) -> Self {
        Self { world, lights: world.lights() }
    }

    fn arrive(&self, path: &mut Path, hit: Option<Hit>) -> Arrival {
        let lights = self.lights;
        if let Some(t) = self.droplet(path, hit) {
            return Arrival::Droplet(t);
        }
        if let Some(field) = self.field_after(path.events)
            && !self.air(path, field, hit.map_or(f32::INFINITY, |hit| hit.t))
        {
            return Arrival::End;
        }
        let Some(hit) = hit else {
            let direction = path.ray.direction;
            // Weighed against finding the same light by light sampling.
            let [of_sun, of_sky] = path.scattered.as_ref().map_or([1.0; 2], |s| {
                let others = [lights.sun_pdf(direction), lights.pdf_rest(s.lit_side, direction)];
                others.map(|other| power_heuristic(s.pdf, other))
            });
            let sun = lights.sun_radiance(direction) * of_sun;
            let sky = lights.sky.radiance(direction, path.cone.spread_rad) * of_sky;
            path.gather(path.throughput * (sun + sky), path.bounce, lights.scale);
            path.guide = path.guide.or(Some((path.guide_filter, Vec3::ZERO)));
            return Arrival::End;
        };
        // Between other surfaces there is little of it, and in fog it is lost.
        if path.scattered.is_none()
            && self.world.fog().is_none()
            && let Some((passes, sent)) = lights.haze(path.ray.direction, hit.t)
        {
            path.gather(path.throughput * sent, path.bounce, lights.scale);
            path.throughput *= passes;
        }
        let (surface, material) = self.world.surface(&hit, &path.ray);
        path.cone.width_m += path.cone.spread_rad * hit.t;

        let emitted = if surface.is_front { self.emitted(&hit, &surface, material) } else { Vec3::ZERO };
        if emitted != Vec3::ZERO {
            let weight = path.scattered.as_ref().map_or(1.0, |s| {
                let other = lights.pdf_rest_emitter([hit.instance, hit.triangle], s.point, s.lit_side, surface.point);
                power_heuristic(s.pdf, other)
            });
            path.gather(path.throughput * emitted * weight, path.bounce, lights.scale);
        }

        let [u_light, dither] = path.sampler.next2();
        let bsdf = self.shade(material, &surface, path.cone.width_m * SHARPNESS, dither);
        // In fog mirrors and panes guide too: what droplets keep paths from would show as noise behind them.
        if path.guide.is_none() && (!bsdf.is_mirror || path.bounce >= 2 || self.world.fog().is_some()) {
            path.guide = Some(self.guide(path, hit.t, bsdf.albedo, surface.shading));
        }
        let lit_side = if material.translucency > 0.0 { Vec3::ZERO } else { surface.shading };
        let events = if bsdf.is_matt { MATT_EVENTS } else { 1 };
        Arrival::Surface(Vertex { surface, bsdf, lit_side, events, u_light })
    }

    fn ask(&self, path: &mut Path, vertex: &Vertex) -> Shadows {
        let Vertex { surface, lit_side, events, u_light, .. } = vertex;
        let air = self.after(path.events + events);
        let sun = self.sun(path, surface.point, air);
        let sun = sun.and_then(|sun| self.ask_straight(path, vertex, sun));
        let rest = self.lights.rest(surface.point, *lit_side);
        let rest = self.ask_rest(path, &rest, *u_light, air, |path, light| self.ask_straight(path, vertex, light));
        self.trace(path, sun, rest, self.lights.faint())
    }

    fn send(&self, path: &mut Path, vertex: &Vertex) -> bool {
        let Vertex { surface, bsdf, lit_side, events, .. } = vertex;
        let [u_lobe, u_roulette] = path.sampler.next2();
        let [u0, u1] = path.sampler.next2();
        let Some(next) = bsdf.sample([u_lobe, u0, u1]) else { return false };
        let Some(pdf) = next.pdf else {
            // Straight through glass: the path goes on as if nothing had happened.
            path.passages += 1;
            path.throughput *= next.weight;
            if path.guide.is_none() {
                path.guide_filter *= next.weight.min(Vec3::ONE);
            }
            path.ray = path.ray.then(surface.leave(next.wi), next.wi);
            return path.passages <= MAX_PASSAGES;
        };

        let roulette = self.roulette(path);
        path.bounce += 1;
        path.events += events;
        path.throughput *= next.weight;
        let Some(chance) = path.survives(u_roulette, roulette) else { return false };
        path.scattered = Some(Scattered { point: surface.point, lit_side: *lit_side, pdf: pdf * chance });
        path.cone.spread_rad += next.spread_rad;
        path.go_on(surface.leave(next.wi), next.wi);
        true
    }

    /// What a path at a surface plays roulette against there; 0 where it ends for sure.
    fn roulette(&self, path: &Path) -> f32 {
        match path.bounce {
            0 if self.world.field().is_some() => ROULETTE_TO_AIR,
            MAX_BOUNCES => 0.0,
            _ => ROULETTE,
        }
    }

    /// Where its ray meets a droplet of the air before a surface; of spray only what is seen straight.
    fn droplet(&self, path: &mut Path, hit: Option<Hit>) -> Option<f32> {
        let (origin, direction) = (path.ray.origin, path.ray.direction);
        let free = hit.map_or(f32::INFINITY, |hit| hit.t);
        let spray = self.world.spray().filter(|_| path.scattered.is_none());
        let in_spray = spray.and_then(|spray| spray.met(origin, direction, free, path.sampler.next2()[0]));
        let in_fog = self.world.fog().filter(|_| self.field_after(path.events).is_none()).and_then(|fog| {
            let fog = fog.scattering(self.after(path.events));
            fog.met(origin, direction, in_spray.unwrap_or(free), path.sampler.next2()[0])
        });
        in_fog.or(in_spray)
    }

    /// What lies behind guides the denoiser all the same.
    fn scatter(&self, path: &mut Path, t: f32, hit: Option<Hit>) -> Turn {
        let (lights, direction) = (self.lights, path.ray.direction);
        if path.guide.is_none() {
            path.guide = Some(hit.map_or((path.guide_filter, Vec3::ZERO), |hit| {
                let (surface, material) = self.world.surface(&hit, &path.ray);
                let width_m = path.cone.width_m + path.cone.spread_rad * hit.t;
                let bsdf = self.shade(material, &surface, width_m * SHARPNESS, 0.5);
                self.guide(path, hit.t, bsdf.albedo, surface.shading)
            }));
        }
        let point = path.ray.origin + direction * t;
        path.cone.width_m += path.cone.spread_rad * t;
        let (scattering, air) = (self.after(path.events), self.after(path.events + 1));
        let on_sun = path.sampler.next2();
        let sun = lights.sample_sun(on_sun).map(|sun| self.dimmed(sun, point, air));
        let [u_light, u_roulette] = path.sampler.next2();
        path.droplets += 1;
        path.events += 1;
        let roulette = if path.droplets > MAX_DROPLETS { 0.0 } else { ROULETTE_IN_AIR };
        let goes_on = chance(path.throughput, roulette);
        let ask = |path: &Path, light: LightSample| {
            let phase = scattering.phase(direction.dot(light.wi));
            Some(self.shadow(path, point, Vec3::splat(phase), phase * goes_on, &light))
        };
        let sun = sun.and_then(|sun| {
            let Some(fog) = self.world.fog().filter(|_| self.world.field().is_some()) else { return ask(path, sun) };
            let depth = fog.depth(point, sun.wi, f32::INFINITY);
            let phase = scattering.phase_of_turned(&self.world.lookups().broad, direction.dot(sun.wi), depth);
            Some(self.shadow(path, point, Vec3::splat(phase), 0.0, &sun))
        });
        let rest = self.ask_rest(path, &lights.rest(point, Vec3::ZERO), u_light, air, ask);
        let shadows = self.trace(path, sun, rest, FAINT_IN_AIR);

        let Some(chance) = path.survives(u_roulette, roulette) else { return Turn { goes_on: false, shadows } };
        let on = scattering.turn(direction, path.sampler.next2());
        let pdf = scattering.phase(direction.dot(on)) * chance;
        path.scattered = Some(Scattered { point, lit_side: Vec3::ZERO, pdf });
        path.go_on(point, on);
        Turn { goes_on: true, shadows }
    }

    /// From where the light of droplets is read that so many events part from the eye; `None` where they are met.
    fn field_after(&self, events: u32) -> Option<&LightField<'_>> {
        self.world.field().filter(|_| events > 0)
    }

    /// How the air scatters light that so many events part from the eye.
    fn after(&self, events: u32) -> Scattering {
        self.field_after(events).map_or_else(|| Scattering::after(events), |_| self.world.lookups().broad)
    }

    /// Gathers what droplets send on along a path's ray as far as it is free, and leaves the path what comes through them;
    /// false where that is so little that it has ended.
    fn air(&self, path: &mut Path, field: &LightField<'_>, free: f32) -> bool {
        let (lights, scattering) = (self.lights, self.world.lookups().broad);
        let Some(fog) = self.world.fog().map(|fog| fog.scattering(scattering)) else { return true };
        let (origin, direction) = (path.ray.origin, path.ray.direction);
        let clear = fog.transmittance(origin, direction, free);
        let ([u_t, u_grid], on_sun) = (path.sampler.next2(), path.sampler.next2());
        if let Some(t) = fog.met(origin, direction, free, u_t * (1.0 - clear)) {
            let point = origin + direction * t;
            let nearest = field.nearest(point, u_grid);
            let mut light = field.sent_on(&nearest, direction);
            if let Some(sun) = lights.sample_sun(on_sun).map(|sun| self.dimmed(sun, point, scattering)) {
                light += field.sun(&nearest) * sun.radiance * (scattering.phase(direction.dot(sun.wi)) / sun.pdf);
            }
            path.gather(path.throughput * (1.0 - clear) * light, path.bounce + 1, lights.scale);
        }
        path.throughput *= clear;
        let carries = path.throughput.max_element();
        if carries < HARDLY {
            path.throughput *= HARDLY / carries.max(f32::MIN_POSITIVE);
            return path.sampler.next2()[0] * HARDLY < carries;
        }
        true
    }

    /// What guides the denoiser at a surface: droplets before it are white and face nowhere.
    fn guide(&self, path: &Path, t: f32, albedo: Vec3, normal: Vec3) -> (Vec3, Vec3) {
        let (origin, direction) = (path.ray.origin, path.ray.direction);
        let through_spray = self.world.spray().map_or(1.0, |spray| spray.transmittance(origin, direction, t));
        let clear = self.clear(origin, direction, t, Scattering::after(0)) * through_spray;
        (path.guide_filter * Vec3::ONE.lerp(albedo, clear), normal * clear)
    }

    /// The ray that asks for light of the sky or of a lamp: of several samples (the first number draws among lights) one, by
    /// what it would bring if nothing were in the way, and for all of them (Talbot, Cline, Egbert, "Importance Resampling
    /// for Global Illumination", 2005).
    fn ask_rest(
        &self,
        path: &mut Path,
        rest: &Rest<'_, W::Map>,
        u: f32,
        air: Scattering,
        ask: impl Fn(&Path, LightSample) -> Option<Shadow>,
    ) -> Option<Shadow> {
        let count = if path.bounce == 0 { self.lights.candidates() } else { 1 };
        let mut u_choice = if count > 1 { path.sampler.next2()[0] } else { 0.0 };
        let (mut chosen, mut total) = (None, 0.0);
        for i in 0..count {
            let [u0, u1] = path.sampler.next2();
            let light = rest.draw([(i as f32 + u) / count as f32, u0, u1]);
            let shadow = light.and_then(|light| ask(path, self.dimmed(light, rest.point(), air)));
            let Some(shadow) = shadow else { continue };
            let brings = shadow.light.element_sum();
            if brings > 0.0 {
                total += brings;
                let share = brings / total;
                if u_choice < share {
                    (u_choice, chosen) = (u_choice / share, Some((shadow, brings)));
                } else {
                    u_choice = (u_choice - share) / (1.0 - share);
                }
            }
        }
        let (shadow, brings) = chosen?;
        Some(Shadow { light: shadow.light * (total / (brings * count as f32)), ..shadow })
    }

    /// Which shadow rays are traced: those that would bring little by chance, the likelier the more, and then for all of them.
    fn trace(&self, path: &mut Path, sun: Option<Shadow>, rest: Option<Shadow>, faint: f32) -> Shadows {
        let us = path.sampler.next2();
        let faint = faint * self.lights.scale;
        let worth = |shadow: Option<Shadow>, u: f32| {
            let shadow = shadow?;
            let chance = (shadow.light.max_element() / faint).min(1.0);
            (u < chance).then(|| Shadow { light: shadow.light / chance, ..shadow })
        };
        Shadows { to_sun: worth(sun, us[0]), to_rest: worth(rest, us[1]) }
    }

    /// The sun as it shines through the air on a surface, some of it from around its disk.
    fn sun(&self, path: &mut Path, point: Vec3, air: Scattering) -> Option<LightSample> {
        let u = path.sampler.next2();
        let sun = self.dimmed(self.lights.sample_sun(u)?, point, air);
        let Some(fog) = self.world.fog() else { return Some(sun) };
        let ([u0, u1], [u2, _]) = (path.sampler.next2(), path.sampler.next2());
        let wi = air.turn_together(sun.wi, fog.depth(point, sun.wi, f32::INFINITY), [u0, u1, u2]);
        // Turned or not, as much comes down on the level.
        let aslant = if wi == sun.wi { 1.0 } else { (sun.wi.z / wi.z.max(0.0)).clamp(0.0, MOST_ASLANT) };
        (wi.z > 0.0).then(|| LightSample { wi, radiance: sun.radiance * aslant, ..sun })
    }

    /// Radiance that a surface emits from its front to where it is seen from.
    #[inline(always)]
    fn emitted(&self, hit: &Hit, surface: &Surface, material: &Material<W::Map>) -> Vec3 {
        let toward = || self.world.direction_mesh(hit.instance, surface.wo);
        material.emitted(self.world.lookups(), &self.lights.beams, surface.uv, toward)
    }

    /// How a material scatters light at a point.
    #[inline(always)]
    fn shade(&self, material: &Material<W::Map>, surface: &Surface, width_m: f32, dither: f32) -> Bsdf {
        material.shade(self.world.lookups(), surface, width_m, dither)
    }

    /// Share of light, scattered so, that droplets let pass along a unit direction for `t` metres.
    #[inline(always)]
    fn clear(&self, origin: Vec3, direction: Vec3, t: f32, scattering: Scattering) -> f32 {
        self.world.fog().map_or(1.0, |fog| fog.scattering(scattering).transmittance(origin, direction, t))
    }

    /// What the air leaves of light on its way to a point.
    fn dimmed(&self, light: LightSample, point: Vec3, air: Scattering) -> LightSample {
        let clear = self.clear(point, light.wi, light.distance, air);
        LightSample { radiance: light.radiance * clear, ..light }
    }

    /// The ray that asks for light which a surface sends on straight from where a light sample lies.
    fn ask_straight(&self, path: &Path, Vertex { surface, bsdf, .. }: &Vertex, light: LightSample) -> Option<Shadow> {
        let (f, pdf) = bsdf.eval(light.wi);
        (f != Vec3::ZERO).then(|| {
            let goes_on = if pdf > 0.0 { chance(path.throughput * f / pdf, self.roulette(path)) } else { 0.0 };
            self.shadow(path, surface.leave(light.wi), f, pdf * goes_on, &light)
        })
    }

    /// The ray that asks for light at a point of which so much is sent on; `pdf` is the density with which the path itself goes
    /// on in that direction.
    fn shadow(&self, path: &Path, origin: Vec3, f: Vec3, pdf: f32, light: &LightSample) -> Shadow {
        let ray = Ray { t_max: light.reach(origin), ..path.ray.then(origin, light.wi) };
        let weight = power_heuristic(light.pdf, pdf) / light.pdf;
        let light = path.throughput * f * light.radiance * weight;
        Shadow { ray, light, bounce: path.bounce + 1 }
    }
}
