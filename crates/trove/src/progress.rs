//! How far a long command is: a bar on a terminal, plain lines elsewhere; told to the program that called it.

use std::io::IsTerminal;
use std::sync::{Arc, Mutex, OnceLock};
use std::time::{Duration, Instant};

use indicatif::{ProgressBar, ProgressStyle};

use crate::watch::{Follower, Watch};

/// Steps of a bar for one frame, so that it moves within a frame too.
const STEPS: u64 = 1000;
/// Time between two plain lines.
const LINE_EVERY: Duration = Duration::from_secs(10);

/// Frames done out of frames to do.
pub(crate) struct Progress {
    shown: Shown,
    state: Mutex<State>,
}

/// Where it is shown.
enum Shown {
    Bar(ProgressBar),
    Lines,
    Follower(Arc<dyn Follower>),
}

struct State {
    done: u64,
    total: u64,
    doing: String,
    started: Instant,
    last_line: Instant,
}

impl Progress {
    /// For `total` frames of which none is done.
    pub(crate) fn new(total: usize, watch: &Watch) -> Self {
        let bar = || {
            let style = ProgressStyle::with_template("{bar:30} {percent:>3} % · {msg} · {eta} left");
            ProgressBar::new(total as u64 * STEPS).with_style(style.expect("the template is a constant that is tested"))
        };
        let shown = match watch.follower() {
            Some(follower) => Shown::Follower(follower),
            None if std::io::stderr().is_terminal() => Shown::Bar(bar()),
            None => Shown::Lines,
        };
        let (total, now) = (total as u64, Instant::now());
        Self { shown, state: Mutex::new(State { done: 0, total, doing: String::new(), started: now, last_line: now }) }
    }

    /// What is being done now.
    pub(crate) fn say(&self, text: &str) {
        match &self.shown {
            Shown::Bar(bar) => bar.set_message(text.to_owned()),
            Shown::Lines => eprintln!("{text}"),
            Shown::Follower(follower) => {
                let Ok(mut state) = self.state.lock() else { return };
                state.doing = text.to_owned();
                follower.progress(state.done as f64, state.total, text);
            }
        }
    }

    /// The frame in work is done to this share.
    pub(crate) fn within(&self, share: f32) {
        let Ok(mut state) = self.state.lock() else { return };
        let share = f64::from(share.clamp(0.0, 1.0));
        let done = state.done as f64 + share;
        match &self.shown {
            Shown::Bar(bar) => bar.set_position((done * STEPS as f64) as u64),
            Shown::Follower(follower) => follower.progress(done, state.total, &state.doing),
            Shown::Lines if state.last_line.elapsed() > LINE_EVERY => {
                state.last_line = Instant::now();
                let left_s = state.started.elapsed().as_secs_f64() * (state.total as f64 - done) / done.max(1e-3);
                eprintln!(
                    "  frame {} of {}, {:.0} %, about {} left",
                    state.done + 1,
                    state.total,
                    100.0 * done / state.total.max(1) as f64,
                    duration(left_s)
                );
            }
            Shown::Lines => {}
        }
    }

    /// One more frame is done.
    pub(crate) fn frame_done(&self) {
        if let Ok(mut state) = self.state.lock() {
            state.done += 1;
            match &self.shown {
                Shown::Bar(bar) => bar.set_position(state.done * STEPS),
                Shown::Follower(follower) => follower.progress(state.done as f64, state.total, &state.doing),
                Shown::Lines => {}
            }
        }
    }

    /// A scene that was thought to have `hint` frames has `count`.
    pub(crate) fn correct(&self, hint: usize, count: usize) {
        if let Ok(mut state) = self.state.lock() {
            state.total = (state.total + count as u64).saturating_sub(hint as u64);
            match &self.shown {
                Shown::Bar(bar) => bar.set_length(state.total * STEPS),
                Shown::Follower(follower) => follower.progress(state.done as f64, state.total, &state.doing),
                Shown::Lines => {}
            }
        }
    }

    /// Takes the bar away.
    pub(crate) fn finish(&self) {
        if let Shown::Bar(bar) = &self.shown {
            bar.finish_and_clear();
        }
    }
}

/// Seconds as people say them.
pub(crate) fn duration(seconds: f64) -> String {
    match seconds {
        s if s < 90.0 => format!("{s:.0} s"),
        s if s < 5400.0 => format!("{:.0} min", s / 60.0),
        s => format!("{:.1} h", s / 3600.0),
    }
}

/// How far a command is that does many like things; shown from the first of them.
pub(crate) struct Steps<'a> {
    progress: OnceLock<Progress>,
    watch: &'a Watch,
}

impl<'a> Steps<'a> {
    pub(crate) fn new(watch: &'a Watch) -> Self {
        Self { progress: OnceLock::new(), watch }
    }

    /// One more is done, of `total`; the answer is whether to go on.
    pub(crate) fn done(&self, done: usize, total: usize) -> bool {
        let progress = self.progress.get_or_init(|| Progress::new(total, self.watch));
        progress.frame_done();
        if done == total {
            progress.finish()
        } else {
            progress.within(0.0)
        }
        !self.watch.stops()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_bar_s_template_is_sound() {
        assert!(ProgressStyle::with_template("{bar:30} {percent:>3} % · {msg} · {eta} left").is_ok());
    }

    #[test]
    fn durations_are_said_in_fitting_units() {
        for (seconds, expect) in [(12.3, "12 s"), (600.0, "10 min"), (7200.0, "2.0 h")] {
            assert_eq!(duration(seconds), expect);
        }
    }
}
