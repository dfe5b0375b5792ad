//! Rows that nuScenes and nuImages share: sensors, poses, logs, attributes, and the tokens by which rows name each other.

use glam::{DAffine3, DVec3};
use serde_json::{Value, json};
use trove_format::{FrameTable, ObjectRow};
use trove_model::{Kind, State};

use super::geometry::{affine, quaternion_wxyz};
use super::unit::Unit;
use crate::files;

/// Folder of the tables, and the version that the devkit is asked for.
pub(crate) const VERSION: &str = "v1.0-trove";
/// Slower than this, a road user stands.
pub(crate) const STANDS_MPS: f64 = State::STANDS_MPS;

/// nuScenes' attributes.
pub(crate) const ATTRIBUTES: [&str; 8] = [
    "vehicle.moving",
    "vehicle.stopped",
    "vehicle.parked",
    "cycle.with_rider",
    "cycle.without_rider",
    "pedestrian.sitting_lying_down",
    "pedestrian.standing",
    "pedestrian.moving",
];

/// The camera's name without its vehicle's.
pub(crate) fn channel(view: &str) -> &str {
    view.split_once('.').map_or(view, |(_, channel)| channel)
}

/// The pose of the vehicle that carries a frame's camera; without one the frame is left out, and counted.
pub(crate) fn world_from_ego(table: &FrameTable, unit: &mut Unit<'_>) -> Option<DAffine3> {
    if table.world_from_ego.is_none() {
        unit.clip("frames left out, whose camera has no vehicle with a known pose", 1);
    }
    table.world_from_ego.as_ref().map(affine)
}

/// A row's name: the same for the same thing in every export.
pub(crate) fn token(table: &str, name: &str) -> String {
    files::sha256(format!("{table}/{name}").as_bytes())[..32].to_owned()
}

/// From World to the dataset's own plane, where nuScenes' maps lie.
pub(crate) fn in_plane(table: &FrameTable, world_from_any: &DAffine3) -> DAffine3 {
    let [x, y] = table.projection.anchor_m;
    DAffine3::from_translation(DVec3::new(x, y, 0.0)) * *world_from_any
}

/// Rows of a table of names.
pub(crate) fn named_rows(table: &str, names: &[&str]) -> Vec<Value> {
    names.iter().map(|name| json!({ "token": token(table, name), "name": name, "description": "" })).collect()
}

/// The row of a sensor.
pub(crate) fn sensor(channel: &str, modality: &str) -> Value {
    json!({ "token": token("sensor", channel), "channel": channel, "modality": modality })
}

/// The row of a sensor's place on a vehicle; a camera has intrinsics. Its token tells rows of other contents apart.
pub(crate) fn calibrated_sensor(
    scene: &str,
    channel: &str,
    ego_from_sensor: DAffine3,
    intrinsic: Option<&[[f64; 3]; 3]>,
) -> Value {
    let intrinsic = intrinsic.map_or_else(|| json!([]), |intrinsic| json!(intrinsic));
    // Nanometres: what is left of the arithmetic is no other calibration.
    let rounded = |values: &[f64]| values.iter().map(|v| (v * 1e9).round() / 1e9).collect::<Vec<_>>();
    let translation = rounded(&ego_from_sensor.translation.to_array());
    let rotation = rounded(&quaternion_wxyz(&ego_from_sensor));
    let name = format!("{scene}/{channel}/{translation:?}/{rotation:?}/{intrinsic}");
    json!({
        "token": token("calibrated_sensor", &name),
        "sensor_token": token("sensor", channel),
        "translation": translation,
        "rotation": rotation,
        "camera_intrinsic": intrinsic,
    })
}

/// The row of a vehicle's pose.
pub(crate) fn ego_pose(name: &str, time_ns: i64, plane_from_ego: DAffine3) -> Value {
    json!({
        "token": token("ego_pose", name),
        "timestamp": time_ns / 1000,
        "translation": plane_from_ego.translation.to_array(),
        "rotation": quaternion_wxyz(&plane_from_ego),
    })
}

