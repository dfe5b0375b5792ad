//! Which surface a ray meets: one interface over the kernels.
//!
//! A kernel is given shapes and what they let pass ([`Shapes`]) once, and then answers batches of rays. It finds
//! (instance, triangle, u, v); everything else about a hit is derived elsewhere, from the mesh, so that all kernels shade
//! alike. Nothing is called back: what counts as a hit follows from data that could lie on a card as well.

mod embree;
mod flat;
mod hierarchy;
mod kernel;
mod obvhs;
mod shapes;

use std::path::PathBuf;

use crate::RenderError;

pub(crate) use flat::{Flat, Here, Hold, asked, flat_map, flat_mesh};
pub(crate) use kernel::{Accel, Coherence, Kernel, PACKET};
pub(crate) use shapes::Shapes;

/// Which ray-tracing kernel to use.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum KernelChoice {
    /// Embree where it is installed, else the built-in one.
    #[default]
    Auto,
    /// Embree 4, loaded at run time; an error where it is missing.
    Embree,
    /// The built-in kernel: the same bytes on every machine.
    Obvhs,
}

/// The chosen kernel; `search` are folders or files in which to look for Embree.
pub(crate) fn kernel(choice: KernelChoice, search: &[PathBuf]) -> Result<Box<dyn Kernel>, RenderError> {
    let embree = || embree::Embree::load(search).map(|kernel| Box::new(kernel) as Box<dyn Kernel>);
    let built_in = || Box::new(obvhs::Obvhs::default());
    match choice {
        KernelChoice::Obvhs => Ok(built_in()),
        KernelChoice::Embree => embree(),
        KernelChoice::Auto => embree().or_else(|problem| {
            tracing::info!(%problem, "using the built-in kernel");
            Ok(built_in())
        }),
    }
}
