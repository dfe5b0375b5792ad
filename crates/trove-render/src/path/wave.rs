//! Paths of neighbouring pixels that advance together, so that their rays may be traced together.

use glam::Vec3;

use super::integrate::{Path, Shadows, Vertex};
use crate::PreparedScene;
use crate::accel::{Hit, PACKET, Ray};
use crate::prepare::Carrier;

/// Paths under way, with room that is used again and again.
#[derive(Default)]
pub(super) struct Wave {
    /// In an order in which [`PACKET`] successive ones start alike.
    pub(super) paths: Vec<Path>,
    /// Where in its tile each path's pixel is.
    pub(super) places: Vec<usize>,
    active: Vec<u32>,
    going: Vec<u32>,
    shadows: Shadows,
    /// Rays traced so far.
    pub(super) rays: u64,
}

impl Wave {
    /// Follows all paths to their ends.
    pub(super) fn run(&mut self, scene: &PreparedScene, carrier: &Carrier) {
        self.active.clear();
        self.active.extend(0..self.paths.len() as u32);
        let mut alike = true;
        while !self.active.is_empty() {
            self.going.clear();
            for group in self.active.chunks(PACKET) {
                let mut hits = [None; PACKET];
                intersect(scene, carrier, &self.paths, group, alike, &mut hits);
                self.rays += group.len() as u64;
                for (&index, hit) in group.iter().zip(hits) {
                    let path = &mut self.paths[index as usize];
                    let mut vertex = Vertex { scene, index, shadows: &mut self.shadows };
                    if vertex.advance(path, hit) {
                        self.going.push(index);
                    }
                }
            }
            self.light(scene, alike);
            std::mem::swap(&mut self.active, &mut self.going);
            alike = false;
        }
    }

    /// Brings light to the paths from lamps, sky and sun where nothing is in the way.
    fn light(&mut self, scene: &PreparedScene, alike: bool) {
        for (shadows, alike) in [(&mut self.shadows.to_rest, false), (&mut self.shadows.to_sun, alike)] {
            self.rays += shadows.len() as u64;
            for group in shadows.chunks(PACKET) {
                let mut rays = [group[0].ray; PACKET];
                let mut light = [Vec3::ZERO; PACKET];
                for ((shadow, ray), light) in group.iter().zip(&mut rays).zip(&mut light) {
                    (*ray, *light) = (shadow.ray, shadow.light);
                }
                self::light(scene, alike, &rays[..group.len()], &mut light);
                for (shadow, light) in group.iter().zip(light) {
                    self.paths[shadow.path as usize].gather(light, shadow.bounce, scene.lights.scale());
                }
            }
            shadows.clear();
        }
    }
}

/// Leaves of the light along each ray what nothing keeps back.
pub(super) fn light(scene: &PreparedScene, alike: bool, rays: &[Ray], light: &mut [Vec3]) {
    if alike {
        rays.chunks(PACKET).zip(light.chunks_mut(PACKET)).for_each(|(rays, light)| scene.shade_packet(rays, light));
    } else {
        rays.iter().zip(light).for_each(|(ray, light)| *light *= scene.transmittance(ray));
    }
}

/// What the rays of a group of paths meet.
pub(super) fn intersect(
    scene: &PreparedScene,
    carrier: &Carrier,
    paths: &[Path],
    group: &[u32],
    alike: bool,
    hits: &mut [Option<Hit>; PACKET],
) {
    let ray = |&index: &u32| paths[index as usize].ray;
    if alike {
        let mut rays = [ray(&group[0]); PACKET];
        rays.iter_mut().zip(group).for_each(|(to, index)| *to = ray(index));
        scene.intersect_packet(&rays[..group.len()], carrier, hits);
        return;
    }
    for (hit, index) in hits.iter_mut().zip(group) {
        let path = &paths[*index as usize];
        let from_eye = path.bounce == 0;
        *hit = if from_eye { scene.intersect_past(&path.ray, carrier) } else { scene.intersect(&path.ray) };
    }
}
