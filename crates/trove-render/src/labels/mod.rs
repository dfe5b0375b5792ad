//! What every pixel shows: one ray through each pixel's centre, as [`crate::sight`] follows it.

mod change;
mod coverage;
mod eye;
mod flow;
mod keypoints;
mod layers;
mod objects;
mod outline;
mod pixel;

use rayon::prelude::*;
use trove_model::{ExtraLabel, Labels, Shot};

pub(crate) use change::changes;

use crate::PreparedScene;
use eye::{Eye, SIDE};
use layers::Layers;

/// All labels of a picture, computed with the current thread pool; `None` once `stop` answers true, which it then does
/// for good.
pub(crate) fn render(scene: &PreparedScene, shot: &Shot, stop: &(dyn Fn() -> bool + Sync)) -> Option<Labels> {
    let eye = Eye::new(scene, shot);
    let mut layers = Layers::new(shot);
    let bands = layers.bands(SIDE).into_par_iter().enumerate();
    bands.try_for_each(|(i, mut band)| (!stop()).then(|| eye.look(i as u32 * SIDE, &mut band)))?;
    let Layers { shown, mut labels } = layers;
    if shot.labels.extra.contains(&ExtraLabel::Coverage) {
        labels.extra.coverage = Some(coverage::coverage(&eye, &labels, stop)?);
    }
    labels.objects = objects::list(scene, &eye.carrier, shot, &shown, stop)?;
    Some(labels)
}
