//! Drops that sit on the glass before a lens, and where rays through them go on.
//!
//! The glass is a dome about the lens, so that every lens looks through it straight; a drop on it is a cap of a ball of water.

use std::collections::HashMap;
use std::f64::consts::{PI, TAU};

use glam::{DVec3, IVec3};
use trove_model::{LensDrops, Random};

use crate::path::falling::{WATER, reflectance};

/// From the lens to the glass.
pub(super) const GLASS_M: f64 = 0.04;
/// Radii of the drops' bases: the median, the standard deviation of the logarithm, the least and the most.
const MEDIAN_M: f64 = 0.6e-3;
const SPREAD: f64 = 0.6;
const RADIUS_M: [f64; 2] = [0.3e-3, 3e-3];
/// Angle between glass and water at the base, on glass that water does not wet well.
const CONTACT_DEG: [f64; 2] = [60.0, 80.0];
/// Places that are tried for a drop before it is left out.
const TRIES: u32 = 300;
/// Side of the cubes by which drops are found.
const CELL_M: f64 = 2e-3;

/// A glass with drops, in Camera.
pub(super) struct Glass {
    drops: Vec<Drop>,
    /// Which of them reach into a cube.
    cells: HashMap<IVec3, Vec<usize>>,
}

/// A drop.
pub(super) struct Drop {
    /// Where the middle of its base lies from the lens, unit.
    axis: DVec3,
    /// Radius of its base, metres.
    base_m: f64,
    /// Between its base and its surface.
    contact_rad: f64,
}

impl Glass {
    /// As far from the camera's axis as an angle.
    pub(super) fn new(what: LensDrops, reach_rad: f64) -> Self {
        let mut random = what.seed.random();
        let height = 1.0 - reach_rad.min(PI).cos();
        let mut left_m2 = what.share * TAU * height * GLASS_M * GLASS_M;
        let mut radii = Vec::new();
        while left_m2 > PI * RADIUS_M[0] * RADIUS_M[0] {
            let base_m = (MEDIAN_M * (SPREAD * random.normal()).exp()).clamp(RADIUS_M[0], RADIUS_M[1]);
            // The last one covers what is left.
            let base_m = base_m.min((left_m2 / PI).sqrt());
            left_m2 -= PI * base_m * base_m;
            radii.push(base_m);
        }
        // Between large ones there is room for small ones, but not the other way round.
        radii.sort_by(|a, b| b.total_cmp(a));
        let mut glass = Self { drops: Vec::new(), cells: HashMap::new() };
        for base_m in radii {
            let contact_rad = random.range(CONTACT_DEG[0], CONTACT_DEG[1]).to_radians();
            let place = (0..TRIES).map(|_| direction(height, &mut random)).find(|&axis| glass.has_room(axis, base_m));
            if let Some(axis) = place {
                glass.put(Drop { axis, base_m, contact_rad });
            }
        }
        glass
    }

    fn has_room(&self, axis: DVec3, base_m: f64) -> bool {
        let apart = |other: &Drop| axis.distance(other.axis) * GLASS_M > base_m + other.base_m;
        cells(axis, base_m).flat_map(|cell| self.cells.get(&cell).into_iter().flatten()).all(|&i| apart(&self.drops[i]))
    }

    fn put(&mut self, drop: Drop) {
        for cell in cells(drop.axis, drop.base_m) {
            self.cells.entry(cell).or_default().push(self.drops.len());
        }
        self.drops.push(drop);
    }

    /// The drop behind which a direction, unit, lies.
    pub(super) fn before(&self, direction: DVec3) -> Option<&Drop> {
        let near = self.cells.get(&cell(direction * GLASS_M))?;
        near.iter().map(|&i| &self.drops[i]).find(|drop| drop.at_base(direction).is_some())
    }
}

impl Drop {
    /// Where a ray from the lens meets the base, from its middle, metres.
    fn at_base(&self, direction: DVec3) -> Option<DVec3> {
        let cos = direction.dot(self.axis);
        let at = direction * (GLASS_M / cos) - self.axis * GLASS_M;
        (cos > 0.0 && at.length_squared() < self.base_m * self.base_m).then_some(at)
    }

    /// The direction in which a ray from the lens goes on that meets the base, and the share of light that comes from there;
    /// `None` where the water's surface mirrors everything: the drop is dark there.
    pub(super) fn onwards(&self, direction: DVec3) -> Option<(DVec3, f64)> {
        let at = self.at_base(direction)?;
        let ball_m = self.base_m / self.contact_rad.sin();
        let inside = refracted(direction, self.axis, 1.0 / f64::from(WATER))?;
        let from_centre = at + self.axis * (ball_m * self.contact_rad.cos());
        let b = inside.dot(from_centre);
        let through_m = (b * b + ball_m * ball_m - from_centre.length_squared()).max(0.0).sqrt() - b;
        let normal = (from_centre + inside * through_m) / ball_m;
        let on = refracted(inside, normal, f64::from(WATER))?;
        let sin = on.cross(normal).length().min(1.0);
        Some((on, 1.0 - f64::from(reflectance(sin as f32))))
    }
}

