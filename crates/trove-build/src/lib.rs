//! `Drive` + `StreetMap` + `AssetLibrary` → `Scene` and its `Shot`s.
//!
//! What goes in: the model's nouns. What comes out: the virtual scene of every keyframe. This crate must not know
//! files, datasets' formats or the renderer.

mod buildings;
mod ground;
mod piece;
mod roads;
