//! `Scene` + `Shot` → `Capture`.
//!
//! What goes in: a virtual scene and a camera. What comes out: the picture and its labels. This crate must not know
//! where the scene came from, nor how a capture is written.
