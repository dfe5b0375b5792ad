//! A building under construction: walls of whole bays and storeys, roofs, and what stands out of them.

use std::ops::Range;

use glam::{Mat3, Quat, Vec2, Vec3, vec2, vec3};
use trove_model::{Asset, Class, Kind, Material, Role, Surface};

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

    /// Where the asset's origin will be, seen from above.
    pub(super) fn middle(&self) -> Vec2 {
        self.model.middle()
    }

    pub(super) fn asset(self, id: &str) -> Asset {
        self.model.asset(id, Kind::Building, Class::Building)
    }

    /// The slot of a material; the same name is the same slot.
    pub(super) fn plain(&mut self, material: Material) -> u16 {
        self.painted(material, &[])
    }

    /// The same in one of some colours.
    pub(super) fn painted(&mut self, material: Material, colors: &[Vec3]) -> u16 {
        self.once(material.name.clone(), |model| model.slot(material, colors))
    }

    /// A slot like another one, with a role.
    pub(super) fn slot_for(&mut self, role: Role, like: u16) -> u16 {
        self.once(format!("{} of slot {like}", role.name()), |model| model.slot_for(role, like))
    }

    /// The slot of a name, which is added where there is none yet.
    fn once(&mut self, name: String, add: impl FnOnce(&mut Model) -> u16) -> u16 {
        if let Some((_, slot)) = self.slots.iter().find(|s| s.0 == name) {
            return *slot;
        }
        let slot = add(&mut self.model);
        self.slots.push((name, slot));
        slot
    }

    /// The slot of a surface of the library, or of a material of that name.
    pub(super) fn surface(&mut self, id: &str) -> u16 {
        if let Some((_, slot)) = self.slots.iter().find(|s| s.0 == id) {
            return *slot;
        }
        let material = self.material(id);
        self.plain(material)
    }

    /// A surface's material, or a plain one of that name.
    pub(super) fn material(&self, id: &str) -> Material {
        let found = self.surfaces.iter().find(|s| s.id == id);
        found.map_or_else(|| Material::plain(id, Vec3::splat(0.3), 0.8), |s| s.material.clone())
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
        let walls: Vec<(u16, &str)> = ids.iter().map(|id| (self.surface(id), *id)).collect();
        self.walls_of(outline, z, &walls);
    }

    /// The same with the slots of the surfaces.
    pub(super) fn walls_of(&mut self, outline: &[Vec2], z: Range<f32>, walls: &[(u16, &str)]) {
        for (i, (a, b, _)) in edges(outline).enumerate() {
            let (slot, id) = walls[i % walls.len()];
            let surface = self.surfaces.iter().find(|s| s.id == id);
            let (cell, cells) = surface.map_or((vec2(3.0, 3.0), [1, 1]), cell);
            let count = (vec2(a.distance(b), z.end - z.start) / cell).round().max(Vec2::ONE);
            // Opposite walls show other parts of the texture.
            let low = cell * vec2((i as u32 * 3 % cells[0]) as f32, 0.0);
            let high = low + cell * count;
            self.add(slot, wall([a, b], &z, low, high));
        }
    }

    /// The slot of a surface, and the corners of one of its cells counted in rows from below.
    pub(super) fn cell(&mut self, id: &str, number: u32) -> (u16, [Vec2; 4]) {
        let (size, cells) = self.surfaces.iter().find(|s| s.id == id).map_or((Vec2::ONE, [1, 1]), cell);
        let low = size * vec2((number % cells[0]) as f32, (number / cells[0] % cells[1]) as f32);
        let high = low + size;
        (self.surface(id), [low, vec2(high.x, low.y), high, vec2(low.x, high.y)])
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
}

/// Size and numbers of a surface's cells.
fn cell(surface: &Surface) -> (Vec2, [u32; 2]) {
    let [across, up] = surface.cells;
    (vec2(surface.size_m[0] / across as f32, surface.size_m[1] / up as f32), surface.cells)
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
pub(super) fn slope(corners: &[Vec3]) -> Shape {
    let along = (corners[1] - corners[0]).normalize_or(Vec3::X);
    let normal = along.cross(corners[2] - corners[0]).normalize_or(Vec3::Z);
    let frame = Mat3::from_cols(along, normal.cross(along), normal);
    let flat: Vec<Vec2> = corners.iter().map(|&c| (frame.transpose() * (c - corners[0])).truncate()).collect();
    Shape::flat(&flat).turned(Quat::from_mat3(&frame)).moved(corners[0])
}
