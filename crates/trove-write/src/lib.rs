//! `Capture` → files.
//!
//! What goes in: pictures, labels and the scene they show. What comes out: files that other tools open, each whole or
//! not there. This crate must not know how any of it was made.
