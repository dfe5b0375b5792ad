//! How much work a file's outlines may make.

use std::cell::Cell;

/// Steps of a few nanoseconds each: all of Monaco takes less than a thousandth of it.
const STEPS: u64 = 1_000_000_000;

/// What is left of the work that a file may make: outlines are compared edge by edge, so one that is tangled on purpose
/// takes the square of its length.
#[derive(Debug)]
pub(super) struct Effort(Cell<u64>);

impl Default for Effort {
    fn default() -> Self {
        Self(Cell::new(STEPS))
    }
}

impl Effort {
    /// Whether there is enough left for so many steps, which are then spent.
    pub(super) fn spend(&self, steps: usize) -> bool {
        let left = self.0.get().checked_sub(steps as u64);
        self.0.set(left.unwrap_or(0));
        left.is_some()
    }

    #[cfg(test)]
    pub(super) fn of(steps: u64) -> Self {
        Self(Cell::new(steps))
    }
}
