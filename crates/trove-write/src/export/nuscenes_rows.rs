//! Rows that nuScenes and nuImages share: sensors, poses, logs, attributes, and the tokens by which rows name each other.

use glam::{DAffine3, DVec3};
use serde_json::{Value, json};
use trove_format::FrameTable;
use trove_model::{Kind, State};

use super::geometry::{affine, quaternion_wxyz};
use super::unit::Unit;
use crate::files;

/// Folder of the tables, and the version that the devkit is asked for.
pub(crate) const VERSION: &str = "v1.0-trove";

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

/// The attribute of an object, as far as its kind and what it does tell it.
pub(crate) fn attribute(kind: Kind, states: &[State]) -> Option<&'static str> {
    match kind {
        Kind::BicycleWithRider | Kind::MotorcycleWithRider => return Some("cycle.with_rider"),
        Kind::Bicycle | Kind::Motorcycle => return Some("cycle.without_rider"),
        _ => {}
    }
    states.iter().find_map(|state| match state {
        State::Moving => Some("vehicle.moving"),
        State::Stopped => Some("vehicle.stopped"),
        State::Parked => Some("vehicle.parked"),
        State::Walking | State::Running => Some("pedestrian.moving"),
        State::Standing => Some("pedestrian.standing"),
        State::Sitting => Some("pedestrian.sitting_lying_down"),
        State::Braking | State::Riding => None,
    })
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
    fn kind_and_states_decide_the_attribute() {
        let of = |kind, states: &[State]| attribute(kind, states);
        assert_eq!(of(Kind::Car, &[State::Moving, State::Braking]), Some("vehicle.moving"));
        assert_eq!(of(Kind::Car, &[State::Stopped]), Some("vehicle.stopped"));
        assert_eq!(of(Kind::Bus, &[State::Parked]), Some("vehicle.parked"));
        assert_eq!(of(Kind::Car, &[]), None);
        assert_eq!(of(Kind::Adult, &[State::Walking]), Some("pedestrian.moving"));
        assert_eq!(of(Kind::Adult, &[State::Sitting]), Some("pedestrian.sitting_lying_down"));
        assert_eq!(of(Kind::BicycleWithRider, &[State::Moving, State::Riding]), Some("cycle.with_rider"));
        assert_eq!(of(Kind::TrafficCone, &[]), None);
        let named = State::ALL.iter().filter_map(|state| of(Kind::Car, &[*state]));
        assert!(named.chain(of(Kind::Bicycle, &[])).all(|name| ATTRIBUTES.contains(&name)));
    }
}
