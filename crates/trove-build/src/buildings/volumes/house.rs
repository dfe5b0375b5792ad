//! A building that is to be built: its volumes, and what stands beside each of their sides.

use trove_model::{Asset, Building, BuildingCustoms, BuildingKind, Polygon, RoofShape};

use crate::buildings::bays::Bays;

/// Ids of buildings that are on no map start here, far below those of any relation.
pub(in crate::buildings) const FIRST_UNMAPPED_ID: i64 = i64::MIN / 2;
/// A side is covered if this share of its length is.
const COVERED_SHARE: f64 = 0.6;
/// Height of a storey that is not measured.
pub(in crate::buildings) const STOREY_M: f64 = 3.2;
/// Ground that is left of a building must be at least this much to be built on, m².
pub(super) const LEAST_M2: f64 = 4.0;
/// Thickness of a canopy's slab, metres.
pub(super) const CANOPY_THICK_M: f64 = 0.45;
/// Nothing is told apart further from the driven path, metres.
pub(super) const FAR_M: f64 = 400.0;
/// A prism of a building.
#[derive(Clone, Debug)]
pub(in crate::buildings) struct Volume<'a> {
    pub building: &'a Building,
    pub footprint: Polygon,
    /// Above the floor of the house, metres.
    pub bottom_m: f64,
    /// Where the roof starts.
    pub eaves_m: f64,
    pub top_m: f64,
    pub roof: RoofShape,
    /// What stands beside each of the footprint's edges, in the order of [`Polygon::edges`].
    pub sides: Vec<Beside>,
    /// Another volume stands on it: no parapet, and nothing on its roof.
    pub is_built_on: bool,
    /// Roof without walls.
    pub is_canopy: bool,
    /// Feet of a canopy's posts.
    pub posts: Vec<glam::DVec2>,
}

impl<'a> Volume<'a> {
    /// Still without footprint and surroundings.
    pub(in crate::buildings) fn new(
        building: &'a Building,
        bottom_m: f64,
        eaves_m: f64,
        top_m: f64,
        roof: RoofShape,
    ) -> Self {
        Self {
            building,
            footprint: Polygon::default(),
            bottom_m,
            eaves_m,
            top_m,
            roof,
            sides: Vec::new(),
            is_built_on: false,
            is_canopy: false,
            posts: Vec::new(),
        }
    }
}

/// One building: an outline, or the parts that stand for it.
#[derive(Clone, Debug)]
pub(in crate::buildings) struct House<'a> {
    pub building: &'a Building,
    pub volumes: Vec<Volume<'a>>,
    /// World height of its floor: the lowest ground around it, and a kerb.
    pub floor_m: f64,
    /// From the driven path, metres; [`FAR_M`] where it is further.
    pub path_m: f64,
    pub customs: &'a BuildingCustoms,
    /// What stands there in place of its volumes.
    pub model: Option<Model<'a>>,
}

/// A model that stands for a building.
#[derive(Clone, Copy, Debug)]
pub(in crate::buildings) struct Model<'a> {
    pub asset: &'a Asset,
    pub bays: Bays,
    pub world_from_mesh: glam::DAffine3,
}

#[cfg(test)]
impl<'a> House<'a> {
    /// On level ground at 0, far from the path and from everything else.
    pub(in crate::buildings) fn alone(building: &'a Building, volumes: Vec<Volume<'a>>) -> Self {
        let customs = crate::testing::building_customs("KE");
        Self { building, volumes, floor_m: 0.0, path_m: FAR_M, customs, model: None }
    }
}

/// `osm way 12`; `unmapped building 3` for one that is on no map.
pub(in crate::buildings) fn name(building: &Building) -> String {
    if building.id < FIRST_UNMAPPED_ID / 2 {
        return format!("unmapped building {}", building.id - FIRST_UNMAPPED_ID);
    }
    if building.id < 0 { format!("osm relation {}", -building.id) } else { format!("osm way {}", building.id) }
}

/// The kind that tells most: a part's own, else its building's.
pub(super) fn kind(source: &Building, whole: &Building) -> Option<BuildingKind> {
    source.kind.or(whole.kind)
}

/// What stands beside one edge of a footprint.
#[derive(Clone, Debug, Default, PartialEq)]
pub(in crate::buildings) struct Beside {
    /// Stretches of the edge that another wall hides.
    pub covers: Vec<Cover>,
    /// Length of the edge, metres.
    pub length_m: f64,
    /// Free distance before the edge, of which the half belongs to it, metres, at most 0.8.
    pub room_m: f64,
}

/// A stretch of an edge that another wall hides from the ground, or from the bottom of the volume, up.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::buildings) struct Cover {
    /// From the start of the edge, metres.
    pub from_m: f64,
    pub to_m: f64,
    /// Up to this level above the house's floor.
    pub up_to_m: f64,
}

impl Beside {
    /// Whether most of the edge is hidden nearly up to a level above the floor.
    pub(in crate::buildings) fn is_covered(&self, level_m: f64) -> bool {
        let hidden = self.covers.iter().filter(|c| c.up_to_m > level_m - 2.5);
        hidden.map(|c| c.to_m - c.from_m).sum::<f64>() > COVERED_SHARE * self.length_m
    }
}
