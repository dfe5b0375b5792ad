//! Puffs of droplets behind vehicles, which scatter light as fog does.
//!
//! What is seen straight or through panes is seen through them; mirrors show none, and they cast no shadow.

use glam::Vec3;
use trove_model::Puff;

/// Halvings of the way through puffs, in which a droplet is looked for.
const HALVINGS: u32 = 24;

/// All spray of a scene.
pub(crate) struct Spray {
    plumes: Vec<Plume>,
}

/// What one vehicle throws up.
struct Plume {
    /// Box around its puffs, World.
    low: Vec3,
    high: Vec3,
    puffs: Vec<Puff>,
}

impl Spray {
    pub(crate) fn new(spray: &[Vec<Puff>]) -> Self {
        let plume = |puffs: &Vec<Puff>| {
            let (mut low, mut high) = (Vec3::MAX, Vec3::MIN);
            for Puff { centre, radius_m: [across_m, up_m], .. } in puffs {
                let half = Vec3::new(*across_m as f32, *across_m as f32, *up_m as f32);
                (low, high) = (low.min(centre.as_vec3() - half), high.max(centre.as_vec3() + half));
            }
            Plume { low, high, puffs: puffs.clone() }
        };
        Self { plumes: spray.iter().filter(|puffs| !puffs.is_empty()).map(plume).collect() }
    }

    pub(crate) fn is_none(&self) -> bool {
        self.plumes.is_empty()
    }

    /// The puffs through which a ray goes.
    fn on(&self, origin: Vec3, direction: Vec3, t_max: f32) -> Vec<&Puff> {
        let plumes = self.plumes.iter().filter(|plume| plume.is_on(origin, direction, t_max));
        let is_met = |puff: &&Puff| puff.optical_depth(origin.as_dvec3(), direction.as_dvec3(), f64::from(t_max)) > 0.0;
        plumes.flat_map(|plume| &plume.puffs).filter(is_met).collect()
    }

    /// Share of light that passes along a unit direction for `t` metres.
    pub(crate) fn transmittance(&self, origin: Vec3, direction: Vec3, t: f32) -> f32 {
        (-depth(&self.on(origin, direction, t), origin, direction, t)).exp()
    }

    /// Where within `t_max` metres a ray meets a droplet, by a number drawn from 0 to 1; `None` where it meets none.
    pub(crate) fn met(&self, origin: Vec3, direction: Vec3, t_max: f32, u: f32) -> Option<f32> {
        let puffs = self.on(origin, direction, t_max);
        let wanted = -(-u).ln_1p();
        if depth(&puffs, origin, direction, t_max) <= wanted {
            return None;
        }
        // What a ray without an end passes lies before its farthest puff's end.
        let reach =
            |puff: &&Puff| puff.centre.as_vec3().distance(origin) + puff.radius_m[0].max(puff.radius_m[1]) as f32;
        let (mut near, mut far) = (0.0, puffs.iter().map(reach).fold(0.0, f32::max).min(t_max));
        for _ in 0..HALVINGS {
            let middle = 0.5 * (near + far);
            if depth(&puffs, origin, direction, middle) > wanted { far = middle } else { near = middle }
        }
        Some(far)
    }

    /// What a metre takes at a place in World.
    pub(crate) fn extinction_at(&self, place: Vec3) -> f32 {
        self.plumes.iter().flat_map(|plume| &plume.puffs).map(|puff| puff.extinction_at(place.as_dvec3())).sum::<f64>()
            as f32
    }
}

impl Plume {
    /// Whether a ray goes through its box.
    fn is_on(&self, origin: Vec3, direction: Vec3, t_max: f32) -> bool {
        let [a, b] = [self.low, self.high].map(|side| (side - origin) / direction);
        a.min(b).max_element().max(0.0) <= a.max(b).min_element().min(t_max)
    }
}

/// Exponent of what puffs take on the first metres of a ray.
fn depth(puffs: &[&Puff], origin: Vec3, direction: Vec3, t: f32) -> f32 {
    let (origin, direction, t) = (origin.as_dvec3(), direction.as_dvec3(), f64::from(t));
    puffs.iter().map(|puff| puff.optical_depth(origin, direction, t)).sum::<f64>() as f32
}

#[cfg(test)]
mod tests {
    use glam::DVec3;

    use super::*;

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
        let (spray, origin) = (spray(), Vec3::new(0.0, 0.2, 0.9));
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
