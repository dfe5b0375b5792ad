//! Long work on a thread of its own, while Python's thread tells how far it is and hears Ctrl-C.

use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{self, RecvTimeoutError};
use std::sync::{Arc, Mutex};
use std::time::Duration;

use pyo3::prelude::*;
use trove::{Follower, Watch};

/// Time between two looks at signals and progress.
const LOOK_EVERY: Duration = Duration::from_millis(50);

#[derive(Default)]
struct Attendant {
    /// What was told last and has not been passed on.
    told: Mutex<Option<(f64, u64, String)>>,
    ended: AtomicBool,
}

impl Follower for Attendant {
    fn progress(&self, done: f64, total: u64, doing: &str) {
        if let Ok(mut told) = self.told.lock() {
            *told = Some((done, total, doing.to_owned()));
        }
    }

    fn stops(&self) -> bool {
        self.ended.load(Ordering::Relaxed)
    }
}

/// Does the work without holding Python's lock; `progress(done, total, doing)` is called on this thread. What a signal's
/// handler or `progress` raises ends the work early and is raised once it has ended; a second signal does not wait.
pub(crate) fn attended<T: Send + 'static>(
    py: Python<'_>,
    progress: Option<&Py<PyAny>>,
    work: impl FnOnce(&Watch) -> T + Send + 'static,
) -> PyResult<T> {
    let attendant = Arc::new(Attendant::default());
    let watch = Watch::of(attendant.clone());
    let (done, mut waiting) = mpsc::channel();
    let worker = std::thread::spawn(move || drop(done.send(work(&watch))));
    let mut raised: Option<PyErr> = None;
    loop {
        let answer;
        (waiting, answer) = py.detach(move || {
            let answer = waiting.recv_timeout(LOOK_EVERY);
            (waiting, answer)
        });
        let heard = py.check_signals().and_then(|()| pass_on(py, progress.filter(|_| raised.is_none()), &attendant));
        match (heard, &raised) {
            (Err(error), None) => {
                attendant.ended.store(true, Ordering::Relaxed);
                raised = Some(error);
            }
            // The thread ends by itself at its next look.
            (Err(error), Some(_)) => return Err(error),
            (Ok(()), _) => {}
        }
        match answer {
            Ok(answer) => return raised.map_or(Ok(answer), Err),
            Err(RecvTimeoutError::Timeout) => {}
            Err(RecvTimeoutError::Disconnected) => match worker.join() {
                Err(panic) => std::panic::resume_unwind(panic),
                Ok(()) => unreachable!("the work answers before its thread ends"),
            },
        }
    }
}

fn pass_on(py: Python<'_>, progress: Option<&Py<PyAny>>, attendant: &Attendant) -> PyResult<()> {
    let told = attendant.told.lock().ok().and_then(|mut told| told.take());
    if let (Some(progress), Some(told)) = (progress, told) {
        progress.call1(py, told)?;
    }
    Ok(())
}
