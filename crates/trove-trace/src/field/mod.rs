//! The light that fills the air around an eye, at the nodes of grids: what is scattered there is read, not followed.

mod directions;

use glam::{IVec3, Vec3, vec3};

use crate::math::floor;

pub use directions::{ByDirection, PART_SR, PARTS, direction_in, part_of, parts_around};

/// Distance of nodes in each grid, metres.
pub const STEPS_M: [f32; GRIDS] = [6.0, 18.0, 54.0];
/// Grids, the finest first.
pub const GRIDS: usize = 3;
/// Nodes along each side of a grid.
pub const SIZE: IVec3 = IVec3::new(11, 11, 5);
/// Nodes of a grid.
pub const PER_GRID: usize = (SIZE.x * SIZE.y * SIZE.z) as usize;

/// What a node knows.
#[derive(Clone, Copy)]
#[repr(C)]
pub struct Node {
    /// What droplets send on, by the direction in which light then goes; the sun's own light is left out.
    pub sent_on: ByDirection,
    /// Irradiance by normal, the sun's own light left out.
    pub irradiance: ByDirection,
    /// Share of the sun that nothing solid hides.
    pub sun: Vec3,
    /// Whether it lies in the open; what it knows is of use only then.
    pub is_open: bool,
}

impl Default for Node {
    fn default() -> Self {
        let dark = [Vec3::ZERO; PARTS];
        Self { sent_on: dark, irradiance: dark, sun: Vec3::ZERO, is_open: false }
    }
}

/// Light at nodes around an eye.
#[derive(Clone, Copy)]
pub struct LightField<'a> {
    /// The lowest node of each grid in its lattice.
    pub lowest: [IVec3; GRIDS],
    /// Grid by grid, from the lowest layer up, row by row.
    pub nodes: &'a [Node],
}

/// Nodes around a point and what each weighs; the weights sum to one.
pub struct Nearest {
    nodes: [(u32, f32); 8],
    count: usize,
}

impl Nearest {
    fn iter(&self) -> impl Iterator<Item = (u32, f32)> {
        self.nodes[..self.count].iter().copied()
    }

    /// One of them, drawn by weight.
    #[inline]
    pub fn one(&self, mut u: f32) -> Option<u32> {
        let mut last = None;
        for (node, weight) in self.iter() {
            last = Some(node);
            if u < weight {
                break;
            }
            u -= weight;
        }
        last
    }
}

impl LightField<'_> {
    /// Open nodes around a point, of a grid that is drawn by `u` where one goes over into the next; none where all is solid.
    #[inline]
    pub fn nearest(&self, point: Vec3, mut u: f32) -> Nearest {
        let mut found = Nearest { nodes: [(0, 0.0); 8], count: 0 };
        let last = SIZE.as_vec3() - 1.0;
        for (grid, lowest) in self.lowest.iter().enumerate() {
            let at = point / STEPS_M[grid] - 0.5 - lowest.as_vec3();
            if grid + 1 < GRIDS {
                // Below the lowest nodes is ground.
                let inside = at.min(last - at).truncate().min_element().min(last.z - at.z).clamp(0.0, 1.0);
                if u >= inside {
                    u = (u - inside) / (1.0 - inside);
                    continue;
                }
                u /= inside;
            }
            let at = at.clamp(Vec3::ZERO, last - 1e-3);
            let low = vec3(floor(at.x), floor(at.y), floor(at.z));
            let (low, share) = (low.as_ivec3(), at - low);
            let mut total = 0.0;
            for corner in 0..8 {
                let high = IVec3::new(corner & 1, corner >> 1 & 1, corner >> 2);
                let weight = Vec3::select(high.cmpgt(IVec3::ZERO), share, 1.0 - share).element_product();
                let at = low + high;
                let node = grid * PER_GRID + ((at.z * SIZE.y + at.y) * SIZE.x + at.x) as usize;
                if self.nodes[node].is_open && weight > 0.0 {
                    found.nodes[found.count] = (node as u32, weight);
                    found.count += 1;
                    total += weight;
                }
            }
            if total > 1e-3 {
                found.nodes[..found.count].iter_mut().for_each(|(_, weight)| *weight /= total);
                return found;
            }
            found.count = 0;
        }
        found
    }

    /// What droplets around a point send on in a direction of light's way.
    #[inline]
    pub fn sent_on(&self, nearest: &Nearest, direction: Vec3) -> Vec3 {
        let parts = directions::parts_around(direction);
        let of = |node: u32| {
            parts.iter().fold(Vec3::ZERO, |sum, &(part, weight)| sum + self.nodes[node as usize].sent_on[part] * weight)
        };
        nearest.iter().fold(Vec3::ZERO, |sum, (node, weight)| sum + of(node) * weight)
    }

    /// Share of the sun that nothing solid hides.
    #[inline]
    pub fn sun(&self, nearest: &Nearest) -> Vec3 {
        nearest.iter().fold(Vec3::ZERO, |sum, (node, weight)| sum + weight * self.nodes[node as usize].sun)
    }
}
