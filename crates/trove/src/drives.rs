//! A dataset named on the command line.

use std::path::Path;

use anyhow::{Context, Result, anyhow};
use clap::Args;
use clap::builder::PossibleValuesParser;
use trove_model::Report;
use trove_read::DATASETS;
use trove_read::drive_source::DriveSource;

use crate::cache;
use crate::recipe::{DriveSection, Keyframes};

/// Which dataset lies at a root, and its own keys.
#[derive(Args, Clone, Debug, Default)]
pub(crate) struct DatasetChoice {
    /// Which dataset it is; without it the one whose root the folder looks like.
    #[arg(long, value_parser = PossibleValuesParser::new(DATASETS.iter().map(|dataset| dataset.name)))]
    pub(crate) dataset: Option<String>,
    /// A key of the dataset's own, as in a recipe's [drive], such as version=v1.0-mini.
    #[arg(long = "option", value_name = "KEY=VALUE")]
    pub(crate) options: Vec<String>,
}

impl DatasetChoice {
    /// Opens the dataset at a root.
    pub(crate) fn open(&self, root: &Path, report: &Report) -> Result<Box<dyn DriveSource>> {
        let dataset = match &self.dataset {
            Some(name) => name.clone(),
            None => recognised(root)?.to_owned(),
        };
        let options = self.options.iter().map(|option| {
            let (key, value) =
                option.split_once('=').context("--option: expected KEY=VALUE, as in a recipe's [drive]")?;
            Ok((key.trim().to_owned(), toml_value(value)))
        });
        let options = options.collect::<Result<_>>()?;
        let section =
            DriveSection { dataset, root: root.to_owned(), scenes: None, keyframes: Keyframes::All, at: None, options };
        Ok(section.opener()?(root, cache::folder().as_deref(), report)?)
    }
}

/// The dataset whose root a folder looks like.
fn recognised(root: &Path) -> Result<&'static str> {
    let found = DATASETS.iter().find(|dataset| (dataset.is_at)(root));
    found.map(|dataset| dataset.name).ok_or_else(|| {
        let names: Vec<&str> = DATASETS.iter().map(|dataset| dataset.name).collect();
        let known = names.join(", ");
        let root = root.display();
        anyhow!(
            "{root}: expected the root of a dataset ({known}), found none; give the root, or name it with --dataset"
        )
    })
}

/// A number, a boolean or a list as TOML has it; anything else is text.
fn toml_value(text: &str) -> toml::Value {
    text.trim().parse().unwrap_or_else(|_| toml::Value::String(text.trim().to_owned()))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn message(choice: &DatasetChoice) -> String {
        let folder = tempfile::tempdir().unwrap();
        format!("{:#}", choice.open(folder.path(), &Report::default()).err().unwrap())
    }

    #[test]
    fn a_folder_that_is_no_dataset_says_which_there_are() {
        let message = message(&DatasetChoice::default());
        assert!(message.contains("nuscenes") && message.contains("--dataset"), "{message}");
    }

    #[test]
    fn options_are_those_of_the_dataset() {
        let of = |option: &str| {
            message(&DatasetChoice { dataset: Some("nuscenes".to_owned()), options: vec![option.to_owned()] })
        };
        assert!(of("version").contains("KEY=VALUE"));
        assert!(of("verison=v1.0-mini").contains("did you mean `version`?"));
        assert!(of("version=v1.0-mini").contains("v1.0-mini"));
    }
}
