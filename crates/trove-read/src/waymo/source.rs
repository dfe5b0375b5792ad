//! Waymo as a source of drives, with the options that are its own.

use std::num::NonZeroUsize;
use std::path::PathBuf;

use serde::Deserialize;
use trove_model::{Drive, Report};

use super::dataset::Waymo;
use crate::ReadError;
use crate::drive_source::{Dataset, DriveListing, DriveSource, LabelPicture, Opener};

pub(crate) const DATASET: Dataset = Dataset { name: "waymo", is_at: Waymo::is_at, configure };

/// The keys of a recipe's `[drive]` that only Waymo has.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Options {
    /// Of how many frames one has its LiDAR read: 5, twice a second, tells ground and walls as well as all of them.
    #[serde(default = "twice_a_second")]
    lidar_every: NonZeroUsize,
}

fn twice_a_second() -> NonZeroUsize {
    NonZeroUsize::MIN.saturating_add(4)
}

fn configure(options: toml::Table) -> Result<Opener, toml::de::Error> {
    let Options { lidar_every } = options.try_into()?;
    Ok(Box::new(move |root, _, report| Ok(Box::new(Waymo::open(root, lidar_every.get(), report)?))))
}

impl DriveSource for Waymo {
    fn drives(&self) -> Vec<DriveListing> {
        self.segments()
    }

    fn read(&self, name: &str, report: &Report) -> Result<Drive, ReadError> {
        self.drive(name, report)
    }

    fn labels(&self, name: &str, report: &Report, each: &mut dyn FnMut(LabelPicture)) -> Result<(), ReadError> {
        self.labels(name, report, each)
    }

    /// Segments share no files.
    fn tables(&self) -> Vec<PathBuf> {
        Vec::new()
    }

    fn recording(&self, name: &str) -> Result<Vec<PathBuf>, ReadError> {
        self.recorded_files(name)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_option_that_makes_no_sense_is_refused() {
        let refused = |text: &str| configure(text.parse().unwrap()).err().map(|error| error.message().to_owned());
        assert_eq!((refused(""), refused("lidar_every = 1")), (None, None));
        assert!(refused("version = 'v2'").unwrap().contains("`lidar_every`"));
        assert!(refused("lidar_every = 0").is_some());
    }
}
