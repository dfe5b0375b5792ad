//! What people dress for.

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
