//! A radar's cycle: waves go out as rays, surfaces mirror and scatter them, and what comes back is gathered in cells of
//! range, azimuth and radial speed, in which a detector looks for peaks.

mod cells;
mod detector;
mod echo;
mod scatter;

use trove_model::{RadarDetection, RadarShot};

use crate::PreparedScene;

/// Computed with the current thread pool; the same for any number of threads.
pub(crate) fn detections(scene: &PreparedScene, shot: &RadarShot) -> Vec<RadarDetection> {
    let of_scan = |(i, scan)| detector::detections(shot, scan, echo::echoes(scene, shot, scan), shot.seed.nth(i));
    let scans: Vec<Vec<RadarDetection>> = (0..).zip(&shot.radar.scans).map(of_scan).collect();
    detector::told(shot, scans)
}
