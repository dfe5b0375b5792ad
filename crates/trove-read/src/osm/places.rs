//! Where a file's nodes are in World.

use glam::DVec2;
use trove_model::{Bounds, DrivingSide, MapProjection};

use super::clip::{line_within, ring_within};
use super::effort::Effort;
use super::raw::{Raw, RawNode};

/// How far from the area roads and other lines are kept, metres: nothing beyond is built.
const REACH_M: f64 = 1000.0;
/// How far from the area outlines are kept, metres: those of buildings that touch it stay whole.
const RING_REACH_M: f64 = 5000.0;

/// Where nodes are in World, and what part of it is wanted.
pub(super) struct Places<'a> {
    pub nodes: &'a [RawNode],
    pub world: Vec<DVec2>,
    pub area: Bounds,
    pub driving_side: DrivingSide,
    pub effort: Effort,
}

impl<'a> Places<'a> {
    pub(super) fn new(raw: &'a Raw, projection: &MapProjection, area: Bounds, driving_side: DrivingSide) -> Self {
        let world = raw.nodes.iter().map(|n| projection.world_from_geo(n.lat_deg, n.lon_deg)).collect();
        Self { nodes: &raw.nodes, world, area, driving_side, effort: Effort::default() }
    }

    /// A node's position; `None` where it is not in the file.
    pub(super) fn of(&self, id: i64) -> Option<DVec2> {
        self.nodes.binary_search_by_key(&id, |n| n.id).ok().map(|i| self.world[i])
    }

    /// The pieces of a line near the area: a way may well lead around the world.
    pub(super) fn near(&self, line: &[DVec2]) -> Vec<Vec<DVec2>> {
        let near = line_within(line, self.area.grown(REACH_M));
        near.into_iter().filter(|piece| piece.len() > 1 && self.touched_by(piece)).collect()
    }

    /// Whether outlines still have this corner after [`Places::near_ring`].
    pub(super) fn keeps(&self, corner: DVec2) -> bool {
        self.area.grown(RING_REACH_M).contains(corner)
    }

    /// An outline, cut where it reaches far beyond the area.
    pub(super) fn near_ring(&self, ring: &[DVec2]) -> Vec<DVec2> {
        ring_within(ring, self.area.grown(RING_REACH_M))
    }

    /// Whether the rectangle around some points shares a point with the area.
    pub(super) fn touched_by(&self, points: &[DVec2]) -> bool {
        Bounds::around(points.iter().copied()).is_some_and(|bounds| bounds.overlaps(&self.area))
    }
}
