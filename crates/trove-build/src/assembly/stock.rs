//! The meshes and materials of a scene, each kept once.

use std::collections::HashMap;
use std::sync::Arc;

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
    // By the asset's mesh and the extras that join it.
    individuals: HashMap<(usize, Vec<usize>), usize>,
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

    /// The index of the mesh of an asset's individual: with what it carries.
    pub(crate) fn individual(&mut self, asset: &Asset, is_driven: bool, seed: Seed) -> usize {
        let extras = asset.drawn_extras(is_driven, seed);
        let key = (Arc::as_ptr(&asset.mesh).addr(), extras);
        if let Some(known) = self.individuals.get(&key) {
            return *known;
        }
        let mesh = self.mesh(&asset.with_extras(&key.1));
        self.individuals.insert(key, mesh);
        mesh
    }

    /// The index of the mesh of what stands at a distance: the individual, or a coarser shape that carries nothing.
    pub(crate) fn seen(&mut self, asset: &Asset, distance_m: f64, seed: Seed) -> usize {
        let mesh = asset.mesh_at(distance_m);
        if Arc::ptr_eq(mesh, &asset.mesh) { self.individual(asset, false, seed) } else { self.mesh(mesh) }
    }

    /// The index of a material.
    pub(crate) fn material(&mut self, material: &Material) -> usize {
        let materials = &mut self.materials;
        *self.material_index.entry(key(material)).or_insert_with(|| {
            materials.push(material.clone());
            materials.len() - 1
        })
    }

    /// The indices of the materials of an asset's individual.
    pub(crate) fn painted(&mut self, asset: &Asset, seed: Seed) -> Vec<usize> {
        asset.materials(seed).iter().map(|material| self.material(material)).collect()
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
    use glam::Vec3;

    #[test]
    fn what_is_used_twice_is_kept_once() {
        let mut stock = Stock::default();
        let mesh = Arc::new(Mesh::default());
        assert_eq!((stock.mesh(&mesh), stock.mesh(&mesh.clone())), (0, 0));
        let grey = Material::plain("grey", Vec3::splat(0.5), 0.5);
        let other = Material { roughness: 0.6, ..grey.clone() };
        assert_eq!((stock.material(&grey), stock.material(&other), stock.material(&grey.clone())), (0, 1, 0));
    }
}
