//! Which of a run's frames a machine makes, where several share them.

use std::collections::BTreeMap;
use std::fmt;
use std::str::FromStr;

use trove_model::Seed;

/// More shares than frames that anyone makes.
pub const MOST_SHARES: i64 = 1_000_000;

/// One of several shares of a run's frames, written `I/N`. Which frames are in it depends on nothing but the names of
/// scenes and the numbers of variations and moments, so every machine knows without asking.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Share {
    number: u32,
    of: u32,
}

/// What of the moments of a scene's variation is wanted: every `of`-th, from the `nth` on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Slice {
    nth: usize,
    of: usize,
}

impl Slice {
    pub(super) const ALL: Self = Self { nth: 0, of: 1 };

    /// Whether the moment at a place among those of the recipe is in it.
    pub(super) fn has(self, place: usize) -> bool {
        place % self.of == self.nth
    }

    /// How many of so many are in it.
    pub(super) fn count(self, of_all: usize) -> usize {
        of_all.saturating_sub(self.nth).div_ceil(self.of)
    }
}

impl Share {
    /// The name of its folder in `.trove/parts`, such as `3-of-8`.
    pub(crate) fn folder(self) -> String {
        format!("{}-of-{}", self.number, self.of)
    }

    /// The share whose folder has that name.
    pub(crate) fn of_folder(name: &str) -> Option<Self> {
        let (number, of) = name.split_once("-of-")?;
        format!("{number}/{of}").parse().ok()
    }

    /// How many shares there are.
    pub(crate) fn of(self) -> u32 {
        self.of
    }

    /// All shares of so many.
    pub(crate) fn all(of: u32) -> impl Iterator<Item = Self> {
        (1..=of).map(move |number| Self { number, of })
    }

    /// What is in it of the variations of scenes. They are dealt out in the order of a hash, whole as long as there are
    /// enough of them, since building a scene is what is worth sharing; else several shares get moments of the same one.
    pub(super) fn slices(self, variations: &[(String, u32)]) -> BTreeMap<(String, u32), Slice> {
        let mut dealt: Vec<&(String, u32)> = variations.iter().collect();
        dealt.sort_by_key(|(scene, variation)| (Seed(0).child(scene).nth((*variation).into()).0, scene, *variation));
        let (index, of, count) = ((self.number - 1) as usize, self.of as usize, dealt.len());
        let slice = |place: usize| {
            if count >= of {
                return (place % of == index).then_some(Slice::ALL);
            }
            let slice = Slice { nth: index / count, of: (of - place).div_ceil(count) };
            (index % count == place).then_some(slice)
        };
        let places = dealt.into_iter().enumerate();
        places.filter_map(|(place, variation)| Some((variation.clone(), slice(place)?))).collect()
    }
}

impl FromStr for Share {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let numbers = text.split_once('/').and_then(|(number, of)| Some((number.parse().ok()?, of.parse().ok()?)));
        match numbers {
            Some((number, of)) if (1..=of).contains(&number) && i64::from(of) <= MOST_SHARES => Ok(Self { number, of }),
            _ => Err(format!(
                "expected the number of a share and how many there are, from 1/1 to {MOST_SHARES}/{MOST_SHARES}, such as 3/8"
            )),
        }
    }
}

impl fmt::Display for Share {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}/{}", self.number, self.of)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn variations(scenes: usize, count: u32) -> Vec<(String, u32)> {
        (0..scenes).flat_map(|scene| (0..count).map(move |v| (format!("scene-{scene:04}"), v))).collect()
    }

    #[test]
    fn every_moment_is_in_one_share_and_shares_are_even() {
        const MOMENTS: usize = 40;
        for (scenes, count, of) in [(1, 1, 1), (1, 1, 2), (1, 1, 7), (3, 1, 7), (5, 2, 7), (10, 3, 7), (1, 1, 60)] {
            let all = variations(scenes, count);
            let mut taken = BTreeMap::<(String, u32, usize), u32>::new();
            let mut sizes = Vec::new();
            for share in Share::all(of) {
                let mut size = 0;
                for ((scene, variation), slice) in share.slices(&all) {
                    let moments: Vec<usize> = (0..MOMENTS).filter(|moment| slice.has(*moment)).collect();
                    assert_eq!(moments.len(), slice.count(MOMENTS));
                    size += moments.len();
                    moments.iter().for_each(|m| *taken.entry((scene.clone(), variation, *m)).or_default() += 1);
                }
                sizes.push(size);
            }
            assert_eq!(taken.len(), all.len() * MOMENTS, "{scenes} {count} {of}");
            assert!(taken.values().all(|&times| times == 1), "{scenes} {count} {of}");
            let (least, most) = (sizes.iter().min().unwrap(), sizes.iter().max().unwrap());
            // Whole variations differ by one; of those that are divided, some are by one more.
            let step =
                if all.len() >= of as usize { MOMENTS } else { MOMENTS.div_ceil(of as usize / all.len()) / 2 + 1 };
            assert!(most - least <= step, "{scenes} {count} {of}: {least} to {most}");
        }
    }

    #[test]
    fn a_scene_of_one_share_stays_whole_where_there_are_enough() {
        let all = variations(20, 1);
        assert!(Share::all(7).all(|share| share.slices(&all).values().all(|slice| *slice == Slice::ALL)));
        // Each share has one scene to build where there are fewer.
        assert!(Share::all(50).all(|share| share.slices(&all).len() == 1));
        // Neighbours in a dataset, which are alike, are not neighbours here.
        let first: Vec<String> =
            "1/10".parse::<Share>().unwrap().slices(&all).into_keys().map(|(scene, _)| scene).collect();
        assert_ne!(first, ["scene-0000", "scene-0010"]);
    }

    #[test]
    fn a_share_is_two_numbers() {
        for text in ["1/1", "3/8", "1000000/1000000"] {
            let share: Share = text.parse().unwrap();
            assert_eq!((share.to_string(), Share::of_folder(&share.folder())), (text.to_owned(), Some(share)));
        }
        for text in ["", "3", "0/8", "9/8", "1/0", "-1/8", "a/b", "1/2/3", "1/1000001"] {
            assert!(text.parse::<Share>().unwrap_err().contains("such as 3/8"), "{text}");
        }
    }
}
