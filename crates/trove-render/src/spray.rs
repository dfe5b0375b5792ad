//! Puffs of droplets behind vehicles as `trove_trace` reads them.

use glam::Vec3;
use trove_trace::{Plume, Puff};

/// All spray of a scene.
pub(crate) struct Spray {
    plumes: Vec<Plume>,
    puffs: Vec<Puff>,
}

impl Spray {
    pub(crate) fn new(spray: &[Vec<trove_model::Puff>]) -> Self {
        let (mut plumes, mut puffs) = (Vec::new(), Vec::new());
        for plume in spray.iter().filter(|plume| !plume.is_empty()) {
            let (mut low, mut high, first) = (Vec3::MAX, Vec3::MIN, puffs.len());
            for trove_model::Puff { centre, radius_m: [across_m, up_m], extinction_per_m } in plume {
                let (centre, half) = (centre.as_vec3(), Vec3::new(*across_m as f32, *across_m as f32, *up_m as f32));
                (low, high) = (low.min(centre - half), high.max(centre + half));
                puffs.push(Puff { centre, per_radius: half.recip(), extinction_per_m: *extinction_per_m as f32 });
            }
            plumes.push(Plume { low, high, first: first as u32, count: plume.len() as u32 });
        }
        Self { plumes, puffs }
    }

    /// To be read.
    pub(crate) fn view(&self) -> trove_trace::Spray<'_> {
        trove_trace::Spray { plumes: &self.plumes, puffs: &self.puffs }
    }
}

#[cfg(test)]
mod tests {
    use glam::DVec3;
    use trove_model::Puff;

    use super::Spray;
    use super::Vec3;

    fn spray() -> Spray {
        let puff = |x_m: f64, extinction_per_m: f64| Puff {
            centre: DVec3::new(x_m, 0.0, 1.0),
            radius_m: [1.5, 1.0],
            extinction_per_m,
        };
        Spray::new(&[vec![puff(5.0, 0.2), puff(6.0, 0.4)], vec![puff(20.0, 0.1)]])
    }

    #[test]
    fn rays_meet_droplets_where_there_are_any_as_often_as_light_is_lost() {
        let (all, origin) = (spray(), Vec3::new(0.0, 0.2, 0.9));
        let spray = all.view();
        for t_max in [5.5, f32::INFINITY] {
            let n = 20_000;
            let found: Vec<f32> =
                (0..n).filter_map(|i| spray.met(origin, Vec3::X, t_max, (i as f32 + 0.5) / n as f32)).collect();
            let lost = 1.0 - spray.transmittance(origin, Vec3::X, t_max);
            assert!((found.len() as f32 / n as f32 - lost).abs() < 1e-3, "{} {lost}", found.len());
            for until in [4.5f32, 5.2, 6.5, 19.0, 21.0] {
                let before = found.iter().filter(|t| **t < until).count() as f32 / n as f32;
                let lost = 1.0 - spray.transmittance(origin, Vec3::X, until.min(t_max));
                assert!((before - lost).abs() < 1e-3, "{until}: {before} {lost}");
            }
            assert!(found.iter().all(|t| spray.extinction_at(origin + Vec3::X * *t) > 0.0));
        }
        assert_eq!(spray.transmittance(origin, Vec3::Y, 100.0), 1.0);
        assert_eq!(spray.met(origin, Vec3::X, 3.0, 0.999), None);
    }
}
