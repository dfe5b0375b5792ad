//! How lawns look from place to place: lush and dry by patches, and bare where people walk.

use glam::{DVec2, Vec3, vec3};
use rayon::prelude::*;
use trove_model::{Mesh, Polygon, Seed};

use super::drape::Drape;
use super::noise::noise;
use crate::place::Conditions;

/// What dried grass and bare earth are to fresh grass: factors on its colour.
const DRY: Vec3 = vec3(1.3, 1.1, 1.2);
const BARE: Vec3 = vec3(1.5, 1.0, 1.5);

/// The look of a place's lawns.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Lawn {
    seed: Seed,
    dryness: f64,
}

impl Lawn {
    /// As climate and season have it.
    pub(crate) fn new(conditions: Conditions, seed: Seed) -> Self {
        Self { seed, dryness: conditions.dryness() }
    }

    /// 0 lush to 1 straw.
    pub(crate) fn dryness(&self, p: DVec2) -> f64 {
        let at = |name: &str, feature_m: f64| noise(self.seed.child(name), p, feature_m) - 0.5;
        (self.dryness + 0.5 * at("broad", 33.0) + 0.5 * at("patch", 8.0) + 0.35 * at("spot", 2.2)).clamp(0.0, 1.0)
    }

    /// 0 grown over to 1 bare earth; more where it is dry.
    pub(crate) fn bareness(&self, p: DVec2) -> f64 {
        let at = |name: &str, feature_m: f64| noise(self.seed.child(name), p, feature_m);
        let worn = 0.65 * at("worn", 9.0) + 0.35 * at("worn spot", 2.5) + 0.22 * (self.dryness(p) - 0.5);
        ((worn - 0.6) / 0.15).clamp(0.0, 1.0)
    }

    /// What the colour of grass is multiplied by.
    fn tint(&self, p: DVec2) -> Vec3 {
        let green = Vec3::splat(0.85).lerp(DRY, self.dryness(p) as f32);
        green.lerp(BARE, self.bareness(p) as f32)
    }

    /// The surface of lawns, `lift_m` above the ground, in the colours that they have from place to place; texture
    /// coordinates are World's x and y in metres.
    pub(crate) fn surface(&self, drape: &Drape<'_>, area: &[Polygon], lift_m: f64) -> Mesh {
        let mut mesh = drape.raised_in_cells(area, lift_m);
        self.color(&mut mesh);
        mesh
    }

    /// Colours a mesh of grass.
    pub(crate) fn color(&self, mesh: &mut Mesh) {
        mesh.tints = mesh.positions.par_iter().map(|p| self.tint(p.truncate().as_dvec2())).collect();
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::plane;
    use trove_model::{Bounds, HeightField, Raster};

    #[test]
    fn a_lawn_is_greener_here_and_drier_there_and_its_mesh_carries_that_on_flat_ground_too() {
        let lawn = Lawn::new(crate::testing::conditions(), Seed(3));
        let bounds = Bounds::square(DVec2::ZERO, 90.0);
        let field = HeightField { origin: bounds.min, cell_m: 3.0, nodes: Raster::filled(31, 31, 1.0) };
        let mesh = lawn.surface(&Drape::new(&field), &[plane::rectangle(bounds)], 0.12);
        assert_eq!(mesh.defect(), None);
        assert!(mesh.positions.iter().all(|p| (p.z - 1.12).abs() < 1e-5));
        let hue = |t: &Vec3| t.x / t.y;
        let (least, most) = mesh.tints.iter().map(hue).fold((f32::INFINITY, 0.0f32), |(l, m), h| (l.min(h), m.max(h)));
        assert!(mesh.tints.len() > 800 && most / least > 1.1, "{least} {most}");
        assert!(mesh.tints.iter().all(|t| t.cmpgt(Vec3::splat(0.5)).all() && t.cmplt(Vec3::splat(2.6)).all()));
    }
}
