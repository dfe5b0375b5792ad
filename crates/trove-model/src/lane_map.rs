//! A dataset's own map of the road.

use glam::{DVec2, DVec3};

use crate::{Paint, Polygon};

/// A lane of a dataset's map.
#[derive(Clone, Debug, PartialEq)]
pub struct Lane {
    /// The dataset's own name of it.
    pub token: String,
    /// Surface.
    pub polygon: Polygon,
    /// Centre line in driving direction; empty where the map has none.
    pub centreline: Vec<DVec2>,
}

/// A painted line of a dataset's map.
#[derive(Clone, Debug, PartialEq)]
pub struct LaneMark {
    /// Along its middle.
    pub line: Vec<DVec2>,
    /// Its paint.
    pub paint: Paint,
    /// Its pattern, the left side first as seen along the line.
    pub pattern: MarkPattern,
}

/// The pattern of a painted line.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[allow(missing_docs)] // the names are the definition
pub enum MarkPattern {
    Solid,
    Dashed,
    DoubleSolid,
    DoubleDashed,
    SolidDashed,
    DashedSolid,
}

impl MarkPattern {
    /// All of them.
    pub const ALL: [Self; 6] =
        [Self::Solid, Self::Dashed, Self::DoubleSolid, Self::DoubleDashed, Self::SolidDashed, Self::DashedSolid];

    /// Its name in files (`double_solid`).
    pub fn name(self) -> &'static str {
        match self {
            Self::Solid => "solid",
            Self::Dashed => "dashed",
            Self::DoubleSolid => "double_solid",
            Self::DoubleDashed => "double_dashed",
            Self::SolidDashed => "solid_dashed",
            Self::DashedSolid => "dashed_solid",
        }
    }
}

/// What a dataset's map says around a drive, in World's plane.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct LaneMap {
    /// Where vehicles can drive.
    pub drivable: Vec<Polygon>,
    /// Lanes.
    pub lanes: Vec<Lane>,
    /// Walkways.
    pub walkways: Vec<Polygon>,
    /// Pedestrian crossings.
    pub crossings: Vec<Polygon>,
    /// Stop lines.
    pub stop_lines: Vec<Polygon>,
    /// Parking areas.
    pub carparks: Vec<Polygon>,
    /// Lines between directions of traffic.
    pub road_dividers: Vec<Vec<DVec2>>,
    /// Lines between lanes of one direction.
    pub lane_dividers: Vec<Vec<DVec2>>,
    /// Painted lines, where the map knows their paint; those that are above have none here.
    pub marks: Vec<LaneMark>,
    /// Points of the ground, metres, where the map has its height: of the carriageway in drivable areas, of what lies behind
    /// the kerb beside them.
    pub ground: Vec<DVec3>,
}

impl LaneMap {
    /// Moves every point of it in plane.
    pub(crate) fn move_points(&mut self, moved: impl Fn(DVec2) -> DVec2) {
        let Self {
            drivable,
            lanes,
            walkways,
            crossings,
            stop_lines,
            carparks,
            road_dividers,
            lane_dividers,
            marks,
            ground,
        } = self;
        let (lane_polygons, centrelines): (Vec<_>, Vec<_>) =
            lanes.iter_mut().map(|lane| (&mut lane.polygon, &mut lane.centreline)).unzip();
        let areas = [drivable, walkways, crossings, stop_lines, carparks].into_iter().flatten().chain(lane_polygons);
        let rings = areas.flat_map(|area| std::iter::once(&mut area.exterior).chain(&mut area.holes));
        let lines = road_dividers.iter_mut().chain(lane_dividers).chain(centrelines);
        let lines = lines.chain(marks.iter_mut().map(|mark| &mut mark.line));
        rings.chain(lines).flatten().for_each(|p| *p = moved(*p));
        ground.iter_mut().for_each(|p| *p = moved(p.truncate()).extend(p.z));
    }
}
