//! The meshes and materials of a scene, each kept once.

use std::collections::HashMap;
use std::sync::Arc;

use glam::Vec3;
use trove_model::{Asset, Beam, CarColors, Kind, Mapping, Material, Mesh, Role, Seed, Texture, Tiling};

use super::flat::Flat;
use super::legs::Legs;
use super::lens;
use super::pedals::Pedals;
use super::postures::Joints;
use super::wheels::{parts, wheels};

/// Meshes and materials, numbered in the order of their first use.
#[derive(Clone, Debug, Default)]
pub(crate) struct Stock {
    /// Shapes.
    pub meshes: Vec<Arc<Mesh>>,
    /// Materials.
    pub materials: Vec<Material>,
    /// Whether street lamps are on.
    pub is_dark: bool,
    /// What colours cars have here.
    pub car_colors: Option<CarColors>,
    // Only ever looked up, so the order inside does not reach the scene.
    mesh_index: HashMap<usize, usize>,
    material_index: HashMap<MaterialKey, usize>,
    // By the asset's mesh and the extras that join it.
    individuals: HashMap<(usize, Vec<usize>), usize>,
    // By the asset's mesh.
    vehicles: HashMap<usize, Joints>,
    legs: HashMap<usize, Option<Arc<Legs>>>,
    // By the asset's mesh: emission and beam of its lenses.
    lenses: HashMap<usize, Option<(Vec3, Arc<Beam>)>>,
}

/// Two materials with the same key are the same; images and beams are told apart by where they lie.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
struct MaterialKey {
    name: String,
    numbers: Vec<u32>,
    images: [usize; 5],
    beam: usize,
    mapping: (Mapping, Tiling),
    role: Option<Role>,
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

    /// The wheels of a vehicle, and the pedals of who rides a bicycle, with the vertices of all of its individuals: extras come
    /// behind its own.
    pub(crate) fn vehicle(&mut self, asset: &Asset) -> Joints {
        let found = self.vehicles.entry(Arc::as_ptr(&asset.mesh).addr());
        let joints = || {
            let parts = parts(&asset.mesh);
            let rides = asset.keypoints.as_ref().filter(|_| asset.kind == Kind::BicycleWithRider);
            let pedals = rides.and_then(|keypoints| Pedals::new(&asset.mesh, &parts, keypoints));
            Joints { wheels: wheels(&asset.mesh, &parts).into(), pedals: pedals.map(Arc::new), legs: None }
        };
        found.or_insert_with(joints).clone()
    }

    /// The legs of a person, with the vertices of all of their individuals and postures.
    pub(crate) fn legs(&mut self, asset: &Asset) -> Option<Arc<Legs>> {
        let found = self.legs.entry(Arc::as_ptr(&asset.mesh).addr());
        found.or_insert_with(|| Some(Arc::new(Legs::new(&asset.mesh, asset.keypoints.as_ref()?)?))).clone()
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

    /// The index of a material in another colour; what shines or lets light through stays as it is.
    pub(crate) fn tinted(&mut self, material: usize, factor: Vec3) -> usize {
        let known = &self.materials[material];
        if known.transmission > 0.0 || known.is_emitter() {
            return material;
        }
        let base_color = (known.base_color * factor).min(known.base_color.max(Vec3::ONE));
        self.material(&Material { base_color, ..known.clone() })
    }

    /// Takes pattern and relief from all surfaces.
    pub(crate) fn flatten(&mut self) {
        let mut flat = Flat::default();
        self.materials.iter_mut().for_each(|material| flat.flatten(material));
        // They are no longer what they were looked up by.
        self.material_index.clear();
    }

    /// The indices of the materials of an asset's individual; in the dark the lenses of street lamps are lit.
    pub(crate) fn painted(&mut self, asset: &Asset, seed: Seed) -> Vec<usize> {
        let mut materials = asset.materials(seed, self.car_colors.as_ref());
        let mut lenses = materials.iter_mut().filter(|material| material.role == Some(Role::StreetLamp)).peekable();
        if self.is_dark && lenses.peek().is_some() {
            let lit = self.lenses.entry(Arc::as_ptr(&asset.mesh).addr());
            let lit = lit.or_insert_with(|| lens::lit(asset).map(|(emission, beam)| (emission, Arc::new(beam))));
            if let Some((emission, beam)) = lit {
                lenses.for_each(|lens| (lens.emission, lens.beam) = (*emission, Some(beam.clone())));
            }
        }
        materials.iter().map(|material| self.material(material)).collect()
    }
}

/// Takes the material apart whole: a new field does not compile until the key has it.
fn key(material: &Material) -> MaterialKey {
    let Material {
        name,
        base_color,
        base_color_map,
        alpha_cutoff,
        roughness,
        metalness,
        orm_map,
        normal_map,
        height_map,
        height_m,
        ior,
        coat,
        flakes,
        sheen,
        subsurface,
        transmission,
        translucency,
        retroreflection,
        emission,
        emission_map,
        beam,
        dirt,
        wetness,
        uv_scale,
        mapping,
        tiling,
        role,
    } = material;
    let shares = [alpha_cutoff, roughness, metalness, coat, flakes, sheen, subsurface, transmission, translucency];
    let others = [retroreflection, dirt, wetness, ior, height_m];
    let colors = [base_color.to_array(), emission.to_array()];
    let numbers = shares.into_iter().chain(others).chain(colors.as_flattened()).chain(uv_scale.as_ref());
    let image = |texture: &Option<Arc<Texture>>| texture.as_ref().map_or(0, |t| Arc::as_ptr(t).addr());
    MaterialKey {
        name: name.clone(),
        numbers: numbers.map(|number| number.to_bits()).collect(),
        images: [base_color_map, orm_map, normal_map, height_map, emission_map].map(image),
        beam: beam.as_ref().map_or(0, |beam| Arc::as_ptr(beam).addr()),
        mapping: (*mapping, *tiling),
        role: *role,
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
