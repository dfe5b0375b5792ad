//! What hangs on a wall or stands on a roof, in the axes of its place.

use glam::{Quat, Vec2, Vec3, vec2, vec3};
use trove_model::{Material, Role};

use super::finish;
use super::parts::{Rail, ShapePlan};
use super::site::Site;
use crate::shape::Shape;

/// A place: x runs along its wall to the right, seen from outside; y into the wall; z up.
#[derive(Clone, Copy, Debug)]
pub(super) struct Spot {
    pub(super) at: Vec3,
    pub(super) turn: Quat,
}

impl Spot {
    fn add(self, site: &mut Site<'_>, slot: u16, shape: Shape) {
        site.add(slot, shape.turned(self.turn).moved(self.at));
    }

    /// A box that reaches from x, z by its size, its back at `y`.
    fn block(self, site: &mut Site<'_>, slot: u16, foot: Vec3, size: Vec3) {
        self.add(site, slot, Shape::block(size).moved(foot + vec3(0.0, -size.y, size.z) / 2.0));
    }

    /// A place beside this one.
    fn beside(self, by: Vec3, turn_rad: f32) -> Self {
        Self { at: self.at + self.turn * by, turn: self.turn * Quat::from_rotation_z(turn_rad) }
    }

    /// Builds a shape of a plan; `tiles` cover it where it has a roof.
    pub(super) fn build(self, site: &mut Site<'_>, slot: u16, tiles: u16, shape: &ShapePlan) {
        match *shape {
            ShapePlan::Block { size } => self.block(site, slot, Vec3::ZERO, size.into()),
            ShapePlan::Window { size, panes } => self.window(site, slot, size.into(), panes),
            ShapePlan::Balcony { size, rail } => self.balcony(site, slot, size.into(), rail),
            ShapePlan::Railing { size } => self.railing(site, slot, size.into()),
            ShapePlan::Awning { size } => self.awning(site, slot, size.into()),
            ShapePlan::Canopy { size } => self.canopy(site, slot, size.into()),
            ShapePlan::Oriel { size } => self.oriel(site, slot, size.into()),
            ShapePlan::Dormer { size, rise, .. } => self.dormer(site, slot, tiles, size.into(), rise),
            ShapePlan::Gable { size: [wide, deep, high] } => {
                self.add(site, slot, prism(&[vec2(-wide / 2.0, 0.0), vec2(wide / 2.0, 0.0), vec2(0.0, high)], deep));
            }
            ShapePlan::Chimney { size, pots } => self.chimney(site, slot, size.into(), pots),
            ShapePlan::Column { radius, height } => self.add(site, slot, Shape::cylinder(radius, height, 16)),
            ShapePlan::Pipe { height } => self.block(site, slot, Vec3::ZERO, vec3(0.1, 0.1, height)),
            ShapePlan::Sign { size, cell } => self.sign(site, slot, size.into(), cell),
            ShapePlan::Ramp { size } => self.ramp(site, slot, size.into()),
            ShapePlan::Steps { wide, count } => {
                for i in 0..count {
                    let size = vec3(wide, 0.3 * (count - i) as f32, 0.16);
                    self.block(site, slot, Vec3::Z * 0.16 * i as f32, size);
                }
            }
            ShapePlan::Plant { size } => self.plant(site, slot, size.into()),
        }
    }

    fn window(self, site: &mut Site<'_>, frame: u16, size: Vec2, panes: [u32; 2]) {
        let glass = finish::common(site, "glass");
        let bar = 0.07;
        self.block(site, glass, vec3(0.0, 0.02, bar / 2.0), vec3(size.x - bar, 0.05, size.y - bar));
        for i in 0..=panes[0] {
            let x = (size.x - bar) * (i as f32 / panes[0] as f32 - 0.5);
            self.block(site, frame, vec3(x, 0.02, 0.0), vec3(bar, 0.1, size.y));
        }
        // Bars across lie behind the upright ones by a hair, so that no faces share a plane.
        for i in 0..=panes[1] {
            let z = (size.y - bar) * i as f32 / panes[1] as f32;
            self.block(site, frame, vec3(0.0, 0.02, z + 0.002), vec3(size.x - 0.004, 0.095, bar - 0.004));
        }
    }

