//! Triangles that shine.

use glam::{Vec2, Vec3};

use super::tree::{Cut, Tree};
use crate::lookups::Lookups;
use crate::math::sqrt;
use crate::ray::NONE;
use crate::texture::Map;

/// All shining triangles of a scene, drawn by what they give to the place that asks.
///
/// They are sampled on the side from which their corners run counter-clockwise, since lamps are closed bodies.
pub struct Emitters<'a, T> {
    /// Sorted by instance and triangle.
    pub triangles: &'a [Emitter],
    /// How those differ over themselves that do.
    pub patterns: &'a [Pattern<T>],
    /// Which of them shine where.
    pub tree: Tree<'a>,
}

/// A shining triangle.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
pub struct Emitter {
    /// Indices of instance and triangle.
    pub key: [u32; 2],
    /// Its first corner, World.
    pub corner: Vec3,
    /// From there to the others.
    pub edges: [Vec3; 2],
    /// Twice the area, along the normal.
    pub cross: Vec3,
    /// On average over it.
    pub radiance: Vec3,
    /// Luminance of that, times the share of its light that gets away from what it is part of: little of a room's does,
    /// through the windows.
    pub brightness: f32,
    /// Index of its pattern; [`NONE`] for what shines alike all over.
    pub pattern: u32,
    /// Index of the aim by which the radiance differs between directions; [`NONE`] for none.
    pub aim: u32,
}

/// How the radiance of a triangle differs over it.
#[derive(Clone, Copy)]
#[repr(C)]
pub struct Pattern<T> {
    /// Where the map is white.
    pub brightest: Vec3,
    /// What texture coordinates are multiplied by.
    pub scale: Vec2,
    /// Texture coordinates of its corners.
    pub uvs: [Vec2; 3],
    /// What the radiance is multiplied by where.
    pub map: T,
}

/// A point on a shining triangle.
#[derive(Clone, Copy, Debug)]
pub struct EmitterPoint {
    /// World.
    pub point: Vec3,
    /// Towards the place that asked.
    pub radiance: Vec3,
    /// Density over solid angle with which it was drawn; infinite seen edge-on.
    pub pdf: f32,
}

/// Coordinates along both edges for two numbers in [0, 1), even over a triangle.
#[inline]
pub fn barycentric(u: [f32; 2]) -> [f32; 2] {
    let root = sqrt(u[0]);
    [root * (1.0 - u[1]), root * u[1]]
}

impl<T: Map> Pattern<T> {
    /// Radiance at two barycentric coordinates.
    #[inline]
    pub fn at(&self, lookups: &Lookups, [b, c]: [f32; 2]) -> Vec3 {
        let [first, second, third] = self.uvs;
        let uv = first + (second - first) * b + (third - first) * c;
        // As sharp as the map is, so that light that is drawn and light that is met are the same.
        let here = self.map.texture().map_or(Vec3::ONE, |map| map.sharp(lookups, uv * self.scale).truncate());
        self.brightest * here
    }
}

impl<T: Map> Emitters<'_, T> {
    /// A point on some triangle for a surface at `from` that is lit from the side of `normal` (both if it is 0), given its cut
    /// of the tree; `None` where no triangle shines on it.
    #[inline]
    pub fn draw(&self, lookups: &Lookups, cut: &Cut, from: Vec3, normal: Vec3, u: [f32; 3]) -> Option<EmitterPoint> {
        let weight = |index: u32| self.triangles[index as usize].weight(from);
        let (index, probability) = self.tree.draw(cut, from, normal, u[0], weight)?;
        let emitter = &self.triangles[index as usize];
        let at = barycentric([u[1], u[2]]);
        let point = emitter.point(at);
        let mut radiance = emitter.radiance;
        if emitter.pattern != NONE {
            radiance = self.patterns[emitter.pattern as usize].at(lookups, at);
        }
        if emitter.aim != NONE {
            radiance *= self.tree.beams.aimed(&self.tree.aims[emitter.aim as usize], from - point);
        }
        Some(EmitterPoint { point, radiance, pdf: probability * emitter.density(from, point) })
    }

    /// Density over solid angle, seen from `from`, with which that point of a triangle is drawn; 0 where it never is.
    #[inline]
    pub fn pdf(&self, key: [u32; 2], from: Vec3, normal: Vec3, point: Vec3) -> f32 {
        let Ok(index) = self.triangles.binary_search_by_key(&key, |e| e.key) else { return 0.0 };
        let weight = |index: u32| self.triangles[index as usize].weight(from);
        let probability = self.tree.probability(index as u32, from, normal, weight);
        if probability > 0.0 { probability * self.triangles[index].density(from, point) } else { 0.0 }
    }
}

impl Emitter {
    /// Its middle.
    #[inline]
    pub fn centre(&self) -> Vec3 {
        self.corner + (self.edges[0] + self.edges[1]) / 3.0
    }

    /// At coordinates along both edges.
    #[inline]
    pub fn point(&self, [b, c]: [f32; 2]) -> Vec3 {
        self.corner + self.edges[0] * b + self.edges[1] * c
    }

    /// What it gives to a place beside others with its beam, roughly; 0 exactly where that is behind it.
    #[inline(always)]
    pub fn weight(&self, from: Vec3) -> f32 {
        let to_place = from - self.centre();
        // Near a triangle its own size counts, not the distance to its middle.
        let square = to_place.length_squared().max(0.25 * sqrt(self.cross.length_squared()));
        self.brightness * self.cross.dot(to_place).max(0.0) / (square * sqrt(square))
    }

    /// Density over solid angle of a point that is drawn evenly from the triangle.
    #[inline(always)]
    pub fn density(&self, from: Vec3, point: Vec3) -> f32 {
        let to_light = point - from;
        let square = to_light.length_squared();
        // d² / (area · |cos|), with area · cos = |cross · to_light| / 2d.
        2.0 * square * sqrt(square) / self.cross.dot(to_light).abs()
    }
}
