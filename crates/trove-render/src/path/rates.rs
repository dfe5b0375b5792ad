//! How fast rays are traced, against the bare kernel.

use std::time::Instant;

use glam::Vec3;
use trove_model::Shot;
use trove_trace::Sampler;

use super::integrate::{Path, Shadow, Shadows, Vertex};
use super::tile::{Eye, tiles};
use super::wave::{self, Wave};
use crate::PreparedScene;
use crate::accel::{Coherence, PACKET};
use crate::prepare::Carrier;
use crate::ray::{Hit, Ray};

/// Seconds that one thread takes for rays of one sort.
#[derive(Clone, Copy, Debug, Default)]
pub struct RaySeconds {
    /// How many rays.
    pub rays: u64,
    /// As pictures are traced: in packets where they run alike, with holes and panes.
    pub renderer: f64,
    /// One by one, all triangles opaque.
    pub bare: f64,
    turn: bool,
}

/// Seconds that the rays of one sample a pixel take.
#[derive(Clone, Copy, Debug, Default)]
pub struct RayTimes {
    /// From the eye.
    pub camera: RaySeconds,
    /// From the first surfaces on.
    pub bounce: RaySeconds,
    /// From the first surfaces to sun, sky and lamps.
    pub shadow: RaySeconds,
}

pub(crate) fn ray_times(scene: &PreparedScene, shot: &Shot) -> RayTimes {
    let (carrier, lights) = (Carrier::new(scene, shot.carrier), &scene.lights.view());
    let eye = Eye { scene, shot, carrier: &carrier, field: None };
    let (mut times, mut wave) = (RayTimes::default(), Wave::default());
    for mut tile in tiles(shot.lens.width_px, shot.lens.height_px) {
        tile.start(&eye, &mut wave);
        let mut paths = std::mem::take(&mut wave.paths);
        let hits = closest(scene, &mut times.camera, &paths, Coherence::Coherent);

        let mut shadows = Shadows::default();
        let advance = |(index, (path, hit)): (u32, (&mut Path, Option<Hit>))| {
            Vertex { scene, lights, field: None, index, shadows: &mut shadows }.advance(path, hit)
        };
        let goes_on: Vec<bool> = (0..).zip(paths.iter_mut().zip(hits)).map(advance).collect();
        let lists = [(&shadows.to_sun, Coherence::Coherent), (&shadows.to_rest, Coherence::Incoherent)];
        for (list, coherence) in lists {
            let rays: Vec<Ray> = list.iter().map(|shadow| shadow.ray).collect();
            let mut light = vec![Vec3::ONE; rays.len()];
            let groups = rays.chunks(PACKET).zip(light.chunks_mut(PACKET));
            times.shadow.take(
                rays.len(),
                || groups.for_each(|(rays, light)| wave::light(scene, coherence, rays, light)),
                || scene.accel().bare_any(&rays),
            );
        }
        let mut goes_on = goes_on.into_iter();
        paths.retain(|_| goes_on.next() == Some(true));
        closest(scene, &mut times.bounce, &paths, Coherence::Incoherent);
    }
    times
}

/// Rays of one sample a pixel by sort, and whether they only ask if anything is met.
pub(crate) fn ray_sorts(scene: &PreparedScene, shot: &Shot) -> [(&'static str, Vec<Ray>, bool); 5] {
    let (carrier, lights) = (Carrier::new(scene, shot.carrier), &scene.lights.view());
    let eye = Eye { scene, shot, carrier: &carrier, field: None };
    let mut wave = Wave::default();
    let (mut closest, mut shadows) = ([const { Vec::new() }; 3], Shadows::default());
    for mut tile in tiles(shot.lens.width_px, shot.lens.height_px) {
        tile.start(&eye, &mut wave);
        let mut paths = std::mem::take(&mut wave.paths);
        for (bounce, rays) in closest.iter_mut().enumerate() {
            let all = paths.iter().map(|path| path.ray);
            rays.extend(all.clone());
            if bounce == 2 {
                break;
            }
            let mut hits = vec![None; paths.len()];
            scene.closest(&all.collect::<Vec<_>>(), Coherence::Incoherent, &mut hits);
            let mut unused = Shadows::default();
            let shadows = if bounce == 0 { &mut shadows } else { &mut unused };
            let mut hits = (0..).zip(hits);
            paths.retain_mut(|path| {
                let (index, hit) = hits.next().expect("one for each path");
                Vertex { scene, lights, field: None, index, shadows }.advance(path, hit)
            });
        }
    }
    // Shares of panes are no question of what is met.
    let asked = |list: Vec<Shadow>| list.into_iter().map(|shadow| Ray { through_glass: true, ..shadow.ray }).collect();
    let [camera, first, second] = closest;
    [
        ("camera", camera, false),
        ("first bounce", first, false),
        ("second bounce", second, false),
        ("to the sun", asked(shadows.to_sun), true),
        ("to sky and lamps", asked(shadows.to_rest), true),
    ]
}

/// Where the rays of one sample a pixel arrive first, with light asked for from straight above.
pub(crate) fn vertices(scene: &PreparedScene, shot: &Shot) -> Vec<trove_trace::Vertex> {
    let [(_, camera, _), ..] = ray_sorts(scene, shot);
    let mut hits = vec![None; camera.len()];
    scene.closest(&camera, Coherence::Incoherent, &mut hits);
    let mut sampler = Sampler::new(shot.seed.0, [0, 0], 0, 0);
    let vertex = |(ray, hit): (&Ray, Option<Hit>)| {
        let hit = hit?;
        let (surface, _) = scene.surface(&hit, ray);
        let material = scene.placed(hit.instance).material(&hit) as u32;
        let ([lobe, dither], [u0, u1]) = (sampler.next2(), sampler.next2());
        let (to_light, u) = (Vec3::Z, [lobe, u0, u1]);
        Some(trove_trace::Vertex { surface, to_light, width_m: hit.t / shot.lens.fx_px as f32, u, dither, material })
    };
    camera.iter().zip(hits).filter_map(vertex).collect()
}

/// What the paths' rays meet, both ways.
fn closest(scene: &PreparedScene, seconds: &mut RaySeconds, paths: &[Path], coherence: Coherence) -> Vec<Option<Hit>> {
    let rays: Vec<Ray> = paths.iter().map(|path| path.ray).collect();
    let all: Vec<u32> = (0..paths.len() as u32).collect();
    let mut found = Vec::with_capacity(paths.len());
    let trace = || {
        for group in all.chunks(PACKET) {
            let mut hits = [None; PACKET];
            wave::closest(scene, coherence, paths, group, &mut hits);
            found.extend_from_slice(&hits[..group.len()]);
        }
    };
    seconds.take(paths.len(), trace, || scene.accel().bare_closest(&rays));
    found
}

impl RaySeconds {
    /// Times both ways of tracing some rays, taking turns in going first, which is to find colder caches.
    fn take(&mut self, rays: usize, renderer: impl FnOnce(), bare: impl FnOnce() -> usize) {
        self.rays += rays as u64;
        self.turn = !self.turn;
        let (seconds_renderer, seconds_bare) = (&mut self.renderer, &mut self.bare);
        let mut renderer = Some(|| *seconds_renderer += seconds_of(renderer));
        if self.turn {
            renderer.take().into_iter().for_each(|time| time());
        }
        *seconds_bare += seconds_of(|| {
            std::hint::black_box(bare());
        });
        renderer.into_iter().for_each(|time| time());
    }
}

fn seconds_of(work: impl FnOnce()) -> f64 {
    let started = Instant::now();
    work();
    started.elapsed().as_secs_f64()
}
