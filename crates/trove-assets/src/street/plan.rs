//! Street furniture that plans tell, put together from simple shapes.

use glam::{Vec2, Vec3};
use serde::Deserialize;
use trove_model::{Asset, Kind, Material};

use super::finish::{
    bar, board, cloth, concrete, dark, galvanised, glass, grey_timber, painted, plastic, post, reflective, rubber,
    rusty, stainless, tarpaulin, timber,
};
use crate::measure::{Wrong, ordinary, within, wrong};
use crate::shape::{Model, Shape};
use crate::surfaces;

/// A piece of furniture: a `[[furniture]]` of a file of plans. Metres; x is its front; colours linear RGB.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct FurniturePlan {
    /// Unique in its library.
    pub(crate) id: String,
    kind: FurnitureKind,
    /// Words that say what it is.
    #[serde(default)]
    tags: Vec<String>,
    /// How often it is drawn among those that fit as well; 1 is ordinary.
    #[serde(default = "ordinary")]
    commonness: f32,
    parts: Vec<PartPlan>,
}

/// What a piece of furniture is.
#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(rename_all = "snake_case")]
enum FurnitureKind {
    Barrier,
    Bench,
    BicycleRack,
    Bin,
    Bollard,
    Debris,
    Hydrant,
    PushablePullable,
    Shelter,
    StreetFurniture,
    TrafficCone,
    UtilityPole,
}

impl From<FurnitureKind> for Kind {
    fn from(kind: FurnitureKind) -> Self {
        match kind {
            FurnitureKind::Barrier => Self::Barrier,
            FurnitureKind::Bench => Self::Bench,
            FurnitureKind::BicycleRack => Self::BicycleRack,
            FurnitureKind::Bin => Self::Bin,
            FurnitureKind::Bollard => Self::Bollard,
            FurnitureKind::Debris => Self::Debris,
            FurnitureKind::Hydrant => Self::Hydrant,
            FurnitureKind::PushablePullable => Self::PushablePullable,
            FurnitureKind::Shelter => Self::Shelter,
            FurnitureKind::StreetFurniture => Self::StreetFurniture,
            FurnitureKind::TrafficCone => Self::TrafficCone,
            FurnitureKind::UtilityPole => Self::UtilityPole,
        }
    }
}

/// Shapes of one finish.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct PartPlan {
    finish: Finish,
    /// The first is the colour of the finish; where there are more, every copy of the thing has one of them.
    #[serde(default)]
    colors: Vec<[f32; 3]>,
    shapes: Vec<ShapePlan>,
}

/// What a part is made of. What can have any colour has to be given one.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize)]
#[serde(rename_all = "snake_case")]
pub(super) enum Finish {
    BoardMarkedConcrete,
    Brick,
    Cloth,
    Concrete,
    Dark,
    Galvanised,
    Glass,
    GreyTimber,
    Painted,
    Plastic,
    Reflective,
    Rubber,
    Rubble,
    Rusty,
    Stainless,
    Tarpaulin,
    Timber,
    WeatheredConcrete,
}

impl Finish {
    /// Whether it has a colour of its own.
    fn is_coloured(self) -> bool {
        !matches!(self, Self::Cloth | Self::Painted | Self::Plastic | Self::Reflective | Self::Tarpaulin)
    }

    /// The material, in a colour where the finish has none.
    pub(super) fn material(self, color: Vec3) -> Material {
        match self {
            Self::BoardMarkedConcrete => surfaces::set("concrete/board-marked"),
            Self::Brick => surfaces::set("brick/flemish"),
            Self::Cloth => cloth(color),
            Self::Concrete => concrete(),
            Self::Dark => dark(),
            Self::Galvanised => galvanised(),
            Self::Glass => glass(),
            Self::GreyTimber => grey_timber(),
            Self::Painted => painted(color),
            Self::Plastic => plastic(color),
            Self::Reflective => reflective(color),
            Self::Rubber => rubber(),
            Self::Rubble => surfaces::set("stone/rubble"),
            Self::Rusty => rusty(),
            Self::Stainless => stainless(),
            Self::Tarpaulin => tarpaulin(color),
            Self::Timber => timber(),
            Self::WeatheredConcrete => surfaces::set("concrete/weathered"),
        }
    }
}

/// A simple shape.
#[derive(Clone, Debug, Deserialize)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
enum ShapePlan {
    /// A profile of [radius, height] that is turned around the vertical, with so many sides.
    Turned { profile: Vec<[f32; 2]>, around: usize },
    /// A box with its middle at a point, its edges a little rounded.
    Bar { at: [f32; 3], size: [f32; 3] },
    /// The same of timber: the grain runs along its longest side.
    Board { at: [f32; 3], size: [f32; 3] },
    /// A box with its edges rounded by a radius.
    Block { at: [f32; 3], size: [f32; 3], round: f32 },
    /// An upright cylinder on a point.
    Post { foot: [f32; 3], radius: f32, height: f32, around: usize },
    /// A tube along a line.
    Tube { path: Vec<[f32; 3]>, radius: f32, around: usize },
}

