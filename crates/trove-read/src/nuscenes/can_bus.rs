//! The vehicle's poses of the CAN bus expansion: `can_bus/scene-0103_pose.json`, 50 a second.

use std::path::Path;

use serde::Deserialize;
use trove_files::read_regular;
use trove_model::{Ego, Outcome, Report, Trajectory, World};

use super::exposures::GlobalFromEgo;
use super::poses;
use super::records::microseconds;
use super::table::Table;

/// A scene of 20 s has 0.4 MB.
const LARGEST: u64 = 64 << 20;
/// The same poses as the ego poses, so those farther from them are not to be trusted, metres and radians.
const FARTHEST_M: f64 = 0.5;
const FARTHEST_RAD: f64 = 0.05;

#[derive(Deserialize)]
struct Message {
    #[serde(deserialize_with = "microseconds")]
    utime: i64,
    pos: [f64; 3],
    /// w, x, y, z.
    orientation: [f64; 4],
}

/// A scene's file below the root.
pub(super) fn file(scene: &str) -> String {
    format!("can_bus/{scene}_pose.json")
}

/// The vehicle's path: the CAN bus's poses where there are such and they agree with the ego poses, else these.
pub(super) fn refined(
    root: &Path,
    scene: &str,
    ego_poses: Trajectory<World, Ego>,
    report: &Report,
) -> Trajectory<World, Ego> {
    let file = file(scene);
    if !root.join(&file).exists() {
        return ego_poses;
    }
    let can = read(root, &file, report);
    let apart = |(time_ns, pose): &(i64, GlobalFromEgo)| {
        let other = can.at(*time_ns)?;
        Some((pose.translation.distance(other.translation), pose.rotation.angle_between(other.rotation)))
    };
    let apart = ego_poses.moments().iter().filter_map(apart);
    let Some((apart_m, apart_rad)) = apart.reduce(|a, b| (a.0.max(b.0), a.1.max(b.1))) else {
        report.note(Outcome::Dropped, "CAN bus poses at none of the scene's times", file);
        return ego_poses;
    };
    if apart_m > FARTHEST_M || apart_rad > FARTHEST_RAD {
        let example = format!("{file}: up to {apart_m:.2} m and {apart_rad:.3} rad");
        report.note(Outcome::Dropped, "CAN bus poses that disagree with the ego poses", example);
        return ego_poses;
    }
    let beyond = ego_poses.moments().iter().filter(|(time_ns, _)| can.at(*time_ns).is_none());
    Trajectory::new(can.moments().iter().chain(beyond).copied().collect()).0
}

/// The poses of a file, in the order of time; what is damaged in it is reported.
fn read(root: &Path, file: &str, report: &Report) -> Trajectory<World, Ego> {
    let path = root.join(file);
    let unusable = |why: &dyn std::fmt::Display| {
        report.note(Outcome::Dropped, "CAN bus file that cannot be read to its end", format!("{file}: {why}"));
    };
    let bytes = read_regular(&path, LARGEST).inspect_err(|why| unusable(why)).unwrap_or_default();
    let (mut table, mut moments) = (Table::new(&path, &bytes[..]), Vec::new());
    loop {
        match table.next_record() {
            Ok(Some(raw)) => {
                let message = serde_json::from_slice::<Message>(raw.bytes).map_err(|why| why.to_string());
                let moment = message.and_then(|m| {
                    let pose = poses::pose(m.pos, m.orientation).ok_or("no valid pose")?;
                    Ok((m.utime.saturating_mul(1000), pose))
                });
                match moment {
                    Ok(moment) => moments.push(moment),
                    Err(why) => {
                        let example = format!("{file}, byte {}: {why}", raw.offset);
                        report.note(Outcome::Dropped, "CAN bus message that cannot be used", example);
                    }
                }
            }
            Ok(None) => break,
            Err(why) => {
                if !bytes.is_empty() {
                    unusable(&why);
                }
                break;
            }
        }
    }
    let (poses, disorder) = Trajectory::new(moments);
    if disorder.backwards > 0 {
        report.note(Outcome::Substituted, "CAN bus messages that go back in time, put in order", file);
    }
    if disorder.duplicates > 0 {
        let example = format!("{file}: {}", disorder.duplicates);
        report.note(Outcome::Dropped, "CAN bus messages of a time that one before them has", example);
    }
    poses
}
