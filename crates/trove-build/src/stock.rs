//! The meshes and materials of a scene, each kept once.

use std::collections::HashMap;
use std::sync::Arc;

use glam::Vec3;
use trove_model::{Asset, Mapping, Material, Mesh, Seed, Tiling};

/// Meshes and materials, numbered in the order of their first use.
#[derive(Clone, Debug, Default)]
pub(crate) struct Stock {
    /// Shapes.
    pub meshes: Vec<Arc<Mesh>>,
    /// Materials.
    pub materials: Vec<Material>,
    // Only ever looked up, so the order inside does not reach the scene.
    mesh_index: HashMap<usize, usize>,
    material_index: HashMap<MaterialKey, usize>,
}

/// Two materials with the same key look the same; images are told apart by where they lie.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
struct MaterialKey {
    name: String,
    numbers: Vec<u32>,
    images: [usize; 4],
    mapping: (Mapping, Tiling),
}

impl Stock {
    /// The index of a mesh.
    pub(crate) fn mesh(&mut self, mesh: &Arc<Mesh>) -> usize {
        let meshes = &mut self.meshes;
        *self.mesh_index.entry(Arc::as_ptr(mesh).addr()).or_insert_with(|| {
            meshes.push(mesh.clone());
            meshes.len() - 1
        })
    }

    /// The index of a material.
    pub(crate) fn material(&mut self, material: &Material) -> usize {
        let materials = &mut self.materials;
        *self.material_index.entry(key(material)).or_insert_with(|| {
            materials.push(material.clone());
            materials.len() - 1
        })
    }

    /// The indices of an asset's materials, with paints drawn; slots with the same paints get the same one.
    pub(crate) fn painted(&mut self, asset: &Asset, seed: Seed) -> Vec<usize> {
        let mut drawn: Vec<(&[Vec3], Vec3)> = Vec::new();
        let mut indices = Vec::with_capacity(asset.slots.len());
        for (i, slot) in asset.slots.iter().enumerate() {
            let known = drawn.iter().find(|(paints, _)| *paints == slot.paints).map(|(_, paint)| *paint);
            let paint = known.or_else(|| seed.child("paint").nth(i as u64).random().pick(&slot.paints).copied());
            let Some(paint) = paint else {
                indices.push(self.material(&slot.material));
                continue;
            };
            drawn.push((&slot.paints, paint));
            indices.push(self.material(&Material { base_color: paint, ..slot.material.clone() }));
        }
        indices
    }
}

fn key(material: &Material) -> MaterialKey {
    let m = material;
    let floats = [
        m.base_color.x,
        m.base_color.y,
        m.base_color.z,
        m.alpha_cutoff,
        m.roughness,
        m.metalness,
        m.ior,
        m.coat,
        m.flakes,
        m.sheen,
        m.subsurface,
        m.transmission,
        m.translucency,
        m.dirt,
        m.wetness,
        m.height_m,
        m.emission.x,
        m.emission.y,
        m.emission.z,
        m.uv_scale.x,
        m.uv_scale.y,
    ];
    let image = |texture: &Option<Arc<trove_model::Texture>>| texture.as_ref().map_or(0, |t| Arc::as_ptr(t).addr());
    MaterialKey {
        name: m.name.clone(),
        numbers: floats.map(f32::to_bits).to_vec(),
        images: [&m.base_color_map, &m.orm_map, &m.normal_map, &m.height_map].map(image),
        mapping: (m.mapping, m.tiling),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use trove_model::Slot;

    #[test]
    fn what_is_used_twice_is_kept_once() {
        let mut stock = Stock::default();
        let mesh = Arc::new(Mesh::default());
        assert_eq!((stock.mesh(&mesh), stock.mesh(&mesh.clone())), (0, 0));
        let grey = Material::plain("grey", Vec3::splat(0.5), 0.5);
        let other = Material { roughness: 0.6, ..grey.clone() };
        assert_eq!((stock.material(&grey), stock.material(&other), stock.material(&grey.clone())), (0, 1, 0));
    }

    #[test]
    fn slots_with_the_same_paints_are_painted_alike() {
        let paints: Vec<Vec3> = (0..50).map(|i| Vec3::splat(i as f32 / 50.0)).collect();
        let body = Slot { material: Material::plain("body", Vec3::ONE, 0.3), paints: paints.clone() };
        let bumper = Slot { material: Material::plain("bumper", Vec3::ONE, 0.5), paints };
        let tyre = Slot { material: Material::plain("tyre", Vec3::ZERO, 0.9), paints: Vec::new() };
        let asset = Asset {
            slots: vec![body, bumper, tyre],
            ..crate::testing::asset("car/a", trove_model::Kind::Car, [4.0, 2.0, 1.5])
        };
        let mut stock = Stock::default();
        let painted = stock.painted(&asset, Seed(1));
        assert_eq!(stock.materials[painted[0]].base_color, stock.materials[painted[1]].base_color);
        assert_eq!(stock.materials[painted[2]].base_color, Vec3::ZERO);
        assert_eq!(stock.painted(&asset, Seed(1)), painted);
        assert_ne!(stock.painted(&asset, Seed(2)), painted);
    }
}
