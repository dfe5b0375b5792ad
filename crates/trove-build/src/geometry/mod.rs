//! Areas, lines and distances in the plane of World's x and y.

pub(crate) mod distance_field;
pub(crate) mod near;
pub(crate) mod path;
pub(crate) mod plane;
pub(crate) mod plane_raster;
pub(crate) mod rings;
pub(crate) mod segments;
