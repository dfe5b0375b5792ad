//! Signals: the first one that asks for an end is heeded by the run, the second one ends; a closed pipe ends quietly.

use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::{Arc, LazyLock, Once};

use signal_hook::consts::{SIGINT, SIGTERM};
use signal_hook::flag;

/// The signal that asked for an end; 0 where none did.
static ASKED: LazyLock<Arc<AtomicUsize>> = LazyLock::new(Arc::default);
/// Whether the next signal ends the program at once: always, but for the first one after [`listen`].
static AT_ONCE: LazyLock<Arc<AtomicBool>> = LazyLock::new(|| Arc::new(AtomicBool::new(true)));
static HANDLERS: Once = Once::new();

/// Takes over the signals of this process.
pub(crate) fn install() {
    HANDLERS.call_once(|| {
        let install = || -> std::io::Result<()> {
            for signal in [SIGINT, SIGTERM] {
                flag::register_conditional_shutdown(signal, status_of(signal as usize), AT_ONCE.clone())?;
                flag::register(signal, AT_ONCE.clone())?;
                flag::register_usize(signal, ASKED.clone(), signal as usize)?;
            }
            // Rust and Python ignore it, and then printing fails, which `println!` takes for a fault of the program.
            #[cfg(unix)]
            flag::register_conditional_default(signal_hook::consts::SIGPIPE, Arc::new(AtomicBool::new(true)))?;
            Ok(())
        };
        if let Err(error) = install() {
            tracing::warn!("Ctrl-C will end the program immediately: {error}");
        }
    });
}

/// From now on the first Ctrl-C or SIGTERM is remembered instead of ending the program.
pub(crate) fn listen() {
    ASKED.store(0, Ordering::SeqCst);
    AT_ONCE.store(false, Ordering::SeqCst);
}

/// Whether an end was asked for.
pub(crate) fn requested() -> bool {
    ASKED.load(Ordering::Relaxed) != 0
}

/// The exit status of a program that ended because it was asked to: 130 after Ctrl-C, 143 after SIGTERM.
pub(crate) fn status() -> i32 {
    status_of(ASKED.load(Ordering::SeqCst))
}

/// 128 and the signal's number, the shell's own convention.
fn status_of(signal: usize) -> i32 {
    128 + signal as i32
}
