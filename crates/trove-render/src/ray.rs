//! Rays and what they meet.

use glam::Vec3;
use trove_model::InstanceId;

pub(crate) use trove_trace::Hit;
use trove_trace::path::Path;

use crate::motion::MIDDLE;
#[cfg(doc)]
use crate::placed::Sort;

/// A keyframe beside the one that is seen; also an index.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Beside {
    Previous,
    Next,
}

/// A ray in World; distances are in lengths of `direction`.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Ray {
    pub(crate) origin: Vec3,
    pub(crate) direction: Vec3,
    pub(crate) t_min: f32,
    pub(crate) t_max: f32,
    /// As `ray_time` gives it.
    pub(crate) time: f32,
    /// The object that it passes through as if it were not there: what carries the sensor. Kernels heed it and the three
    /// below where they look for surfaces; shadows stay.
    pub(crate) past: Option<InstanceId>,
    /// The keyframe beside at which it looks: what does not stand then as it stands now is not there.
    pub(crate) beside: Option<Beside>,
    /// Whether panes of glass are not there.
    pub(crate) through_glass: bool,
    /// Whether what keeps off neither rain nor snow is not there ([`Sort::shelters`]).
    pub(crate) for_shelter: bool,
}

impl Ray {
    /// From a point to infinity, at the moment of the labels, through nothing.
    pub(crate) fn new(origin: Vec3, direction: Vec3) -> Self {
        let (t_min, t_max) = (0.0, f32::INFINITY);
        Self {
            origin,
            direction,
            t_min,
            t_max,
            time: MIDDLE,
            past: None,
            beside: None,
            through_glass: false,
            for_shelter: false,
        }
    }

    /// Where and when it goes, without what it passes through.
    pub(crate) fn plain(&self) -> trove_trace::Ray {
        let Self { origin, t_min, direction, t_max, time, .. } = *self;
        trove_trace::Ray { origin, t_min, direction, t_max, time }
    }
}

impl From<trove_trace::Ray> for Ray {
    fn from(ray: trove_trace::Ray) -> Self {
        let trove_trace::Ray { origin, t_min, direction, t_max, time } = ray;
        Self { t_min, t_max, time, ..Self::new(origin, direction) }
    }
}

impl From<&Path> for Ray {
    fn from(path: &Path) -> Self {
        Self { past: (path.past != 0).then_some(InstanceId(path.past)), ..path.ray.into() }
    }
}
