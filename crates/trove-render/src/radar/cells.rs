//! Cells of range, azimuth and radial speed, in which echoes that cannot be told apart add up.

use std::collections::BTreeMap;
use std::f64::consts::PI;

use trove_model::{Class, InstanceId, RadarScan, Seed};

use super::echo::Echo;

/// Cells across what is told apart.
const A_RESOLUTION: f64 = 2.0;
/// How far an echo reaches, in cells: Hann's window is as wide as what is told apart at half of its height.
const REACH: i32 = 1;

/// A cell's number along each axis.
pub(super) type Key = [i32; 3];

/// Echoes of a cell.
#[derive(Clone, Copy, Debug)]
pub(super) struct Cell {
    pub(super) signal: f64,
    /// Range, sine of the azimuth and speed, the means of its echoes.
    pub(super) at: [f64; 3],
    /// The strongest thing in it.
    pub(super) class: Class,
    pub(super) instance: InstanceId,
    pub(super) surfaces: u8,
}

/// The cells of a scan.
pub(super) struct Cells {
    /// Where there are echoes.
    pub(super) cells: BTreeMap<Key, Cell>,
    /// What a receiver has in each cell, also beside those.
    pub(super) received: BTreeMap<Key, f64>,
}

/// Lengths of a cell's sides: metres, sines and metres a second.
pub(super) fn sides(scan: &RadarScan) -> [f64; 3] {
    [scan.range_resolution_m, scan.azimuth_resolution_rad, scan.speed_resolution_mps].map(|told| told / A_RESOLUTION)
}

impl Cells {
    /// Gathers echoes; those of a cell are of one strength or another from cycle to cycle.
    pub(super) fn new(scan: &RadarScan, echoes: &[Echo], seed: Seed) -> Self {
        let sides = sides(scan);
        let place = |at: [f64; 3]| std::array::from_fn::<f64, 3, _>(|i| at[i] / sides[i]);
        let mut sums: BTreeMap<Key, Sum> = BTreeMap::new();
        for echo in echoes {
            let at = [echo.range_m, echo.sine, echo.radial_mps];
            sums.entry(place(at).map(|x| x.round() as i32)).or_default().add(echo, at);
        }
        let cells: BTreeMap<Key, Cell> = sums.into_iter().map(|(key, sum)| (key, sum.cell(fades(seed, key)))).collect();
        let mut received: BTreeMap<Key, f64> = BTreeMap::new();
        for (key, cell) in &cells {
            let place = place(cell.at);
            for beside in around(*key) {
                let share: f64 = (0..3).map(|i| window(f64::from(beside[i]) - place[i])).product();
                *received.entry(beside).or_default() += cell.signal * share;
            }
        }
        Self { cells, received }
    }

    /// What is received in a cell.
    pub(super) fn at(&self, key: Key) -> f64 {
        self.received.get(&key).copied().unwrap_or(0.0)
    }
}

/// A cell and those that touch it.
pub(super) fn around([a, b, c]: Key) -> impl Iterator<Item = Key> {
    let near = |x: i32| x - REACH..=x + REACH;
    near(a).flat_map(move |a| near(b).flat_map(move |b| near(c).map(move |c| [a, b, c])))
}

/// Power of Hann's window so many cells away.
fn window(cells: f64) -> f64 {
    let full = A_RESOLUTION;
    if cells.abs() < full { (PI / (2.0 * full) * cells).cos().powi(4) } else { 0.0 }
}

/// Parts of a thing add up and cancel out, from cycle to cycle otherwise: one part that is stronger than many others
/// (Swerling's third case), about a mean of 1.
fn fades(seed: Seed, key: Key) -> f64 {
    let seed = key.into_iter().fold(seed, |seed, i| seed.nth(i as u32 as u64));
    let mut random = seed.random();
    let mut exponential = || -(1.0 - random.unit()).ln();
    (exponential() + exponential()) / 2.0
}

#[derive(Default)]
struct Sum {
    signal: f64,
    weighted: [f64; 3],
    /// What of it is of which thing; few.
    things: Vec<(Class, InstanceId, u8, f64)>,
}

impl Sum {
    fn add(&mut self, echo: &Echo, at: [f64; 3]) {
        self.signal += echo.signal;
        self.weighted.iter_mut().zip(at).for_each(|(sum, x)| *sum += x * echo.signal);
        let Echo { class, instance, surfaces, .. } = *echo;
        match self.things.iter_mut().find(|thing| (thing.0, thing.1, thing.2) == (class, instance, surfaces)) {
            Some(thing) => thing.3 += echo.signal,
            None => self.things.push((class, instance, surfaces, echo.signal)),
        }
    }

    fn cell(self, fades: f64) -> Cell {
        let strongest = self.things.iter().reduce(|a, b| if b.3 > a.3 { b } else { a });
        let (class, instance, surfaces, _) = strongest.copied().unwrap_or((Class::Void, InstanceId(0), 0, 0.0));
        let at = self.weighted.map(|sum| sum / self.signal);
        Cell { signal: self.signal * fades, at, class, instance, surfaces }
    }
}
