//! Histogram matching, class by class: road becomes as bright as road, sky as blue as sky.

use std::collections::BTreeMap;

/// Bins of a channel.
const BINS: usize = 512;
/// Channels' range: L\*, a\*, b\*.
const LOW: [f32; 3] = [0.0, -110.0, -110.0];
const HIGH: [f32; 3] = [100.0, 110.0, 110.0];
/// With fewer pixels a class's histogram says little.
const LEAST: u64 = 500;

/// Histograms of L\*, a\* and b\* by class id.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Histograms {
    classes: BTreeMap<u8, Vec<[u64; 3]>>,
}

impl Histograms {
    /// The number of pixels that are of no class; they are not counted and stay as they are.
    pub const NONE: u8 = 255;

    /// Counts a picture's pixels.
    pub fn count(&mut self, pixels: &[[f32; 3]], classes: &[u8]) {
        for (pixel, class) in pixels.iter().zip(classes).filter(|(_, class)| **class != Self::NONE) {
            let bins = self.classes.entry(*class).or_insert_with(|| vec![[0; 3]; BINS]);
            (0..3).for_each(|c| bins[position(pixel[c], c) as usize][c] += 1);
        }
    }

    /// Takes another's counts in.
    pub fn join(&mut self, other: &Self) {
        for (class, bins) in &other.classes {
            let own = self.classes.entry(*class).or_insert_with(|| vec![[0; 3]; BINS]);
            own.iter_mut().zip(bins).for_each(|(a, b)| (0..3).for_each(|c| a[c] += b[c]));
        }
    }

    /// Pixels by class id.
    pub fn pixels(&self) -> BTreeMap<u8, u64> {
        self.classes.iter().map(|(class, bins)| (*class, bins.iter().map(|b| b[0]).sum())).collect()
    }

    /// Shares of a class's pixels in the bins of a channel; zeros without pixels.
    pub(super) fn shares(&self, class: u8, channel: usize) -> Vec<f64> {
        let Some(bins) = self.classes.get(&class) else { return vec![0.0; BINS] };
        let all = bins.iter().map(|bin| bin[channel]).sum::<u64>().max(1);
        bins.iter().map(|bin| bin[channel] as f64 / all as f64).collect()
    }

    /// For every class that both have enough of, the value that each bin's becomes.
    pub fn towards(&self, target: &Self) -> Matching {
        let of_class = |(class, bins): (&u8, &Vec<[u64; 3]>)| {
            let wanted = target.classes.get(class)?;
            let enough = |bins: &[[u64; 3]]| bins.iter().map(|b| b[0]).sum::<u64>() >= LEAST;
            (enough(bins) && enough(wanted)).then(|| (*class, [0, 1, 2].map(|c| map(bins, wanted, c))))
        };
        Matching { classes: self.classes.iter().filter_map(of_class).collect() }
    }
}

/// What becomes of the colours of each class.
#[derive(Clone, Debug, PartialEq)]
pub struct Matching {
    classes: BTreeMap<u8, [Vec<f32>; 3]>,
}

impl Matching {
    /// The matched colour; one of a class that was not seen on both sides stays.
    pub fn apply(&self, pixel: [f32; 3], class: u8) -> [f32; 3] {
        let Some(maps) = self.classes.get(&class) else { return pixel };
        std::array::from_fn(|c| {
            // Between the middles of bins, so that steps do not show.
            let at = (position(pixel[c], c) - 0.5).clamp(0.0, BINS as f32 - 1.001);
            let (low, share) = (at as usize, at.fract());
            maps[c][low] * (1.0 - share) + maps[c][low + 1] * share
        })
    }
}

/// Where a value lies among the bins, 0 to `BINS`.
fn position(value: f32, channel: usize) -> f32 {
    let share = (value - LOW[channel]) / (HIGH[channel] - LOW[channel]);
    (share * BINS as f32).clamp(0.0, BINS as f32 - 0.001)
}

/// The value at a place among the bins, 0 to `BINS`.
pub(super) fn value(channel: usize, at: f32) -> f32 {
    LOW[channel] + at / BINS as f32 * (HIGH[channel] - LOW[channel])
}

/// The value of the target with as large a share of pixels below it, for the middle of every bin.
fn map(source: &[[u64; 3]], target: &[[u64; 3]], channel: usize) -> Vec<f32> {
    let total = |bins: &[[u64; 3]]| bins.iter().map(|b| b[channel]).sum::<u64>().max(1) as f64;
    let (all, wanted) = (total(source), total(target));
    let (mut below, mut bin, mut passed) = (0.0, 0, 0.0);
    source
        .iter()
        .map(|counts| {
            let here = counts[channel] as f64;
            let share = (below + here / 2.0) / all;
            below += here;
            while bin + 1 < BINS && (passed + target[bin][channel] as f64) / wanted < share {
                passed += target[bin][channel] as f64;
                bin += 1;
            }
            let within = (share * wanted - passed) / (target[bin][channel] as f64).max(1.0);
            value(channel, (bin as f64 + within.clamp(0.0, 1.0)) as f32)
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn evenly_spread_values_become_those_of_the_target_and_other_classes_stay() {
        let spread = |low: f32, high: f32| -> Vec<[f32; 3]> {
            (0..20_000).map(|i| [low + (high - low) * (i as f32 + 0.5) / 20_000.0, 0.0, 10.0]).collect()
        };
        let (source, target) = (spread(20.0, 40.0), spread(50.0, 90.0));
        let (mut a, mut b) = (Histograms::default(), Histograms::default());
        a.count(&source, &vec![9; source.len()]);
        b.count(&target, &vec![9; target.len()]);
        let matching = a.towards(&b);
        for (from, to) in [(22.0, 54.0), (30.0, 70.0), (39.0, 88.0)] {
            let found = matching.apply([from, 0.0, 10.0], 9)[0];
            assert!((found - to).abs() < 0.5, "{from} became {found} rather than {to}");
        }
        assert_eq!(matching.apply([30.0, 0.0, 10.0], 1), [30.0, 0.0, 10.0]);
    }
}
