//! Droplets that hang in the air in one place.

use glam::DVec3;

/// A cloud of droplets, thickest in its middle and without an edge: an ellipsoid with an upright axis in which the extinction
/// is (1 − r²)² of the middle's, r growing from 0 there to 1 at its surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Puff {
    /// World, metres.
    pub centre: DVec3,
    /// Half of its width and of its height, metres; more than 0.
    pub radius_m: [f64; 2],
    /// What a metre takes from light in its middle, as the exponent of its loss.
    pub extinction_per_m: f64,
}

impl Puff {
    /// Its volume, if it were as thick everywhere as in its middle, as a share of the ellipsoid's box of twice its radii.
    const FILLS: f64 = 4.0 * std::f64::consts::PI / 105.0;

    /// A puff of droplets that cover so much together, m².
    pub fn covering(area_m2: f64, centre: DVec3, radius_m: [f64; 2]) -> Self {
        let [across_m, up_m] = radius_m;
        let box_m3 = 8.0 * across_m * across_m * up_m;
        Self { centre, radius_m, extinction_per_m: area_m2 / (box_m3 * Self::FILLS) }
    }

    /// What a metre takes at a place in World.
    pub fn extinction_at(&self, place: DVec3) -> f64 {
        self.extinction_per_m * (1.0 - ((place - self.centre) * self.per_radius()).length_squared()).max(0.0).powi(2)
    }

    /// What it takes of light on the first `t_m` metres along a unit direction, as the exponent of the loss.
    pub fn optical_depth(&self, origin: DVec3, direction: DVec3, t_m: f64) -> f64 {
        let (from, way) = ((origin - self.centre) * self.per_radius(), direction * self.per_radius());
        let per_m = way.length();
        let nearest_m = -from.dot(way) / (per_m * per_m);
        let inside_squared = 1.0 - (from + way * nearest_m).length_squared();
        if inside_squared <= 0.0 {
            return 0.0;
        }
        let half = inside_squared.sqrt();
        let [first, last] = [0.0, t_m].map(|t| ((t - nearest_m) * per_m).clamp(-half, half));
        // ∫ (h² − u²)² du
        let until = |u: f64| u * (inside_squared * (inside_squared - u * u / 1.5) + u.powi(4) / 5.0);
        self.extinction_per_m * (until(last) - until(first)) / per_m
    }

    /// What makes it a ball of radius 1.
    fn per_radius(&self) -> DVec3 {
        let [across_m, up_m] = self.radius_m;
        DVec3::new(across_m, across_m, up_m).recip()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const PUFF: Puff = Puff { centre: DVec3::new(1.0, 2.0, 0.5), radius_m: [2.0, 0.8], extinction_per_m: 0.3 };

    #[test]
    fn the_loss_along_a_way_is_the_sum_of_what_its_metres_take() {
        let origins = [DVec3::new(-5.0, 1.0, 0.7), DVec3::new(1.5, 2.5, 0.4), DVec3::new(1.0, 2.0, 9.0)];
        for origin in origins {
            for aim in [DVec3::new(1.2, 2.1, 0.3), DVec3::new(0.0, 3.5, 0.6), DVec3::new(9.0, 9.0, 9.0)] {
                let direction = (aim - origin).normalize();
                for t_m in [0.5, 6.0, 50.0] {
                    let step_m = t_m / 20_000.0;
                    let at = |i: i32| PUFF.extinction_at(origin + direction * (f64::from(i) + 0.5) * step_m);
                    let sum = (0..20_000).map(at).sum::<f64>() * step_m;
                    let found = PUFF.optical_depth(origin, direction, t_m);
                    assert!((found - sum).abs() < 1e-6, "{origin} {aim} {t_m}: {found} {sum}");
                }
            }
        }
    }

    #[test]
    fn it_is_thickest_in_its_middle_and_ends_at_its_surface() {
        let at = |x_m: f64, z_m: f64| PUFF.extinction_at(PUFF.centre + DVec3::new(x_m, 0.0, z_m));
        assert_eq!([at(0.0, 0.0), at(2.0, 0.0), at(0.0, 0.9)], [0.3, 0.0, 0.0]);
        assert!((at(1.0, 0.0) - 0.3 * 0.5625).abs() < 1e-12 && (at(0.0, 0.4) - at(1.0, 0.0)).abs() < 1e-12);
    }

    #[test]
    fn droplets_cover_as_much_in_a_puff_of_any_size() {
        for radius_m in [[0.4, 0.3], [1.5, 2.0]] {
            let puff = Puff::covering(0.7, DVec3::new(3.0, -1.0, 1.0), radius_m);
            // Seen from above, cell by cell.
            let (side, far_m) = (200, radius_m[0]);
            let cell_m = 2.0 * far_m / f64::from(side);
            let at = |i: i32| (f64::from(i) + 0.5) * cell_m - far_m;
            let column = |x: i32, y: i32| {
                puff.optical_depth(puff.centre + DVec3::new(at(x), at(y), 9.0), DVec3::NEG_Z, 20.0) * cell_m * cell_m
            };
            let covered: f64 = (0..side).flat_map(|y| (0..side).map(move |x| column(x, y))).sum();
            assert!((covered / 0.7 - 1.0).abs() < 1e-3, "{covered}");
        }
    }
}
