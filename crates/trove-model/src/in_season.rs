//! The library as it looks over the year, what of it is met in a country, and who of it is dressed for the weather.

use std::collections::BTreeSet;

use crate::{Asset, AssetLibrary, Kind, Outdoors, Season};

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

impl Asset {
    /// Whether what it wears is worn then.
    pub fn suits(&self, outdoors: Outdoors) -> bool {
        self.worn_in.is_empty() || self.worn_in.contains(&outdoors)
    }
}

impl AssetLibrary {
    /// The library without what stands in other countries; without a country all that stands in some alone is left out.
    pub fn found_in(self, country: Option<&str>) -> Self {
        let stays = |asset: &Asset| asset.countries.is_empty() || asset.countries.iter().any(|c| Some(&**c) == country);
        Self { assets: self.assets.into_iter().filter(stays).collect(), ..self }
    }

    /// The library without who is not dressed for it; of a kind of which nobody is, all stay.
    pub fn dressed_for(self, outdoors: Outdoors) -> Self {
        let dressed: BTreeSet<Kind> = self.assets.iter().filter(|a| a.suits(outdoors)).map(|a| a.kind).collect();
        let stays = |asset: &Asset| asset.suits(outdoors) || !dressed.contains(&asset.kind);
        Self { assets: self.assets.into_iter().filter(stays).collect(), ..self }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Class, Foliage, Kind, Material, Mesh, Plant, Slot};
    use glam::Vec3;

    #[test]
    fn a_season_changes_paints_and_cut_off_of_its_slot_alone() {
        let slot = |name: &str| Slot::new(Material::plain(name, Vec3::ONE, 0.5), vec![Vec3::Y]);
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

    #[test]
    fn what_stands_in_some_countries_is_met_in_these_alone() {
        let asset = |id: &str, countries: &[&str]| Asset {
            countries: countries.iter().map(|c| (*c).to_owned()).collect(),
            ..Asset::new(id, Kind::Car, Class::Car, Mesh::default(), Vec::new(), "test")
        };
        let assets = vec![asset("car/a", &[]), asset("car/b", &["IN", "LK"]), asset("car/c", &["GB"])];
        let library = AssetLibrary { assets, ..AssetLibrary::default() };
        let found = |country: Option<&str>| {
            library.clone().found_in(country).assets.iter().map(|a| a.id.clone()).collect::<Vec<_>>()
        };
        assert_eq!(found(Some("LK")), ["car/a", "car/b"]);
        assert_eq!(found(Some("GB")), ["car/a", "car/c"]);
        assert_eq!(found(None), ["car/a"]);
    }

    #[test]
    fn who_is_not_dressed_for_it_is_left_out_unless_nobody_of_the_kind_is() {
        let asset = |id: &str, kind: Kind, worn_in: &[Outdoors]| Asset {
            worn_in: worn_in.to_vec(),
            ..Asset::new(id, kind, kind.class(), Mesh::default(), Vec::new(), "test")
        };
        let assets = vec![
            asset("adult/coat", Kind::Adult, &[Outdoors::Wet, Outdoors::Cold]),
            asset("adult/plain", Kind::Adult, &[]),
            asset("adult/tee", Kind::Adult, &[Outdoors::Warm]),
            asset("car/a", Kind::Car, &[]),
            asset("child/tee", Kind::Child, &[Outdoors::Warm]),
        ];
        let library = AssetLibrary { assets, ..AssetLibrary::default() };
        let left = |outdoors: Outdoors| {
            library.clone().dressed_for(outdoors).assets.iter().map(|a| a.id.clone()).collect::<Vec<_>>()
        };
        assert_eq!(left(Outdoors::Cold), ["adult/coat", "adult/plain", "car/a", "child/tee"]);
        assert_eq!(left(Outdoors::Warm), ["adult/plain", "adult/tee", "car/a", "child/tee"]);
        assert_eq!(left(Outdoors::Mild), ["adult/plain", "car/a", "child/tee"]);
    }
}
