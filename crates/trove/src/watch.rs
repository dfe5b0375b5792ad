//! Who follows a command under way: the terminal and its signals, or a program that called it.

use std::sync::Arc;

use crate::interrupt;

/// A program that runs a command; it is asked and told from any thread.
pub trait Follower: Send + Sync {
    /// `done` of `total` pictures are finished, counting the share of the one in work; `doing` is what is being done.
    fn progress(&self, done: f64, total: u64, doing: &str);

    /// Whether the command shall end early; what is finished is kept.
    fn stops(&self) -> bool;
}

/// Whom a command tells how far it is, and who may end it: by default the terminal.
#[derive(Clone, Default)]
pub struct Watch(Option<Arc<dyn Follower>>);

impl Watch {
    /// A program's.
    pub fn of(follower: Arc<dyn Follower>) -> Self {
        Self(Some(follower))
    }

    /// The program that is told; `None` where it is the terminal.
    pub(crate) fn follower(&self) -> Option<Arc<dyn Follower>> {
        self.0.clone()
    }

    /// From now on the terminal's first signal is an end that was asked for, instead of ending the program.
    pub(crate) fn listen(&self) {
        if self.0.is_none() {
            interrupt::listen();
        }
    }

    /// Whether an end was asked for.
    pub(crate) fn stops(&self) -> bool {
        self.0.as_ref().map_or_else(interrupt::requested, |follower| follower.stops())
    }
}
