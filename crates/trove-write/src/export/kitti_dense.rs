//! KITTI's optical flow of 2015 and depth completion: 16-bit pictures of numbers.

use trove_format::FrameFile;
use trove_model::Occlusion;

use super::dataset::Dataset;
use super::plan::Plan;
use super::unit::Unit;
use crate::{WriteError, png_file};

/// `training/image_2/*_10.png`, `*_11.png` and `training/flow_occ/*_10.png`: pairs of frames that follow each other; and
/// `training/flow_noc/*_10.png`, where only flow to what the second picture shows is valid.
pub(super) struct KittiFlow;

/// `<split>/<sequence>/{image_02/data,proj_depth/groundtruth/image_02}/*.png`.
pub(super) struct KittiDepth;

/// A flow of nothing; one step is a 64th of a pixel.
const ZERO: f64 = 32768.0;
const STEPS_PER_PX: f64 = 64.0;
/// Steps in a metre of depth.
const STEPS_PER_M: f64 = 256.0;

impl Dataset for KittiFlow {
    fn write(&self, plan: &Plan, frames: &[usize], unit: &mut Unit<'_>) -> Result<(), WriteError> {
        for &i in frames {
            let first = &plan.frames[i];
            let follows = |next: &&super::plan::PlannedFrame| {
                next.sequence == first.sequence && next.keyframe == first.keyframe + 1
            };
            let Some(next) = plan.frames.get(i + 1).filter(follows) else {
                unit.clip("frames without a next one, to which flow would lead", 1);
                continue;
            };
            let frame = plan.open(first)?;
            unit.link(&format!("training/image_2/{i:06}_10.png"), &frame.needed(FrameFile::Rgb)?)?;
            unit.link(&format!("training/image_2/{i:06}_11.png"), &plan.open(next)?.needed(FrameFile::Rgb)?)?;
            let flow = frame.flow_forward()?;
            let occlusion = frame.has(FrameFile::OccludedForward).then(|| frame.occluded_forward()).transpose()?;
            let mut beyond = 0;
            let pixel = |[u, v]: &[f32; 2]| {
                if u.is_nan() || v.is_nan() {
                    return [0; 3];
                }
                let [u, v] = [u, v].map(|px| (f64::from(*px) * STEPS_PER_PX + ZERO).round());
                if [u, v].iter().any(|step| !(0.0..=65535.0).contains(step)) {
                    beyond += 1;
                    return [0; 3];
                }
                [u as u16, v as u16, 1]
            };
            let pixels: Vec<[u16; 3]> = flow.data.iter().map(pixel).collect();
            unit.clip("pixels whose flow is beyond ±512 pixels, which are invalid", beyond);
            let png = png_file::rgb16("flow", flow.width, flow.height, &pixels)?;
            unit.write(&format!("training/flow_occ/{i:06}_10.png"), &png)?;
            if let Some(occlusion) = occlusion {
                let seen = |(pixel, occlusion)| if occlusion == Occlusion::Seen { pixel } else { [0; 3] };
                let pixels: Vec<[u16; 3]> = pixels.into_iter().zip(occlusion.data).map(seen).collect();
                let png = png_file::rgb16("flow", flow.width, flow.height, &pixels)?;
                unit.write(&format!("training/flow_noc/{i:06}_10.png"), &png)?;
            }
        }
        Ok(())
    }
}

impl Dataset for KittiDepth {
    fn write(&self, plan: &Plan, frames: &[usize], unit: &mut Unit<'_>) -> Result<(), WriteError> {
        for planned in frames.iter().map(|i| &plan.frames[*i]) {
            let frame = plan.open(planned)?;
            let sequence = format!("{}/{:04}", planned.split, planned.sequence);
            let name = format!("{:010}.png", planned.index);
            unit.link(&format!("{sequence}/image_02/data/{name}"), &frame.needed(FrameFile::Rgb)?)?;
            let depth = frame.depth_m()?;
            let mut beyond = 0;
            let step = |depth_m: &f32| {
                let steps = (f64::from(*depth_m) * STEPS_PER_M).round();
                if !steps.is_finite() || steps < 1.0 {
                    return 0; // sky, or beside a fisheye
                }
                if steps > 65535.0 {
                    beyond += 1;
                    return 0;
                }
                steps as u16
            };
            let steps: Vec<u16> = depth.data.iter().map(step).collect();
            unit.clip("pixels farther than 255.99 m, which are invalid", beyond);
            let png = png_file::grey16("depth", depth.width, depth.height, &steps)?;
            unit.write(&format!("{sequence}/proj_depth/groundtruth/image_02/{name}"), &png)?;
        }
        Ok(())
    }
}
