//! Many paths at once, one step of all of them after the other, as a card follows them.

use core::sync::atomic::{AtomicU32, Ordering};

use crate::flat::{Asked, Table};
use crate::path::{Arrival, Path, Sample, Shadows, Start, World, arrive, ask, scatter, send};
use crate::ray::{Hit, NONE};
use crate::surface::Exposure;
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
    /// What comes down where they have arrived.
    pub exposures: Table<Exposure>,
    /// Where that is.
    pub arrivals: Table<Arrival>,
    /// Light that they asked for there.
    pub shadows: Table<Shadows>,
    /// Places of those that are under way, in no order; one list is read while the other is written.
    pub active: [Table<u32>; 2],
    /// One.
    pub counts: Table<Counts>,
    /// What they brought.
    pub samples: Table<Sample>,
}

/// What is counted on the way.
#[derive(Clone, Copy, Debug, Default)]
#[repr(C)]
pub struct Counts {
    /// Paths in the list that is written.
    pub going: u32,
    /// Rays that asked for light.
    pub shadows: u32,
}

/// What is done with all paths before the next thing is done with any.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Step {
    /// Each start becomes a path under way, in the first list.
    Begin,
    /// What the rays of those in a list meet.
    Trace,
    /// What comes down there.
    Shelter,
    /// Where they have arrived, and what light is there.
    Arrive,
    /// Those at droplets ask for light and go on; who goes on is put into the other list.
    Scatter,
    /// Those at surfaces ask for light.
    Ask,
    /// And go on.
    Send,
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
    /// done in the order begin, (trace, shelter, arrive, scatter, ask, send, light) until nobody goes on, end; each once for each
    /// place, by any threads.
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
                    let asked = Asked { ray: path.ray, past: path.past, marks: 0, through_glass: 0 };
                    self.hits.place(place).write(world.scene.closest(&asked).unwrap_or(Hit::NOTHING));
                }
                Step::Shelter => {
                    let place = self.active[which].place(i).read() as usize;
                    let ray = &(*self.paths.place(place)).ray;
                    let exposure = self.hit(place).map(|hit| world.readable().exposure(&hit, ray));
                    self.exposures.place(place).write(exposure.unwrap_or(Exposure::BARE));
                }
                Step::Arrive => {
                    let place = self.active[which].place(i).read() as usize;
                    let world = world.readable().under(self.exposures.place(place).read());
                    let arrival = arrive(&world, &mut *self.paths.place(place), self.hit(place));
                    self.arrivals.place(place).write(arrival);
                    self.shadows.place(place).write(Shadows::default());
                }
                Step::Scatter => {
                    let place = self.active[which].place(i).read() as usize;
                    if let Arrival::Droplet(t) = *self.arrivals.place(place) {
                        let world = world.readable().under(self.exposures.place(place).read());
                        let turn = scatter(&world, &mut *self.paths.place(place), t, self.hit(place));
                        self.shadows.place(place).write(turn.shadows);
                        self.go_on(which, place, turn.goes_on);
                    }
                }
                Step::Ask => {
                    let place = self.active[which].place(i).read() as usize;
                    if let Arrival::Surface(vertex) = &*self.arrivals.place(place) {
                        let shadows = ask(&world.readable(), &mut *self.paths.place(place), vertex);
                        self.shadows.place(place).write(shadows);
                    }
                }
                Step::Send => {
                    let place = self.active[which].place(i).read() as usize;
                    if let Arrival::Surface(vertex) = &*self.arrivals.place(place) {
                        let goes_on = send(&world.readable(), &mut *self.paths.place(place), vertex);
                        self.go_on(which, place, goes_on);
                    }
                }
                Step::Light => {
                    let place = self.active[which].place(i).read() as usize;
                    let (world, asked) = (world.readable(), self.shadows.place(place).read());
                    let mut rays = 0;
                    for shadow in [asked.to_rest, asked.to_sun].into_iter().flatten() {
                        let light = world.let_through(&shadow.ray, shadow.light);
                        (*self.paths.place(place)).gather(light, shadow.bounce, world.lights().scale);
                        rays += 1;
                    }
                    if rays > 0 {
                        AtomicU32::from_ptr(&raw mut (*self.counts.place(0)).shadows)
                            .fetch_add(rays, Ordering::Relaxed);
                    }
                }
            }
        }
    }

    /// What the ray of a path meets.
    ///
    /// # Safety
    /// As for [`Self::step`].
    #[inline(always)]
    unsafe fn hit(&self, place: usize) -> Option<Hit> {
        // SAFETY: the caller vouches for it.
        let hit = unsafe { self.hits.place(place).read() };
        (hit.instance != NONE).then_some(hit)
    }

    /// Puts a path into the other list if it goes on.
    ///
    /// # Safety
    /// As for [`Self::step`].
    #[inline(always)]
    unsafe fn go_on(&self, which: usize, place: usize, goes_on: bool) {
        if goes_on {
            // SAFETY: the caller vouches for it.
            unsafe {
                let going = &raw mut (*self.counts.place(0)).going;
                let going = AtomicU32::from_ptr(going).fetch_add(1, Ordering::Relaxed);
                self.active[1 - which].place(going as usize).write(place as u32);
            }
        }
    }

    /// What was counted since this was last asked.
    ///
    /// # Safety
    /// As for [`Self::step`], between two steps.
    pub unsafe fn take_counts(&self) -> Counts {
        // SAFETY: the caller vouches for it.
        unsafe { self.counts.place(0).replace(Counts::default()) }
    }
}
