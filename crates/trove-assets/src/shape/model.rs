//! Shapes and their materials put together into an asset.

use std::sync::Arc;

use glam::{Vec3, vec3};
use trove_model::{Asset, Class, Kind, Material, Slot};

use super::{Prism, Shape};

/// An asset under construction.
#[derive(Clone, Debug, Default)]
pub(crate) struct Model {
    shape: Shape,
    slots: Vec<Slot>,
}

impl Model {
    /// A slot with a material; `paints` are the base colours that it is seen in, a colour as often as it is common.
    pub(crate) fn slot(&mut self, material: Material, paints: &[Vec3]) -> u16 {
        self.slots.push(Slot { material, paints: paints.to_vec() });
        self.slots.len() as u16 - 1
    }

    /// Adds a shape, all of it in one slot.
    pub(crate) fn add(&mut self, slot: u16, shape: Shape) {
        self.add_marked(shape.slot(slot));
    }

    /// Adds a shape that knows its slots.
    pub(crate) fn add_marked(&mut self, shape: Shape) {
        self.shape = std::mem::take(&mut self.shape).and(shape);
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

    /// The asset: slots without triangles go, the origin comes to the ground, and but for what stands on a pole to the
    /// middle of the bounds.
    pub(crate) fn asset(self, id: &str, kind: Kind, class: Class) -> Asset {
        let mut mesh = self.shape.into_mesh();
        let (low, high) = mesh.bounds().unwrap_or_default();
        let middle = if kind.is_on_pole() { Vec3::ZERO } else { (low + high) / 2.0 };
        let origin = vec3(middle.x, middle.y, low.z);
        mesh.positions.iter_mut().for_each(|p| *p -= origin);

        let used: Vec<bool> = (0..self.slots.len()).map(|s| mesh.slots.contains(&(s as u16))).collect();
        let number = |s: u16| used[..usize::from(s)].iter().filter(|u| **u).count() as u16;
        mesh.slots.iter_mut().for_each(|s| *s = number(*s));
        let slots = self.slots.into_iter().zip(&used).filter_map(|(slot, used)| used.then_some(slot)).collect();

        let (low, high) = mesh.bounds().unwrap_or_default();
        let size_m = high.as_dvec3() - low.as_dvec3();
        let (id, mesh, licence) = (id.into(), Arc::new(mesh), crate::LICENCE.into());
        Asset { id, kind, class, size_m, mesh, slots, frost_tender: false, licence }
    }
}
