//! A scene in another machine's memory, such as a graphics card's, which follows paths through it.

use trove_trace::field::LightField;
use trove_trace::path::{Sample, Start};

/// A scene in another machine's memory.
pub(crate) trait RemoteScene: Send + Sync {
    /// Room there for up to `most` paths at once, through fog whose light is read from a field if there is one.
    ///
    /// # Errors
    /// What the machine refuses: most likely it is full, or lost.
    fn wave<'a>(&'a self, field: Option<LightField<'a>>, most: usize) -> Result<Box<dyn RemoteWave + 'a>, String>;
}

/// Paths that go together.
pub(crate) trait RemoteWave {
    /// Follows paths from their starts to their ends and puts what each brought into `samples`; how many rays that took.
    ///
    /// # Errors
    /// What the machine refuses: most likely it is lost.
    fn follow(&mut self, starts: &[Start], samples: &mut [Sample]) -> Result<u64, String>;
}

/// Where a scene's paths are followed.
pub(crate) enum Place {
    /// By this processor, as it was asked to.
    Here,
    /// By this processor, and why not by the machine that was asked to.
    Refused(String),
    /// By another machine.
    There(Box<dyn RemoteScene>),
}
