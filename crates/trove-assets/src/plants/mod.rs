//! Trees, bushes, and what covers the ground.

mod bark;
mod bushes;
mod check;
mod cover;
mod growth;
mod individual;
mod leaves;
mod plan;
mod stems;
mod tones;
mod trees;

use trove_model::Asset;

pub(crate) use cover::covers;
pub(crate) use plan::{PlantPlans, RowPlan, ShrubPlan, TreePlan};

/// Every model of this family; all but spruces and palms as these plans tell.
pub(crate) fn assets(plans: &PlantPlans) -> Vec<Asset> {
    let (mut assets, stems) = rayon::join(|| planned(plans), stems::assets);
    assets.extend(stems);
    assets
}

/// The plants of these plans.
pub(crate) fn planned(plans: &PlantPlans) -> Vec<Asset> {
    let (mut assets, bushes) = rayon::join(|| trees::assets(&plans.trees), || bushes::assets(plans));
    assets.extend(bushes);
    assets
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;
    use std::sync::LazyLock;

    use trove_model::{Asset, Climate, Kind, Material, PlantForm, Season};

    use super::assets;
    use crate::Plans;

    static PLANTS: LazyLock<Vec<Asset>> = LazyLock::new(|| assets(&Plans::built_in().plants));

    fn leaves(asset: &Asset) -> impl Iterator<Item = &Material> {
        asset.slots.iter().map(|s| &s.material).filter(|m| m.translucency > 0.0)
    }

    #[test]
    fn plants_are_many_light_enough_and_of_real_size() {
        for (kind, species, triangles, height) in
            [(Kind::Tree, 12, [60_000, 12_000, 2_500], 1.5..18.5), (Kind::Bush, 12, [9_000, 2_500, 900], 0.2..3.4)]
        {
            let of_kind = || PLANTS.iter().filter(|a| a.kind == kind);
            let names: BTreeSet<&str> =
                of_kind().filter_map(|a| a.plant.as_ref().unwrap().species.as_deref()).collect();
            assert!(names.len() >= species, "{names:?}");
            for asset in of_kind() {
                let levels = std::iter::once(&asset.mesh).chain(asset.coarser.iter().map(|c| &c.mesh));
                let found: Vec<usize> = levels.map(|mesh| mesh.triangles.len()).collect();
                assert!(found.iter().zip(&triangles).all(|(found, most)| found <= most), "{}: {found:?}", asset.id);
                assert!(found.windows(2).all(|pair| pair[1] < pair[0]), "{}: {found:?}", asset.id);
                assert!(height.contains(&asset.size_m.z), "{} is {} high", asset.id, asset.size_m.z);
            }
        }
    }

    #[test]
    fn coarser_plants_are_as_large_and_use_the_same_slots() {
        for asset in &*PLANTS {
            for coarser in &asset.coarser {
                assert_eq!(coarser.mesh.defect(), None, "{}", asset.id);
                assert!(coarser.mesh.slot_count() <= asset.slots.len(), "{}", asset.id);
                let (low, high) = coarser.mesh.bounds().unwrap();
                let size = (high - low).as_dvec3() / asset.size_m;
                assert!(size.min_element() > 0.75 && size.max_element() < 1.5, "{} becomes {size} as large", asset.id);
            }
        }
    }

    #[test]
    fn every_climate_has_trees_shrubs_hedges_and_beds() {
        use Climate::{Arid, Cold, Mediterranean, Subtropical, Temperate, Tropical};
        for climate in [Tropical, Subtropical, Mediterranean, Arid, Temperate, Cold] {
            let living = |kind, form| {
                let plants = PLANTS.iter().filter(|a| a.kind == kind).filter_map(|a| a.plant.as_ref());
                let species = plants.filter(|p| p.form == form && p.commonness(climate) > 0.1);
                species.map(|p| p.species.as_deref()).collect::<BTreeSet<_>>().len()
            };
            assert!(
                living(Kind::Tree, PlantForm::Free) >= 4 && living(Kind::Bush, PlantForm::Free) >= 3,
                "{climate:?}"
            );
            assert!(living(Kind::Bush, PlantForm::Hedge) > 0 && living(Kind::Bush, PlantForm::Bed) > 0, "{climate:?}");
        }
    }

    #[test]
    fn leaves_are_green_cut_out_let_light_through_and_fall_in_winter_but_for_twigs() {
        for asset in &*PLANTS {
            assert!(leaves(asset).count() >= 1, "{}", asset.id);
            let plant = asset.plant.as_ref().unwrap();
            let bare = plant.seasons.iter().find(|f| f.season == Season::Winter);
            for (slot, material) in asset.slots.iter().map(|s| (s, &s.material)).filter(|(_, m)| m.translucency > 0.0) {
                let above = |cutoff: f32| covered(&Material { alpha_cutoff: cutoff, ..material.clone() });
                assert!((0.12..0.85).contains(&above(0.5)), "{} covers {}", material.name, above(0.5));
                if material.name.ends_with("heads") {
                    continue;
                }
                assert!(slot.paints.iter().all(|p| p.y > p.z && p.y > 0.8 * p.x), "{} is not green", material.name);
                if let Some(bare) = bare.filter(|b| b.alpha_cutoff > 0.9) {
                    let left = above(bare.alpha_cutoff);
                    assert!(left > 0.004 && left < 0.3 * above(0.5), "{} keeps {left}", material.name);
                }
            }
        }
    }

    /// Leaf area over what a plant covers of the ground, or of a wall where it is slender: trees of streets have 2 to 8
    /// (McPherson and others 2016), palms less and clipped hedges more.
    #[test]
    fn plants_have_as_many_leaves_as_those_of_streets() {
        for asset in &*PLANTS {
            let mesh = &asset.mesh;
            let covered: Vec<f32> = asset.slots.iter().map(|s| covered(&s.material)).collect();
            let corners = |t: usize| mesh.triangles[t].map(|i| mesh.positions[i as usize]);
            let of_leaves: Vec<usize> =
                (0..mesh.triangles.len()).filter(|&t| covered[usize::from(mesh.slot(t))] > 0.0).collect();
            let area = |t: usize| {
                let [a, b, c] = corners(t);
                (b - a).cross(c - a).length() / 2.0 * covered[usize::from(mesh.slot(t))]
            };
            let leaves: f32 = of_leaves.iter().map(|&t| area(t)).sum();
            let all = || of_leaves.iter().flat_map(|&t| corners(t));
            let low = all().fold(glam::Vec3::INFINITY, glam::Vec3::min);
            let size = all().fold(glam::Vec3::NEG_INFINITY, glam::Vec3::max) - low;
            let covers = std::f32::consts::FRAC_PI_4 * size.x * size.y.max(size.z);
            let most = if asset.kind == Kind::Tree { 8.0 } else { 11.0 };
            assert!((1.0..most).contains(&(leaves / covers)), "{}: {leaves} m² over {covers} m²", asset.id);
        }
    }

    /// Share of a picture of leaves that they cover; 0 of anything else.
    fn covered(material: &Material) -> f32 {
        let Some(picture) = material.base_color_map.as_ref().filter(|_| material.translucency > 0.0) else {
            return 0.0;
        };
        let there = picture.rgba.iter().filter(|t| f32::from(t[3]) > material.alpha_cutoff * 255.0).count();
        there as f32 / picture.rgba.len() as f32
    }

    #[test]
    fn crowns_are_lit_from_outside() {
        for asset in PLANTS.iter().filter(|a| a.kind == Kind::Tree) {
            let mesh = &asset.mesh;
            let middle = glam::Vec3::Z * asset.size_m.z as f32 * 0.45;
            let leaf = |t: usize| asset.slots[usize::from(mesh.slot(t))].material.translucency > 0.0;
            let outward = (0..mesh.triangles.len()).filter(|&t| leaf(t)).map(|t| {
                let i = mesh.triangles[t][0] as usize;
                mesh.normals[i].dot((mesh.positions[i] - middle).normalize_or_zero())
            });
            let (sum, n) = outward.fold((0.0, 0), |(s, n), x| (s + x, n + 1));
            assert!(sum / n as f32 > 0.2, "{}: {}", asset.id, sum / n as f32);
        }
    }
}
