//! A building under construction: walls of whole bays and storeys, roofs, and what stands out of them.

use std::ops::Range;

use glam::{Mat3, Quat, Vec2, Vec3, vec2, vec3};
use trove_model::{Asset, Class, Kind, Material, Surface};

use crate::shape::{Model, Shape};

/// Walls go up on it.
pub(super) struct Site<'a> {
    surfaces: &'a [Surface],
    model: Model,
    /// Names of materials that have a slot.
    slots: Vec<(String, u16)>,
}

/// A rectangle about the origin, counter-clockwise from its low corner.
pub(super) fn rectangle(size_m: Vec2) -> Vec<Vec2> {
    let half = size_m / 2.0;
    vec![-half, vec2(half.x, -half.y), half, vec2(-half.x, half.y)]
}

/// An outline's edges with their outward normals.
fn edges(outline: &[Vec2]) -> impl Iterator<Item = (Vec2, Vec2, Vec2)> + '_ {
    (0..outline.len()).map(|i| {
        let (a, b) = (outline[i], outline[(i + 1) % outline.len()]);
        (a, b, -(b - a).perp().normalize_or(Vec2::X))
    })
}

impl<'a> Site<'a> {
    pub(super) fn new(surfaces: &'a [Surface]) -> Self {
        Self { surfaces, model: Model::default(), slots: Vec::new() }
    }

    pub(super) fn asset(self, id: &str) -> Asset {
        self.model.asset(id, Kind::Building, Class::Building)
    }

    /// The slot of a material; the same name is the same slot.
    pub(super) fn plain(&mut self, material: Material) -> u16 {
        if let Some((_, slot)) = self.slots.iter().find(|s| s.0 == material.name) {
            return *slot;
        }
        let name = material.name.clone();
        let slot = self.model.slot(material, &[]);
        self.slots.push((name, slot));
        slot
    }

    /// The slot of a surface of the library, or of a material of that name.
    pub(super) fn surface(&mut self, id: &str) -> u16 {
        if let Some((_, slot)) = self.slots.iter().find(|s| s.0 == id) {
            return *slot;
        }
        let found = self.surfaces.iter().find(|s| s.id == id);
        self.plain(found.map_or_else(|| Material::plain(id, Vec3::splat(0.3), 0.8), |s| s.material.clone()))
    }

    pub(super) fn add(&mut self, slot: u16, shape: Shape) {
        self.model.add(slot, shape);
    }

    /// A box by its middle and size.
    pub(super) fn block(&mut self, slot: u16, middle: Vec3, size: Vec3) {
        self.add(slot, Shape::block(size).moved(middle));
    }

    /// Walls around an outline, an edge each from `ids` in turn; every wall shows whole bays and whole storeys.
    pub(super) fn walls(&mut self, outline: &[Vec2], z: Range<f32>, ids: &[&str]) {
        for (i, (a, b, _)) in edges(outline).enumerate() {
            let id = ids[i % ids.len()];
            let slot = self.surface(id);
            let surface = self.surfaces.iter().find(|s| s.id == id);
            let (cell, cells) = surface.map_or((vec2(3.0, 3.0), [1, 1]), |s| {
                (vec2(s.size_m[0] / s.cells[0] as f32, s.size_m[1] / s.cells[1] as f32), s.cells)
            });
            let count = (vec2(a.distance(b), z.end - z.start) / cell).round().max(Vec2::ONE);
            // Opposite walls show other parts of the texture.
            let low = cell * vec2((i as u32 * 3 % cells[0]) as f32, 0.0);
            let high = low + cell * count;
            self.add(slot, wall([a, b], &z, low, high));
        }
    }

    /// A wall around an outline without openings, uvs in metres.
    pub(super) fn blank_walls(&mut self, slot: u16, outline: &[Vec2], z: Range<f32>) {
        for (a, b, _) in edges(outline) {
            self.add(slot, wall([a, b], &z, Vec2::ZERO, vec2(a.distance(b), z.end - z.start)));
        }
    }

