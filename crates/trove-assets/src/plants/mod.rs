//! Trees, bushes, and what covers the ground.

mod bushes;
mod cover;
mod growth;
mod leaves;
mod stems;
mod trees;

use rayon::prelude::*;
use trove_model::{Asset, Climate, LeafType, Plant, PlantForm};

pub(crate) use cover::covers;

/// Every model of this family.
pub(crate) fn assets() -> Vec<Asset> {
    let groups: [fn() -> Vec<Asset>; 3] = [trees::assets, stems::assets, bushes::assets];
    let placed = |asset: Asset| Asset { plant: Some(plant(&asset.id)), ..asset };
    groups.par_iter().flat_map_iter(|group| group()).map(placed).collect()
}

/// Where a plant is common, and what maps call it.
fn plant(id: &str) -> Plant {
    use Climate::{Arid, Cold, Mediterranean, Subtropical, Temperate, Tropical};
    const TENDER: [(Climate, f32); 2] = [(Temperate, 0.0), (Cold, 0.0)];
    let (leaves, genera, habitat): (LeafType, &[&str], Vec<(Climate, f32)>) = match id {
        "tree/palm" | "tree/palm-low" => {
            let warm = [(Tropical, 0.4), (Subtropical, 0.4), (Mediterranean, 0.9), (Arid, 0.9)];
            (LeafType::Frond, &["palm", "phoenix", "washingtonia", "roystonea", "cocos"], [&TENDER[..], &warm].concat())
        }
        "tree/rain-tree" => (LeafType::Broad, &["samanea", "albizia"], [&TENDER[..], &[(Tropical, 2.0)]].concat()),
        "bush/tropical" => (LeafType::Broad, &[], TENDER.to_vec()),
        "tree/spruce" => (LeafType::Needle, &["picea", "abies"], vec![(Temperate, 0.3), (Mediterranean, 0.1)]),
        "tree/pine" => (LeafType::Needle, &["pinus", "cedrus", "larix"], vec![(Tropical, 0.1), (Temperate, 0.4)]),
        "tree/cypress" => (LeafType::Needle, &["cupressus", "italica"], vec![(Temperate, 0.0), (Cold, 0.0)]),
        "tree/birch" => (LeafType::Broad, &["betula"], vec![(Tropical, 0.0), (Temperate, 0.4)]),
        "tree/linden" => (LeafType::Broad, &["tilia"], vec![(Tropical, 0.0), (Temperate, 1.6)]),
        "tree/plane" => (LeafType::Broad, &["platanus"], vec![(Temperate, 1.4), (Mediterranean, 1.4)]),
        "tree/oak" => (LeafType::Broad, &["quercus", "fagus"], Vec::new()),
        _ => (LeafType::Broad, &[], Vec::new()),
    };
    let form = if id == "bush/hedge" { PlantForm::Hedge } else { PlantForm::Free };
    let genera = genera.iter().map(|g| (*g).into()).collect();
    Plant { form, leaves, genera, habitat, ..Plant::default() }
}

#[cfg(test)]
mod tests {
    use trove_model::{Asset, Kind, Material};

    use super::assets;

    fn leaves(asset: &Asset) -> impl Iterator<Item = &Material> {
        asset.slots.iter().map(|s| &s.material).filter(|m| m.translucency > 0.0)
    }

    #[test]
    fn plants_are_many_light_enough_and_of_real_size() {
        let assets = assets();
        let of = |kind| assets.iter().filter(move |a| a.kind == kind);
        assert!(of(Kind::Tree).count() >= 8 && of(Kind::Bush).count() >= 5);
        for (kind, triangles, height) in [(Kind::Tree, 40_000, 4.5..18.5), (Kind::Bush, 6_000, 0.3..3.2)] {
            for asset in of(kind) {
                assert!(asset.mesh.triangles.len() <= triangles, "{}: {}", asset.id, asset.mesh.triangles.len());
                assert!(height.contains(&asset.size_m.z), "{} is {} high", asset.id, asset.size_m.z);
            }
        }
    }

    #[test]
    fn leaves_are_green_cut_out_and_let_light_through() {
        for asset in &assets() {
            assert_eq!(leaves(asset).count(), 1, "{}", asset.id);
            for material in leaves(asset) {
                let picture = material.base_color_map.as_ref().unwrap();
                let there = picture.rgba.iter().filter(|t| t[3] > 127).count() as f32 / picture.rgba.len() as f32;
                assert!((0.12..0.8).contains(&there), "{} covers {there} of its card", material.name);
                assert!(material.alpha_cutoff == 0.5);
                let [r, g, b] = [0, 1, 2].map(|c| picture.rgba.iter().map(|t| u32::from(t[c])).sum::<u32>());
                assert!(g > r && r > b, "{} is not green", material.name);
            }
        }
    }

    #[test]
    fn crowns_are_lit_from_outside() {
        for asset in assets().iter().filter(|a| a.kind == Kind::Tree) {
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
