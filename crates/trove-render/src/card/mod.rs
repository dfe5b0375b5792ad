//! Paths on a graphics card: the functions of `trove_trace`, compiled to PTX, which the card's driver compiles for the card.

mod driver;
mod emulated;
mod follow;
mod memory;
mod rates;
mod world;

use std::ffi::CString;
use std::sync::Arc;

use self::driver::Device;
use self::memory::{Shared, Uploaded};
use self::world::flat;
use crate::PreparedScene;
use crate::accel::Flat;
use crate::remote::RemoteScene;

pub(crate) use emulated::Emulated;
pub use rates::CardRate;
pub(crate) use rates::card_rates;

/// `trove_trace` for cards; `make ptx` writes it.
const PTX: &str = include_str!("trace.ptx");

/// A graphics card that follows paths.
pub struct Card {
    device: Arc<Device>,
    shared: Shared,
}

/// A machine that scenes can be sent to.
pub(crate) trait Machine: Send + Sync {
    /// Name, for the identity of a run.
    fn name(&self) -> &str;

    /// Sends a scene.
    ///
    /// # Errors
    /// Why its paths cannot be followed there.
    fn take(&self, scene: &PreparedScene) -> Result<Box<dyn RemoteScene>, String>;
}

impl Card {
    /// Opens this machine's NVIDIA card of a number, counted from 0, and compiles the functions for it.
    ///
    /// # Errors
    /// Why there is none that could be used: no driver, no such card, or one that is too old or in use by somebody alone.
    pub fn open(number: u32) -> Result<Self, String> {
        let ptx = CString::new(PTX).map_err(|e| e.to_string())?;
        let device = Arc::new(Device::open(number, &ptx)?);
        Ok(Self { device, shared: Shared::default() })
    }

    /// Name, memory, compute capability and driver, for people.
    pub fn about(&self) -> &str {
        &self.device.about
    }

    fn upload(&self, shapes: &Flat, scene: &PreparedScene) -> Result<Uploaded, String> {
        Uploaded::new(&self.device, &self.shared, shapes, scene)
    }
}

impl Machine for Card {
    fn name(&self) -> &str {
        &self.device.name
    }

    fn take(&self, scene: &PreparedScene) -> Result<Box<dyn RemoteScene>, String> {
        let shapes = flat(scene)?;
        Ok(Box::new(self.upload(&shapes, scene)?))
    }
}

#[cfg(test)]
mod follows;

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use std::path::Path;

    use sha2::{Digest, Sha256};

    use super::*;

    /// `make ptx` writes it anew; `make lint` compiles it again where it can and compares.
    #[test]
    fn the_ptx_is_of_these_sources() {
        let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
        let (mut folders, mut files) = (vec![root.join("crates/trove-trace")], Vec::new());
        while let Some(folder) = folders.pop() {
            for path in std::fs::read_dir(folder).unwrap().map(|e| e.unwrap().path()) {
                let name = path.file_name().unwrap().to_string_lossy();
                if path.is_dir() {
                    folders.push(path);
                } else if name == "Cargo.toml" || (name.ends_with(".rs") && name != "tests.rs") {
                    files.push(path);
                }
            }
        }
        files.sort_by_key(|path| path.to_str().unwrap().to_owned());
        let mut hasher = Sha256::new();
        files.iter().for_each(|file| hasher.update(std::fs::read(file).unwrap()));
        let sources: String = hasher.finalize()[..8].iter().map(|byte| format!("{byte:02x}")).collect();
        let lock = std::fs::read_to_string(root.join("Cargo.lock")).unwrap();
        let glam = lock.split("name = \"glam\"\nversion = \"").nth(1).unwrap().split('"').next().unwrap();
        let head: Vec<_> = PTX.lines().filter_map(|line| line.strip_prefix("// ")).take(4).collect();
        assert_eq!(head[2..], [format!("glam {glam}"), format!("sources {sources}")], "run `make ptx`");
    }

    #[test]
    fn a_machine_says_what_card_it_has_or_why_none() {
        match Card::open(0) {
            Ok(card) => assert!(card.about().contains("compute capability")),
            Err(why) => assert!(!why.is_empty()),
        }
    }
}
