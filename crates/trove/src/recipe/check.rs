//! What a value of a recipe has to be.

use std::fmt::Display;

use anyhow::{Result, ensure};

pub(super) fn check(key: &str, value: impl Display, holds: bool, expected: &str) -> Result<()> {
    ensure!(holds, "{key}: expected {expected}, found {value}");
    Ok(())
}
