//! Paths followed in waves, step by step, on a card or on the processor.

use trove_trace::path::{Arrival, Path, Sample, Shadows, Start};
use trove_trace::wave::{Counts, Step, Wave};
use trove_trace::{Exposure, FlatWorld, Hit, Table};

/// Who does the steps of a wave.
pub(super) trait Steps {
    /// A step of the first `count` paths of list `which`.
    fn step(&mut self, step: Step, which: usize, count: usize) -> Result<(), String>;

    /// What was counted since this was last asked.
    fn counts(&mut self) -> Result<Counts, String>;
}

/// Follows `count` paths to their ends; how many rays that took.
pub(super) fn follow(steps: &mut impl Steps, count: usize) -> Result<u64, String> {
    steps.step(Step::Begin, 0, count)?;
    let (mut which, mut going, mut rays) = (0, count, 0);
    while going > 0 {
        for step in [Step::Trace, Step::Shelter, Step::Arrive, Step::Scatter, Step::Ask, Step::Send, Step::Light] {
            steps.step(step, which, going)?;
        }
        let counts = steps.counts()?;
        rays += going as u64 + u64::from(counts.shadows);
        (which, going) = (1 - which, counts.going as usize);
    }
    steps.step(Step::End, 0, count)?;
    Ok(rays)
}

/// Follows paths on the processor, by one thread, as a card would; what they brought, and how many rays that took.
///
/// # Safety
/// The world has to be as [`FlatWorld::readable`] wants it.
pub(super) unsafe fn follow_here(world: &FlatWorld, starts: &[Start]) -> (Vec<Sample>, u64) {
    let count = starts.len();
    let mut paths: Vec<_> = starts.iter().map(|start| Path::new(*start)).collect();
    let (mut hits, mut exposures) = (vec![Hit::NOTHING; count], vec![Exposure::BARE; count]);
    let (mut arrivals, mut shadows) = (vec![Arrival::End; count], vec![Shadows::default(); count]);
    let mut active = [vec![0; count], vec![0; count]];
    let (mut samples, mut counts) = (vec![Sample::default(); count], [Counts::default()]);
    let wave = Wave {
        starts: Table::at(starts.as_ptr() as u64, count),
        paths: table(&mut paths),
        hits: table(&mut hits),
        exposures: table(&mut exposures),
        arrivals: table(&mut arrivals),
        shadows: table(&mut shadows),
        active: active.each_mut().map(|list| table(list)),
        counts: table(&mut counts),
        samples: table(&mut samples),
    };
    let followed = follow(&mut Here { world, wave: &wave }, count);
    (samples, followed.unwrap_or_default())
}

fn table<T>(values: &mut [T]) -> Table<T> {
    Table::at(values.as_mut_ptr() as u64, values.len())
}

/// A wave in the processor's memory.
struct Here<'a> {
    world: &'a FlatWorld,
    wave: &'a Wave,
}

impl Steps for Here<'_> {
    fn step(&mut self, step: Step, which: usize, count: usize) -> Result<(), String> {
        for i in 0..count {
            // SAFETY: whoever made this vouches for the world; the tables are as long as the starts, and `follow` does the
            // steps in order.
            unsafe { self.wave.step(step, self.world, which, i) };
        }
        Ok(())
    }

    fn counts(&mut self) -> Result<Counts, String> {
        // SAFETY: as above.
        Ok(unsafe { self.wave.take_counts() })
    }
}
