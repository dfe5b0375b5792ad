//! Measures that no plant can have, refused before it grows: they would fail, or take all memory.

use std::ops::RangeInclusive;

use super::bark::Bark;
use super::leaves::{Outline, Sprig};
use super::plan::{ClimatePlan, RowPlan, ShrubPlan, TreePlan};
use super::tones::Year;
use crate::measure::{Wrong, wrong};

/// Numbers by their keys, with their ranges and these in words.
fn within<const N: usize>(numbers: [(&'static str, f32, RangeInclusive<f32>, &'static str); N]) -> Result<(), Wrong> {
    match numbers.into_iter().find(|(_, number, range, _)| !range.contains(number)) {
        Some((key, number, _, expected)) => wrong(key, expected, &number),
        None => Ok(()),
    }
}

impl TreePlan {
    /// The key of a value that no tree can have, with what was expected and what it is.
    pub(crate) fn check(&self) -> Result<(), Wrong> {
        within([
            ("height_m", self.height_m, 1.0..=60.0, "metres from 1 to 60"),
            ("radius_m", self.radius_m, 0.2..=20.0, "metres from 0.2 to 20"),
            ("clear", self.clear, 0.02..=0.6, "a share from 0.02 to 0.6"),
            ("lobe", self.lobe, 0.05..=1.0, "a share from 0.05 to 1"),
            ("flat", self.flat, 0.1..=5.0, "a number from 0.1 to 5"),
            ("leader", self.leader, -1.0..=1.0, "a share from -1 to 1"),
            ("lift", self.lift, -1.0..=1.0, "a number from -1 to 1"),
            ("trunk_m", self.trunk_m, 0.03..=2.0, "metres from 0.03 to 2"),
            ("roots", self.roots, 0.0..=2.0, "a number from 0 to 2"),
            ("hang", self.hang, -5.0..=5.0, "a number from -5 to 5"),
        ])?;
        // Heights below the crown are shares of it too.
        if self.clear + self.leader * (1.0 - self.clear) < 0.02 {
            return wrong("leader", "a trunk that divides above the ground", &self.leader);
        }
        let is_curve = (2..=20).contains(&self.crown.len())
            && self.crown.is_sorted_by(|a, b| a.0 < b.0)
            && self.crown.iter().all(|(up, share)| (0.0..=1.0).contains(up) && (0.0..=1.0).contains(share));
        if !is_curve {
            return wrong("crown", "2 to 20 points (height, radius) from 0 to 1, from below upwards", &self.crown);
        }
        if !(2..=200).contains(&self.lobes) {
            return wrong("lobes", "a number from 2 to 200", &self.lobes);
        }
        if !(10..=8000).contains(&self.points) {
            return wrong("points", "a number from 10 to 8000", &self.points);
        }
        let is_word =
            |name: &String| !name.is_empty() && name.chars().all(|c| c.is_alphanumeric() && !c.is_uppercase());
        if let Some(name) = self.genera.iter().find(|name| !is_word(name)) {
            return wrong("genera", "words in lower case", name);
        }
        if let Bark::Furrowed(apart_m) = self.bark
            && !(0.005..=0.5).contains(&apart_m)
        {
            return wrong("bark", "furrows 0.005 to 0.5 metres apart", &apart_m);
        }
        colors("bark_color", &[self.bark_color])?;
        foliage(self.sprig, self.card_m, self.cards)?;
        tones(self.green, &self.year)?;
        chosen(self.commonness, &self.habitat)
    }
}

impl ShrubPlan {
    /// The key of a value that no shrub can have, with what was expected and what it is.
    pub(crate) fn check(&self) -> Result<(), Wrong> {
        if self.half_m.iter().any(|m| !(0.05..=10.0).contains(m)) {
            return wrong("half_m", "three lengths from 0.05 to 10 metres", &self.half_m);
        }
        if !(1..=100).contains(&self.clumps) {
            return wrong("clumps", "a number from 1 to 100", &self.clumps);
        }
        within([("clump", self.clump, 0.05..=1.0, "a share from 0.05 to 1")])?;
        foliage(self.sprig, self.card_m, self.cards)?;
        tones(self.green, &self.year)?;
        chosen(self.commonness, &self.habitat)
    }
}

impl RowPlan {
    /// The key of a value that no hedge can have, with what was expected and what it is.
    pub(crate) fn check_hedge(&self) -> Result<(), Wrong> {
        if !self.flowers.is_empty() {
            return wrong("flowers", "none, which only a bed has", &self.flowers);
        }
        self.check_bed()
    }

    /// The same for a bed.
    pub(crate) fn check_bed(&self) -> Result<(), Wrong> {
        if self.flowers.len() > 8 {
            return wrong("flowers", "at most 8 colours", &self.flowers.len());
        }
        colors("flowers", &self.flowers)?;
        foliage(self.sprig, self.card_m, self.cards)?;
        tones(self.green, &self.year)?;
        chosen(self.commonness, &self.habitat)
    }
}

fn foliage(sprig: Sprig, card_m: f32, cards: usize) -> Result<(), Wrong> {
    within([("card_m", card_m, 0.05..=5.0, "metres from 0.05 to 5")])?;
    if !(1..=10_000).contains(&cards) {
        return wrong("cards", "a number from 1 to 10000", &cards);
    }
    let Sprig::Leaves { outline, length, width, count } = sprig else { return Ok(()) };
    within([
        ("sprig.leaves.length", length, 0.02..=0.6, "a share of the card from 0.02 to 0.6"),
        ("sprig.leaves.width", width, 0.05..=2.0, "a share of the length from 0.05 to 2"),
    ])?;
    if !(1..=40).contains(&count) {
        return wrong("sprig.leaves.count", "a number from 1 to 40", &count);
    }
    match outline {
        Outline::Oval(e) if !(0.2..=3.0).contains(&e) => wrong("sprig.leaves.outline", "oval from 0.2 to 3", &e),
        Outline::Palmate(depth) if !(0.0..=1.0).contains(&depth) => {
            wrong("sprig.leaves.outline", "palmate from 0 to 1", &depth)
        }
        _ => Ok(()),
    }
}

fn tones(green: [f32; 3], year: &Year) -> Result<(), Wrong> {
    colors("green", &[green])?;
    let lists: &[&[[f32; 3]]] = match year {
        Year::Evergreen => &[],
        Year::Turns(colors) => &[colors],
        Year::Blossoms { spring, autumn } => &[spring, autumn],
        Year::Keeps(dead) => &[&[*dead]],
    };
    for list in lists {
        if !(1..=20).contains(&list.len()) {
            return wrong("year", "1 to 20 colours", &list.len());
        }
        colors("year", list)?;
    }
    Ok(())
}

fn colors(key: &'static str, colors: &[[f32; 3]]) -> Result<(), Wrong> {
    match colors.iter().find(|color| color.iter().any(|v| !(0.0..=1.0).contains(v))) {
        Some(color) => wrong(key, "colours from 0 to 1", color),
        None => Ok(()),
    }
}

fn chosen(commonness: f32, habitat: &[(ClimatePlan, f32)]) -> Result<(), Wrong> {
    if !(commonness.is_finite() && commonness > 0.0) {
        return wrong("commonness", "a number above 0", &commonness);
    }
    for (i, (climate, share)) in habitat.iter().enumerate() {
        if habitat[..i].iter().any(|(other, _)| other == climate) {
            return wrong("habitat", "each climate once", climate);
        }
        if !(0.0..=100.0).contains(share) {
            return wrong("habitat", "numbers from 0 to 100", share);
        }
    }
    Ok(())
}
