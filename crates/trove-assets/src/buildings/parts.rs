//! What plans hang on walls, set before them and put on roofs.

use serde::Deserialize;

use crate::measure::{Wrong, within, wrong};

/// A thing of one finish, as often as its places say.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct PartPlan {
    pub(super) finish: String,
    /// Which of the masses it belongs to, from 0.
    #[serde(default)]
    pub(super) mass: usize,
    #[serde(default = "front")]
    pub(super) sides: Vec<Side>,
    /// Metres from the middle of the wall to the right, seen from outside.
    #[serde(default)]
    pub(super) along: Places,
    /// Metres from the wall outwards.
    #[serde(default)]
    pub(super) out: Places,
    /// Metres above the ground.
    #[serde(default)]
    pub(super) up: Places,
    pub(super) shape: ShapePlan,
}

/// The wall of a mass that a part hangs on; `top` is its middle, where outwards is to the front.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize)]
#[serde(rename_all = "snake_case")]
pub(super) enum Side {
    Front,
    Right,
    Back,
    Left,
    Top,
}

/// Where copies stand along a line.
#[derive(Clone, Debug, Deserialize)]
#[serde(untagged, expecting = "expected a list of metres or { count, step } with from or skip")]
pub(super) enum Places {
    /// At these.
    At(Vec<f32>),
    /// So many at equal steps, about 0 or from a point on, without some.
    Steps(Steps),
}

#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Steps {
    count: u32,
    step: f32,
    from: Option<f32>,
    #[serde(default)]
    skip: Vec<u32>,
}

impl Default for Places {
    fn default() -> Self {
        Self::At(vec![0.0])
    }
}

impl Places {
    pub(super) fn metres(&self) -> Vec<f32> {
        match self {
            Self::At(list) => list.clone(),
            Self::Steps(Steps { count, step, from, skip }) => {
                let from = from.unwrap_or(-step * (count.saturating_sub(1)) as f32 / 2.0);
                (0..*count).filter(|i| !skip.contains(i)).map(|i| from + step * i as f32).collect()
            }
        }
    }

    fn check(&self, key: &'static str) -> Result<(), Wrong> {
        if let Self::Steps(steps) = self
            && steps.count > 500
        {
            return wrong(key, "at most 500 places", &steps.count);
        }
        within(key, "metres from -300 to 300", -300.0..=300.0, &self.metres())
    }
}

/// A shape; sizes are along the wall, outwards and upwards, and it stands on its place with its back to the wall.
#[derive(Clone, Debug, Deserialize)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub(super) enum ShapePlan {
    Block {
        size: [f32; 3],
    },
    /// A frame of the finish around panes, so many across and up.
    Window {
        size: [f32; 2],
        panes: [u32; 2],
    },
    Balcony {
        size: [f32; 2],
        rail: Rail,
    },
    Railing {
        size: [f32; 2],
    },
    Awning {
        size: [f32; 2],
    },
    /// A slab with a rod at each end.
    Canopy {
        size: [f32; 3],
    },
    /// A bay that stands out with slanting sides and windows.
    Oriel {
        size: [f32; 3],
    },
    /// A window in a roof, under a gable or a flat lid.
    Dormer {
        size: [f32; 3],
        tiles: String,
        rise: f32,
    },
    /// A prism under a triangle.
    Gable {
        size: [f32; 3],
    },
    Chimney {
        size: [f32; 3],
        pots: u32,
    },
    Column {
        radius: f32,
        height: f32,
    },
    Pipe {
        height: f32,
    },
    /// One of the library's shop signs on a board.
    Sign {
        size: [f32; 2],
        cell: u32,
    },
    /// A slab that rises to the right.
    Ramp {
        size: [f32; 3],
    },
    Steps {
        wide: f32,
        count: u32,
    },
    /// Machines and a lift house on a flat roof.
    Plant {
        size: [f32; 2],
    },
}

/// What keeps people on a balcony.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize)]
#[serde(rename_all = "snake_case")]
pub(super) enum Rail {
    Glass,
    Bars,
    Solid,
}

fn front() -> Vec<Side> {
    vec![Side::Front]
}

impl PartPlan {
    pub(super) fn finishes(&self) -> impl Iterator<Item = &str> {
        std::iter::once(self.finish.as_str()).chain(self.shape.tiles())
    }

    pub(super) fn check(&self, masses: usize) -> Result<(), Wrong> {
        if self.mass >= masses {
            return wrong("parts.mass", "the number of a mass, from 0", &self.mass);
        }
        self.along.check("parts.along")?;
        self.out.check("parts.out")?;
        self.up.check("parts.up")?;
        let counts = match &self.shape {
            ShapePlan::Window { panes, .. } => panes.to_vec(),
            ShapePlan::Steps { count, .. } => vec![*count],
            _ => Vec::new(),
        };
        if counts.iter().any(|count| !(1..=40).contains(count)) {
            return wrong("parts.shape", "counts from 1 to 40", &counts);
        }
        within("parts.shape", "metres from 0.01 to 200", 0.01..=200.0, &self.shape.lengths())
    }
}

impl ShapePlan {
    /// What covers it, where it has a roof of its own.
    pub(super) fn tiles(&self) -> Option<&str> {
        match self {
            Self::Dormer { tiles, .. } => Some(tiles),
            _ => None,
        }
    }

    fn lengths(&self) -> Vec<f32> {
        match self {
            Self::Block { size }
            | Self::Canopy { size }
            | Self::Oriel { size }
            | Self::Dormer { size, .. }
            | Self::Gable { size }
            | Self::Chimney { size, .. }
            | Self::Ramp { size } => size.to_vec(),
            Self::Window { size, .. }
            | Self::Balcony { size, .. }
            | Self::Railing { size }
            | Self::Awning { size }
            | Self::Sign { size, .. }
            | Self::Plant { size } => size.to_vec(),
            Self::Column { radius, height } => vec![*radius, *height],
            Self::Pipe { height } => vec![*height],
            Self::Steps { wide, .. } => vec![*wide],
        }
    }
}
