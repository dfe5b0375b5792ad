//! Fallen leaves.

use glam::{Vec3, vec3};
use trove_model::{CoverKind, GroundCover, Material, Seed, Slot};

use super::patch::{Patch, heading, point, varied};

/// From leaves that a wind has torn off over yellow ones to those that have lain for a season.
const SHADES: [Vec3; 4] =
    [vec3(0.13, 0.15, 0.05), vec3(0.3, 0.22, 0.06), vec3(0.23, 0.13, 0.055), vec3(0.13, 0.085, 0.05)];
const SIDE_M: f32 = 0.5;

pub(super) fn covers() -> Vec<GroundCover> {
    // Broad leaves, and the leaflets of feathered ones.
    let sorts = [("broad-0", 13, 0.07), ("broad-1", 9, 0.085), ("small-0", 42, 0.028), ("mixed-0", 22, 0.05)];
    sorts
        .map(|(name, count, length_m)| {
            let name = format!("leaves-{name}");
            let mut random = Seed(34).child(&name).random();
            let mut patch = Patch::default();
            for _ in 0..count {
                let curl_m = length_m * random.range(0.04, 0.22) as f32;
                let middle = point(SIDE_M, &mut random) + Vec3::Z * random.range(0.003, 0.006) as f32;
                let length_m = length_m * random.range(0.6, 1.3) as f32;
                let tint = varied(Vec3::ONE, 0.35, &mut random);
                patch.lying_leaf(middle, heading(&mut random), length_m, curl_m, tint);
            }
            let material = Material { translucency: 0.2, ..Material::plain("fallen leaves", SHADES[0], 0.75) };
            patch.cover(&name, CoverKind::Leaves, SIDE_M, Slot::new(material, SHADES.to_vec()))
        })
        .to_vec()
}
