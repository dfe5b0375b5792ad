//! `Scene` + `Shot` → `Capture`; `Scene` + any other `Sensor` → `Points`; `Scene` + `GridShot` → `Occupancy`.
//!
//! What goes in: a virtual scene and what looks at it. What comes out: a camera's picture and its labels, or what a
//! sensor's rays meet. This crate must not know where the scene came from, nor how a capture is written.
//!
//! ```
//! use std::sync::Arc;
//!
//! use glam::{DAffine3, DMat3, DQuat, DVec3, Vec3};
//! use trove_model::{
//!     Class, Distortion, Environment, EnvironmentMap, Instance, InstanceId, Lens, Light, Material, Mesh, Pose, Scene, Shot,
//! };
//! use trove_render::{Denoising, KernelChoice, Renderer, RendererOptions};
//!
//! // A square of ground under a white sky, seen from 2 m above it by a camera that looks north.
//! let ground = Mesh {
//!     positions: vec![
//!         Vec3::new(-50.0, -50.0, 0.0),
//!         Vec3::new(50.0, -50.0, 0.0),
//!         Vec3::new(50.0, 50.0, 0.0),
//!         Vec3::new(-50.0, 50.0, 0.0),
//!     ],
//!     triangles: vec![[0, 1, 2], [0, 2, 3]],
//!     ..Mesh::default()
//! };
//! let sky = EnvironmentMap { name: "white".into(), width: 2, height: 1, rgb: vec![[1.0; 3]; 2] };
//! let scene = Scene {
//!     meshes: vec![Arc::new(ground)],
//!     materials: vec![Material::plain("grass", Vec3::new(0.1, 0.3, 0.05), 0.9)],
//!     instances: vec![Instance {
//!         id: InstanceId(0),
//!         class: Class::Ground,
//!         mesh: 0,
//!         materials: vec![0],
//!         world_from_mesh: DAffine3::IDENTITY,
//!         previous: None,
//!         next: None,
//!         object: None,
//!     }
//!     .at_rest()],
//!     others: Default::default(),
//!     keyframes_apart_s: [f64::INFINITY; 2],
//!     light: Light::clear(Environment::Map(Arc::new(sky))),
//!     provenance: Vec::new(),
//! };
//! let lens = Lens {
//!     width_px: 16,
//!     height_px: 16,
//!     fx_px: 16.0,
//!     fy_px: 16.0,
//!     cx_px: 8.0,
//!     cy_px: 8.0,
//!     distortion: Distortion::None,
//! };
//! let north = DQuat::from_mat3(&DMat3::from_cols(DVec3::X, DVec3::NEG_Z, DVec3::Y));
//! let shot = Shot { spp: 16, ..Shot::new("example", lens, Pose::new(north, DVec3::Z * 2.0)) };
//!
//! let options =
//!     RendererOptions { kernel: KernelChoice::Obvhs, denoise: Denoising::None, threads: 1, ..RendererOptions::default() };
//! let renderer = Renderer::new(&options)?;
//! let prepared = renderer.prepare(&scene)?;
//! let capture = renderer.render(&prepared, &shot, true, &|_share| false).expect("nothing stops it");
//!
//! let [red, green, blue] = *capture.color.expect("light was asked for").radiance.at(8, 15);
//! assert!(green > red && red > blue, "grass");
//! // The lowest row's pixels look 7.5/16 downwards: the ground is 2 m / (7.5/16) away along the camera's axis.
//! assert!((capture.labels.depth_m.at(8, 15) - 2.0 * 16.0 / 7.5).abs() < 1e-4);
//! assert_eq!(*capture.labels.depth_m.at(8, 0), f32::INFINITY, "sky");
//! # Ok::<(), trove_render::RenderError>(())
//! ```

mod accel;
mod cache;
mod card;
mod convolution;
mod denoise;
mod drops;
mod error;
mod field;
mod film;
mod fog;
mod labels;
mod lidar;
mod light;
mod lookups;
mod material;
mod motion;
mod noise;
mod path;
mod placed;
mod poisson;
mod prepare;
mod radar;
mod ray;
mod remote;
mod renderer;
mod scan;
mod shared_library;
mod sight;
mod spray;
mod surface;
mod texture;
mod voxels;

pub use accel::KernelChoice;
pub use card::{Card, CardRate};
pub use denoise::Denoising;
pub use error::RenderError;
pub use light::{BakedSky, SUN_RADIUS_RAD, bake_sky};
pub use path::{RaySeconds, RayTimes};
pub use prepare::PreparedScene;
pub use renderer::{Capabilities, DeviceChoice, Renderer, RendererOptions};
