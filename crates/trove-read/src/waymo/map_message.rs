//! v1's `MapFeature` → records.

use glam::{DVec2, DVec3};

use super::fault::Unusable;
use super::records::{MapFeature, MapForm};
use crate::protobuf::{Fields, Malformed, doubles};
use trove_files::Budget;

/// `LaneCenter.LaneType`.
const BIKE_LANE: u64 = 3;
/// `RoadLine.RoadLineType` from which on lines are yellow: they part directions of traffic.
const FIRST_YELLOW: u64 = 4;

/// Reads a feature.
pub(super) fn feature(message: &[u8], budget: &Budget) -> Result<MapFeature, Unusable> {
    let mut feature = MapFeature { id: 0, form: MapForm::Other };
    for field in Fields::new(message) {
        let (number, value) = field?;
        match number {
            1 => feature.id = value.varint()? as i64,
            3 => {
                let (kind, line) = typed_line(value.bytes()?, 2, 8, budget)?;
                feature.form = MapForm::Lane { is_for_bicycles: kind == BIKE_LANE, line };
            }
            4 => {
                let (kind, line) = typed_line(value.bytes()?, 1, 2, budget)?;
                feature.form = MapForm::RoadLine { is_between_directions: kind >= FIRST_YELLOW, line };
            }
            5 => feature.form = MapForm::RoadEdge(typed_line(value.bytes()?, 1, 2, budget)?.1),
            8 => feature.form = MapForm::Crosswalk(typed_line(value.bytes()?, 0, 1, budget)?.1),
            10 => feature.form = MapForm::Driveway(typed_line(value.bytes()?, 0, 1, budget)?.1),
            _ => {}
        }
    }
    Ok(feature)
}

/// The type and the points that stand in two fields of a message.
fn typed_line(message: &[u8], kind_at: u32, line_at: u32, budget: &Budget) -> Result<(u64, Vec<DVec2>), Unusable> {
    let (mut kind, mut line) = (0, Vec::new());
    for field in Fields::new(message) {
        let (number, value) = field?;
        if number == kind_at {
            kind = value.varint()?;
        } else if number == line_at {
            budget.take(1, 2 * size_of::<DVec2>())?;
            line.push(point(value.bytes()?)?.truncate());
        }
    }
    Ok((kind, line))
}

/// A `MapPoint` or `Vector3d`.
pub(super) fn point(message: &[u8]) -> Result<DVec3, Malformed> {
    Ok(DVec3::from_array(doubles(message, [1, 2, 3])?.map(|v| v.unwrap_or(0.0))))
}
