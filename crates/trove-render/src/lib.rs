//! `Scene` + `Shot` → `Capture`; `Scene` + any other `Sensor` → `Points`.
//!
//! What goes in: a virtual scene and what looks at it. What comes out: a camera's picture and its labels, or what a
//! sensor's rays meet. This crate must not know where the scene came from, nor how a capture is written.

mod accel;
mod cache;
mod denoise;
mod error;
mod film;
mod labels;
mod light;
mod material;
mod motion;
mod path;
mod placed;
mod prepare;
mod ray;
mod renderer;
mod sampling;
mod scan;
mod shared_library;
mod sight;
mod surface;
mod texture;

pub use accel::KernelChoice;
pub use denoise::Denoising;
pub use error::RenderError;
pub use light::{BakedSky, SUN_RADIUS_RAD, bake_sky};
pub use path::{RaySeconds, RayTimes};
pub use prepare::PreparedScene;
pub use renderer::{Capabilities, Renderer, RendererOptions};
