//! Which model a plant becomes, and how large.

use glam::DVec3;
use trove_model::{Asset, AssetLibrary, Kind, Seed};

use super::Wish;
use crate::scenery::Scenery;

/// A model is scaled at most by this, and at least by one over it.
const MAX_SCALE: f64 = 1.6;
/// Individuals differ from their species by so much in each direction.
const VARIATION: f64 = 0.1;
/// Nearer to the equator it hardly freezes at the heights where cities lie.
const FROST_LAT_DEG: f64 = 34.0;

/// The plants of a library.
pub(super) struct Species<'a> {
    pub(super) trees: Vec<&'a Asset>,
    pub(super) bushes: Vec<&'a Asset>,
    /// It never freezes there.
    is_warm: bool,
}

/// A plant that has a model and a size, and no place yet.
pub(super) struct Grown<'a> {
    asset: &'a Asset,
    scale: DVec3,
    yaw_rad: f64,
    seed: Seed,
    /// Half its width, metres.
    pub(super) radius_m: f64,
}

impl<'a> Species<'a> {
    /// The plants that live at a latitude.
    pub(super) fn new(library: &'a AssetLibrary, lat_deg: f64) -> Self {
        let is_warm = lat_deg.abs() < FROST_LAT_DEG;
        let lives = |asset: &&Asset| !asset.frost_tender || is_warm;
        let of_kind = |kind| library.of_kind(kind).filter(lives).collect();
        Self { trees: of_kind(Kind::Tree), bushes: of_kind(Kind::Bush), is_warm }
    }

    /// How many lots a species has in the draw: towns are green with broad crowns, palms are planted here and there, and
    /// conifers hardly grow where it never freezes.
    fn commonness(&self, asset: &Asset) -> usize {
        match asset.id.as_str() {
            "tree/spruce" | "tree/pine" if self.is_warm => 1,
            "tree/palm" | "tree/palm-low" => 4,
            "tree/rain-tree" => 20,
            _ => 10,
        }
    }

    /// The plant for a wish; `None` where the library has none of the kind.
    pub(super) fn grow(&self, wish: &Wish, seed: Seed) -> Option<Grown<'a>> {
        let models = if wish.kind == Kind::Tree { &self.trees } else { &self.bushes };
        let scale_of = |asset: &Asset| wish.height_m / asset.size_m.z.max(0.1);
        let suits = |asset: &&&Asset| (1.0 / MAX_SCALE..=MAX_SCALE).contains(&scale_of(asset));

        // One species a group, of those that grow to the height; else the one that comes nearest.
        let suitable: Vec<&Asset> = models.iter().filter(suits).copied().collect();
        let strangeness = |asset: &Asset| scale_of(asset).ln().abs();
        let nearest = || models.iter().copied().min_by(|a, b| strangeness(a).total_cmp(&strangeness(b)));
        let lots: Vec<&Asset> = suitable.into_iter().flat_map(|a| std::iter::repeat_n(a, self.commonness(a))).collect();
        let asset = Seed(wish.group).child("species").random().pick(&lots).copied().or_else(nearest)?;

        let mut random = seed.random();
        let mut vary = || 1.0 + random.range(-VARIATION, VARIATION);
        let (wide, high) = (vary(), vary());
        let size = scale_of(asset).clamp(1.0 / MAX_SCALE, MAX_SCALE);
        let scale = DVec3::new(size * wide, size * wide, size * high);
        let radius_m = (asset.size_m * scale).truncate().max_element() / 2.0;
        Some(Grown { asset, scale, yaw_rad: random.range(0.0, std::f64::consts::TAU), seed, radius_m })
    }
}

impl<'a> Grown<'a> {
    /// The plant at a place.
    pub(super) fn scenery(self, foot_world: DVec3) -> Scenery<'a> {
        Scenery { asset: self.asset, foot_world, yaw_rad: self.yaw_rad, scale: self.scale, seed: self.seed }
    }
}
