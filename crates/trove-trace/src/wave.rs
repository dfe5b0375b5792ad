//! Many paths at once, one step of all of them after the other, as a card follows them.

use core::sync::atomic::{AtomicU32, Ordering};

use crate::flat::{Asked, NONE, Table};
use crate::path::{Path, Sample, Start, Turn, World, advance};
use crate::ray::Hit;
use crate::world::FlatWorld;

/// Room for paths, each with its own place in every table.
#[derive(Clone, Copy)]
#[repr(C)]
pub struct Wave {
    /// Where they begin.
    pub starts: Table<Start>,
    /// As they are under way.
    pub paths: Table<Path>,
    /// What their rays meet; the instance is [`NONE`] where that is nothing.
    pub hits: Table<Hit>,
    /// What came of that.
    pub turns: Table<Turn>,
    /// Places of those that are under way, in no order; one list is read while the other is written.
    pub active: [Table<u32>; 2],
    /// How many are in the list that is written; one number.
    pub going: Table<u32>,
    /// What they brought.
    pub samples: Table<Sample>,
}

/// What is done with all paths before the next thing is done with any.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Step {
    /// Each start becomes a path under way, in the first list.
    Begin,
    /// What the rays of those in a list meet.
    Trace,
    /// What comes of that; who goes on is put into the other list.
    Turn,
    /// What reaches those in the list of the light that they asked for.
    Light,
    /// What each path brought.
    End,
}

impl Wave {
    /// A step of the `i`-th path in list `which`, or of all paths for [`Step::Begin`] and [`Step::End`].
    ///
    /// # Safety
    /// The world has to be as [`FlatWorld::readable`] wants it, all tables as long as that of the starts, and steps have to be
    /// done in the order begin, (trace, turn, light) until nobody goes on, end; each once for each place, by any threads.
    #[inline(always)]
    pub unsafe fn step(&self, step: Step, world: &FlatWorld, which: usize, i: usize) {
        // SAFETY: the caller vouches for all tables, and that nobody else is at this place.
        unsafe {
            match step {
                Step::Begin => {
                    self.paths.place(i).write(Path::new(self.starts.values()[i]));
                    self.active[0].place(i).write(i as u32);
                }
                Step::End => self.samples.place(i).write((*self.paths.place(i)).sample()),
                Step::Trace => {
                    let place = self.active[which].place(i).read() as usize;
                    let path = &*self.paths.place(place);
                    let asked = Asked { ray: path.ray, past: path.past, stays: 0, through_glass: 0 };
                    self.hits.place(place).write(world.scene.closest(&asked).unwrap_or(Hit::NOTHING));
                }
                Step::Turn => {
                    let place = self.active[which].place(i).read();
                    let hit = self.hits.place(place as usize).read();
                    let hit = (hit.instance != NONE).then_some(hit);
                    let turn = advance(&world.readable(), &mut *self.paths.place(place as usize), hit);
                    self.turns.place(place as usize).write(turn);
                    if turn.goes_on {
                        let going = AtomicU32::from_ptr(self.going.place(0)).fetch_add(1, Ordering::Relaxed);
                        self.active[1 - which].place(going as usize).write(place);
                    }
                }
                Step::Light => {
                    let place = self.active[which].place(i).read() as usize;
                    let (world, turn) = (world.readable(), self.turns.place(place).read());
                    for shadow in [turn.to_rest, turn.to_sun].into_iter().flatten() {
                        let light = world.let_through(&shadow.ray, shadow.light);
                        (*self.paths.place(place)).gather(light, shadow.bounce, world.lights().scale);
                    }
                }
            }
        }
    }
}
