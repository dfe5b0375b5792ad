//! `class_map.toml`: in what numbers a folder's labels are.

use std::num::NonZero;

/// A map that comes with the program, for labels that were written as a dataset has them (docs/judge.md).
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ClassMapFile {
    /// The map's name (`waymo`).
    pub like: &'static str,
    /// A pixel is the class's number times this, plus the object's.
    pub instance_divisor: NonZero<u16>,
}

impl ClassMapFile {
    /// The file's name, beside or above the labels.
    pub const NAME: &str = "class_map.toml";

    /// The file's text.
    pub fn to_toml(&self) -> String {
        format!("like = \"{}\"\ninstance_divisor = {}\n", self.like, self.instance_divisor)
    }
}
