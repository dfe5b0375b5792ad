//! LiDAR sweeps, a file each.

use trove_model::ClassMap;

use super::cloud::Cloud;
use super::dataset::Dataset;
use super::plan::Plan;
use super::unit::Unit;
use super::{las, pcd};
use crate::WriteError;

/// `<split>/<drive>_v<variation>_k<keyframe>_<LiDAR>.<form>`.
pub(super) struct PointClouds {
    /// What the points' labels are numbered by.
    pub map: ClassMap,
    /// The files' form.
    pub form: Form,
}

/// A form of files of points.
#[derive(Clone, Copy)]
pub(super) enum Form {
    /// Point Cloud Library's, in the sensor's axes.
    Pcd,
    /// ASPRS's, in World.
    Las,
}

impl Dataset for PointClouds {
    fn write(&self, plan: &Plan, frames: &[usize], unit: &mut Unit<'_>) -> Result<(), WriteError> {
        if !plan.has_sweeps() {
            return Err(WriteError::Unfit {
                path: plan.source.clone(),
                expected: "sweeps of a LiDAR".into(),
                found: "none".into(),
                remedy: "give the recipe a LiDAR, with [sensors.NAME]".into(),
            });
        }
        // The first frame of a moment writes all that was measured at it.
        let first = |frame: &&usize| plan.same_moment(**frame).all(|other| other > **frame);
        for frame in frames.iter().filter(first).map(|i| &plan.frames[*i]) {
            for planned in plan.sweeps(frame) {
                let cloud = Cloud::of(plan.open_sweep(planned)?, &self.map)?;
                let name = format!("{}/{}", frame.split, frame.flat_name_of(&planned.view));
                match self.form {
                    Form::Pcd => unit.write(&format!("{name}.pcd"), &pcd::file(&cloud))?,
                    Form::Las => unit.write(&format!("{name}.las"), &las::file(&cloud)?)?,
                }
            }
        }
        Ok(())
    }
}