    /// A moulding along every edge that stands out by `out_m` and reaches `in_m` inwards, mitred at the corners.
    pub(super) fn band(&mut self, slot: u16, outline: &[Vec2], z: Range<f32>, out_m: f32, in_m: f32) {
        let normals: Vec<Vec2> = edges(outline).map(|(_, _, out)| out).collect();
        let moved = |i: usize, by_m: f32| {
            let (before, after) = (normals[(i + normals.len() - 1) % normals.len()], normals[i]);
            outline[i] + (before + after) / (1.0 + before.dot(after)).max(0.2) * by_m
        };
        for i in 0..outline.len() {
            let j = (i + 1) % outline.len();
            let [a, b, c, d] = [moved(i, out_m), moved(j, out_m), moved(j, -in_m), moved(i, -in_m)];
            let (low, high) = (|p: Vec2| p.extend(z.start), |p: Vec2| p.extend(z.end));
            self.add(slot, slope(&[low(a), low(b), high(b), high(a)]));
            self.add(slot, slope(&[low(c), low(d), high(d), high(c)]));
            self.add(slot, slope(&[high(a), high(b), high(c), high(d)]));
            self.add(slot, slope(&[low(d), low(c), low(b), low(a)]));
        }
    }

    /// A flat roof behind a parapet with a coping.
    pub(super) fn flat_roof(&mut self, outline: &[Vec2], z_m: f32, parapet_m: f32, covering: &str, coping: u16) {
        let cover = self.surface(covering);
        self.add(cover, Shape::flat(outline).moved(Vec3::Z * z_m));
        self.band(coping, outline, z_m..z_m + parapet_m, 0.0, 0.3);
        self.band(coping, outline, z_m + parapet_m..z_m + parapet_m + 0.08, 0.06, 0.36);
    }

    /// A roof with its ridge along x over a rectangle, with eaves; `hip_m` pulls the ridge's ends in (0: gables).
    pub(super) fn pitched_roof(&mut self, tiles: &str, gable: u16, size: Vec2, z_m: f32, rise_m: f32, hip_m: f32) {
        let tiles = self.surface(tiles);
        let eaves = if hip_m > 0.0 { vec2(0.45, 0.45) } else { vec2(0.2, 0.4) };
        let half = size / 2.0;
        let out = half + eaves;
        // Eaves lie lower, along the slope.
        let low = z_m - rise_m * eaves.y / half.y;
        let ridge = if hip_m > 0.0 { half.x - hip_m } else { out.x };
        let top = z_m + rise_m;
        for side in [-1.0f32, 1.0] {
            let corner = |x: f32| vec3(x * side, -out.y * side, low);
            let end = |x: f32| vec3(x * side, 0.0, top);
            self.roof_plane(tiles, gable, &[corner(-out.x), corner(out.x), end(ridge), end(-ridge)]);
            if hip_m > 0.0 {
                let foot = |y: f32| vec3(out.x * side, y * out.y * side, low);
                self.roof_plane(tiles, gable, &[foot(-1.0), foot(1.0), end(ridge)]);
            } else {
                let at = |y: f32, z: f32| vec3(half.x * side, y * half.y * side, z);
                self.add(gable, slope(&[at(-1.0, z_m), at(1.0, z_m), at(0.0, top)]));
            }
        }
    }

    /// One sloping plane with its underside and its edges, counter-clockwise from above.
    fn roof_plane(&mut self, tiles: u16, under: u16, corners: &[Vec3]) {
        let thick = Vec3::Z * 0.12;
        self.add(tiles, slope(corners));
        let below: Vec<Vec3> = corners.iter().rev().map(|&c| c - thick).collect();
        self.add(under, slope(&below));
        for (i, &a) in corners.iter().enumerate() {
            let b = corners[(i + 1) % corners.len()];
            self.add(under, slope(&[a - thick, b - thick, b, a]));
        }
    }

