//! A path in a world of plain numbers → where it goes and the light that it brings, on a processor or, compiled to PTX, on a
//! graphics card.
//!
//! What goes in: hierarchies of boxes over triangles and over the instances of meshes, and surfaces, materials, lights and
//! air as numbers, in tables or behind the trait `path::World`; and a ray. What comes out: the nearest hit that counts, and
//! what paths bring. This crate must not know where its numbers come from, nor who asks; it has no standard library, no
//! allocation and no dynamic dispatch, since a card has none of them.
//!
//! ```
//! use glam::{Affine3A, Vec3};
//! use trove_trace::{Corners, Mesh, Pair, Ray, Tables, leaf};
//!
//! /// One triangle, in World as it is.
//! struct One([Corners; 1]);
//!
//! impl Tables for One {
//!     fn top(&self) -> (&[Pair], u32) {
//!         (&[], leaf(0, 1))
//!     }
//!     fn instance(&self, place: u32) -> u32 {
//!         place
//!     }
//!     fn mesh(&self, _: u32) -> Mesh<'_> {
//!         Mesh { pairs: &[], corners: &self.0, root: leaf(0, 1) }
//!     }
//!     fn mesh_from_world(&self, _: u32, _: f32) -> Affine3A {
//!         Affine3A::IDENTITY
//!     }
//! }
//!
//! let one = One([Corners::new([Vec3::ZERO, Vec3::X, Vec3::Y], 7)]);
//! let down = Ray { origin: Vec3::new(0.25, 0.5, 2.0), direction: -Vec3::Z, t_min: 0.0, t_max: f32::INFINITY, time: 0.5 };
//! let hit = trove_trace::closest(&one, &down, |_instance| true, |_hit| true).expect("it runs through the triangle");
//! assert_eq!((hit.t, hit.triangle, hit.u, hit.v), (2.0, 7, 0.25, 0.5));
//! ```

#![no_std]
#![cfg_attr(target_arch = "nvptx64", feature(abi_ptx, core_float_math, stdarch_nvptx))]

// For roots, and for tests.
#[cfg(not(target_arch = "nvptx64"))]
extern crate std;

mod beam;
mod bsdf;
#[cfg(target_arch = "nvptx64")]
mod card;
mod exposure;
pub mod field;
mod flat;
mod fog;
pub mod light;
mod lookups;
mod mask;
mod material;
mod math;
mod motion;
mod pair;
pub mod path;
mod ray;
mod sampler;
mod sampling;
mod sheared;
mod spray;
mod stack;
mod surface;
mod tables;
#[cfg(test)]
mod testing;
mod texture;
mod trace;
pub mod wave;
mod world;

pub use bsdf::{Bsdf, BsdfSample, Coat, Lobes, Parameters, ggx, reflected};
pub use exposure::{Bears, ComesDown, SnowLeft, exposure};
pub use flat::{Asked, FlatMesh, FlatOpacity, FlatScene, Look, Placement, SHELTERS, STAYS, Table};
pub use fog::{Fog, MATT_EVENTS, Scattering};
pub use lookups::{Lookups, NOISE_SIDE};
pub use mask::Mask;
pub use material::{Material, alpha, holds_snow};
pub use motion::Motion;
pub use pair::{LEAF_MOST, Pair, inner, leaf};
pub use ray::{Hit, NONE, Ray};
pub use sampler::Sampler;
pub use sampling::{Basis, cosine_hemisphere, cosine_pdf, disk, power_heuristic};
pub use sheared::Corners;
pub use spray::{Plume, Puff, Spray};
pub use stack::DEPTH;
pub use surface::{Exposure, Surface, Triangle, gap_m};
pub use tables::{Mesh, Tables};
pub use texture::{FlatTexture, Map, Texture, between};
pub use trace::{any, closest, closest_on};
pub use world::{FlatLights, FlatLook, FlatMaterials, FlatWeather, FlatWorld, ReadableWorld, Stand, of_normals};
