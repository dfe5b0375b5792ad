//! Rays on a graphics card: the functions of `trove_trace`, compiled to PTX, which the card's driver compiles for the card.

mod driver;
mod follow;
mod rates;
mod world;

use std::ffi::CString;

use trove_trace::{FlatWorld, Table};

use self::driver::{Buffer, Device};
use self::world::world;
use crate::PreparedScene;
use crate::accel::{Flat, Hold};

pub use rates::CardRate;
pub(crate) use rates::card_rates;

/// `trove_trace` for cards; `make ptx` writes it.
const PTX: &str = include_str!("trace.ptx");

/// Threads that start together; 64 to 256 differ by little.
const BLOCK: u32 = 128;

/// A graphics card that traces rays, for the thread that found it.
pub struct Card {
    device: Device,
}

impl Card {
    /// Opens this machine's first NVIDIA card and compiles the functions for it.
    ///
    /// # Errors
    /// Why there is none that could be used: no driver, no card, or one that is too old or in use by somebody alone.
    pub fn find() -> Result<Self, String> {
        let ptx = CString::new(PTX).map_err(|e| e.to_string())?;
        Device::open(&ptx).map(|device| Self { device })
    }

    /// Name, memory, compute capability and driver, for people.
    pub fn about(&self) -> &str {
        &self.device.about
    }

    /// Puts a scene into the card's memory.
    fn upload(&self, shapes: &Flat, scene: &PreparedScene) -> Result<Uploaded<'_>, String> {
        let mut memory = Memory { device: &self.device, held: Vec::new() };
        let world = self.device.hold(&[world(scene, shapes, None, &mut memory)?])?;
        Ok(Uploaded { world, held: memory.held })
    }
}

/// A scene in a card's memory.
struct Uploaded<'a> {
    /// Which begins with what rays meet.
    world: Buffer<'a, FlatWorld>,
    held: Vec<Buffer<'a, u8>>,
}

impl Uploaded<'_> {
    fn bytes(&self) -> usize {
        self.world.bytes() + self.held.iter().map(Buffer::bytes).sum::<usize>()
    }
}

/// What is kept there as long as the scene is.
struct Memory<'a> {
    device: &'a Device,
    held: Vec<Buffer<'a, u8>>,
}

impl Hold for Memory<'_> {
    type Error = String;

    fn hold<T: Copy + 'static>(&mut self, values: &[T]) -> Result<Table<T>, String> {
        let buffer = self.device.hold(values)?.into_bytes();
        let table = Table::at(buffer.address(), values.len());
        self.held.push(buffer);
        Ok(table)
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
        match Card::find() {
            Ok(card) => assert!(card.about().contains("compute capability")),
            Err(why) => assert!(!why.is_empty()),
        }
    }
}
