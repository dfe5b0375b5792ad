//! People's shapes, mixed from MakeHuman's macro targets: every target's weight is the product of what its name says.

use glam::Vec3;
use serde::Deserialize;
use trove_model::{HumanBody, Seed};

/// What someone is built like; sliders run from 0 to 1 with the average at a half.
#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Build {
    /// 0 woman, 1 man.
    pub(super) male: f32,
    pub(super) years: f32,
    pub(super) muscle: f32,
    pub(super) weight: f32,
    pub(super) height: f32,
    /// 1 is ideal.
    pub(super) proportions: f32,
    /// African, Asian, Caucasian shares, which come to 1.
    pub(super) origins: [f32; 3],
}

/// Pairs of targets that make faces differ: one way, the other way.
const FEATURES: [[&str; 2]; 9] = [
    ["nose-scale-vert-decr", "nose-scale-vert-incr"],
    ["nose-scale-horiz-decr", "nose-scale-horiz-incr"],
    ["nose-point-down", "nose-point-up"],
    ["nose-hump-decr", "nose-hump-incr"],
    ["chin-width-decr", "chin-width-incr"],
    ["chin-prominent-decr", "chin-prominent-incr"],
    ["head-fat-decr", "head-fat-incr"],
    ["head-square", "head-oval"],
    ["head-scale-horiz-decr", "head-scale-horiz-incr"],
];

impl Build {
    /// All vertices of the body in this shape, metres; faces differ by seed.
    pub(super) fn shape(&self, body: &HumanBody, seed: Seed) -> Vec<Vec3> {
        let mut positions = body.positions.clone();
        let mut add = |name: &str, weight: f32| {
            if let Some(target) = body.targets.get(name).filter(|_| weight > 1e-4) {
                target.iter().for_each(|&(vertex, by)| positions[vertex as usize] += by * weight);
            }
        };
        // MakeHuman's slider has 25 years in its middle and 90 at its end.
        let age = if self.years < 25.0 { (self.years - 1.0) / 48.0 } else { 0.5 + (self.years - 25.0) / 130.0 };
        let genders = [("female", 1.0 - self.male), ("male", self.male)];
        let ages = between(age, &[(0.0, "baby"), (0.1875, "child"), (0.5, "young"), (1.0, "old")]);
        let muscles = between(self.muscle, &[(0.0, "minmuscle"), (0.5, "averagemuscle"), (1.0, "maxmuscle")]);
        let weights = between(self.weight, &[(0.0, "minweight"), (0.5, "averageweight"), (1.0, "maxweight")]);
        let heights = between(self.height, &[(0.0, "minheight"), (0.5, ""), (1.0, "maxheight")]);
        let proportions =
            between(self.proportions, &[(0.0, "uncommonproportions"), (0.5, ""), (1.0, "idealproportions")]);
        for (gender, g) in genders {
            for &(age, a) in &ages {
                for (origin, share) in ["african", "asian", "caucasian"].into_iter().zip(self.origins) {
                    add(&format!("{origin}-{gender}-{age}"), g * a * share);
                }
                for &(muscle, m) in &muscles {
                    for &(weight, w) in &weights {
                        let (person, share) = (format!("{gender}-{age}-{muscle}-{weight}"), g * a * m * w);
                        add(&format!("universal-{person}"), share);
                        for &(more, s) in heights.iter().chain(&proportions) {
                            add(&format!("{person}-{more}"), share * s);
                        }
                    }
                }
            }
        }
        let mut random = seed.random();
        for [one, other] in FEATURES {
            let way = random.range(-0.6, 0.6) as f32;
            add(if way < 0.0 { one } else { other }, way.abs());
        }
        positions
    }
}

/// The two stops that a value lies between, and their shares.
fn between(value: f32, stops: &[(f32, &'static str)]) -> Vec<(&'static str, f32)> {
    let share = |i: usize| {
        let near = |j: usize| (value - stops[i].0) / (stops[j].0 - stops[i].0);
        match () {
            () if i > 0 && value < stops[i].0 => 1.0 - near(i - 1),
            () if i + 1 < stops.len() && value > stops[i].0 => 1.0 - near(i + 1),
            () => 1.0,
        }
    };
    (0..stops.len()).map(|i| (stops[i].1, share(i).clamp(0.0, 1.0))).filter(|s| s.1 > 0.0).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_value_between_two_stops_is_shared_by_them() {
        let stops = [(0.0, "a"), (0.5, "b"), (1.0, "c")];
        assert_eq!(between(0.5, &stops), [("b", 1.0)]);
        assert_eq!(between(0.25, &stops), [("a", 0.5), ("b", 0.5)]);
        assert_eq!(between(2.0, &stops), [("c", 1.0)]);
    }
}
