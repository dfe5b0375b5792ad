//! Clouds: fair-weather ones, flat below, heaped above, lit by the sun and the sky; thin ice clouds far above them; and
//! from a cover of about four fifths on a closed deck instead.
//!
//! A cloud is where a field over the ground exceeds the height above the clouds' base, with puffs bitten out of it. Rays
//! march through that space, and through each lit point another one towards the sun.

use std::f32::consts::PI;

use glam::{Vec2, Vec3};
use trove_model::{PhysicalSky, Seed, luminance};

use crate::noise::{Plane, Puffs};

/// Height of the clouds' flat bases above the ground.
const BASE_M: f32 = 1_300.0;

/// Height of the highest tops above the bases.
const TOPS_M: f32 = 2_400.0;

/// Height of ice clouds.
const CIRRUS_M: f32 = 9_000.0;

/// Side of the square after which the clouds repeat; farther than one sees through haze.
const PERIOD_M: f32 = 48_000.0;

/// Side of the cube after which large and small puffs repeat.
const PUFFS_M: [f32; 2] = [2_400.0, 510.0];

/// How much of the field the large and the small puffs bite away.
const BITE: [f32; 2] = [0.36, 0.2];

/// Extinction of a full cloud, 1/m: one sees some forty metres into it.
const EXTINCTION: f32 = 0.035;

/// Clouds are lost where they are this many times as far as the haze lets see.
const SEEN_TO: f32 = 1.4;

/// Rays end where this little light still passes.
const OPAQUE: f32 = 0.02;

/// Lengths of the steps towards the sun, metres: short where detail shows.
const TO_SUN_M: [f32; 3] = [80.0, 220.0, 550.0];

/// Scattering orders are summed as in Wrenninge, Kulla, Lundqvist 2013: each octave has this share of the strength, of
/// the extinction, and of the forward peak of the last one.
const OCTAVE: [f32; 3] = [0.6, 0.3, 0.5];

/// Brings a thick cloud that faces the sun to the 0.8 of a white surface that satellites see.
const GAIN: f32 = 4.2;

/// Below this cover the sun stands in a gap: recordings under broken clouds have shadows.
const SUN_CLEAR_BELOW: f32 = 0.7;

/// Covers between which broken clouds grow into a deck.
const DECK: [f32; 2] = [0.75, 0.95];

/// A deck lets this share of the light through to the ground (Kasten and Czeplak 1980), and this of the sun itself.
const DECK_PASSES: f32 = 0.25;
const DECK_SUN: f32 = 0.004;

/// What is left of the sun's and the sky's colours below a deck, at a luminance of about 1.
const DECK_COLOR: Vec3 = Vec3::new(0.97, 1.0, 1.06);

/// Clouds over a place.
pub(super) struct Clouds {
    field: Plane,
    puffs: &'static Puffs,
    /// Where the fields lie over the place, metres.
    offset: Vec2,
    /// How far the deck is closed, 0 to 1, and its radiance at the zenith.
    closed: f32,
    deck: Vec3,
    /// Optical thickness of the ice clouds where they are thickest.
    cirrus: f32,
    /// Value of the field at the clouds' edge, and by how much it exceeds that at the highest tops.
    edge: f32,
    span: f32,
    to_sun: Vec3,
    sun: Vec3,
    /// Mean radiance of the sky and of the ground, which light the clouds too.
    above: Vec3,
    below: Vec3,
    /// Distance over which haze takes 63 % of a cloud's contrast.
    haze_m: f32,
}

