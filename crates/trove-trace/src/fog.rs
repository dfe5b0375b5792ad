//! Fog, rain and snow between surfaces: droplets that scatter light mostly onwards, swallow none, and thin out with height.
//!
//! How thick it is falls exponentially upwards, so that the depth along a ray, and the place where a ray is scattered, have
//! closed forms. Below the lowest point of the scene there is none: rays that leave the map see its ground as in clear air.
//!
//! The more often light has been scattered, the fewer and wider turns it takes, which come to the same (after Joseph, Wiscombe
//! and Weinman, "The Delta-Eddington Approximation for Radiative Flux Transfer", 1976): most droplets send it on so nearly
//! straight that soon nobody could tell which it has met. What they do to the sun's light is drawn at its end, as one turn
//! for all of them.

use core::f32::consts::PI;

use glam::Vec3;

use crate::math::{exp, less_exp, log_less, sqrt, turn, unit};
use crate::sampling::Basis;

/// Mean cosine of scattering by water droplets of fog, 5 to 20 µm (Deirmendjian 1969: 0.84 to 0.87).
const ASYMMETRY: f32 = 0.85;
/// Mean cosine of what those droplets scatter that are taken together, seen where light arrives.
const TOGETHER_ASYMMETRY: f32 = 0.9;

/// Scattering events after which light takes the fewest turns; up to [`EXACT_EVENTS`] it meets every droplet.
const MIXED_EVENTS: u32 = 5;
const EXACT_EVENTS: u32 = 1;
/// Turns of light that are told apart at most.
const MOST_TURNS: u32 = 12;
/// What a matt surface counts for, which does not tell ways apart that differ by the turns of single droplets.
pub const MATT_EVENTS: u32 = 3;

/// How light is scattered.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
pub struct Scattering {
    /// Share of the droplets that scatter it one by one; the others are taken together.
    share: f32,
    /// Mean cosine of Henyey and Greenstein's function, which is kept below `most` and then made a density again.
    asymmetry: f32,
    most: f32,
    sum: f32,
    /// Mean cosine of what those droplets scatter that are taken together, seen where light arrives.
    together: f32,
}

/// Cosine of the angle within which [`Scattering::broad`] has no peak, 25°.
const PEAK_COS: f32 = 0.906_307_8;

impl Scattering {
    /// Of light that so many scattering events part from the eye. With `ASYMMETRY`² of the droplets taken together, the first
    /// two moments of the phase function are kept; with fewer of them, the first.
    #[inline]
    pub fn after(events: u32) -> Self {
        let mixed = events.clamp(EXACT_EVENTS, MIXED_EVENTS) - EXACT_EVENTS;
        let together = ASYMMETRY * ASYMMETRY * mixed as f32 / (MIXED_EVENTS - EXACT_EVENTS) as f32;
        let share = 1.0 - together;
        Self {
            share,
            asymmetry: (ASYMMETRY - together) / share,
            most: f32::INFINITY,
            sum: 1.0,
            together: TOGETHER_ASYMMETRY,
        }
    }

    /// Of light whose scattering is not followed but read from a field: the peak of what droplets scatter nearly straight
    /// on is taken as not scattered (after Iwabuchi and Suzuki 2009). It is added up, so [`Lookups`](crate::Lookups) keep it.
    #[inline]
    pub fn broad() -> Self {
        let exact = Self::after(0);
        let most = exact.phase(PEAK_COS);
        let (mut sum, mut peak, steps) = (0.0f64, 0.0f64, 20_000);
        // Finest ahead.
        let from_ahead = |i: i32| {
            let share = f64::from(i) / f64::from(steps);
            2.0 * share * share * share
        };
        for i in 0..steps {
            let cos = 1.0 - 0.5 * (from_ahead(i) + from_ahead(i + 1));
            let width_sr = (from_ahead(i + 1) - from_ahead(i)) * 2.0 * core::f64::consts::PI;
            let all = exact.phase(cos as f32);
            let left = f64::from(all.min(most)) * width_sr;
            sum += left;
            peak += (f64::from(all) * width_sr - left) * cos;
        }
        let share = sum as f32;
        Self { share, asymmetry: ASYMMETRY, most, sum: share, together: (peak / (1.0 - sum)) as f32 }
    }

