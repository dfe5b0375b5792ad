//! Surfaces without pattern or relief, to show what textures are worth.

use std::collections::HashMap;
use std::sync::Arc;

use glam::Vec4;
use trove_model::{Material, Texture};

/// Materials whose maps are gone.
#[derive(Default)]
pub(super) struct Flat {
    // By where an image lies, and by what is cut out of it.
    means: HashMap<(usize, u32), Vec4>,
    cut_outs: HashMap<usize, Arc<Texture>>,
}

impl Flat {
    /// Gives a material the means of its maps in their place; what they cut out stays cut out.
    pub(super) fn flatten(&mut self, material: &mut Material) {
        if let Some(map) = material.base_color_map.take() {
            material.base_color *= self.mean(&map, material.alpha_cutoff).truncate();
            material.base_color_map = (material.alpha_cutoff > 0.0).then(|| self.cut_out(&map));
        }
        if let Some(map) = material.orm_map.take() {
            let mean = self.mean(&map, 0.0);
            material.roughness *= mean.y;
            material.metalness *= mean.z;
        }
        if let Some(map) = material.emission_map.take() {
            material.emission *= self.mean(&map, 0.0).truncate();
        }
        (material.normal_map, material.height_map, material.height_m) = (None, None, 0.0);
    }

    fn mean(&mut self, map: &Arc<Texture>, cutoff: f32) -> Vec4 {
        let key = (Arc::as_ptr(map).addr(), cutoff.to_bits());
        *self.means.entry(key).or_insert_with(|| map.mean(cutoff).0)
    }

    /// White of the same outline.
    fn cut_out(&mut self, map: &Arc<Texture>) -> Arc<Texture> {
        let white = || {
            let rgba = map.rgba.iter().map(|texel| [255, 255, 255, texel[3]]).collect();
            Arc::new(Texture { name: format!("{}.outline", map.name), rgba, ..**map })
        };
        self.cut_outs.entry(Arc::as_ptr(map).addr()).or_insert_with(white).clone()
    }
}

#[cfg(test)]
mod tests {
    use glam::Vec3;
    use trove_model::ColorSpace;

    use super::*;

    fn map(color_space: ColorSpace, texels: [[u8; 4]; 2]) -> Option<Arc<Texture>> {
        Some(Arc::new(Texture { name: "a".into(), width: 2, height: 1, rgba: texels.into(), color_space }))
    }

    #[test]
    fn a_surface_looks_from_afar_as_it_did_and_holes_stay() {
        let mut leaf = Material {
            base_color: Vec3::new(0.5, 1.0, 1.0),
            base_color_map: map(ColorSpace::Srgb, [[255, 188, 0, 255], [9, 9, 9, 0]]),
            alpha_cutoff: 0.5,
            roughness: 0.8,
            metalness: 1.0,
            orm_map: map(ColorSpace::Linear, [[0, 255, 51, 255], [0, 0, 51, 255]]),
            normal_map: map(ColorSpace::Linear, [[255, 0, 0, 255]; 2]),
            height_map: map(ColorSpace::Linear, [[255; 4]; 2]),
            height_m: 0.1,
            emission: Vec3::ONE,
            emission_map: map(ColorSpace::Srgb, [[255, 0, 255, 255], [255, 0, 0, 255]]),
            ..Material::default()
        };
        let mut wall = Material { alpha_cutoff: 0.0, ..leaf.clone() };
        let mut flat = Flat::default();
        flat.flatten(&mut leaf);
        flat.flatten(&mut wall);
        // 188 is half of the light; only what is there counts, on the wall all of it.
        assert!((leaf.base_color - Vec3::new(0.5, 0.503, 0.0)).abs().max_element() < 1e-3, "{}", leaf.base_color);
        assert!(
            (wall.base_color - Vec3::new(0.2507, 0.2529, 0.0014)).abs().max_element() < 1e-3,
            "{}",
            wall.base_color
        );
        assert_eq!(leaf.base_color_map.as_ref().unwrap().rgba, [[255; 4], [255, 255, 255, 0]]);
        assert_eq!((leaf.roughness, leaf.emission), (0.4, Vec3::new(1.0, 0.0, 0.5)));
        assert!((leaf.metalness - 0.2).abs() < 1e-6);
        assert_eq!((leaf.textures().count(), wall.textures().count(), wall.height_m), (1, 0, 0.0));
    }
}