impl Clouds {
    /// `None` for a clear sky. `sun` is the irradiance of a surface facing it, above the clouds; `above` and `below` are
    /// the mean radiance of sky and ground.
    pub(super) fn new(sky: &PhysicalSky, sun: Vec3, above: Vec3, below: Vec3) -> Option<Self> {
        let cover = sky.cloud_cover.clamp(0.0, 1.0) as f32;
        if cover < 0.01 {
            return None;
        }
        let seed = Seed(sky.cloud_seed).child("clouds");
        let field = Plane::fractal(seed.child("field"), 512, 20, 4, 0.55);
        // Puffs bite into the edges, so the field has to start beyond them.
        let [edge, top] = field.quantiles_from_above([f64::from(cover.powf(0.75)), 0.002]);
        let to_sun = sky.to_sun.normalize().as_vec3();
        let lit = luminance(above) * PI + luminance(sun) * to_sun.z.max(0.0);
        let mut clouds = Self {
            field,
            puffs: Puffs::shared(),
            offset: Vec2::ZERO,
            closed: smoothstep(DECK[0], DECK[1], cover),
            // Irradiance under the overcast sky of the CIE is 7π/9 of its zenith's radiance.
            deck: DECK_COLOR * (DECK_PASSES * lit * 9.0 / (7.0 * PI)),
            cirrus: 0.35 * (2.0 * cover).min(1.0),
            edge,
            span: (top - edge).max(0.05),
            to_sun,
            sun,
            above,
            below,
            haze_m: 75_000.0 / sky.turbidity.clamp(1.7, 10.0) as f32,
        };
        // The clouds lie anywhere, but that few of them stand before the sun.
        let mut random = seed.child("offset").random();
        let tries = if cover < SUN_CLEAR_BELOW { 24 } else { 1 };
        let mut clearest = (-1.0, Vec2::ZERO);
        for _ in 0..tries {
            clouds.offset = Vec2::new(random.unit() as f32, random.unit() as f32) * PERIOD_M;
            let passes = clouds.sun_share();
            if passes > clearest.0 {
                clearest = (passes, clouds.offset);
            }
        }
        clouds.offset = clearest.1;
        Some(clouds)
    }

    /// Share of the sun's light that the clouds before it let through.
    pub(super) fn sun_share(&self) -> f32 {
        let (_, passed, _) = self.heap(self.to_sun);
        let ice = (-self.ice_thickness(self.to_sun)).exp();
        let broken = passed * ice;
        broken * (1.0 - self.closed) + DECK_SUN * self.closed
    }

    /// Radiance of the sky in a direction with the clouds before it, where the air alone has the radiance `air`.
    pub(super) fn before(&self, air: Vec3, direction: Vec3) -> Vec3 {
        /// Nearer to the horizon clouds are lost in haze.
        const LOWEST_Z: f32 = 0.012;
        if direction.z < LOWEST_Z {
            return air.lerp(self.deck_radiance(direction), self.closed);
        }
        let deck = if self.closed > 0.0 { self.deck_radiance(direction) } else { Vec3::ZERO };
        if self.closed >= 1.0 {
            return deck;
        }
        let behind = self.behind_ice(air, direction);
        let (light, passed, reach) = self.heap(direction);
        let opacity = 1.0 - passed;
        let broken = if opacity < 1e-3 {
            behind
        } else {
            // Haze lies before the clouds, and has the colour of the sky there.
            let hazes = reach / self.haze_m;
            let seen = (-hazes).exp() * (1.0 - smoothstep(0.7 * SEEN_TO, SEEN_TO, hazes));
            light * seen + air * opacity * (1.0 - seen) + behind * passed
        };
        broken.lerp(deck, self.closed)
    }

    /// Heaped clouds in a direction: the light that they send, the share that passes them, and how far away they are.
    fn heap(&self, direction: Vec3) -> (Vec3, f32, f32) {
        if direction.z <= 0.0 {
            return (Vec3::ZERO, 1.0, 0.0);
        }
        let (mut t, end) = (BASE_M / direction.z, ((BASE_M + TOPS_M) / direction.z).min(SEEN_TO * self.haze_m));
        let (mut light, mut passed, mut reach) = (Vec3::ZERO, 1.0f32, 0.0f32);
        let phases = phases(direction.dot(self.to_sun));
        let mut lit = Vec3::ZERO;
        while t < end && passed > OPAQUE {
            let point = direction * t;
            let step = 60.0 + 0.007 * t;
            // Nothing changes by more than a span in 900 m, so far from clouds a longer step misses none.
            let inside = self.inside(point, self.room(point), t);
            if inside <= 0.0 {
                t += (-inside * 900.0).clamp(step, 40.0 * step);
                continue;
            }
            let stays = (-density(point, inside) * EXTINCTION * step).exp();
            let weight = passed * (1.0 - stays);
            // Where little is added the last value does.
            if weight > 0.04 || lit == Vec3::ZERO {
                lit = self.scattered(point, inside, phases);
            }
            light += lit * weight;
            reach += weight * t;
            passed *= stays;
            t += step;
        }
        let opacity = 1.0 - passed;
        (light, passed, if opacity > 0.0 { reach / opacity } else { 0.0 })
    }

    /// Streaks of ice along the wind, before the air's radiance.
    fn behind_ice(&self, air: Vec3, direction: Vec3) -> Vec3 {
        let passed = (-self.ice_thickness(direction)).exp();
        let [wide, ..] = phases(direction.dot(self.to_sun));
        let light = self.sun * (wide + 0.04) * 1.6 + self.above * 0.6;
        air * passed + light * (1.0 - passed)
    }

