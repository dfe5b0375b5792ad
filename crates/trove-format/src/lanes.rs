//! `lanes.json`: lanes and painted lines of a scene's roads.

use std::path::Path;

use glam::{DVec2, DVec3};
use serde::{Deserialize, Serialize};
use trove_model::{Drive, LaneUsage, MarkPattern, Paint, RoadPlan};

use crate::{FormatError, Projection, file, names, rows};

/// What lies farther from the driven path is not told, metres.
const NEAR_M: f64 = 150.0;

/// The whole of `lanes.json`. World is x east, y north, z up, metres.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct LanesFile {
    /// The drive (`scene-0103`).
    pub scene: String,
    /// The dataset (`nuscenes`).
    pub dataset: String,
    /// From latitude and longitude to World.
    pub projection: Projection,
    /// Lanes within 150 m of the driven path.
    pub lanes: Vec<LaneRow>,
    /// Lines painted along lanes, likewise.
    pub lines: Vec<LineRow>,
    /// Kerbs, likewise.
    #[serde(default)]
    pub kerbs: Vec<KerbRow>,
}

/// A lane.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct LaneRow {
    /// Its number in the scene, from 1.
    pub id: u32,
    /// What it is for.
    #[serde(with = "names::lane_usage")]
    #[cfg_attr(test, schemars(schema_with = "names::lane_usage::schema"))]
    pub usage: LaneUsage,
    /// From edge to edge, metres.
    pub width_m: f64,
    /// Its middle on the road, World, in the direction in which it is driven.
    pub centreline_m: Vec<[f64; 3]>,
}

/// A painted line, or two side by side.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct LineRow {
    /// Its number in the scene, from 1.
    pub id: u32,
    /// Its paint.
    #[serde(with = "names::paint")]
    #[cfg_attr(test, schemars(schema_with = "names::paint::schema"))]
    pub paint: Paint,
    /// Its pattern, the left side first as seen along the points.
    #[serde(with = "names::mark_pattern")]
    #[cfg_attr(test, schemars(schema_with = "names::mark_pattern::schema"))]
    pub pattern: MarkPattern,
    /// Width of one line, metres.
    pub width_m: f64,
    /// Its middle on the paint, World; along dashes and gaps alike.
    pub points_m: Vec<[f64; 3]>,
}

/// The edge of a carriageway along a kerb.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct KerbRow {
    /// Its number in the scene, after those of the lines.
    pub id: u32,
    /// Along the foot of the stones, World, with the carriageway on the left.
    pub points_m: Vec<[f64; 3]>,
}

impl LanesFile {
    /// The file's name.
    pub const NAME: &str = "lanes.json";

    /// Of a drive through a place with these roads.
    pub fn new(drive: &Drive, roads: &RoadPlan) -> Self {
        let path: Vec<DVec2> = drive.keyframes.iter().map(|k| k.world_from_ego.translation.truncate()).collect();
        let is_near = |p: &DVec3| path.iter().any(|q| q.distance(p.truncate()) < NEAR_M);
        let near = |points: &[DVec3]| points.iter().any(is_near);
        // To the millimetre.
        let rounded = |m: f64| (m * 1e3).round() / 1e3;
        let told = |points: &[DVec3]| points.iter().map(|p| p.to_array().map(rounded)).collect();
        let lanes = (1..).zip(&roads.lanes).filter(|(_, lane)| near(&lane.centreline)).map(|(id, lane)| LaneRow {
            id,
            usage: lane.usage,
            width_m: rounded(lane.width_m),
            centreline_m: told(&lane.centreline),
        });
        let lines = (1..).zip(&roads.lines).filter(|(_, line)| near(&line.points)).map(|(id, line)| LineRow {
            id,
            paint: line.paint,
            pattern: line.pattern,
            width_m: rounded(line.width_m),
            points_m: told(&line.points),
        });
        // Kerbs run around whole blocks: the parts of each that are near.
        let parts = roads.kerbs.iter().flat_map(|kerb| kerb.chunk_by(|a, b| is_near(a) == is_near(b)));
        let kerbs = (1 + roads.lines.len() as u32..).zip(parts.filter(|part| is_near(&part[0]) && part.len() > 1));
        Self {
            scene: drive.id.clone(),
            dataset: drive.dataset.clone(),
            projection: (&drive.projection).into(),
            lanes: lanes.collect(),
            lines: lines.collect(),
            kerbs: kerbs.map(|(id, part)| KerbRow { id, points_m: told(part) }).collect(),
        }
    }

    /// Reads it from the folder of a variation.
    ///
    /// # Errors
    /// A file that cannot be read or is damaged.
    pub fn read(folder: &Path) -> Result<Self, FormatError> {
        let path = folder.join(Self::NAME);
        file::parsed(&path, &file::bytes(&path)?, "the lanes that trove generate wrote")
    }

    /// The file's bytes: one line a field and one line a lane or painted line.
    pub fn to_json(&self) -> Vec<u8> {
        rows::bytes(self)
    }
}
