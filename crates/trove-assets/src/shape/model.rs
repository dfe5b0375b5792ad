//! Shapes and their materials put together into an asset.

use std::sync::Arc;

use glam::{Vec2, Vec3, vec3};
use trove_model::{Asset, Class, Extra, Keypoints, Kind, Material, Mesh, Role, Slot};

use super::{Prism, Shape};

/// What a place on a slot's surface is tinted, by the slot and the position above the asset's foot.
type Tint = Box<dyn Fn(u16, Vec3) -> Vec3>;

/// An asset under construction.
#[derive(Default)]
pub(crate) struct Model {
    shape: Shape,
    slots: Vec<Slot>,
    extras: Vec<(Extra, Shape)>,
    tint: Option<Tint>,
    keypoints: Option<Keypoints<Vec3>>,
}

impl Model {
    /// A slot with a material; `paints` are the base colours that it is seen in, a colour as often as it is common.
    pub(crate) fn slot(&mut self, material: Material, paints: &[Vec3]) -> u16 {
        self.slots.push(Slot::new(material, paints.to_vec()));
        self.slots.len() as u16 - 1
    }

    /// The slots so far, in the order of their numbers.
    pub(crate) fn slots(&mut self) -> &mut [Slot] {
        &mut self.slots
    }

    /// A slot like another one, with a role.
    pub(crate) fn slot_for(&mut self, role: Role, like: u16) -> u16 {
        let mut slot = self.slots[usize::from(like)].clone();
        slot.material.role = Some(role);
        self.slots.push(slot);
        self.slots.len() as u16 - 1
    }

    /// Says whether a slot's paints are drawn by what colours cars have where it stands.
    pub(crate) fn paint_by_region(&mut self, slot: u16, by_region: bool) {
        self.slots[usize::from(slot)].by_region = by_region;
    }

    /// Adds a shape, all of it in one slot.
    pub(crate) fn add(&mut self, slot: u16, shape: Shape) {
        self.add_marked(shape.slot(slot));
    }

    /// Adds a shape that knows its slots.
    pub(crate) fn add_marked(&mut self, shape: Shape) {
        self.shape = std::mem::take(&mut self.shape).and(shape);
    }

    /// Says where the points of the person are whom it shows.
    pub(crate) fn shows(&mut self, keypoints: Keypoints<Vec3>) {
        self.keypoints = Some(keypoints);
    }

    /// What it is so far, without extras.
    pub(crate) fn shape(&self) -> &Shape {
        &self.shape
    }

    /// Moves all that is there already.
    pub(crate) fn shift(&mut self, by: Vec3) {
        self.shape = std::mem::take(&mut self.shape).moved(by);
        self.extras.iter_mut().for_each(|(_, shape)| *shape = std::mem::take(shape).moved(by));
        self.keypoints = self.keypoints.map(|points| points.map(|p| p + by));
    }

    /// Makes all that is there larger or smaller.
    pub(crate) fn scale(&mut self, by: f32) {
        let by = Vec3::splat(by);
        self.shape = std::mem::take(&mut self.shape).scaled(by);
        self.extras.iter_mut().for_each(|(_, shape)| *shape = std::mem::take(shape).scaled(by));
        self.keypoints = self.keypoints.map(|points| points.map(|p| p * by));
    }

    /// Adds what some variations have; its shape knows its slots, and [`Extra::mesh`] is taken from it.
    pub(crate) fn add_extra(&mut self, group: &str, share: f32, when_driven: bool, shape: Shape) {
        let extra = Extra { group: group.into(), share, when_driven, mesh: Arc::default() };
        self.extras.push((extra, shape));
    }

    /// What is in slot `from` inside a prism goes to slot `to`.
    pub(crate) fn mark(&mut self, prism: &Prism, from: u16, to: u16) {
        let (chosen, other) = std::mem::take(&mut self.shape).split_slot(from);
        self.shape = other.and(chosen.mark(prism, to));
    }

    /// `mark` on both sides of y = 0.
    pub(crate) fn mark_both(&mut self, prism: &Prism, from: u16, to: u16) {
        self.mark(prism, from, to);
        self.mark(&prism.mirrored(), from, to);
    }

    /// Tints the vertices of the finished meshes: rust at the foot, soot below an edge.
    pub(crate) fn tint(&mut self, tint: impl Fn(u16, Vec3) -> Vec3 + 'static) {
        self.tint = Some(Box::new(tint));
    }

    /// Where the origin of its asset will be, seen from above: the middle of what has been built so far.
    pub(crate) fn middle(&self) -> Vec2 {
        let places = || self.shape.positions.iter().map(|p| p.truncate());
        let (low, high) = (places().fold(Vec2::MAX, Vec2::min), places().fold(Vec2::MIN, Vec2::max));
        (low + high) / 2.0
    }

    /// The asset: slots without triangles go, the origin comes to the ground, and but for what stands on a pole to the
    /// middle of the bounds.
    pub(crate) fn asset(self, id: &str, kind: Kind, class: Class) -> Asset {
        let (extras, shapes): (Vec<Extra>, Vec<Shape>) = self.extras.into_iter().unzip();
        let mut meshes: Vec<Mesh> = std::iter::once(self.shape).chain(shapes).map(Shape::into_mesh).collect();
        let (low, high) = meshes[0].bounds().unwrap_or_default();
        let middle = if kind.is_on_pole() { Vec3::ZERO } else { (low + high) / 2.0 };
        let origin = vec3(middle.x, middle.y, low.z);

        let mut used = vec![false; self.slots.len()];
        meshes.iter().flat_map(|mesh| &mesh.slots).for_each(|s| used[usize::from(*s)] = true);
        let number = |s: u16| used[..usize::from(s)].iter().filter(|u| **u).count() as u16;
        for mesh in &mut meshes {
            mesh.positions.iter_mut().for_each(|p| *p -= origin);
            if let Some(tint) = &self.tint {
                mesh.tints = vec![Vec3::ONE; mesh.positions.len()];
                for (t, slot) in mesh.triangles.iter().zip(&mesh.slots) {
                    t.map(|i| i as usize).into_iter().for_each(|i| mesh.tints[i] = tint(*slot, mesh.positions[i]));
                }
            }
            mesh.slots.iter_mut().for_each(|s| *s = number(*s));
        }
        let slots = self.slots.into_iter().zip(&used).filter_map(|(slot, used)| used.then_some(slot)).collect();
        let mut meshes = meshes.into_iter();
        let mesh = meshes.next().unwrap_or_default();
        let extras = extras.into_iter().zip(meshes).map(|(e, mesh)| Extra { mesh: Arc::new(mesh), ..e }).collect();
        let keypoints = self.keypoints.map(|points| points.map(|p| p - origin));
        Asset { extras, keypoints, ..Asset::new(id, kind, class, mesh, slots, crate::licence::LICENCE) }
    }
}
