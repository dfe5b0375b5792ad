//! A thread beside the run, which works on what it is given in that order.

use std::panic::resume_unwind;
use std::sync::mpsc::{Receiver, SyncSender, channel, sync_channel};
use std::thread::{self, JoinHandle};

/// Jobs that wait while one is worked on: pictures are large.
const WAITING: usize = 1;

/// Takes jobs and gives back what became of them; `T` is what it works with.
pub(super) struct Worker<T, J, D> {
    jobs: SyncSender<J>,
    done: Receiver<D>,
    under_way: usize,
    thread: JoinHandle<T>,
}

impl<T: Send + 'static, J: Send + 'static, D: Send + 'static> Worker<T, J, D> {
    /// Starts it; it ends with what has been given to it once this is dropped.
    pub(super) fn new(mut tool: T, work: impl Fn(&mut T, J) -> D + Send + 'static) -> Self {
        let (jobs, given) = sync_channel::<J>(WAITING);
        let (finished, done) = channel();
        let thread = thread::spawn(move || {
            given.iter().all(|job| finished.send(work(&mut tool, job)).is_ok());
            tool
        });
        Self { jobs, done, under_way: 0, thread }
    }

    /// Hands a job over, once there is room for it.
    pub(super) fn give(&mut self, job: J) {
        // Only a panic ends the thread before this; `end` goes on with it.
        self.under_way += usize::from(self.jobs.send(job).is_ok());
    }

    /// What is done by now and was not given back yet.
    pub(super) fn done(&mut self) -> Vec<D> {
        let done: Vec<D> = self.done.try_iter().collect();
        self.under_way -= done.len();
        done
    }

    /// All the rest, as soon as it is done; fewer than were given if the thread panicked.
    pub(super) fn rest(&mut self) -> Vec<D> {
        let under_way = std::mem::take(&mut self.under_way);
        self.done.iter().take(under_way).collect()
    }

    /// Ends it, once [`Self::rest`] has been taken, and gives back what it worked with; panics where its thread did.
    pub(super) fn end(self) -> T {
        drop(self.jobs);
        self.thread.join().unwrap_or_else(|panic| resume_unwind(panic))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn everything_comes_back_in_its_order_and_once() {
        let mut worker = Worker::new(0, |sum, n: u32| {
            *sum += n;
            n * n
        });
        let mut squares = Vec::new();
        for n in 0..20 {
            worker.give(n);
            squares.extend(worker.done());
        }
        squares.extend(worker.rest());
        assert_eq!(squares, (0..20).map(|n| n * n).collect::<Vec<_>>());
        assert!(worker.rest().is_empty() && worker.done().is_empty());
        assert_eq!(worker.end(), 190);
    }

    #[test]
    fn a_thread_that_panics_is_not_waited_for() {
        let mut worker = Worker::new((), |(), n: u32| assert!(n < 2, "on purpose"));
        (0..6).for_each(|n| worker.give(n));
        assert_eq!(worker.rest().len(), 2);
    }
}
