//! Libraries of models, textures and skies, with files made on the fly.

#![allow(clippy::unwrap_used)] // all of this is tests

mod damaged;
mod files;
mod libraries;
mod models;
mod packed;