    fn ice_thickness(&self, direction: Vec3) -> f32 {
        // The earth's curvature bounds the way through the layer.
        let at = direction.truncate() * (CIRRUS_M / (direction.z.max(0.0) + 0.06)) + self.offset;
        let streak = self.field.at(Vec2::new(at.x + 0.35 * at.y, at.y * 4.0 - at.x) / (2.5 * PERIOD_M));
        let tuft = self.field.at(Vec2::new(at.x - 0.6 * at.y, at.y * 2.0 + at.x) * (2.2 / PERIOD_M));
        self.cirrus * smoothstep(0.46, 0.78, 0.65 * streak + 0.35 * tuft) * (0.4 + 0.8 * tuft)
    }

    /// The overcast sky of the CIE, three times as bright at the zenith as at the horizon, uneven as real ones are.
    fn deck_radiance(&self, direction: Vec3) -> Vec3 {
        let z = direction.z.max(0.0);
        let at = direction.truncate() * (BASE_M / (z + 0.12)) + self.offset;
        let uneven = 0.7 * self.field.at(at / (0.3 * PERIOD_M)) + 0.3 * self.field.at(at / (0.08 * PERIOD_M));
        let near_sun = (-(1.0 - direction.dot(self.to_sun)) / 0.1).exp();
        self.deck * ((1.0 + 2.0 * z) / 3.0 * (0.78 + 0.44 * uneven) * (1.0 + 0.35 * near_sun))
    }

    /// By how much the field exceeds the height at a point, in spans; negative outside clouds.
    fn room(&self, point: Vec3) -> f32 {
        let over = (self.field.at((point.truncate() + self.offset) / PERIOD_M) - self.edge) / self.span;
        over - (point.z - BASE_M) / TOPS_M
    }

    /// The room at a point that puffs leave, negative outside clouds; detail is left out far from the eye.
    fn inside(&self, point: Vec3, room: f32, from_eye_m: f32) -> f32 {
        if room <= 0.0 {
            return room;
        }
        let left = room - BITE[0] * self.puffs.at(point / PUFFS_M[0]);
        let detail = BITE[1] * (1.0 - from_eye_m / 40_000.0).max(0.0);
        let is_edge = (0.0..0.3).contains(&left) && detail > 0.0;
        if is_edge { left - detail * self.puffs.at(point / PUFFS_M[1]) } else { left }
    }

    /// Radiance that a point of a cloud sends to the eye per unit of extinction.
    fn scattered(&self, point: Vec3, inside: f32, phases: [f32; 3]) -> Vec3 {
        let (mut thickness, mut along) = (0.0, 0.0);
        for step in TO_SUN_M {
            let p = point + self.to_sun * (along + 0.5 * step);
            // Detail is too small to matter to a whole step.
            thickness += density(p, self.inside(p, self.room(p), f32::INFINITY)) * EXTINCTION * step;
            along += step;
        }
        let [strength, extinction, _] = OCTAVE;
        let octave = |i: i32| strength.powi(i) * phases[i as usize] * (-thickness * extinction.powi(i)).exp();
        let from_sun = self.sun * GAIN * (0..3).map(octave).sum::<f32>();
        let height = ((point.z - BASE_M) / TOPS_M).clamp(0.0, 1.0);
        // Thin parts are lit through and through.
        let open = 0.6 * (-inside * 5.0).exp();
        from_sun + self.above * (0.45 + 0.4 * height + open) + self.below * (0.5 * (1.0 - height) + open)
    }
}

/// 0 outside to 1 in the middle of a cloud.
fn density(point: Vec3, inside: f32) -> f32 {
    (inside * 10.0).clamp(0.0, 1.0) * smoothstep(0.0, 60.0, point.z - BASE_M)
}

/// The phase function of each octave for the cosine between eye ray and sun: mostly even, with a forward peak that makes
/// thin edges before the sun shine (two lobes of Henyey and Greenstein 1941).
fn phases(cos: f32) -> [f32; 3] {
    let lobe = |g: f32| {
        let square = 1.0 + g * g - 2.0 * g * cos;
        (1.0 - g * g) / (square * square.sqrt()) / (4.0 * PI)
    };
    let peak = |i: i32| OCTAVE[2].powi(i);
    [0, 1, 2].map(|i| 0.65 * lobe(0.75 * peak(i)) + 0.35 * lobe(-0.3 * peak(i)))
}

fn smoothstep(low: f32, high: f32, x: f32) -> f32 {
    let t = ((x - low) / (high - low)).clamp(0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}
