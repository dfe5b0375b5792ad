//! Poses, as the dataset's tables have them, and the vehicle's over time.

use std::path::Path;

use glam::{DQuat, DVec3};
use trove_model::{Frame, Outcome, Pose, Report, Trajectory};

use super::feather::Table;
use super::frames::{Axle, City};
use crate::ReadError;

/// The columns of a pose.
pub(super) const POSE: [&str; 7] = ["qw", "qx", "qy", "qz", "tx_m", "ty_m", "tz_m"];

/// Beyond this from a city's origin nothing is a position, metres.
pub(super) const FARTHEST_M: f64 = 1e6;
/// Nothing was recorded before 1970 or after 2100, nanoseconds.
const TIMES_NS: std::ops::Range<i64> = 0..4_102_444_800_000_000_000;

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

/// Reads `city_SE3_egovehicle.feather`; rows that are none are left out and reported.
pub(super) fn path(file: &Path, report: &Report) -> Result<Trajectory<City, Axle>, ReadError> {
    let table = Table::read(file, &[&["timestamp_ns"], &POSE[..]].concat())?;
    let mut moments = Vec::with_capacity(table.rows());
    for (i, (time_ns, pose)) in table.integers("timestamp_ns")?.into_iter().zip(poses(&table)?).enumerate() {
        match time_ns.filter(|time_ns| TIMES_NS.contains(time_ns)).zip(pose) {
            Some(moment) => moments.push(moment),
            None => {
                let example = format!("{}: row {i}", file.display());
                report.note(Outcome::Dropped, "Argoverse 2 ego pose without a time or a valid pose", example);
            }
        }
    }
    let (path, disorder) = Trajectory::new(moments);
    if disorder.backwards > 0 {
        let what = "Argoverse 2 ego poses that go back in time, put in order";
        report.note(Outcome::Substituted, what, file.display());
    }
    if disorder.duplicates > 0 {
        let example = format!("{}: {}", file.display(), disorder.duplicates);
        report.note(Outcome::Dropped, "Argoverse 2 ego poses of a time that one before them has", example);
    }
    Ok(path)
}
