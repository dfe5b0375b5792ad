//! What covers the ground, by the patch: grass, weeds, flowers, fallen leaves, the soil around a street's tree.
//!
//! All of it is triangles without cut-outs: rays pass by a blade without asking a picture whether it is there.

mod grass;
mod litter;
mod patch;
mod tree_pit;

use trove_model::GroundCover;

/// Every cover, sorted by id.
pub(crate) fn covers() -> Vec<GroundCover> {
    let mut covers = [grass::covers(), litter::covers(), tree_pit::covers()].concat();
    covers.sort_by(|a, b| a.id.cmp(&b.id));
    covers
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeMap;

    use trove_model::CoverKind;

    use super::covers;

    #[test]
    fn covers_are_sound_light_lie_on_the_ground_and_keep_to_their_square() {
        let mut kinds: BTreeMap<CoverKind, usize> = BTreeMap::new();
        for cover in &covers() {
            *kinds.entry(cover.kind).or_default() += 1;
            assert_eq!(cover.mesh.defect(), None, "{}", cover.id);
            assert_eq!(cover.mesh.slot_count(), cover.slots.len(), "{}", cover.id);
            assert!(cover.mesh.triangles.len() <= 4500, "{}: {}", cover.id, cover.mesh.triangles.len());
            let (low, high) = cover.mesh.bounds().unwrap();
            assert!((-1e-6..0.01).contains(&low.z), "{} stands at {}", cover.id, low.z);
            let reach = low.truncate().abs().max(high.truncate().abs()).max_element();
            assert!(f64::from(reach) < cover.side_m / 2.0 + 0.12, "{} reaches {reach}", cover.id);
        }
        assert_eq!(kinds.len(), 7, "{kinds:?}");
        let triangles: usize = covers().iter().map(|c| c.mesh.triangles.len()).sum();
        assert!(triangles < 40_000, "{triangles}");
    }

    #[test]
    fn grass_is_as_dense_over_a_large_patch_as_over_a_small_one() {
        for kind in [CoverKind::GrassNear, CoverKind::GrassMiddle, CoverKind::GrassFar] {
            let density = |c: &trove_model::GroundCover| c.mesh.triangles.len() as f64 / c.side_m.powi(2);
            let found: Vec<f64> = covers().iter().filter(|c| c.kind == kind).map(density).collect();
            let (least, most) = found.iter().fold((f64::INFINITY, 0.0f64), |(l, m), &d| (l.min(d), m.max(d)));
            assert!(found.len() >= 2 && most / least < 1.05, "{kind:?}: {found:?}");
        }
    }
}
