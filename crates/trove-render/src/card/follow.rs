//! Paths followed in waves, step by step, on a card or on the processor.

use std::ffi::CStr;

use trove_trace::path::{Path, Sample, Start, Turn};
use trove_trace::wave::{Step, Wave};
use trove_trace::{FlatWorld, Hit, Table};

use super::driver::{Buffer, Device};
use super::{BLOCK, Uploaded};

/// Who does the steps of a wave.
pub(super) trait Machine {
    /// A step of the first `count` paths of list `which`.
    fn step(&mut self, step: Step, which: usize, count: usize) -> Result<(), String>;

    /// How many paths went on since this was last asked.
    fn going(&mut self) -> Result<usize, String>;
}

/// Follows `count` paths to their ends.
pub(super) fn follow(machine: &mut impl Machine, count: usize) -> Result<(), String> {
    machine.step(Step::Begin, 0, count)?;
    let (mut which, mut going) = (0, count);
    while going > 0 {
        for step in [Step::Trace, Step::Turn, Step::Light] {
            machine.step(step, which, going)?;
        }
        (which, going) = (1 - which, machine.going()?);
    }
    machine.step(Step::End, 0, count)
}

/// A wave in the processor's memory, followed by one thread.
pub(super) struct Here<'a> {
    world: &'a FlatWorld,
    wave: Wave,
    going: Box<u32>,
    samples: Vec<Sample>,
    /// What the tables of the wave lie in.
    _held: Held<'a>,
}

type Held<'a> = (&'a [Start], Vec<Path>, Vec<Hit>, Vec<Turn>, [Vec<u32>; 2]);

impl<'a> Here<'a> {
    /// # Safety
    /// The world has to be as [`FlatWorld::readable`] wants it.
    pub(super) unsafe fn new(world: &'a FlatWorld, starts: &'a [Start]) -> Self {
        let count = starts.len();
        let mut paths: Vec<_> = starts.iter().map(|start| Path::new(*start)).collect();
        let mut hits = vec![Hit::NOTHING; count];
        let mut turns = vec![Turn::default(); count];
        let mut active = [vec![0; count], vec![0; count]];
        let (mut samples, mut going) = (vec![Sample::default(); count], Box::new(0));
        let wave = Wave {
            starts: Table::at(starts.as_ptr() as u64, count),
            paths: table(&mut paths),
            hits: table(&mut hits),
            turns: table(&mut turns),
            active: active.each_mut().map(|list| table(list)),
            going: Table::at(&raw mut *going as u64, 1),
            samples: table(&mut samples),
        };
        Self { world, wave, going, samples, _held: (starts, paths, hits, turns, active) }
    }

    pub(super) fn samples(&self) -> &[Sample] {
        &self.samples
    }
}

fn table<T>(values: &mut [T]) -> Table<T> {
    Table::at(values.as_mut_ptr() as u64, values.len())
}

impl Machine for Here<'_> {
    fn step(&mut self, step: Step, which: usize, count: usize) -> Result<(), String> {
        for i in 0..count {
            // SAFETY: `new` was vouched for, the tables are as long as the starts, and `follow` does the steps in order.
            unsafe { self.wave.step(step, self.world, which, i) };
        }
        Ok(())
    }

    fn going(&mut self) -> Result<usize, String> {
        Ok(std::mem::take(&mut *self.going) as usize)
    }
}

/// A wave in a card's memory.
pub(super) struct There<'a> {
    device: &'a Device,
    world: u64,
    wave: Buffer<'a, Wave>,
    going: Buffer<'a, u32>,
    samples: Buffer<'a, Sample>,
    _held: Vec<Buffer<'a, u8>>,
    /// On the card so far.
    pub(super) seconds: f64,
}

impl<'a> There<'a> {
    pub(super) fn new(device: &'a Device, uploaded: &Uploaded<'_>, starts: &[Start]) -> Result<Self, String> {
        let count = starts.len();
        let starts = device.hold(starts)?;
        let (paths, hits, turns) =
            (device.room::<Path>(count)?, device.room::<Hit>(count)?, device.room::<Turn>(count)?);
        let (first, second) = (device.room(count)?, device.room(count)?);
        let (samples, going) = (device.room(count)?, device.hold(&[0u32])?);
        let wave = device.hold(&[Wave {
            starts: Table::at(starts.address(), count),
            paths: Table::at(paths.address(), count),
            hits: Table::at(hits.address(), count),
            turns: Table::at(turns.address(), count),
            active: [&first, &second].map(|list: &Buffer<'_, u32>| Table::at(list.address(), count)),
            going: Table::at(going.address(), 1),
            samples: Table::at(samples.address(), count),
        }])?;
        let held = vec![
            starts.into_bytes(),
            paths.into_bytes(),
            hits.into_bytes(),
            turns.into_bytes(),
            first.into_bytes(),
            second.into_bytes(),
        ];
        Ok(Self { device, world: uploaded.world.address(), wave, going, samples, _held: held, seconds: 0.0 })
    }

    pub(super) fn samples(&self, count: usize) -> Result<Vec<Sample>, String> {
        let mut samples = vec![Sample::default(); count];
        self.samples.read(&mut samples)?;
        Ok(samples)
    }
}

/// What a step is called on the card.
pub(super) fn name(step: Step) -> &'static CStr {
    match step {
        Step::Begin => c"begin",
        Step::Trace => c"trace",
        Step::Turn => c"turn",
        Step::Light => c"light",
        Step::End => c"end",
    }
}

impl Machine for There<'_> {
    fn step(&mut self, step: Step, which: usize, count: usize) -> Result<(), String> {
        let function = self.device.function(name(step))?;
        // SAFETY: world and wave are as `world` and `new` make them, and `follow` does the steps in order.
        self.seconds +=
            unsafe { function.run(&[self.world, self.wave.address()], &[which as u32, count as u32], BLOCK)? };
        Ok(())
    }

    fn going(&mut self) -> Result<usize, String> {
        let mut going = [0];
        self.going.read(&mut going)?;
        self.going.write(&[0])?;
        Ok(going[0] as usize)
    }
}
