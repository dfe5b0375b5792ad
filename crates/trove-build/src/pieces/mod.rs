//! What builders hand over: pieces and scenery, in materials of the palette.

mod palette;
mod piece;
mod scenery;

pub(crate) use palette::{ANY, Palette, tinted};
pub(crate) use piece::Piece;
pub(crate) use scenery::Scenery;
