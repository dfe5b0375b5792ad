//! The library as it looks over the year.

use crate::{Asset, AssetLibrary, Season};

impl Asset {
    /// As it looks in a season.
    fn in_season(&self, season: Season) -> Self {
        let mut asset = self.clone();
        for foliage in self.plant.iter().flat_map(|p| &p.seasons).filter(|f| f.season == season) {
            if let Some(slot) = asset.slots.get_mut(usize::from(foliage.slot)) {
                slot.paints.clone_from(&foliage.paints);
                slot.material.alpha_cutoff = foliage.alpha_cutoff;
            }
        }
        asset
    }
}

impl AssetLibrary {
    /// The library as it looks in a season; shapes and images are shared.
    pub fn in_season(&self, season: Season) -> Self {
        Self { assets: self.assets.iter().map(|a| a.in_season(season)).collect(), ..self.clone() }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Class, Foliage, Kind, Material, Mesh, Plant, Slot};
    use glam::Vec3;

    #[test]
    fn a_season_changes_paints_and_cut_off_of_its_slot_alone() {
        let slot = |name: &str| Slot { material: Material::plain(name, Vec3::ONE, 0.5), paints: vec![Vec3::Y] };
        let autumn = Foliage { season: Season::Autumn, slot: 1, paints: vec![Vec3::X, Vec3::ONE], alpha_cutoff: 0.8 };
        let mesh = Mesh::default();
        let tree = Asset {
            plant: Some(Plant { seasons: vec![autumn], ..Plant::default() }),
            ..Asset::new("tree/a", Kind::Tree, Class::Tree, mesh, vec![slot("bark"), slot("leaves")], "test")
        };
        let library = AssetLibrary { assets: vec![tree], ..AssetLibrary::default() };
        let seen = |season: Season| {
            let slots = &library.in_season(season).assets[0].slots;
            [0, 1].map(|i: usize| (slots[i].paints.len(), slots[i].material.alpha_cutoff))
        };
        assert_eq!(seen(Season::Autumn), [(1, 0.0), (2, 0.8)]);
        assert_eq!(seen(Season::Summer), [(1, 0.0), (1, 0.0)]);
    }
}