    /// A slab with a balustrade of glass and a rail, hung on the wall between two points, `deep_m` deep.
    pub(super) fn balcony(&mut self, wall: [Vec2; 2], floor_m: f32, deep_m: f32, slab: u16) {
        let [a, b] = wall;
        let out = -(b - a).perp().normalize_or(Vec2::X);
        let turn = Quat::from_rotation_z((b - a).to_angle());
        let middle = (a + b) / 2.0 + out * deep_m / 2.0;
        let width = a.distance(b);
        let at = |along: f32, outwards: f32, z: f32| {
            let p = middle + (b - a).normalize_or(Vec2::X) * along + out * outwards;
            p.extend(floor_m + z)
        };
        let glass = self
            .plain(Material { transmission: 0.75, ..Material::plain("balustrade glass", vec3(0.62, 0.7, 0.68), 0.05) });
        let rail = self.plain(Material { metalness: 0.8, ..Material::plain("rail", vec3(0.35, 0.36, 0.37), 0.4) });
        let mut put = |slot: u16, size: Vec3, place: Vec3| self.add(slot, Shape::block(size).turned(turn).moved(place));
        put(slab, vec3(width, deep_m, 0.18), at(0.0, 0.0, -0.09));
        put(glass, vec3(width - 0.06, 0.015, 0.95), at(0.0, deep_m / 2.0 - 0.05, 0.5));
        put(rail, vec3(width, 0.05, 0.05), at(0.0, deep_m / 2.0 - 0.05, 1.03));
        for side in [-1.0, 1.0] {
            put(glass, vec3(0.015, deep_m - 0.08, 0.95), at(side * (width / 2.0 - 0.05), 0.0, 0.5));
            put(rail, vec3(0.05, deep_m, 0.05), at(side * (width / 2.0 - 0.05), 0.0, 1.03));
        }
    }

    /// Machines and a stair head on a flat roof that lies within `half` of the middle.
    pub(super) fn roof_plant(&mut self, half: Vec2, z_m: f32) {
        let concrete = self.surface("concrete/plain");
        let metal = self.plain(Material::plain("roof plant", vec3(0.4, 0.41, 0.41), 0.5));
        let dark = self.plain(Material::plain("roof fan", Vec3::splat(0.05), 0.6));
        self.block(concrete, vec3(half.x * 0.45, half.y * 0.2, z_m + 1.35), vec3(4.2, 3.4, 2.7));
        for i in 0..4 {
            let x = -half.x * 0.6 + i as f32 * 2.3;
            self.block(metal, vec3(x, -half.y * 0.3, z_m + 0.75), vec3(1.7, 1.5, 1.2));
            self.add(dark, Shape::cylinder(0.5, 0.08, 16).moved(vec3(x, -half.y * 0.3, z_m + 1.34)));
        }
        self.block(metal, vec3(-half.x * 0.2, half.y * 0.35, z_m + 0.6), vec3(half.x * 0.7, 0.5, 0.45));
        for i in 0..3 {
            let at = vec3(half.x * (0.1 * i as f32 - 0.7), half.y * 0.55, z_m);
            self.add(metal, Shape::cylinder(0.16, 1.1, 12).moved(at));
        }
    }

    /// A roof over an entrance.
    pub(super) fn canopy(&mut self, slot: u16, middle: Vec3, size: Vec3) {
        self.block(slot, middle, size);
        for x in [-0.4, 0.4] {
            let from = middle + vec3(x * size.x, -size.y * 0.4, size.z / 2.0);
            let to = middle + vec3(x * size.x, size.y * 0.5, 1.2);
            self.add(slot, Shape::tube(&[from, to], 0.025, 6));
        }
    }
}

/// An upright rectangle over an edge, with the texture's corners.
fn wall([a, b]: [Vec2; 2], z: &Range<f32>, low: Vec2, high: Vec2) -> Shape {
    let normal = -(b - a).perp().normalize_or(Vec2::X);
    Shape {
        positions: vec![a.extend(z.start), b.extend(z.start), b.extend(z.end), a.extend(z.end)],
        normals: vec![normal.extend(0.0); 4],
        uvs: vec![low, vec2(high.x, low.y), high, vec2(low.x, high.y)],
        triangles: vec![[0, 1, 2], [0, 2, 3]],
        slots: vec![0, 0],
    }
}

/// A flat polygon in space, counter-clockwise from outside; u runs along its first edge, in metres.
fn slope(corners: &[Vec3]) -> Shape {
    let along = (corners[1] - corners[0]).normalize_or(Vec3::X);
    let normal = along.cross(corners[2] - corners[0]).normalize_or(Vec3::Z);
    let frame = Mat3::from_cols(along, normal.cross(along), normal);
    let flat: Vec<Vec2> = corners.iter().map(|&c| (frame.transpose() * (c - corners[0])).truncate()).collect();
    Shape::flat(&flat).turned(Quat::from_mat3(&frame)).moved(corners[0])
}
