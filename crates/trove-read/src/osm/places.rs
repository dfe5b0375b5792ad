//! Where a file's nodes are in World.

use glam::DVec2;
use trove_model::{Bounds, DrivingSide, MapProjection};

use super::raw::{Raw, RawNode};

/// Where nodes are in World, and what part of it is wanted.
pub(super) struct Places<'a> {
    pub nodes: &'a [RawNode],
    pub world: Vec<DVec2>,
    pub area: Bounds,
    pub driving_side: DrivingSide,
}

impl<'a> Places<'a> {
    pub(super) fn new(raw: &'a Raw, projection: &MapProjection, area: Bounds, driving_side: DrivingSide) -> Self {
        let world = raw.nodes.iter().map(|n| projection.world_from_geo(n.lat_deg, n.lon_deg)).collect();
        Self { nodes: &raw.nodes, world, area, driving_side }
    }

    /// A node's position; `None` where it is not in the file.
    pub(super) fn of(&self, id: i64) -> Option<DVec2> {
        self.nodes.binary_search_by_key(&id, |n| n.id).ok().map(|i| self.world[i])
    }

    /// Whether the rectangle around some points shares a point with the area.
    pub(super) fn touched_by(&self, points: &[DVec2]) -> bool {
        Bounds::around(points.iter().copied()).is_some_and(|bounds| bounds.overlaps(&self.area))
    }
}