    /// Share of light from afar that droplets, met one by one, scatter into a direction, a steradian, by the cosine between
    /// the ways, if it came through so much depth and only those were taken together that [`Self::broad`] leaves out.
    #[inline]
    pub fn phase_of_turned(self, broad: &Self, cos: f32, depth: f32) -> f32 {
        let mean = (1.0 - broad.share) * depth;
        let (mut chance, mut left, mut turned, mut sum) = (exp(-mean), 1.0, self, 0.0);
        for met in 1..=MOST_TURNS {
            sum += turned.phase(cos) * if met == MOST_TURNS { left } else { chance };
            left -= chance;
            if left < 1e-3 {
                break;
            }
            chance *= mean / met as f32;
            turned.asymmetry *= broad.together;
        }
        sum
    }

    /// Share of light from a direction that is scattered into another, a steradian, by the cosine between the ways; also the
    /// density of [`Self::turn`], but for [`Self::broad`].
    #[inline]
    pub fn phase(self, cos: f32) -> f32 {
        let g = self.asymmetry;
        let square = 1.0 + g * g - 2.0 * g * cos;
        ((1.0 - g * g) / (4.0 * PI * square * sqrt(square))).min(self.most) / self.sum
    }

    /// A way on from a unit direction.
    #[inline]
    pub fn turn(self, direction: Vec3, u: [f32; 2]) -> Vec3 {
        turned(direction, self.asymmetry, u)
    }

    /// A way on after all droplets on a way that are taken together, which has so much depth of all droplets: one turn, since
    /// turns by Henyey and Greenstein's function, one after another, are one with the product of their mean cosines.
    #[inline]
    pub fn turn_together(self, direction: Vec3, depth: f32, u: [f32; 3]) -> Vec3 {
        let met = poisson((1.0 - self.share) * depth, u[0]);
        if met == 0 { direction } else { turned(direction, power(self.together, met), [u[1], u[2]]) }
    }
}

/// A unit direction turned by Henyey and Greenstein's phase function (1941) of a mean cosine.
#[inline(always)]
fn turned(direction: Vec3, g: f32, u: [f32; 2]) -> Vec3 {
    let inner = (1.0 - g * g) / (1.0 - g + 2.0 * g * u[0]);
    let cos = ((1.0 + g * g - inner * inner) / (2.0 * g)).clamp(-1.0, 1.0);
    let (across, (sin, along)) = (sqrt(1.0 - cos * cos), turn(u[1]));
    unit(Basis::about(direction).to_world(Vec3::new(across * along, across * sin, cos)))
}

/// A number to the power of a count.
#[inline(always)]
fn power(x: f32, count: i32) -> f32 {
    (0..count).fold(1.0, |product, _| product * x)
}

/// How many come where so many are expected; no more than are of any use.
#[inline(always)]
fn poisson(mean: f32, mut u: f32) -> i32 {
    let mut chance = exp(-mean);
    let mut count = 0;
    while u >= chance && count < 30 {
        u -= chance;
        count += 1;
        chance *= mean / count as f32;
    }
    count
}

/// Fog and what falls in a scene.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
pub struct Fog {
    /// At the ground.
    pub extinction_per_m: f32,
    /// Over which it thins out to 1/e.
    pub height_m: f32,
    /// Where the ground is.
    pub ground_z: f32,
    /// There is none below.
    pub lowest_z: f32,
}

impl Fog {
    /// What is left of it for light that is scattered so.
    #[inline]
    pub fn scattering(&self, scattering: Scattering) -> Self {
        Self { extinction_per_m: self.extinction_per_m * scattering.share, ..*self }
    }

    /// What a metre takes at a height.
    #[inline]
    pub fn extinction_per_m(&self, z: f32) -> f32 {
        if z < self.lowest_z { 0.0 } else { self.extinction_per_m * exp((self.ground_z - z) / self.height_m) }
    }

