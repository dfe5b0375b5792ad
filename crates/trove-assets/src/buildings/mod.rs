//! Whole buildings, for footprints that are rectangles. Their fronts look towards −y.

mod blocks;
mod houses;
mod site;

use rayon::prelude::*;
use trove_model::{Asset, Surface};

/// Every model of this family, made with these surfaces.
pub(crate) fn assets(surfaces: &[Surface]) -> Vec<Asset> {
    let builders: [fn(&[Surface]) -> Asset; 10] = [
        houses::row,
        houses::detached,
        houses::apartments,
        houses::shops,
        blocks::slab,
        blocks::tower,
        blocks::warehouse,
        blocks::corner,
        blocks::ribbon,
        blocks::hotel,
    ];
    builders.par_iter().map(|build| build(surfaces)).collect()
}

#[cfg(test)]
mod tests {
    use glam::Vec2;
    use trove_model::{Material, Surface, SurfaceKind, Tags};

    use super::assets;

    #[test]
    fn buildings_lie_along_x_and_are_light() {
        let assets = assets(&[]);
        assert!(assets.len() >= 8);
        for asset in &assets {
            assert!(asset.size_m.x >= asset.size_m.y, "{} measures {}", asset.id, asset.size_m);
            assert!(asset.mesh.triangles.len() <= 15_000, "{} has {} triangles", asset.id, asset.mesh.triangles.len());
        }
    }

    #[test]
    fn walls_show_whole_bays_and_storeys() {
        let material = Material { name: "facade/brick-row".into(), uv_scale: Vec2::ONE / 12.0, ..Material::default() };
        let id = material.name.clone();
        let surface = Surface {
            id,
            kind: SurfaceKind::Facade,
            tags: Tags::default(),
            material,
            size_m: [11.6, 12.4],
            cells: [4, 4],
            design: None,
        };
        let assets = assets(std::slice::from_ref(&surface));
        let row = assets.iter().find(|a| a.id == "building/row-houses").unwrap();
        let slot = row.slots.iter().position(|s| s.material.name == surface.id).unwrap();
        let mesh = &row.mesh;
        for t in (0..mesh.triangles.len()).filter(|&t| usize::from(mesh.slot(t)) == slot) {
            for i in mesh.triangles[t] {
                let cells = mesh.uvs[i as usize] / Vec2::new(2.9, 3.1);
                assert!((cells - cells.round()).length() < 1e-3, "{cells}");
            }
        }
    }
}
