//! The built-in, generated `AssetLibrary`.
//!
//! What goes in: nothing. What comes out: models and surfaces, the same at every call. This crate must not know
//! files, datasets or how scenes are built and rendered.
