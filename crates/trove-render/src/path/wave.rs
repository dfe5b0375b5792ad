//! Paths of neighbouring pixels that advance together, so that their rays may be traced together.

use glam::Vec3;
use trove_trace::path::{Path, Sample, Shadow, Start, Turn, advance};

use super::seen::Seen;
use super::splat::Place;
use crate::PreparedScene;
use crate::accel::{Coherence, PACKET};
use crate::field::LightField;
use crate::ray::{Hit, Ray};

/// Shadow rays to trace, each with the index of its path.
#[derive(Default)]
pub(super) struct Shadows {
    /// All in nearly the same direction.
    pub(super) to_sun: Vec<(u32, Shadow)>,
    /// To the sky and to lamps.
    pub(super) to_rest: Vec<(u32, Shadow)>,
}

impl Shadows {
    /// Those of a path; whether it goes on.
    pub(super) fn take(&mut self, path: u32, turn: &Turn) -> bool {
        self.to_sun.extend(turn.shadows.to_sun.map(|shadow| (path, shadow)));
        self.to_rest.extend(turn.shadows.to_rest.map(|shadow| (path, shadow)));
        turn.goes_on
    }
}

/// Paths under way, with room that is used again and again.
#[derive(Default)]
pub(super) struct Wave {
    /// In an order in which [`PACKET`] successive ones start alike.
    pub(super) starts: Vec<Start>,
    /// Where in its tile each path's sample belongs.
    pub(super) places: Vec<Place>,
    pub(super) samples: Vec<Sample>,
    paths: Vec<Path>,
    active: Vec<u32>,
    going: Vec<u32>,
    shadows: Shadows,
    /// Rays traced so far.
    pub(super) rays: u64,
}

impl Wave {
    /// Follows all paths from their starts to their ends.
    pub(super) fn run(&mut self, scene: &PreparedScene, field: Option<&LightField>) {
        let seen = Seen::new(scene, field);
        self.paths.clear();
        self.paths.extend(self.starts.iter().map(|start| Path::new(*start)));
        self.active.clear();
        self.active.extend(0..self.paths.len() as u32);
        let mut coherence = Coherence::Coherent;
        while !self.active.is_empty() {
            self.going.clear();
            for group in self.active.chunks(PACKET) {
                let mut hits = [None; PACKET];
                closest(scene, coherence, &self.paths, group, &mut hits);
                self.rays += group.len() as u64;
                for (&index, hit) in group.iter().zip(hits) {
                    let turn = advance(&seen, &mut self.paths[index as usize], hit);
                    if self.shadows.take(index, &turn) {
                        self.going.push(index);
                    }
                }
            }
            self.light(scene, coherence, seen.lights.scale);
            std::mem::swap(&mut self.active, &mut self.going);
            coherence = Coherence::Incoherent;
        }
        self.samples.clear();
        self.samples.extend(self.paths.iter().map(Path::sample));
    }

    /// Brings light to the paths from lamps, sky and sun where nothing is in the way.
    fn light(&mut self, scene: &PreparedScene, to_sun: Coherence, scale: f32) {
        let lists = [(&mut self.shadows.to_rest, Coherence::Incoherent), (&mut self.shadows.to_sun, to_sun)];
        for (shadows, coherence) in lists {
            self.rays += shadows.len() as u64;
            for group in shadows.chunks(PACKET) {
                let mut rays = [Ray::from(group[0].1.ray); PACKET];
                let mut light = [Vec3::ZERO; PACKET];
                for (((_, shadow), ray), light) in group.iter().zip(&mut rays).zip(&mut light) {
                    (*ray, *light) = (shadow.ray.into(), shadow.light);
                }
                self::light(scene, coherence, &rays[..group.len()], &mut light[..group.len()]);
                for ((path, shadow), light) in group.iter().zip(light) {
                    self.paths[*path as usize].gather(light, shadow.bounce, scale);
                }
            }
            shadows.clear();
        }
    }
}

/// Leaves of the light along each ray of a group what nothing keeps back.
pub(super) fn light(scene: &PreparedScene, coherence: Coherence, rays: &[Ray], light: &mut [Vec3]) {
    match coherence {
        Coherence::Coherent => scene.any(rays, coherence, light),
        Coherence::Incoherent => {
            // Panes are multiplied together first: another order would round otherwise.
            let mut shares = [Vec3::ONE; PACKET];
            scene.any(rays, coherence, &mut shares[..rays.len()]);
            light.iter_mut().zip(shares).for_each(|(light, share)| *light *= share);
        }
    }
}

/// What the rays of a group of paths meet.
pub(super) fn closest(
    scene: &PreparedScene,
    coherence: Coherence,
    paths: &[Path],
    group: &[u32],
    hits: &mut [Option<Hit>; PACKET],
) {
    let ray = |&index: &u32| Ray::from(&paths[index as usize]);
    let mut rays = [ray(&group[0]); PACKET];
    rays.iter_mut().zip(group).for_each(|(to, index)| *to = ray(index));
    scene.closest(&rays[..group.len()], coherence, &mut hits[..group.len()]);
}