    fn balcony(self, site: &mut Site<'_>, slab: u16, size: Vec2, rail: Rail) {
        match rail {
            Rail::Glass => {
                let end = |x: f32| (self.at + self.turn * vec3(x, 0.0, 0.0)).truncate();
                site.balcony([end(-size.x / 2.0), end(size.x / 2.0)], self.at.z, size.y, slab);
            }
            Rail::Bars => {
                self.block(site, slab, vec3(0.0, 0.0, -0.16), vec3(size.x, size.y, 0.16));
                let dark = finish::common(site, "dark");
                self.beside(vec3(0.0, 0.05 - size.y, 0.0), 0.0).railing(site, dark, vec2(size.x - 0.06, 1.02));
                for side in [-1.0f32, 1.0] {
                    let at = vec3(side * (size.x / 2.0 - 0.05), -size.y / 2.0, 0.0);
                    let ends = self.beside(at, side * std::f32::consts::FRAC_PI_2);
                    ends.railing(site, dark, vec2(size.y - 0.16, 1.02));
                }
            }
            Rail::Solid => {
                self.block(site, slab, vec3(0.0, 0.0, -0.18), vec3(size.x, size.y, 0.18));
                let front = vec3(size.x, 0.1, 1.0);
                self.block(site, slab, vec3(0.0, 0.1 - size.y, 0.0), front);
                for side in [-1.0, 1.0] {
                    let at = vec3(side * (size.x / 2.0 - 0.05), 0.0, 0.0);
                    self.block(site, slab, at, vec3(0.1, size.y - 0.1, 1.0));
                }
            }
        }
    }

    /// Uprights under a handrail.
    fn railing(self, site: &mut Site<'_>, slot: u16, size: Vec2) {
        self.block(site, slot, vec3(0.0, 0.025, size.y - 0.05), vec3(size.x, 0.05, 0.05));
        self.block(site, slot, vec3(0.0, 0.015, 0.08), vec3(size.x, 0.03, 0.03));
        let count = (size.x / 0.16).ceil().max(1.0) as u32;
        for i in 0..=count {
            let x = (size.x - 0.03) * (i as f32 / count as f32 - 0.5);
            self.block(site, slot, vec3(x, 0.0125, 0.0), vec3(0.025, 0.025, size.y - 0.04));
        }
    }

    /// Cloth that slopes from the wall, with a hem.
    fn awning(self, site: &mut Site<'_>, cloth: u16, size: Vec2) {
        let row = |out: f32, z: f32| vec![vec3(-size.x / 2.0, -out, z), vec3(size.x / 2.0, -out, z)];
        let sheet = Shape::sheet(&[row(size.y, -0.7), row(size.y, -0.45), row(0.05, 0.0)]);
        let cloth = site.slot_for(Role::Awning, cloth);
        self.add(site, cloth, sheet.plate(0.02));
    }

    fn canopy(self, site: &mut Site<'_>, slot: u16, size: Vec3) {
        self.block(site, slot, vec3(0.0, 0.05, 0.0), size);
        let metal = finish::common(site, "metal");
        for x in [-0.4, 0.4] {
            let from = vec3(x * size.x, -size.y * 0.9, size.z);
            self.add(site, metal, Shape::tube(&[from, vec3(x * size.x, 0.0, size.z + 1.1)], 0.025, 6));
        }
    }

    fn oriel(self, site: &mut Site<'_>, slot: u16, size: Vec3) {
        let frame = finish::common(site, "white wood");
        let lead = finish::common(site, "lead");
        let slant = size.y.min(size.x * 0.3);
        let plan = |by: f32| {
            let (wide, deep) = (size.x / 2.0 + by, size.y + by);
            [vec2(-wide + slant, -deep), vec2(wide - slant, -deep), vec2(wide, 0.1), vec2(-wide, 0.1)]
        };
        self.add(site, slot, Shape::extruded(&plan(0.0), size.z));
        self.add(site, lead, Shape::extruded(&plan(0.08), 0.1).moved(Vec3::Z * (size.z - 0.02)));
        let (sill, high) = (size.z * 0.28, size.z * 0.58);
        let front = self.beside(vec3(0.0, -size.y, sill), 0.0);
        front.window(site, frame, vec2(size.x - 2.0 * slant - 0.16, high), [2, 2]);
        let face = vec2(slant, size.y + 0.1);
        for side in [-1.0f32, 1.0] {
            let middle = vec3(side * (size.x / 2.0 - slant / 2.0), 0.05 - size.y / 2.0, sill);
            let turned = self.beside(middle, side * face.y.atan2(face.x));
            turned.window(site, frame, vec2(face.length() - 0.2, high), [1, 2]);
        }
    }