/// The rows of a log: what was recorded when and where.
pub(crate) fn log(scene: &str, table: &FrameTable) -> Value {
    json!({
        "token": token("log", scene),
        "logfile": table.scene,
        "vehicle": table.dataset,
        "date_captured": date(table.time_ns),
        "location": table.place,
    })
}

/// The attribute of an object, as far as its motion and kind tell it.
pub(crate) fn attribute(kind: Kind, speed_mps: Option<f64>, ever_moves: bool) -> Option<&'static str> {
    match kind {
        Kind::BicycleWithRider | Kind::MotorcycleWithRider => return Some("cycle.with_rider"),
        Kind::Bicycle | Kind::Motorcycle => return Some("cycle.without_rider"),
        _ => {}
    }
    let moves = speed_mps? > STANDS_MPS;
    match kind {
        Kind::Adult | Kind::Child | Kind::ConstructionWorker | Kind::PoliceOfficer if moves => {
            Some("pedestrian.moving")
        }
        Kind::Adult | Kind::Child | Kind::ConstructionWorker | Kind::PoliceOfficer => Some("pedestrian.standing"),
        kind if !kind.is_car() => None,
        _ if moves => Some("vehicle.moving"),
        _ if ever_moves => Some("vehicle.stopped"),
        _ => Some("vehicle.parked"),
    }
}

/// Speed over the ground.
pub(crate) fn speed_mps(object: &ObjectRow) -> Option<f64> {
    object.velocity_mps.map(|[x, y, _]| x.hypot(y))
}

/// The day of a time, in UTC, by the civil calendar.
fn date(time_ns: i64) -> String {
    let days = time_ns.div_euclid(86_400_000_000_000);
    // Years begin in March, so that the day that a leap year adds is the last one; eras have 400 years.
    let (era, day) = ((days + 719_468).div_euclid(146_097), (days + 719_468).rem_euclid(146_097));
    let year = (day - day / 1_460 + day / 36_524 - day / 146_096) / 365;
    let day = day - (365 * year + year / 4 - year / 100);
    let month = (5 * day + 2) / 153;
    let (day, month) = (day - (153 * month + 2) / 5 + 1, if month < 10 { month + 3 } else { month - 9 });
    format!("{:04}-{month:02}-{day:02}", era * 400 + year + i64::from(month <= 2))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn days_are_those_of_the_calendar() {
        let day = 86_400_000_000_000;
        assert_eq!(date(0), "1970-01-01");
        assert_eq!(date(-1), "1969-12-31");
        assert_eq!(date(1_532_402_927_647_951_000), "2018-07-24");
        assert_eq!([date(951_782_400_000_000_000), date(951_782_400_000_000_000 + day)], ["2000-02-29", "2000-03-01"]);
    }

    #[test]
    fn motion_and_kind_decide_the_attribute() {
        assert_eq!(attribute(Kind::Car, Some(3.0), true), Some("vehicle.moving"));
        assert_eq!(attribute(Kind::Car, Some(0.0), true), Some("vehicle.stopped"));
        assert_eq!(attribute(Kind::Bus, Some(0.1), false), Some("vehicle.parked"));
        assert_eq!(attribute(Kind::Car, None, true), None);
        assert_eq!(attribute(Kind::Adult, Some(1.3), true), Some("pedestrian.moving"));
        assert_eq!(attribute(Kind::BicycleWithRider, None, false), Some("cycle.with_rider"));
        assert_eq!(attribute(Kind::TrafficCone, Some(0.0), false), None);
        for kind in Kind::ALL {
            let of = |speed| attribute(kind, Some(speed), false);
            assert!([0.0, 1.0].into_iter().filter_map(of).all(|name| ATTRIBUTES.contains(&name)), "{kind:?}");
        }
    }
}