    /// Share of light that passes along a unit direction for `t` metres.
    #[inline]
    pub fn transmittance(&self, origin: Vec3, direction: Vec3, t: f32) -> f32 {
        exp(-self.depth(origin, direction, t))
    }

    /// Optical depth along a unit direction for `t` metres; it may be infinite.
    #[inline]
    pub fn depth(&self, origin: Vec3, direction: Vec3, t: f32) -> f32 {
        let (thick, up) = (self.extinction_per_m(origin.z), direction.z / self.height_m);
        if thick <= 0.0 {
            return 0.0;
        }
        let t = t.min(self.way_down(origin, direction));
        if t < f32::INFINITY {
            thick * t * less_exp(up * t)
        } else if up > 0.0 {
            thick / up
        } else {
            f32::INFINITY
        }
    }

    /// How far light goes before it meets a droplet, metres, less than `t_max`; drawn with the density of that.
    #[inline]
    pub fn met(&self, origin: Vec3, direction: Vec3, t_max: f32, u: f32) -> Option<f32> {
        let (thick, up) = (self.extinction_per_m(origin.z), direction.z / self.height_m);
        if thick <= 0.0 {
            return None;
        }
        let depth = u * log_less(u);
        let x = depth * up / thick;
        // Upwards there may not be as much.
        let t = if x >= 1.0 { f32::INFINITY } else { depth / thick * log_less(x) };
        (t < t_max.min(self.way_down(origin, direction))).then_some(t)
    }

    /// How far it is down to where there is none.
    #[inline(always)]
    fn way_down(&self, origin: Vec3, direction: Vec3) -> f32 {
        if direction.z < 0.0 { (origin.z - self.lowest_z).max(0.0) / -direction.z } else { f32::INFINITY }
    }
}

#[cfg(test)]
mod tests {
    use trove_model::Seed;

    use super::*;

    const FOG: Fog = Fog { extinction_per_m: 0.03, height_m: 40.0, ground_z: 2.0, lowest_z: -5.0 };

    /// The depth by many short steps.
    fn depth(origin: Vec3, direction: Vec3, t: f32) -> f64 {
        let n = 200_000;
        let step = f64::from(t) / f64::from(n);
        let at = |i: i32| f64::from(origin.z) + f64::from(direction.z) * step * (f64::from(i) + 0.5);
        let thick = |z: f64| if z < -5.0 { 0.0 } else { 0.03 * ((2.0 - z) / 40.0).exp() };
        (0..n).map(|i| thick(at(i)) * step).sum()
    }

    #[test]
    fn light_passes_as_the_sum_of_short_steps_says() {
        let ways = [Vec3::X, Vec3::Z, Vec3::NEG_Z, Vec3::new(0.8, 0.0, -0.6), Vec3::new(1.0, 0.0, 1e-5).normalize()];
        for direction in ways {
            for (z, t) in [(2.0, 10.0), (30.0, 150.0), (-4.9, 3.0)] {
                let origin = Vec3::Z * z;
                let (found, expected) = (FOG.transmittance(origin, direction, t), (-depth(origin, direction, t)).exp());
                assert!((f64::from(found) - expected).abs() < 1e-4, "{direction} {z} {t}: {found} {expected}");
            }
        }
        // All of what lies above: 0.03 · 40.
        assert!((FOG.transmittance(Vec3::Z * 2.0, Vec3::Z, f32::INFINITY) - (-1.2f32).exp()).abs() < 1e-6);
        assert_eq!(FOG.transmittance(Vec3::Z * 2.0, Vec3::X, f32::INFINITY), 0.0);
    }

