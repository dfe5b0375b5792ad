//! How far a long command is: a bar on a terminal, plain lines elsewhere; told to the program that called it.

use std::io::IsTerminal;
use std::sync::{Arc, Mutex, OnceLock};
use std::time::{Duration, Instant, SystemTime, UNIX_EPOCH};

use indicatif::{ProgressBar, ProgressStyle};

use crate::watch::{Follower, Watch};

/// Steps of a bar for one frame, so that it moves within a frame too.
const STEPS: u64 = 1000;
/// Time between two plain lines.
const LINE_EVERY: Duration = Duration::from_secs(60);

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
    /// Those of them that were there before, which took no time.
    found: u64,
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
        Self {
            shown,
            state: Mutex::new(State { done: 0, found: 0, total, doing: String::new(), started: now, last_line: now }),
        }
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
            Shown::Lines => state.line(done),
        }
    }

    /// One more frame is done.
    pub(crate) fn frame_done(&self) {
        self.one_more(0);
    }

    /// One more frame was done before.
    pub(crate) fn frame_found(&self) {
        self.one_more(1);
    }

    fn one_more(&self, found: u64) {
        if let Ok(mut state) = self.state.lock() {
            state.done += 1;
            state.found += found;
            match &self.shown {
                Shown::Bar(bar) => bar.set_position(state.done * STEPS),
                Shown::Follower(follower) => follower.progress(state.done as f64, state.total, &state.doing),
                Shown::Lines => {
                    let done = state.done as f64;
                    state.line(done);
                }
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

    /// Frames in all.
    pub(crate) fn total(&self) -> u64 {
        self.state.lock().map_or(0, |state| state.total)
    }

    /// Takes the bar away.
    pub(crate) fn finish(&self) {
        if let Shown::Bar(bar) = &self.shown {
            bar.finish_and_clear();
        }
    }
}

impl State {
    /// Says once a minute how far it is with so many done, and when it will end.
    fn line(&mut self, done: f64) {
        if self.last_line.elapsed() < LINE_EVERY {
            return;
        }
        self.last_line = Instant::now();
        let share = 100.0 * done / self.total.max(1) as f64;
        let ends = match self.left_s(done, self.started.elapsed().as_secs_f64()) {
            Some(left_s) => {
                let now_s = SystemTime::now().duration_since(UNIX_EPOCH).unwrap_or_default().as_secs_f64();
                format!("about {} left, until {} UTC", duration(left_s), clock(now_s + left_s))
            }
            None => "nothing new yet".into(),
        };
        eprintln!("  frame {} of {}, {share:.0} %, {ends}", (done as u64 + 1).min(self.total), self.total);
    }

    /// Seconds until all are done; `None` before the first new one.
    fn left_s(&self, done: f64, elapsed_s: f64) -> Option<f64> {
        let new = done - self.found as f64;
        (new > 0.0).then(|| elapsed_s / new * (self.total as f64 - done).max(0.0))
    }
}

/// The time of day of a moment, seconds since 1970 UTC.
fn clock(unix_s: f64) -> String {
    let minutes = (unix_s / 60.0) as u64;
    format!("{:02}:{:02}", minutes / 60 % 24, minutes % 60)
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
    fn what_was_there_before_does_not_count_for_the_pace() {
        let progress = Progress::new(100, &Watch::default());
        let left = |done, elapsed_s| progress.state.lock().unwrap().left_s(done, elapsed_s);
        (0..40).for_each(|_| progress.frame_found());
        assert_eq!((progress.total(), left(40.0, 9.0)), (100, None));
        (0..10).for_each(|_| progress.frame_done());
        assert_eq!(left(50.0, 30.0), Some(150.0));
        assert_eq!(clock(1_763_999_999.0), "15:59");
    }

    #[test]
    fn durations_are_said_in_fitting_units() {
        for (seconds, expect) in [(12.3, "12 s"), (600.0, "10 min"), (7200.0, "2.0 h")] {
            assert_eq!(duration(seconds), expect);
        }
    }
}
