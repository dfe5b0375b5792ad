//! What the page loads of a scene, once it is looked at: lanes, who is where, shapes.

use std::collections::BTreeMap;

use serde::{Serialize, Serializer};
use trove_format::{LanesFile, ObjectOrigin, ObjectRow, TrajectoryFile};

use super::pose::{Pose, pose_of_rows};
use super::shapes::Shapes;

type Line = Vec<[f64; 3]>;

#[derive(Default, Serialize)]
pub(super) struct SceneChunk {
    lanes: Vec<Line>,
    lines: Vec<Line>,
    kerbs: Vec<Line>,
    way: Line,
    /// Who moves, moment by moment.
    pub(super) moments: Vec<Things>,
    /// What stands still.
    pub(super) scenery: Things,
    pub(super) shapes: Option<Shapes>,
}

/// Boxes of a moment, by their numbers in the labels.
#[derive(Default)]
pub(super) struct Things(BTreeMap<u32, Thing>);

/// A box in the scene.
#[derive(Serialize)]
pub(super) struct Thing {
    pub(super) id: u32,
    pub(super) class_id: u8,
    pub(super) kind: &'static str,
    pub(super) origin: ObjectOrigin,
    pub(super) asset: String,
    pub(super) pose: Pose,
    pub(super) size: [f64; 3],
}

/// An object in an image.
#[derive(Serialize)]
pub(super) struct Seen {
    id: u32,
    class_id: u8,
    kind: &'static str,
    asset: String,
    category: String,
    #[serde(rename = "box")]
    visible_box: Option<[u32; 4]>,
    range_m: f32,
    visible_px: u32,
    occlusion: f32,
    states: Vec<&'static str>,
}

impl SceneChunk {
    pub(super) fn set_lanes(&mut self, file: LanesFile) {
        let LanesFile { lanes, lines, kerbs, .. } = file;
        self.lanes = lanes.into_iter().map(|lane| short(lane.centreline_m)).collect();
        self.lines = lines.into_iter().map(|line| short(line.points_m)).collect();
        self.kerbs = kerbs.into_iter().map(|kerb| short(kerb.points_m)).collect();
    }

    /// A box of the last moment.
    pub(super) fn add(&mut self, thing: Thing) {
        match self.moments.last_mut().filter(|_| thing.origin != ObjectOrigin::Scenery) {
            Some(moment) => moment.add(thing),
            None => self.scenery.add(thing),
        }
    }

    pub(super) fn set_way(&mut self, file: &TrajectoryFile) {
        self.way = file.moments.iter().map(|moment| moment.pose.world_from_ego_translation_m).collect();
    }
}

impl Things {
    /// Another box; of an object of several parts the first counts.
    pub(super) fn add(&mut self, thing: Thing) {
        self.0.entry(thing.id).or_insert(thing);
    }
}

impl From<&ObjectRow> for Thing {
    fn from(row: &ObjectRow) -> Self {
        Self {
            id: row.id,
            class_id: row.class_id,
            kind: row.kind.name(),
            origin: row.origin,
            asset: row.asset.clone(),
            pose: pose_of_rows(&row.world_from_body),
            size: row.size_m.map(centimetres),
        }
    }
}

impl Serialize for Things {
    fn serialize<S: Serializer>(&self, to: S) -> Result<S::Ok, S::Error> {
        to.collect_seq(self.0.values())
    }
}

impl Seen {
    pub(super) fn of(row: &ObjectRow) -> Self {
        Self {
            id: row.id,
            class_id: row.class_id,
            kind: row.kind.name(),
            asset: row.asset.clone(),
            category: row.category.clone(),
            visible_box: row.visible_box,
            range_m: row.range_m,
            visible_px: row.visible_px,
            occlusion: row.occlusion,
            states: row.states.iter().map(|state| state.name()).collect(),
        }
    }
}

fn short(points: Line) -> Line {
    points.into_iter().map(|point| point.map(centimetres)).collect()
}

pub(super) fn centimetres(value: f64) -> f64 {
    (value * 100.0).round() / 100.0
}
