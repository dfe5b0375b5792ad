//! How well a street map and a drive agree, and the small correction that lays one on the other; and what a drive tells of
//! its streets where there is no map.

mod assumed;
mod correction;
mod evidence;
mod fit;
mod walls;

use glam::DVec2;
use trove_model::{Bounds, Drive, DrivingSide, Outcome, Report, StreetMap};

use crate::geometry::segments::SegmentIndex;
pub(crate) use assumed::{assumed, has_houses};
use evidence::{Evidence, Movable, Pulls};
use fit::{Fit, fit, median_m};

/// Further away than this is no road of that lane, metres: the distance counts as this much.
const REACH_M: f64 = 200.0;
/// Steps along lines, metres.
const STEP_M: f64 = 2.0;
/// Above this, map and drive do not lie on each other, metres.
const LIMIT_M: f64 = 5.0;

/// What becomes of a street map that does not lie on the drive even after the correction.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum OnDisagreement {
    /// It is used all the same, with a warning.
    Warn,
    /// Only its buildings are used.
    #[default]
    BuildingsOnly,
    /// It is not used.
    Refuse,
}

/// The map as it is to be built: moved by the rigid correction that lays it on the drive, where the recording asks for one
/// clearly; `None` where it is refused. Distances before and after and the correction go into the report.
pub fn agreed(
    drive: &Drive,
    map: &StreetMap,
    driving_side: DrivingSide,
    bounds: Bounds,
    on_disagreement: OnDisagreement,
    report: &Report,
) -> Option<StreetMap> {
    let (evidence, movable) = (Evidence::new(drive, driving_side, bounds), Movable::new(map));
    let corrected = match fit(&evidence, &movable) {
        Fit::Stays => map.clone(),
        Fit::Moves(correction) => {
            Offsets::new(drive, map, bounds, &evidence).measure("map.before_correction.", report);
            report.measure("map.correction.east_m", correction.shift_m.x);
            report.measure("map.correction.north_m", correction.shift_m.y);
            report.measure("map.correction.turn_deg", correction.turn_rad.to_degrees());
            correction.corrected(map)
        }
        Fit::TooFar(correction) => {
            let example = format!("{}: by {:.1} m", drive.id, correction.shift_m.length());
            report.note(Outcome::Warned, "street map that would need too large a shift", example);
            map.clone()
        }
    };
    let offsets = Offsets::new(drive, &corrected, bounds, &evidence);
    offsets.measure("map.", report);
    if offsets.path_to_road_m.is_none() {
        report.note(Outcome::Warned, "street map has no road for cars around the drive", &drive.id);
    }
    if offsets.agree() {
        return Some(corrected);
    }
    let what = "street map and drive do not match";
    match on_disagreement {
        OnDisagreement::Warn => report.note(Outcome::Warned, what, &drive.id),
        OnDisagreement::BuildingsOnly => {
            report.note(Outcome::Dropped, &format!("everything except buildings: {what}"), &drive.id)
        }
        OnDisagreement::Refuse => report.note(Outcome::Dropped, &format!("the whole map: {what}"), &drive.id),
    }
    match on_disagreement {
        OnDisagreement::Warn => Some(corrected),
        OnDisagreement::BuildingsOnly => {
            Some(StreetMap { buildings: corrected.buildings, licence: corrected.licence, ..StreetMap::default() })
        }
        OnDisagreement::Refuse => None,
    }
}

/// How far map and drive lie apart: medians, metres; `None` where there is nothing to compare.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Offsets {
    /// From the driven path to the nearest road for cars.
    path_to_road_m: Option<f64>,
    /// From the dataset's lane centres to the nearest road for cars.
    lane_to_road_m: Option<f64>,
    /// From roads to the middle of the lanes on them.
    road_m: Option<f64>,
    /// From walls that the LiDAR saw to the outlines of buildings.
    facade_m: Option<f64>,
}

impl Offsets {
    fn new(drive: &Drive, map: &StreetMap, bounds: Bounds, evidence: &Evidence) -> Self {
        let identity = correction::Correction::identity(evidence.middle());
        let Pulls { roads, facades, .. } = evidence.pulls(&Movable::new(map), &identity);
        let lines = map.roads.iter().filter(|r| r.kind.is_for_cars()).map(|r| r.centreline.as_slice());
        let index = SegmentIndex::new(lines.clone());
        let is_there = lines.flat_map(|line| line.windows(2)).next().is_some();
        let path: Vec<DVec2> = drive.keyframes.iter().map(|k| k.world_from_ego.translation.truncate()).collect();
        let lanes = drive.lane_map.iter().flat_map(|m| &m.lanes);
        let centres = lanes.flat_map(|lane| {
            if lane.centreline.len() > 1 { steps(&lane.centreline) } else { vec![lane.polygon.centroid()] }
        });
        let centres: Vec<DVec2> = centres.filter(|p| bounds.contains(*p)).collect();
        Self {
            path_to_road_m: is_there.then(|| median_distance_m(&index, &path)).flatten(),
            lane_to_road_m: is_there.then(|| median_distance_m(&index, &centres)).flatten(),
            road_m: median_m(&roads),
            facade_m: median_m(&facades),
        }
    }

    fn agree(&self) -> bool {
        [self.path_to_road_m, self.lane_to_road_m].iter().flatten().all(|&distance_m| distance_m <= LIMIT_M)
    }

    fn measure(&self, prefix: &str, report: &Report) {
        let rows = [
            ("path_to_road_median_m", self.path_to_road_m),
            ("lane_to_road_median_m", self.lane_to_road_m),
            ("road_offset_median_m", self.road_m),
            ("facade_offset_median_m", self.facade_m),
        ];
        for (name, value) in rows {
            if let Some(value_m) = value {
                report.measure(&format!("{prefix}{name}"), value_m);
            }
        }
    }
}

/// Points along a line.
fn steps(line: &[DVec2]) -> Vec<DVec2> {
    let mut points = Vec::new();
    for pair in line.windows(2) {
        let count = (pair[0].distance(pair[1]) / STEP_M).ceil().max(1.0);
        points.extend((0..count as usize).map(|i| pair[0].lerp(pair[1], i as f64 / count)));
    }
    points
}

fn median_distance_m(index: &SegmentIndex, points: &[DVec2]) -> Option<f64> {
    let distance_m = |p: &DVec2| index.nearest(*p, REACH_M).map_or(REACH_M, |n| n.distance_m);
    let mut distances_m: Vec<f64> = points.iter().map(distance_m).collect();
    distances_m.sort_by(f64::total_cmp);
    distances_m.get(distances_m.len() / 2).copied()
}

#[cfg(test)]
mod tests;
