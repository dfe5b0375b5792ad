//! A card's functions and tables on the processor: what a card is checked against.

use rayon::prelude::*;
use trove_trace::field::LightField;
use trove_trace::path::{Sample, Start};
use trove_trace::{FlatWorld, Table};

use super::Machine;
use super::follow::follow_here;
use super::world::{flat, world};
use crate::PreparedScene;
use crate::accel::Here;
use crate::remote::{RemoteScene, RemoteWave};

/// Paths that one thread follows together.
const TOGETHER: usize = 1024;

/// A card without a card.
pub(crate) struct Emulated;

/// A scene as a card would have it.
struct Tables {
    world: FlatWorld,
    _memory: Here,
}

impl Machine for Emulated {
    fn name(&self) -> &str {
        "emulated"
    }

    fn take(&self, scene: &PreparedScene) -> Result<Box<dyn RemoteScene>, String> {
        let (shapes, mut memory) = (flat(scene)?, Here::default());
        let Ok(world) = world(scene, &shapes, &mut memory);
        Ok(Box::new(Tables { world, _memory: memory }))
    }
}

impl RemoteScene for Tables {
    fn wave<'a>(&'a self, field: Option<LightField<'a>>, _: usize) -> Result<Box<dyn RemoteWave + 'a>, String> {
        let mut world = self.world;
        if let Some(field) = field {
            (world.nodes, world.lowest) = (Table::at(field.nodes.as_ptr() as u64, field.nodes.len()), field.lowest);
        }
        Ok(Box::new(Wave { world, _tables: self }))
    }
}

struct Wave<'a> {
    world: FlatWorld,
    _tables: &'a Tables,
}

impl RemoteWave for Wave<'_> {
    fn follow(&mut self, starts: &[Start], samples: &mut [Sample]) -> Result<u64, String> {
        let some = |(starts, samples): (&[Start], &mut [Sample])| {
            // SAFETY: the tables are as `world` makes them; the scene keeps its memory, and whoever asked the field.
            let (found, rays) = unsafe { follow_here(&self.world, starts) };
            samples.copy_from_slice(&found);
            rays
        };
        Ok(starts.par_chunks(TOGETHER).zip(samples.par_chunks_mut(TOGETHER)).map(some).sum())
    }
}
