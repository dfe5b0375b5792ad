//! Builds meshes from simple forms: lofts, lathes, tubes, blocks, ellipsoids, blends, and cuts through them.
//!
//! A form is made at the origin, then moved, marked with slots, and joined to others in a [`Model`].

mod blend;
mod curve;
mod cut;
mod form;
mod lay;
mod loft;
mod model;
mod outline;
mod smooth;

pub(crate) use blend::{Blend, Limb};
pub(crate) use curve::Curve;
pub(crate) use cut::Prism;
pub(crate) use form::Shape;
pub(crate) use model::Model;
pub(crate) use outline::{arc, clipped, hull, inset, outset, pane, rect, rounded, shrunk, simple, soft};
