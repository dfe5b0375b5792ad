//! Names that are safe as one part of a path.

use std::fmt;
use std::path::{Path, PathBuf};

/// Longest name in bytes: file systems take 255, of which a hidden name beside it needs some.
const LONGEST_BYTES: usize = 200;

/// Characters that separate or match on some system.
const SPECIAL: [char; 9] = ['/', '\\', ':', '*', '?', '"', '<', '>', '|'];

/// A name that is one visible file or folder on every system, wherever it came from.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct PathComponent(String);

impl PathComponent {
    /// Takes a name as it is.
    ///
    /// # Errors
    /// A name that is empty, hidden, over 200 bytes, ends in a dot or a space, or holds a control character or one of
    /// `/ \ : * ? " < > |`.
    pub fn new(name: &str) -> Result<Self, UnsafeName> {
        let unsafe_name = |problem| Err(UnsafeName { name: name.to_owned(), problem });
        match name {
            "" => unsafe_name("is empty"),
            _ if name.len() > LONGEST_BYTES => unsafe_name("is longer than 200 bytes"),
            _ if name.starts_with('.') => unsafe_name("begins with a dot"),
            _ if name.ends_with(['.', ' ']) => unsafe_name("ends with a dot or a space"),
            _ if name.contains(char::is_control) => unsafe_name("has a control character"),
            _ if name.contains(SPECIAL) => unsafe_name("has a separator or wildcard"),
            _ => Ok(Self(name.to_owned())),
        }
    }

    /// The name.
    pub fn as_str(&self) -> &str {
        &self.0
    }
}

/// A name that cannot be one part of a path.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct UnsafeName {
    name: String,
    problem: &'static str,
}

impl fmt::Display for UnsafeName {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(out, "the name {:?} {}, so no folder can have it", self.name, self.problem)
    }
}

impl std::error::Error for UnsafeName {}

/// A folder below which every path lies that is made from names.
#[derive(Clone, Debug)]
pub struct OutputRoot(PathBuf);

impl OutputRoot {
    /// Of a folder, which need not be there yet.
    pub fn new(root: &Path) -> Self {
        Self(root.to_owned())
    }

    /// The folder itself.
    pub fn path(&self) -> &Path {
        &self.0
    }

    /// A path below it: names with `/` between them.
    ///
    /// # Errors
    /// A part that is not a [`PathComponent`].
    pub fn at(&self, names: &str) -> Result<PathBuf, UnsafeName> {
        names.split('/').try_fold(self.0.clone(), |path, name| Ok(path.join(PathComponent::new(name)?.as_str())))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_name_is_one_visible_part_of_a_path() {
        for name in ["scene-0103", "CAM_FRONT", "ego.CAM_FRONT", "Straße 7", "東京", "a..b", &"x".repeat(200)] {
            assert_eq!(PathComponent::new(name).unwrap().as_str(), name);
        }
        let unsafe_names =
            ["", ".", "..", ".trove", "/x", "../../x", "a/b", "a\\b", "C:", "a\0", "a\n", "\u{1b}[2J", "a."];
        for name in unsafe_names.into_iter().chain([&*"x".repeat(201)]) {
            assert!(PathComponent::new(name).is_err(), "{name:?}");
        }
    }

    #[test]
    fn nothing_lies_outside_the_root() {
        let root = OutputRoot::new(Path::new("out"));
        assert_eq!(root.at("s/v00").unwrap(), Path::new("out/s/v00"));
        for names in ["", "/x", "s//v00", "s/../../x", ".trove/run.json", "s/"] {
            assert!(root.at(names).is_err(), "{names}");
        }
    }
}
