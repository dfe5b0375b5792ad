//! What a kernel answers: one interface over all of them.

use std::sync::Arc;

use glam::Vec3;

use super::shapes::Shapes;
use crate::RenderError;
use crate::ray::{Hit, Ray};

/// How the rays of a batch lie to each other; it decides speed alone.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Coherence {
    /// [`PACKET`] successive ones start and run alike.
    Coherent,
    /// Each on its own.
    Incoherent,
}

/// Most rays that a kernel traces together.
pub(crate) const PACKET: usize = 16;
/// A kernel without a scene; it remembers what it built of every mesh.
pub(crate) trait Kernel: Send + Sync {
    /// Name and version, for people.
    fn name(&self) -> String;

    /// Whether it gives the same bytes on every machine.
    fn is_same_everywhere(&self) -> bool {
        false
    }

    /// Builds what traces rays among the shapes.
    fn build(&self, shapes: &Arc<Shapes>) -> Result<Box<dyn Accel>, RenderError>;
}

/// A kernel's scene, which answers batches of rays. Results have the rays' order and number.
pub(crate) trait Accel: Send + Sync {
    /// The nearest surface of each ray, holes and what the ray passes through left out. All rays of a batch look at one
    /// moment and pass through glass, or none does.
    fn closest(&self, rays: &[Ray], coherence: Coherence, hits: &mut [Option<Hit>]);

    /// Whether [`Accel::closest`] would find a surface for each ray, in less time.
    fn blocked(&self, rays: &[Ray], coherence: Coherence, blocked: &mut [bool]);

    /// Leaves of the light along each ray what no hit keeps back: nothing behind what is opaque, a tinted share behind
    /// panes.
    fn any(&self, rays: &[Ray], coherence: Coherence, light: &mut [Vec3]);

    /// The nearest surface of one instance as if nothing else were there, at the moment of the labels; of what rays pass
    /// through, glass alone is left out. The rays run alike.
    fn closest_on(&self, instance: u32, rays: &[Ray], hits: &mut [Option<Hit>]);

    /// How many rays meet a triangle, found as the nearest one with nothing judged: the kernel as its makers deliver it, to
    /// measure against.
    fn bare_closest(&self, rays: &[Ray]) -> usize;

    /// The same, found as any.
    fn bare_any(&self, rays: &[Ray]) -> usize;
}
