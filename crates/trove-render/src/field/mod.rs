//! The light that fills the air around an eye, at the nodes of grids: what is scattered there is read, not followed.

mod directions;

pub(crate) use directions::Kernel;

use std::collections::BTreeMap;
use std::sync::{Arc, Mutex, PoisonError};

use glam::{IVec3, Vec3};
use trove_model::{Random, Seed};
use trove_trace::field::{self, ByDirection, GRIDS, Node, PER_GRID, SIZE, STEPS_M};

/// Nodes of a grid on each side of the eye's, and below it.
const BESIDE: i32 = SIZE.x / 2;
const BELOW: i32 = 1;

/// Eyes in a cell of this size share a field, metres.
const CELL_M: Vec3 = Vec3::new(STEPS_M[1], STEPS_M[1], STEPS_M[0]);

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

fn lowest(place: [i32; 3]) -> [IVec3; GRIDS] {
    let eye = (IVec3::from(place).as_vec3() + 0.5) * CELL_M;
    std::array::from_fn(|grid| (eye / STEPS_M[grid]).floor().as_ivec3() - IVec3::new(BESIDE, BESIDE, BELOW))
}

impl LightField {
    /// Where nodes are around eyes at a place.
    pub(crate) fn sites(place: [i32; 3]) -> impl Iterator<Item = Site> {
        let lowest = lowest(place);
        let site = move |grid: usize, i: i32| {
            let at = lowest[grid] + IVec3::new(i % SIZE.x, i / SIZE.x % SIZE.y, i / (SIZE.x * SIZE.y));
            Site { grid, at, point: (at.as_vec3() + 0.5) * STEPS_M[grid], step_m: STEPS_M[grid] }
        };
        (0..GRIDS).flat_map(move |grid| (0..PER_GRID as i32).map(move |i| site(grid, i)))
    }

    /// Of nodes in the order of [`Self::sites`].
    pub(crate) fn new(place: [i32; 3], nodes: Vec<Node>) -> Self {
        Self { lowest: lowest(place), nodes }
    }

    /// Gives all nodes, in order, what they send on and their irradiance.
    pub(crate) fn set(&mut self, tables: Vec<(ByDirection, ByDirection)>) {
        for (node, tables) in self.nodes.iter_mut().zip(tables) {
            (node.sent_on, node.irradiance) = tables;
        }
    }

    /// To be read.
    pub(crate) fn view(&self) -> field::LightField<'_> {
        field::LightField { lowest: self.lowest, nodes: &self.nodes }
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
