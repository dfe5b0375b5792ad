//! Whole buildings, for footprints that are rectangles. Their fronts look towards −y.

mod blocks;
mod finish;
mod massing;
mod parts;
mod plan;
mod repeat;
mod roof;
mod site;
mod spot;

use rayon::prelude::*;
use trove_model::{Asset, Surface};

pub(crate) use plan::BuildingPlan;

/// Every model of this family, made with these surfaces.
pub(crate) fn assets(plans: &[BuildingPlan], surfaces: &[Surface]) -> Vec<Asset> {
    let builders: [fn(&[Surface]) -> Asset; 2] = [blocks::warehouse, blocks::corner];
    let mut assets = planned(plans, surfaces);
    assets.par_extend(builders.par_iter().map(|build| build(surfaces)));
    assets
}

/// The buildings of these plans.
pub(crate) fn planned(plans: &[BuildingPlan], surfaces: &[Surface]) -> Vec<Asset> {
    plans.par_iter().map(|plan| plan.asset(surfaces)).collect()
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;

    use glam::{Vec2, Vec3};
    use trove_model::{Asset, Material, Surface, SurfaceKind, Tags};

    use super::assets;
    use crate::plans::Plans;

    /// How much of its box a building covers, seen from above.
    fn filled(asset: &Asset) -> f64 {
        const CELLS: usize = 100;
        let (size, mesh) = (asset.size_m.truncate().as_vec2(), &asset.mesh);
        let mut covered = vec![false; CELLS * CELLS];
        let place = |v: f32| (v * CELLS as f32).clamp(0.0, CELLS as f32);
        for t in &mesh.triangles {
            let [a, b, c] = t.map(|i| mesh.positions[i as usize].truncate() / size + 0.5);
            let (low, high) = (a.min(b).min(c), a.max(b).max(c));
            for i in place(low.x) as usize..place(high.x).ceil() as usize {
                for j in place(low.y) as usize..place(high.y).ceil() as usize {
                    let p = Vec2::new(i as f32 + 0.5, j as f32 + 0.5) / CELLS as f32;
                    let turns = [(a, b), (b, c), (c, a)].map(|(a, b)| (b - a).perp_dot(p - a));
                    covered[i * CELLS + j] |= turns.iter().all(|t| *t >= 0.0) || turns.iter().all(|t| *t <= 0.0);
                }
            }
        }
        covered.iter().filter(|is| **is).count() as f64 / covered.len() as f64
    }

    fn built_in() -> Vec<Asset> {
        assets(&Plans::built_in().buildings, &[])
    }

    #[test]
    fn buildings_lie_along_x_on_the_ground_and_are_light() {
        let assets = built_in();
        let ids: BTreeSet<&str> = assets.iter().map(|asset| &*asset.id).collect();
        assert!(ids.len() == assets.len() && ids.len() >= 38, "{ids:?}");
        for asset in &assets {
            assert_eq!(asset.mesh.defect(), None, "{}", asset.id);
            assert!(asset.size_m.x >= asset.size_m.y, "{} measures {}", asset.id, asset.size_m);
            assert!(asset.mesh.triangles.len() <= 15_000, "{} has {} triangles", asset.id, asset.mesh.triangles.len());
            // What stands on the ground is broad: nothing but a building's foot may be its lowest point.
            let feet = asset.mesh.positions.iter().filter(|p| p.z.abs() < 1e-3);
            let (low, high) =
                feet.fold((Vec3::INFINITY, Vec3::NEG_INFINITY), |(low, high), p| (low.min(*p), high.max(*p)));
            let foot = (high - low).truncate() / asset.size_m.truncate().as_vec2();
            assert!(foot.min_element() > 0.75, "{} stands on {foot} of its box", asset.id);
        }
    }

    #[test]
    fn buildings_fill_their_boxes_but_for_those_with_deep_canopies() {
        let assets = built_in();
        let mut gaping: Vec<&str> = assets.iter().filter(|a| filled(a) < 0.95).map(|a| &*a.id).collect();
        let known = ["brick-apartments", "detached-house", "hotel", "slab-block"].map(|id| format!("building/{id}"));
        gaping.sort_unstable();
        assert_eq!(gaping, known);
    }

    #[test]
    fn slabs_that_may_be_repeated_lie_within_their_building() {
        for asset in &built_in() {
            let (low, high) = asset.mesh.bounds().unwrap();
            for (axis, slab) in asset.repeats.iter().enumerate() {
                let Some([from, to]) = *slab else { continue };
                let inside = f64::from(low[axis]) < from && to < f64::from(high[axis]);
                assert!(inside && to - from >= 2.0, "{} along {axis}: {from} to {to}", asset.id);
            }
        }
        let without = |axis: usize, is_large: fn(&Asset) -> bool| -> Vec<String> {
            let assets = built_in();
            let fixed = assets.iter().filter(|a| a.repeats[axis].is_none() && is_large(a));
            let mut names: Vec<String> = fixed.map(|a| a.id.replace("building/", "")).collect();
            names.sort_unstable();
            names
        };
        let fixed = ["boulevard-block", "deck-access-flats", "detached-house", "farmhouse", "hawker-centre"];
        assert_eq!(without(0, |_| true), fixed);
        assert_eq!(without(2, |a| a.size_m.z >= 18.0), ["fire-station"]);
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
        let assets = assets(&Plans::built_in().buildings, std::slice::from_ref(&surface));
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