/// Where a ray goes on behind a surface whose normal is on that side, by Snell's law; `index` is that before it over that
/// behind it. `None` where all is reflected.
fn refracted(direction: DVec3, normal: DVec3, index: f64) -> Option<DVec3> {
    let cos = direction.dot(normal);
    let cos2 = 1.0 - index * index * (1.0 - cos * cos);
    (cos2 > 0.0).then(|| (direction * index + normal * (cos2.sqrt() - index * cos)).normalize())
}

/// A direction about the camera's axis; all places of the dome up to a height, radii, are as likely.
fn direction(height: f64, random: &mut Random) -> DVec3 {
    let (z, turn) = (1.0 - height * random.unit(), TAU * random.unit());
    let across = (1.0 - z * z).max(0.0).sqrt();
    DVec3::new(across * turn.cos(), across * turn.sin(), z)
}

/// The cubes into which a disc on the dome may reach.
fn cells(axis: DVec3, radius_m: f64) -> impl Iterator<Item = IVec3> {
    let [low, high] = [-radius_m, radius_m].map(|r| cell(axis * GLASS_M + r));
    (low.z..=high.z)
        .flat_map(move |z| (low.y..=high.y).map(move |y| (y, z)))
        .flat_map(move |(y, z)| (low.x..=high.x).map(move |x| IVec3::new(x, y, z)))
}

fn cell(point: DVec3) -> IVec3 {
    (point / CELL_M).floor().as_ivec3()
}

#[cfg(test)]
mod tests {
    use trove_model::Seed;

    use super::*;

    fn drop(base_m: f64, contact_deg: f64) -> Drop {
        Drop { axis: DVec3::Z, base_m, contact_rad: contact_deg.to_radians() }
    }

    /// From the lens to a place on the base.
    fn towards(x_m: f64) -> DVec3 {
        DVec3::new(x_m, 0.0, GLASS_M).normalize()
    }

    #[test]
    fn a_ray_through_the_middle_goes_straight_and_loses_what_water_reflects() {
        let (on, share) = drop(1e-3, 70.0).onwards(DVec3::Z).unwrap();
        assert!(on.distance(DVec3::Z) < 1e-12, "{on}");
        assert!((share - (1.0 - (0.333f64 / 2.333).powi(2))).abs() < 1e-5, "{share}");
    }

    #[test]
    fn a_flat_drop_is_a_lens_of_the_lensmaker_s_focal_length() {
        let drop = drop(1e-3, 20.0);
        let focal_m = 1e-3 / 20f64.to_radians().sin() / 0.333;
        for x_m in [2e-5, 5e-5] {
            let (direction, on) = (towards(x_m), drop.onwards(towards(x_m)).unwrap().0);
            let turned = direction.x / direction.z - on.x / on.z;
            assert!((turned * focal_m / x_m - 1.0).abs() < 0.02, "{}", turned * focal_m / x_m);
        }
    }

    #[test]
    fn the_rim_of_a_steep_drop_is_dark_from_where_water_mirrors_all() {
        // A ray that meets the base squarely meets the surface at an angle whose sine is its place over the ball's radius.
        let steep = Drop { axis: DVec3::Z, base_m: 1e-5, contact_rad: 80f64.to_radians() };
        let edge = 1e-5 / 80f64.to_radians().sin() / 1.333;
        assert!(steep.onwards(towards(edge * 0.99)).is_some());
        assert!(steep.onwards(towards(edge * 1.01)).is_none() && steep.at_base(towards(edge * 1.01)).is_some());
    }

    #[test]
    fn drops_cover_as_much_of_the_glass_as_is_asked_for_and_never_each_other() {
        for share in [0.05, 0.3, LensDrops::MOST] {
            let glass = Glass::new(LensDrops { share, seed: Seed(3) }, 1.5);
            let mut random = Seed(5).random();
            let height = 1.0 - 1.5f64.cos();
            let covered = (0..100_000).filter(|_| glass.before(direction(height, &mut random)).is_some()).count();
            let found = covered as f64 / 100_000.0;
            assert!((found / share - 1.0).abs() < 0.06, "{found} instead of {share}");
            for (i, a) in glass.drops.iter().enumerate() {
                let apart = |b: &Drop| a.axis.distance(b.axis) * GLASS_M > a.base_m + b.base_m;
                assert!(glass.drops[..i].iter().all(apart));
            }
        }
    }
}
