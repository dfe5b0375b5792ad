//! Ctrl-C: the first one asks for an end, the second one ends.

use std::sync::Once;
use std::sync::atomic::{AtomicBool, Ordering};

static REQUESTED: AtomicBool = AtomicBool::new(false);
static HANDLER: Once = Once::new();

/// From now on Ctrl-C (and SIGTERM) is remembered instead of ending the program.
pub(crate) fn listen() {
    REQUESTED.store(false, Ordering::Relaxed);
    HANDLER.call_once(|| {
        let handler = || {
            if REQUESTED.swap(true, Ordering::Relaxed) {
                std::process::exit(130); // 128 + SIGINT, the shell's own convention
            }
        };
        if let Err(error) = ctrlc::set_handler(handler) {
            tracing::warn!("Ctrl-C will end the program immediately: {error}");
        }
    });
}

/// Whether an end was asked for.
pub(crate) fn requested() -> bool {
    REQUESTED.load(Ordering::Relaxed)
}
