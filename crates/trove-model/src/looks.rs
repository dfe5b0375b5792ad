//! What photographs tell of how things look.

use std::collections::BTreeMap;

use glam::Vec3;

use crate::{Class, InstanceId};

/// How a place looks in photographs against how it was built.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Looks {
    /// Factors on the linear colour of vehicles' paint, of people's largest garment and of buildings, by their ids.
    pub things: BTreeMap<InstanceId, Vec3>,
    /// The same on everything of a class that has none of its own.
    pub classes: BTreeMap<Class, Vec3>,
    /// Contrast of the photographs' film ([`crate::Film::contrast`]); `None` where they do not tell.
    pub contrast: Option<f64>,
    /// Stops that are added to the exposure of each camera, by its name.
    pub exposure_ev: BTreeMap<String, f64>,
}
