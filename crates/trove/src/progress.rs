//! How far a long command is: a bar on a terminal, plain lines elsewhere.

use std::io::IsTerminal;
use std::sync::{Mutex, OnceLock};
use std::time::{Duration, Instant};

use indicatif::{ProgressBar, ProgressStyle};

/// Steps of a bar for one frame, so that it moves within a frame too.
const STEPS: u64 = 1000;
/// Time between two plain lines.
const LINE_EVERY: Duration = Duration::from_secs(10);

/// Frames done out of frames to do.
pub(crate) struct Progress {
    bar: Option<ProgressBar>,
    state: Mutex<State>,
}

struct State {
    done: u64,
    total: u64,
    started: Instant,
    last_line: Instant,
}

impl Progress {
    /// For `total` frames of which none is done.
    pub(crate) fn new(total: usize) -> Self {
        let bar = std::io::stderr().is_terminal().then(|| {
            let style = ProgressStyle::with_template("{bar:30} {percent:>3} % · {msg} · {eta} left");
            ProgressBar::new(total as u64 * STEPS).with_style(style.expect("the template is a constant that is tested"))
        });
        let now = Instant::now();
        Self { bar, state: Mutex::new(State { done: 0, total: total as u64, started: now, last_line: now }) }
    }

    /// What is being done now.
    pub(crate) fn say(&self, text: &str) {
        match &self.bar {
            Some(bar) => bar.set_message(text.to_owned()),
            None => eprintln!("{text}"),
        }
    }

    /// The frame in work is done to this share.
    pub(crate) fn within(&self, share: f32) {
        let Ok(mut state) = self.state.lock() else { return };
        let share = f64::from(share.clamp(0.0, 1.0));
        if let Some(bar) = &self.bar {
            bar.set_position(state.done * STEPS + (share * STEPS as f64) as u64);
        } else if state.last_line.elapsed() > LINE_EVERY {
            state.last_line = Instant::now();
            let done = state.done as f64 + share;
            let left_s = state.started.elapsed().as_secs_f64() * (state.total as f64 - done) / done.max(1e-3);
            eprintln!(
                "  frame {} of {}, {:.0} %, about {} left",
                state.done + 1,
                state.total,
                100.0 * done / state.total.max(1) as f64,
                duration(left_s)
            );
        }
    }

    /// One more frame is done.
    pub(crate) fn frame_done(&self) {
        if let Ok(mut state) = self.state.lock() {
            state.done += 1;
            if let Some(bar) = &self.bar {
                bar.set_position(state.done * STEPS);
            }
        }
    }

    /// A scene that was thought to have `hint` frames has `count`.
    pub(crate) fn correct(&self, hint: usize, count: usize) {
        if let Ok(mut state) = self.state.lock() {
            state.total = (state.total + count as u64).saturating_sub(hint as u64);
            if let Some(bar) = &self.bar {
                bar.set_length(state.total * STEPS);
            }
        }
    }

    /// Takes the bar away.
    pub(crate) fn finish(&self) {
        if let Some(bar) = &self.bar {
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

/// How far a command is that does many like things; made with the first of them.
#[derive(Default)]
pub(crate) struct Steps(OnceLock<Progress>);

impl Steps {
    /// One more is done, of `total`.
    pub(crate) fn done(&self, done: usize, total: usize) {
        let progress = self.0.get_or_init(|| Progress::new(total));
        progress.frame_done();
        if done == total { progress.finish() } else { progress.within(0.0) }
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
