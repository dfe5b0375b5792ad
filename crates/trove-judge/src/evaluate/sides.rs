//! In which classes two sides are judged, and in what numbers each is.

use std::path::{Path, PathBuf};

use trove_model::ClassMap;

use crate::{JudgeError, Numbering};

/// The map of our own frames.
const OURS: &str = "trove20";
/// The classes that most labels can be judged in.
const PAPER: &str = "paper13";

/// The classes to judge in, and both sides' numbers.
pub(super) struct Sides {
    pub(super) classes: ClassMap,
    pub(super) predicted: Side,
    pub(super) truth: Side,
}

/// A side's numbers.
pub(super) struct Side {
    pub(super) numbering: Numbering,
    /// What each is among the classes to judge in.
    pub(super) numbers: [u8; 256],
}

/// Finds out about two sides whose pictures belong together: from what is given for them, else from their files, and what
/// still is not known from the classes to judge in.
pub(super) fn of(
    pairs: &[(PathBuf, PathBuf)],
    roots: [&Path; 2],
    classes: Option<&ClassMap>,
    given: [Option<&Numbering>; 2],
) -> Result<Sides, JudgeError> {
    let told = |given: Option<&Numbering>, file: Option<&PathBuf>| match (given, file) {
        (Some(given), _) => Ok(Some(given.clone())),
        (None, Some(file)) => Numbering::of_file(file),
        (None, None) => Ok(None),
    };
    let first = pairs.first();
    let told = [told(given[0], first.map(|(p, _)| p))?, told(given[1], first.map(|(_, t)| t))?];
    let (classes, why) = match classes {
        Some(classes) => (classes.clone(), "its files do not tell, so as in --classes"),
        None => (common(&told, roots)?, "its files do not tell, so as the default is"),
    };
    let [predicted, truth] = told;
    let side = |told: Option<Numbering>, root: &Path| {
        let numbering = told.unwrap_or_else(|| Numbering { map: classes.clone(), why: why.to_owned() });
        let numbers = numbering.map.in_map(&classes).ok_or_else(|| {
            let found = format!("{} ({})", numbering.map.name, numbering.why);
            let remedy = format!("choose other classes with --classes, such as {} or {PAPER}", numbering.map.name);
            JudgeError::unexpected(root, format!("labels that can be judged in {}", classes.name), found, &remedy)
        })?;
        Ok::<_, JudgeError>(Side { numbering, numbers })
    };
    Ok(Sides { predicted: side(predicted, roots[0])?, truth: side(truth, roots[1])?, classes })
}

/// The classes in which two sides can be judged that tell as much as they do.
fn common(told: &[Option<Numbering>; 2], roots: [&Path; 2]) -> Result<ClassMap, JudgeError> {
    let is_ours = |told: &Numbering| [OURS, PAPER].contains(&told.map.name.as_str());
    match told {
        [Some(p), Some(t)] if !is_ours(p) && p.map.in_map(&t.map).is_some() => Ok(t.map.clone()),
        // Nothing says that the other side is in the same numbers.
        [Some(one), None] | [None, Some(one)] if !is_ours(one) => {
            let other = roots[usize::from(told[0].is_some())];
            let expected =
                format!("labels that tell their numbers, as those do that are compared with them ({})", one.map.name);
            let found = format!("none that do; the others are told by: {}", one.why);
            let remedy = "give the class map of both sides with --classes, or that of one with --predicted-classes or \
                          --truth-classes; pictures to look at have to be written as ids instead of colours";
            Err(JudgeError::unexpected(other, expected, found, remedy))
        }
        _ => Ok(ClassMap::named(PAPER).expect("a built-in map")),
    }
}
