//! Fair-weather clouds: flat below, heaped above, lit by the sun and the sky.
//!
//! A cloud is where a field over the ground exceeds the height above the clouds' base, with puffs bitten out of it. Rays
//! march through that space, and through each lit point another one towards the sun.

use glam::{Vec2, Vec3};
use trove_model::{PhysicalSky, Seed};

use super::noise::{Plane, Puffs};

/// Height of the clouds' flat bases above the ground.
const BASE_M: f32 = 1_300.0;

/// Height of the highest tops above the bases, under a broken sky and under a closed one (which is a flat layer).
const TOPS_M: [f32; 2] = [2_200.0, 700.0];

/// Side of the square after which the clouds repeat; farther than one sees through haze.
const PERIOD_M: f32 = 48_000.0;

/// Side of the cube after which large and small puffs repeat.
const PUFFS_M: [f32; 2] = [2_400.0, 510.0];

/// How much of the field the large and the small puffs bite away.
const BITE: [f32; 2] = [0.42, 0.13];

/// Extinction of a full cloud, 1/m: one sees some forty metres into it.
const EXTINCTION: f32 = 0.035;

/// Rays end where this little light still passes.
const OPAQUE: f32 = 0.02;

/// Lengths of the steps towards the sun, metres: short where detail shows.
const TO_SUN_M: [f32; 5] = [40.0, 70.0, 120.0, 220.0, 400.0];

/// Scattering orders are summed as in Wrenninge, Kulla, Lundqvist 2013: each octave has this share of the strength, of
/// the extinction, and of the forward peak of the last one.
const OCTAVE: [f32; 3] = [0.55, 0.4, 0.5];

/// Brings a thick cloud that faces the sun to the 0.8 of a white surface that satellites see.
const GAIN: f32 = 4.2;

/// From which cover on the sun itself is hidden.
const SUN_HIDDEN_FROM: f32 = 0.8;

/// Clouds over a place.
pub(super) struct Clouds {
    field: Plane,
    puffs: Puffs,
    cover: f32,
    /// Value of the field at the clouds' edge, and by how much it exceeds that at the highest tops.
    edge: f32,
    span: f32,
    tops_m: f32,
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
        let field = Plane::fractal(seed.child("field"), 512, 9, 5, 0.5);
        // Puffs bite into the edges, so the field has to start beyond them.
        let edge = field.quantile_from_above(f64::from(cover.powf(0.75)));
        let span = (field.quantile_from_above(0.002) - edge).max(0.05);
        let closed = hidden_share(cover);
        Some(Self {
            field,
            puffs: Puffs::new(seed.child("puffs")),
            cover,
            edge,
            span,
            tops_m: TOPS_M[0] + (TOPS_M[1] - TOPS_M[0]) * closed,
            to_sun: sky.to_sun.normalize().as_vec3(),
            sun,
            above,
            below,
            haze_m: 75_000.0 / sky.turbidity.clamp(1.7, 10.0) as f32,
        })
    }

    /// Share of the sun's light that the clouds before it let through.
    pub(super) fn sun_share(cover: f64) -> f32 {
        1.0 - 0.98 * hidden_share(cover.clamp(0.0, 1.0) as f32)
    }

    /// Radiance of the sky in a direction with the clouds before it, where the air alone has the radiance `air`.
    pub(super) fn before(&self, air: Vec3, direction: Vec3) -> Vec3 {
        /// Nearer to the horizon clouds are lost in haze.
        const LOWEST_Z: f32 = 0.012;
        if direction.z < LOWEST_Z {
            return air;
        }
        let from_sun = direction.dot(self.to_sun).clamp(-1.0, 1.0).acos();
        let opening = self.opening(from_sun);
        let (mut t, end) = (BASE_M / direction.z, ((BASE_M + self.tops_m) / direction.z).min(3.0 * self.haze_m));
        let (mut light, mut passed, mut reach) = (Vec3::ZERO, 1.0f32, 0.0f32);
        let phases = phases(direction.dot(self.to_sun));
        while t < end && passed > OPAQUE {
            let point = direction * t;
            let step = 25.0 + 0.003 * t;
            // Nothing changes by more than a span in 900 m, so far from clouds a longer step misses none.
            let inside = self.inside(point, self.room(point) - opening, t);
            if inside <= 0.0 {
                t += (-inside * 900.0).clamp(step, 40.0 * step);
                continue;
            }
            let stays = (-density(point, inside) * EXTINCTION * step).exp();
            let weight = passed * (1.0 - stays);
            light += self.scattered(point, phases) * weight;
            reach += weight * t;
            passed *= stays;
            t += step;
        }
        let opacity = 1.0 - passed;
        if opacity < 1e-3 {
            return air;
        }
        // Haze lies before the clouds, and has the colour of the sky there.
        let seen = (-(reach / opacity) / self.haze_m).exp();
        let cloud = light * seen + air * opacity * (1.0 - seen);
        cloud + air * passed
    }

    /// How much the field is lowered around the sun, which stays clear of broken clouds.
    fn opening(&self, from_sun_rad: f32) -> f32 {
        let near = 1.0 - smoothstep(4.0, 14.0, from_sun_rad.to_degrees());
        1.5 * near * (1.0 - hidden_share(self.cover))
    }

    /// By how much the field exceeds the height at a point, in spans; negative outside clouds.
    fn room(&self, point: Vec3) -> f32 {
        let over = (self.field.at(Vec2::new(point.x, point.y) / PERIOD_M) - self.edge) / self.span;
        over - (point.z - BASE_M) / self.tops_m
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
    fn scattered(&self, point: Vec3, phases: [f32; 3]) -> Vec3 {
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
        let height = ((point.z - BASE_M) / self.tops_m).clamp(0.0, 1.0);
        from_sun + self.above * (0.5 + 0.4 * height) + self.below * (0.5 * (1.0 - height))
    }
}

/// 0 outside to 1 in the middle of a cloud.
fn density(point: Vec3, inside: f32) -> f32 {
    (inside * 10.0).clamp(0.0, 1.0) * smoothstep(0.0, 60.0, point.z - BASE_M)
}

/// 0 while the sun stays clear, 1 under a closed cover.
fn hidden_share(cover: f32) -> f32 {
    ((cover - SUN_HIDDEN_FROM) / (1.0 - SUN_HIDDEN_FROM)).clamp(0.0, 1.0)
}

/// The phase function of each octave for the cosine between eye ray and sun: mostly even, with a forward peak that makes
/// thin edges before the sun shine (two lobes of Henyey and Greenstein 1941).
fn phases(cos: f32) -> [f32; 3] {
    let lobe = |g: f32| {
        let square = 1.0 + g * g - 2.0 * g * cos;
        (1.0 - g * g) / (square * square.sqrt()) / (4.0 * std::f32::consts::PI)
    };
    let peak = |i: i32| OCTAVE[2].powi(i);
    [0, 1, 2].map(|i| 0.65 * lobe(0.75 * peak(i)) + 0.35 * lobe(-0.3 * peak(i)))
}

fn smoothstep(low: f32, high: f32, x: f32) -> f32 {
    let t = ((x - low) / (high - low)).clamp(0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}
