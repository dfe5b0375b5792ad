//! The light that fills the air around an eye, at the nodes of grids: what is scattered there is read, not followed.

pub(crate) mod directions;

use std::collections::BTreeMap;
use std::sync::{Arc, Mutex, PoisonError};

use glam::{IVec3, Vec3};
use trove_model::{Random, Seed};

use directions::{ByDirection, PARTS};

/// Distance of nodes in the finest grid, metres, and how many times it is that of the next finer one in the others.
const STEP_M: f32 = 6.0;
const COARSER: f32 = 3.0;
const GRIDS: usize = 3;
/// Nodes of a grid on each side of the eye's, and below and above it.
const BESIDE: i32 = 5;
const BELOW: i32 = 1;
const ABOVE: i32 = 3;
const SIZE: IVec3 = IVec3::new(2 * BESIDE + 1, 2 * BESIDE + 1, BELOW + 1 + ABOVE);
const PER_GRID: usize = (SIZE.x * SIZE.y * SIZE.z) as usize;

/// Eyes in a cell of this size share a field, metres.
const CELL_M: Vec3 = Vec3::new(COARSER * STEP_M, COARSER * STEP_M, STEP_M);

/// What a node knows.
#[derive(Clone)]
pub(crate) struct Node {
    /// What droplets send on, by the direction in which light then goes; the sun's own light is left out.
    pub(crate) sent_on: ByDirection,
    /// Irradiance by normal, the sun's own light left out.
    pub(crate) irradiance: ByDirection,
    /// Share of the sun that nothing solid hides.
    pub(crate) sun: Vec3,
    /// Whether it lies in the open; what it knows is of use only then.
    pub(crate) is_open: bool,
}

impl Default for Node {
    fn default() -> Self {
        let dark = [Vec3::ZERO; PARTS];
        Self { sent_on: dark, irradiance: dark, sun: Vec3::ZERO, is_open: false }
    }
}

/// Where a node is.
pub(crate) struct Site {
    grid: usize,
    /// In its grid's lattice over all the world.
    at: IVec3,
    /// World.
    pub(crate) point: Vec3,
    /// To its neighbours, metres.
    pub(crate) step_m: f32,
}

impl Site {
    /// A stream of numbers that is the same wherever the eye is.
    pub(crate) fn random(&self, stream: u64) -> Random {
        let seed = Seed(stream).nth(self.grid as u64);
        self.at.to_array().iter().fold(seed, |seed, &i| seed.nth(i as u64)).random()
    }
}

/// Light at nodes around an eye.
pub(crate) struct LightField {
    /// The lowest node of each grid in its lattice.
    lowest: [IVec3; GRIDS],
    nodes: Vec<Node>,
}

/// Nodes around a point and what each weighs; the weights sum to one.
pub(crate) struct Nearest {
    nodes: [(u32, f32); 8],
    count: usize,
}

impl Nearest {
    fn iter(&self) -> impl Iterator<Item = (u32, f32)> {
        self.nodes[..self.count].iter().copied()
    }

    /// One of them, drawn by weight.
    pub(crate) fn one(&self, mut u: f32) -> Option<u32> {
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

fn step_m(grid: usize) -> f32 {
    STEP_M * COARSER.powi(grid as i32)
}

fn lowest(place: [i32; 3]) -> [IVec3; GRIDS] {
    let eye = (IVec3::from(place).as_vec3() + 0.5) * CELL_M;
    std::array::from_fn(|grid| (eye / step_m(grid)).floor().as_ivec3() - IVec3::new(BESIDE, BESIDE, BELOW))
}

impl LightField {
    /// Where nodes are around eyes at a place.
    pub(crate) fn sites(place: [i32; 3]) -> impl Iterator<Item = Site> {
        let lowest = lowest(place);
        let site = move |grid: usize, i: i32| {
            let at = lowest[grid] + IVec3::new(i % SIZE.x, i / SIZE.x % SIZE.y, i / (SIZE.x * SIZE.y));
            Site { grid, at, point: (at.as_vec3() + 0.5) * step_m(grid), step_m: step_m(grid) }
        };
        (0..GRIDS).flat_map(move |grid| (0..PER_GRID as i32).map(move |i| site(grid, i)))
    }

    /// Of nodes in the order of [`Self::sites`].
    pub(crate) fn new(place: [i32; 3], nodes: Vec<Node>) -> Self {
        Self { lowest: lowest(place), nodes }
    }

    pub(crate) fn node(&self, node: u32) -> &Node {
        &self.nodes[node as usize]
    }

    /// Gives all nodes, in order, what they send on and their irradiance.
    pub(crate) fn set(&mut self, tables: Vec<(ByDirection, ByDirection)>) {
        for (node, tables) in self.nodes.iter_mut().zip(tables) {
            (node.sent_on, node.irradiance) = tables;
        }
    }

    /// Open nodes around a point, of a grid that is drawn by `u` where one goes over into the next; none where all is solid.
    pub(crate) fn nearest(&self, point: Vec3, mut u: f32) -> Nearest {
        let mut found = Nearest { nodes: [(0, 0.0); 8], count: 0 };
        let last = SIZE.as_vec3() - 1.0;
        for (grid, lowest) in self.lowest.iter().enumerate() {
            let at = point / step_m(grid) - 0.5 - lowest.as_vec3();
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
            let (low, share) = (at.floor().as_ivec3(), at - at.floor());
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
    pub(crate) fn sent_on(&self, nearest: &Nearest, direction: Vec3) -> Vec3 {
        let parts = directions::parts_around(direction);
        let of = |node: u32| parts.iter().map(|&(part, weight)| self.node(node).sent_on[part] * weight).sum::<Vec3>();
        nearest.iter().map(|(node, weight)| of(node) * weight).sum()
    }

    /// Share of the sun that nothing solid hides.
    pub(crate) fn sun(&self, nearest: &Nearest) -> Vec3 {
        nearest.iter().map(|(node, weight)| weight * self.node(node).sun).sum()
    }
}

/// The fields of a scene, by place.
#[derive(Default)]
pub(crate) struct LightFields {
    made: Mutex<BTreeMap<[i32; 3], Arc<LightField>>>,
}

impl LightFields {
    /// The one around an eye, or what is made now for eyes at its place.
    pub(crate) fn get(&self, eye: Vec3, make: impl FnOnce([i32; 3]) -> LightField) -> Arc<LightField> {
        let lock = || self.made.lock().unwrap_or_else(PoisonError::into_inner);
        let place = (eye / CELL_M).floor().as_ivec3().to_array();
        if let Some(made) = lock().get(&place) {
            return made.clone();
        }
        // Not under the lock: threads of the pool that help with it may come here too.
        let made = Arc::new(make(place));
        lock().entry(place).or_insert(made).clone()
    }
}
