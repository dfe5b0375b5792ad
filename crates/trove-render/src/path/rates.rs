//! How fast rays are traced, against the bare kernel.

use std::time::Instant;

use glam::Vec3;
use trove_model::Shot;
use trove_trace::path::{Path, Shadow, Start, advance};

use super::seen::Seen;
use super::tile::{Eye, tiles};
use super::wave::{self, Shadows};
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
    let (carrier, seen) = (Carrier::new(scene, shot.carrier), Seen::new(scene, None));
    let eye = Eye { scene, shot, carrier: &carrier, field: None };
    let mut times = RayTimes::default();
    for mut tile in tiles(shot.lens.width_px, shot.lens.height_px) {
        let mut starts = Vec::new();
        tile.start(&eye, &mut starts, &mut Vec::new());
        let mut paths: Vec<Path> = starts.iter().map(|start| Path::new(*start)).collect();
        let hits = closest(scene, &mut times.camera, &paths, Coherence::Coherent);

        let mut shadows = Shadows::default();
        let turn = |(path, hit): (&mut Path, Option<Hit>)| shadows.take(0, &advance(&seen, path, hit));
        let goes_on: Vec<bool> = paths.iter_mut().zip(hits).map(turn).collect();
        let lists = [(&shadows.to_sun, Coherence::Coherent), (&shadows.to_rest, Coherence::Incoherent)];
        for (list, coherence) in lists {
            let rays: Vec<Ray> = list.iter().map(|(_, shadow)| shadow.ray.into()).collect();
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
    let (carrier, seen) = (Carrier::new(scene, shot.carrier), Seen::new(scene, None));
    let eye = Eye { scene, shot, carrier: &carrier, field: None };
    let (mut closest, mut shadows) = ([const { Vec::new() }; 3], Shadows::default());
    for mut tile in tiles(shot.lens.width_px, shot.lens.height_px) {
        let mut starts = Vec::new();
        tile.start(&eye, &mut starts, &mut Vec::new());
        let mut paths: Vec<Path> = starts.iter().map(|start| Path::new(*start)).collect();
        for (bounce, rays) in closest.iter_mut().enumerate() {
            let all = paths.iter().map(Ray::from);
            rays.extend(all.clone());
            if bounce == 2 {
                break;
            }
            let mut hits = vec![None; paths.len()];
            scene.closest(&all.collect::<Vec<_>>(), Coherence::Incoherent, &mut hits);
            let mut unused = Shadows::default();
            let shadows = if bounce == 0 { &mut shadows } else { &mut unused };
            let mut hits = hits.into_iter();
            paths.retain_mut(|path| {
                let hit = hits.next().expect("one for each path");
                shadows.take(0, &advance(&seen, path, hit))
            });
        }
    }
    // Shares of panes are no question of what is met.
    let through = |(_, shadow): (u32, Shadow)| Ray { through_glass: true, ..shadow.ray.into() };
    let asked = |list: Vec<(u32, Shadow)>| list.into_iter().map(through).collect();
    let [camera, first, second] = closest;
    [
        ("camera", camera, false),
        ("first bounce", first, false),
        ("second bounce", second, false),
        ("to the sun", asked(shadows.to_sun), true),
        ("to sky and lamps", asked(shadows.to_rest), true),
    ]
}

/// Where the paths of one sample a pixel begin.
pub(crate) fn starts(scene: &PreparedScene, shot: &Shot) -> Vec<Start> {
    let carrier = Carrier::new(scene, shot.carrier);
    let eye = Eye { scene, shot, carrier: &carrier, field: None };
    let (mut starts, mut places) = (Vec::new(), Vec::new());
    for mut tile in tiles(shot.lens.width_px, shot.lens.height_px) {
        tile.start(&eye, &mut starts, &mut places);
    }
    starts
}

/// What the paths' rays meet, both ways.
fn closest(scene: &PreparedScene, seconds: &mut RaySeconds, paths: &[Path], coherence: Coherence) -> Vec<Option<Hit>> {
    let rays: Vec<Ray> = paths.iter().map(Ray::from).collect();
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
