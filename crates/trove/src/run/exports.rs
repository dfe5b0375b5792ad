//! The datasets that a finished run is exported as.

use std::path::Path;

use anyhow::{Context, Result, ensure};
use trove_write::{Choice, DatasetFormat, FrameFolders, export};

use crate::progress::Steps;
use crate::recipe::Recipe;
use crate::store;
use crate::watch::Watch;

/// Refuses forms that nothing could be exported to.
pub(super) fn check(recipe: &Recipe, out: &Path) -> Result<()> {
    ensure!(
        recipe.output.formats.is_empty() || store::address(out).is_none(),
        "output.formats: expected an output folder on this machine, found {}; run trove export on a copy of it",
        out.display()
    );
    Ok(())
}

/// Writes the forms of `output.formats` below the output folder; false where it was asked to end before.
pub(super) fn write(recipe: &Recipe, out: &Path, watch: &Watch) -> Result<bool> {
    for name in &recipe.output.formats {
        let format = DatasetFormat::named(name).context("a recipe's formats are known once it has been read")?;
        let progress = Steps::new(watch);
        let folder = out.join(FrameFolders::EXPORTS).join(name);
        let exported = export(out, &folder, format, &Choice::default(), &|done, total| progress.done(done, total))?;
        if exported.interrupted {
            return Ok(false);
        }
    }
    Ok(true)
}
