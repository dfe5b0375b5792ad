//! Poses, as the dataset's tables have them, and the vehicle's over time.

use std::path::Path;

use glam::{DQuat, DVec3};
use trove_model::{Frame, Outcome, Pose, Report};

use super::feather::Table;
use super::frames::{Axle, City};
use crate::ReadError;

/// The columns of a pose.
pub(super) const POSE: [&str; 7] = ["qw", "qx", "qy", "qz", "tx_m", "ty_m", "tz_m"];

/// Beyond this from a city's origin nothing is a position, metres.
pub(super) const FARTHEST_M: f64 = 1e6;
/// Nothing was recorded before 1970 or after 2100, nanoseconds.
const TIMES_NS: std::ops::Range<i64> = 0..4_102_444_800_000_000_000;
/// Between poses farther apart in time than this the vehicle's is not known, nanoseconds.
const LONGEST_GAP_NS: i64 = 300_000_000;

/// A table's poses; `None` for a row that holds none (NaN, zero, absurd).
pub(super) fn poses<Dst: Frame, Src: Frame>(table: &Table) -> Result<Vec<Option<Pose<Dst, Src>>>, ReadError> {
    let columns = POSE.map(|name| table.numbers(name));
    let [w, x, y, z, tx, ty, tz] = columns;
    let (w, x, y, z, tx, ty, tz) = (w?, x?, y?, z?, tx?, ty?, tz?);
    let pose = |i: usize| {
        let rotation = DQuat::from_xyzw(x[i], y[i], z[i], w[i]);
        let translation = DVec3::new(tx[i], ty[i], tz[i]);
        let is_unit_enough = (0.9..1.1).contains(&rotation.length());
        (is_unit_enough && translation.abs().cmplt(DVec3::splat(FARTHEST_M)).all())
            .then(|| Pose::new(rotation, translation))
    };
    Ok((0..table.rows()).map(pose).collect())
}

/// Where the vehicle was, in the order of time.
pub(super) struct Poses(Vec<(i64, Pose<City, Axle>)>);

impl Poses {
    /// Reads `city_SE3_egovehicle.feather`; rows that are none are left out and reported.
    pub(super) fn read(path: &Path, report: &Report) -> Result<Self, ReadError> {
        let table = Table::read(path, &[&["timestamp_ns"], &POSE[..]].concat())?;
        let mut moments = Vec::with_capacity(table.rows());
        for (i, (time_ns, pose)) in table.integers("timestamp_ns")?.into_iter().zip(poses(&table)?).enumerate() {
            match time_ns.filter(|time_ns| TIMES_NS.contains(time_ns)).zip(pose) {
                Some(moment) => moments.push(moment),
                None => {
                    let example = format!("{}: row {i}", path.display());
                    report.note(Outcome::Dropped, "Argoverse 2 ego pose without a time or a valid pose", example);
                }
            }
        }
        if !moments.is_sorted_by_key(|(time_ns, _)| *time_ns) {
            let what = "Argoverse 2 ego poses that go back in time, put in order";
            report.note(Outcome::Substituted, what, path.display());
            moments.sort_by_key(|(time_ns, _)| *time_ns);
        }
        let count = moments.len();
        moments.dedup_by_key(|(time_ns, _)| *time_ns);
        if moments.len() < count {
            let example = format!("{}: {}", path.display(), count - moments.len());
            report.note(Outcome::Dropped, "Argoverse 2 ego poses of a time that one before them has", example);
        }
        Ok(Self(moments))
    }

    /// The vehicle at a time, between the poses before and after; `None` where they are too far apart.
    pub(super) fn at(&self, time_ns: i64) -> Option<Pose<City, Axle>> {
        let next = self.0.partition_point(|(t, _)| *t < time_ns);
        let (after_ns, after) = self.0.get(next)?;
        if *after_ns == time_ns {
            return Some(*after);
        }
        let (before_ns, before) = self.0.get(next.checked_sub(1)?)?;
        let gap_ns = after_ns.saturating_sub(*before_ns);
        let share = time_ns.saturating_sub(*before_ns) as f64 / gap_ns as f64;
        (gap_ns <= LONGEST_GAP_NS).then(|| before.interpolate(after, share))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_vehicle_is_between_its_poses_and_nowhere_beyond_them() {
        let at = |time_ns, x| (time_ns, Pose::from_yaw(0.0, DVec3::new(x, 0.0, 0.0)));
        let poses = Poses(vec![at(0, 0.0), at(100_000_000, 1.0), at(600_000_000, 9.0)]);
        assert_eq!(poses.at(100_000_000).unwrap().translation.x, 1.0);
        assert!((poses.at(25_000_000).unwrap().translation.x - 0.25).abs() < 1e-12);
        assert!(poses.at(-1).is_none() && poses.at(600_000_001).is_none());
        assert!(poses.at(300_000_000).is_none(), "half a second without a pose");
    }
}
