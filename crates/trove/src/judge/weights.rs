//! How much each class is worth when frames are chosen.

use std::collections::BTreeMap;
use std::path::Path;

use anyhow::{Context, Result, bail};
use trove_files::{LARGEST_TEXT, read_text};
use trove_model::ClassMap;

use crate::recipe::nearest;

/// What a class can weigh at most.
const HEAVIEST: f64 = 1000.0;

/// The weights in a file (TOML, `class = weight`) by the training ids of a class map; classes that it leaves out weigh 1.
///
/// # Errors
/// A file that is missing or no such TOML, a class that does not count in the map, or a weight out of 0 to 1000.
pub(crate) fn read_weights(path: &Path, map: &ClassMap) -> Result<[f64; 20]> {
    let text = read_text(path, LARGEST_TEXT).with_context(|| path.display().to_string())?;
    weights(&text, map).with_context(|| path.display().to_string())
}

fn weights(text: &str, map: &ClassMap) -> Result<[f64; 20]> {
    let table: BTreeMap<String, f64> = toml::from_str(text).context("expected lines such as `\"car\" = 1.5`")?;
    let names: Vec<&str> = map.counted().map(|class| class.name.as_str()).collect();
    let mut weights = [1.0; 20];
    for (name, weight) in table {
        let Some(id) = names.iter().position(|known| *known == name).filter(|id| *id < weights.len()) else {
            bail!("expected a class of {} that counts, found `{name}`{}", map.name, nearest(&name, &names));
        };
        if !(0.0..=HEAVIEST).contains(&weight) {
            bail!("{name}: expected a weight from 0 to {HEAVIEST}, found {weight}");
        }
        weights[id] = weight;
    }
    Ok(weights)
}

#[cfg(test)]
mod tests {
    use trove_model::Class;

    use super::*;

    #[test]
    fn weights_stand_where_the_classes_have_their_training_ids() {
        let map = ClassMap::named("camvid").unwrap();
        let found = weights("bicyclist = 2.5\nroad = 0", &map).unwrap();
        let id = |name: &str| map.counted().position(|class| class.name == name).unwrap();
        let ours = map.train_ids_of_ours();
        let cycle = usize::from(Class::CycleRider.id());
        assert_eq!((found[id("bicyclist")], found[id("road")], found[id("car")]), (2.5, 0.0, 1.0));
        assert_eq!(ours[cycle].map(usize::from), Some(id("bicyclist")));
    }

    #[test]
    fn wrong_weights_are_told_with_what_was_expected() {
        let map = ClassMap::named("camvid").unwrap();
        for (text, part) in [
            ("bycyclist = 2", "did you mean `bicyclist`?"),
            ("car = -1", "car: expected a weight from 0 to 1000, found -1"),
            ("car = nan", "found NaN"),
            ("car = \"much\"", "expected lines such as"),
        ] {
            let told = format!("{:#}", weights(text, &map).unwrap_err());
            assert!(told.contains(part), "{told}");
        }
    }
}
