//! What people dress for.

use std::collections::BTreeSet;

use crate::{Asset, AssetLibrary, Kind};

/// What it is like outdoors, as far as people dress by it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Outdoors {
    /// Arms and legs may be bare.
    Warm,
    /// Long sleeves and trousers, or a jacket.
    Mild,
    /// Rain: something over what is worn otherwise.
    Wet,
    /// Frost or snow: coats.
    Cold,
}

impl Outdoors {
    /// All four.
    pub const ALL: [Self; 4] = [Self::Warm, Self::Mild, Self::Wet, Self::Cold];

    /// Its name in plans and libraries (`cold`).
    pub fn name(self) -> &'static str {
        match self {
            Self::Warm => "warm",
            Self::Mild => "mild",
            Self::Wet => "wet",
            Self::Cold => "cold",
        }
    }

    /// What it is like of this name.
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|outdoors| outdoors.name() == name)
    }
}

impl Asset {
    /// Whether what it wears is worn then.
    pub fn suits(&self, outdoors: Outdoors) -> bool {
        self.worn_in.is_empty() || self.worn_in.contains(&outdoors)
    }
}

impl AssetLibrary {
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
    use crate::Mesh;

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
