//! What can be wrong with a scene or with the machine.

use std::path::PathBuf;

/// Why a renderer could not be made or a scene could not be prepared.
#[derive(Debug, thiserror::Error)]
pub enum RenderError {
    /// The scene breaks its own rules: its builder must act.
    #[error("scene: {place}: expected {expected}, found {found}")]
    Scene {
        /// Which mesh, material or instance.
        place: String,
        /// What should be there.
        expected: &'static str,
        /// What is there.
        found: String,
    },
    /// A shared library that was asked for is not on this machine or is not usable: the user must act.
    #[error("{library}: {problem}; looked in {}; install it or choose the built-in kernel", list(.looked))]
    Library {
        /// Which.
        library: &'static str,
        /// What happened.
        problem: String,
        /// Where it was looked for.
        looked: Vec<PathBuf>,
    },
    /// The kernel could not build a scene: mostly, memory is short.
    #[error(
        "{kernel}: {problem}; free memory, or build a smaller area, or choose the built-in kernel (--kernel obvhs)"
    )]
    Kernel {
        /// Which, with its version.
        kernel: String,
        /// What it was doing, and what it said.
        problem: String,
    },
    /// The graphics card that was asked for cannot be used.
    #[error("cuda:{number}: {problem}; let the processor do it (--device cpu), or see docs/cards.md")]
    Card {
        /// Which, counted from 0.
        number: u32,
        /// What the driver said.
        problem: String,
    },
    /// The machine refused threads.
    #[error("cannot start {threads} threads: {source}; use fewer")]
    Threads {
        /// How many were asked for.
        threads: usize,
        /// The machine's answer.
        source: rayon::ThreadPoolBuildError,
    },
}

fn list(paths: &[PathBuf]) -> String {
    if paths.is_empty() {
        return "the system's folders".into();
    }
    paths.iter().map(|p| p.display().to_string()).collect::<Vec<_>>().join(", ")
}