impl ShapePlan {
    fn shape(&self) -> Shape {
        match self {
            Self::Turned { profile, around } => {
                Shape::lathe(&profile.iter().copied().map(Vec2::from_array).collect::<Vec<_>>(), *around)
            }
            Self::Bar { at, size } => bar((*at).into(), (*size).into()),
            Self::Board { at, size } => board((*at).into(), (*size).into()),
            Self::Block { at, size, round } => Shape::rounded_block((*size).into(), *round).moved((*at).into()),
            Self::Post { foot, radius, height, around } => post((*foot).into(), *radius, *height, *around),
            Self::Tube { path, radius, around } => {
                Shape::tube(&path.iter().copied().map(Vec3::from_array).collect::<Vec<_>>(), *radius, *around)
            }
        }
    }

    fn check(&self) -> Result<(), Wrong> {
        let near = |points: &mut dyn Iterator<Item = &f32>| {
            within("parts.shapes", "points within 20 metres", -20.0..=20.0, points)
        };
        let thick = |sizes: &[f32]| within("parts.shapes", "sizes from 0.001 to 20 metres", 0.001..=20.0, sizes);
        let around = |n: usize| match n {
            3..=64 => Ok(()),
            _ => wrong("parts.shapes", "from 3 to 64 sides around", &n),
        };
        let line = |n: usize| match n {
            2..=200 => Ok(()),
            _ => wrong("parts.shapes", "lines of 2 to 200 points", &n),
        };
        match self {
            Self::Turned { profile, around: sides } => {
                line(profile.len()).and(around(*sides)).and(near(&mut profile.iter().flatten()))?;
                within("parts.shapes", "radii that are not negative", 0.0..=20.0, profile.iter().map(|[r, _]| r))
            }
            Self::Bar { at, size } | Self::Board { at, size } => near(&mut at.iter()).and(thick(size)),
            Self::Block { at, size, round } => {
                let half = size.iter().fold(f32::INFINITY, |least, side| least.min(side / 2.0));
                near(&mut at.iter()).and(thick(size))?;
                within("parts.shapes", "a radius of at most half the shortest side", 0.0..=half, [round])
            }
            Self::Post { foot, radius, height, around: sides } => {
                near(&mut foot.iter()).and(thick(&[*radius, *height])).and(around(*sides))
            }
            Self::Tube { path, radius, around: sides } => {
                line(path.len()).and(around(*sides)).and(thick(&[*radius]))?;
                near(&mut path.iter().flatten())
            }
        }
    }
}

impl FurniturePlan {
    /// The key of a value that nothing can be built from, with what was expected and what it is.
    pub(crate) fn check(&self) -> Result<(), Wrong> {
        within("commonness", "a number from 0 to 1000", 0.0..=1000.0, [&self.commonness])?;
        let shapes = || self.parts.iter().flat_map(|part| &part.shapes);
        if !(1..=400).contains(&shapes().count()) || self.parts.len() > 40 {
            let found = format!("{} parts with {} shapes", self.parts.len(), shapes().count());
            return wrong("parts", "at most 40 parts with 1 to 400 shapes", &found);
        }
        for part in &self.parts {
            if part.colors.is_empty() && !part.finish.is_coloured() {
                return wrong("parts.colors", "a colour for this finish", &part.finish);
            }
            within("parts.colors", "linear RGB from 0 to 1", 0.0..=1.0, part.colors.iter().flatten())?;
        }
        shapes().try_for_each(ShapePlan::check)
    }

    /// What it tells of.
    pub(crate) fn asset(&self) -> Asset {
        let mut model = Model::default();
        let slots: Vec<u16> = self
            .parts
            .iter()
            .map(|part| {
                let colors: Vec<Vec3> = part.colors.iter().copied().map(Vec3::from_array).collect();
                let material = part.finish.material(colors.first().copied().unwrap_or(Vec3::ONE));
                model.slot(material, if colors.len() > 1 { &colors } else { &[] })
            })
            .collect();
        for (part, slot) in self.parts.iter().zip(slots) {
            part.shapes.iter().for_each(|shape| model.add(slot, shape.shape()));
        }
        let kind = Kind::from(self.kind);
        let asset = model.asset(&self.id, kind, kind.class());
        Asset { commonness: self.commonness, ..asset }.tagged(&self.tags)
    }
}