    fn dormer(self, site: &mut Site<'_>, slot: u16, tiles: u16, size: Vec3, rise: f32) {
        let frame = finish::common(site, "white wood");
        self.beside(vec3(0.0, size.y, 0.0), 0.0).block(site, slot, Vec3::ZERO, size);
        let window = self.beside(vec3(0.0, 0.0, 0.15), 0.0);
        window.window(site, frame, vec2(size.x - 0.3, size.z - 0.3), [2, 2]);
        let lid = vec2(size.x / 2.0 + 0.12, size.y + 0.12);
        if rise <= 0.0 {
            let at = vec3(0.0, size.y, size.z);
            self.block(site, tiles, at, vec3(2.0 * lid.x, lid.y + 0.05, 0.1));
            return;
        }
        self.add(
            site,
            slot,
            prism(&[vec2(-lid.x, 0.0), vec2(lid.x, 0.0), vec2(0.0, rise)], size.y).moved(vec3(0.0, size.y, size.z)),
        );
        for side in [-1.0f32, 1.0] {
            let foot = |y: f32| vec3(side * (lid.x + 0.03), y, size.z + 0.06);
            let ridge = |y: f32| vec3(0.0, y, size.z + rise + 0.1);
            let (out, back) = (-0.12, size.y);
            let face = if side > 0.0 {
                [foot(out), foot(back), ridge(back), ridge(out)]
            } else {
                [foot(back), foot(out), ridge(out), ridge(back)]
            };
            site.roof_plane(tiles, tiles, &face.map(|corner| self.at + self.turn * corner));
        }
    }

    fn chimney(self, site: &mut Site<'_>, slot: u16, size: Vec3, pots: u32) {
        let clay = site.plain(Material::plain("chimney pot", vec3(0.28, 0.12, 0.07), 0.8));
        self.block(site, slot, vec3(0.0, size.y / 2.0, 0.0), size);
        self.block(site, slot, vec3(0.0, size.y / 2.0 + 0.06, size.z - 0.1), vec3(size.x + 0.12, size.y + 0.12, 0.14));
        for i in 0..pots {
            let y = size.y * ((i as f32 + 0.5) / pots as f32 - 0.5);
            self.add(site, clay, Shape::cylinder(0.11, 0.4, 10).moved(vec3(0.0, y, size.z)));
        }
    }

    fn sign(self, site: &mut Site<'_>, board: u16, size: Vec2, cell: u32) {
        self.block(site, board, vec3(0.0, 0.02, 0.0), vec3(size.x, 0.14, size.y));
        let (low, high) = (vec3(0.06 - size.x / 2.0, -0.13, 0.05), vec3(size.x / 2.0 - 0.06, -0.13, size.y - 0.05));
        let (slot, uvs) = site.cell("sign/shops", cell);
        let face = Shape {
            positions: vec![low, vec3(high.x, low.y, low.z), high, vec3(low.x, low.y, high.z)],
            normals: vec![-Vec3::Y; 4],
            uvs: uvs.to_vec(),
            triangles: vec![[0, 1, 2], [0, 2, 3]],
            slots: vec![0, 0],
        };
        let slot = site.slot_for(Role::ShopSign, slot);
        self.add(site, slot, face);
    }

    fn ramp(self, site: &mut Site<'_>, slot: u16, size: Vec3) {
        // Thin at its foot, so that nothing lies below the floor.
        let half = size.x / 2.0;
        let polygon = [vec2(-half, 0.0), vec2(half, size.z - 0.25), vec2(half, size.z)];
        self.add(site, slot, prism(&polygon, size.y));
    }

    fn plant(self, site: &mut Site<'_>, housing: u16, size: Vec2) {
        let metal = finish::common(site, "metal");
        let dark = finish::common(site, "dark");
        let house = vec3((size.x * 0.3).min(4.2), (size.y * 0.7).min(3.6), 2.7);
        self.block(site, housing, vec3((size.x - house.x) / 2.0, house.y / 2.0, 0.0), house);
        let coping = vec3(house.x + 0.16, house.y + 0.16, 0.12);
        self.block(site, housing, vec3((size.x - house.x) / 2.0, coping.y / 2.0, house.z - 0.02), coping);
        let room = size.x - house.x - 0.6;
        let count = (room / 2.3).floor().clamp(0.0, 5.0) as u32;
        for i in 0..count {
            let foot = vec3(1.15 + 2.3 * i as f32 - size.x / 2.0, -size.y * 0.2, 0.15);
            self.block(site, metal, foot, vec3(1.7, 1.5, 1.2));
            self.block(site, dark, foot - vec3(0.0, 0.2, 0.25), vec3(1.5, 1.1, 0.3));
            self.add(site, dark, Shape::cylinder(0.5, 0.08, 12).moved(foot + vec3(0.0, -0.75, 1.2)));
        }
        self.block(site, metal, vec3(-house.x / 2.0, size.y * 0.2, 0.35), vec3(room * 0.8, 0.5, 0.45));
        for i in 0..2 {
            let at = vec3(0.5 + 0.7 * i as f32 - size.x / 2.0, size.y * 0.38, 0.0);
            self.add(site, metal, Shape::cylinder(0.16, 1.1, 10).moved(at));
        }
    }
}

/// A polygon in x and z, counter-clockwise seen from the front, made thick outwards.
fn prism(polygon: &[Vec2], deep_m: f32) -> Shape {
    Shape::extruded(polygon, deep_m).turned(Quat::from_rotation_x(std::f32::consts::FRAC_PI_2)).smooth(0.1)
}
