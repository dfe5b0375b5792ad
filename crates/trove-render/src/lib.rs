//! `Scene` + `Shot` → `Capture`.
//!
//! What goes in: a virtual scene and a camera. What comes out: the picture and its labels. This crate must not know
//! where the scene came from, nor how a capture is written.

mod accel;
mod cache;
mod denoise;
mod error;
mod film;
mod labels;
mod light;
mod material;
mod path;
mod prepare;
mod renderer;
mod sampling;
mod shared_library;
mod texture;

pub use accel::KernelChoice;
pub use denoise::Denoising;
pub use error::RenderError;
pub use light::{BakedSky, SUN_RADIUS_RAD, bake_sky};
pub use path::{RaySeconds, RayTimes};
pub use prepare::PreparedScene;
pub use renderer::{Capabilities, Renderer, RendererOptions};