    #[test]
    fn as_much_meets_droplets_as_does_not_pass() {
        let mut random = Seed(4).random();
        for direction in [Vec3::X, Vec3::Z, Vec3::new(0.6, 0.0, 0.8), Vec3::new(0.8, 0.0, -0.6)] {
            for t in [7.0, 30.0, f32::INFINITY] {
                let (draws, origin) = (40_000, Vec3::Z * 3.0);
                let met = (0..draws).filter(|_| FOG.met(origin, direction, t, random.unit() as f32).is_some()).count();
                let (found, expected) =
                    (met as f64 / draws as f64, 1.0 - f64::from(FOG.transmittance(origin, direction, t)));
                // Five standard deviations.
                let slack = 5.0 * (expected * (1.0 - expected) / draws as f64).sqrt() + 1e-6;
                assert!((found - expected).abs() < slack, "{direction} {t}: {found} {expected}");
            }
        }
    }

    #[test]
    fn ways_on_are_drawn_as_the_phase_function_says() {
        let mut random = Seed(5).random();
        let direction = Vec3::new(0.3, -0.5, 0.4).normalize();
        for scattering in [1, 3, 5].map(Scattering::after) {
            // Over twenty equal steps of the cosine.
            let (draws, mut drawn, mut sum) = (200_000, [0.0f64; 20], 0.0);
            for _ in 0..draws {
                let cos = scattering.turn(direction, [random.unit() as f32, random.unit() as f32]).dot(direction);
                drawn[(((cos + 1.0) * 10.0) as usize).min(19)] += 1.0;
                sum += f64::from(cos);
            }
            assert!((sum / f64::from(draws) - f64::from(scattering.asymmetry)).abs() < 2e-3);
            for (i, found) in drawn.iter().enumerate() {
                let share: f64 = (0..1000)
                    .map(|k| f64::from(scattering.phase(-1.0 + 0.1 * (i as f32 + (k as f32 + 0.5) / 1000.0))) * 1e-4)
                    .sum::<f64>()
                    * 2.0
                    * std::f64::consts::PI;
                let expected = share * f64::from(draws);
                assert!((found - expected).abs() < 5.0 * expected.sqrt() + 1.0, "{i}: {found} {expected}");
            }
        }
    }

    /// Shares of light from straight above that leave a layer of a depth: upwards, downwards, and downwards within cones of
    /// 11° and 26°, of so many draws. It meets every droplet, or as many as there are after so many events.
    fn through(depth: f32, first: Option<u32>, draws: u32) -> [f64; 4] {
        let mut random = Seed(6).random();
        let mut unit = move || random.unit() as f32;
        let mut left = [0u32; 4];
        for _ in 0..draws {
            let (mut z, mut way, mut met) = (0.0f32, Vec3::Z, 0);
            loop {
                let scattering = Scattering::after(first.map_or(0, |first| first + met));
                z += -(-unit()).ln_1p() / scattering.share * way.z;
                if z < 0.0 || z > depth {
                    if met == 0 {
                        way = scattering.turn_together(way, depth, [unit(), unit(), unit()]);
                    }
                    let ways = [z < 0.0, z > depth, z > depth && way.z > 0.98, z > depth && way.z > 0.9];
                    left.iter_mut().zip(ways).for_each(|(left, way)| *left += u32::from(way));
                    break;
                }
                way = scattering.turn(way, [unit(), unit()]);
                met += 1;
            }
        }
        left.map(|left| f64::from(left) / f64::from(draws))
    }

    #[test]
    fn light_scattered_often_passes_a_layer_as_if_it_met_every_droplet() {
        let draws = 400_000;
        for depth in [1.0, 4.0, 12.0] {
            let exact = through(depth, None, draws);
            // Of paths that start at droplets, and of those that start at matt surfaces: what gets through, and its cones.
            for (first, most) in [(0, [0.005, 0.005]), (MATT_EVENTS, [0.01, 0.025])] {
                for (i, (exact, found)) in exact.into_iter().zip(through(depth, Some(first), draws)).enumerate() {
                    // So much of the light, and four standard deviations of both.
                    let slack = most[i / 2] + 4.0 * (2.0 * exact * (1.0 - exact) / f64::from(draws)).sqrt();
                    assert!((exact - found).abs() < slack, "{depth}, {first}: {found} instead of {exact}");
                }
            }
        }
    }
}
