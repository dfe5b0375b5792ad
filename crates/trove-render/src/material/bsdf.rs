//! One principled surface: lacquer over metal or over a dielectric that scatters, transmits or lets light through.

use std::f32::consts::PI;

use glam::Vec3;

use super::{albedo, ggx};
use crate::prepare::Surface;
use crate::sampling::{Basis, cosine_hemisphere, cosine_pdf};

/// Roughness α and normal reflectance of lacquer.
const COAT_ALPHA: f32 = 0.003;
const COAT_F0: f32 = 0.04;

/// A material at a point.
pub(crate) struct Parameters {
    pub(crate) base_color: Vec3,
    /// GGX α.
    pub(crate) alpha: f32,
    pub(crate) metalness: f32,
    /// Normal reflectance of the dielectric.
    pub(crate) f0: f32,
    pub(crate) coat: f32,
    pub(crate) translucency: f32,
    pub(crate) transmission: f32,
    /// Colour of what goes straight through.
    pub(crate) tint: Vec3,
}

/// How light scatters at a point, for one outgoing direction.
pub(crate) struct Bsdf {
    basis: Basis,
    geometric: Vec3,
    wo: Vec3,
    alpha: f32,
    f0: Vec3,
    /// Light that single reflection loses between facets, given back (Turquin 2019).
    gain: Vec3,
    coat: f32,
    /// What the lacquer leaves for the rest.
    under_coat: f32,
    diffuse: Vec3,
    translucency: f32,
    through: Vec3,
    /// Chances of the lobes: lacquer, facets, diffuse; the rest is straight through.
    chances: [f32; 3],
    /// For the denoiser: all that it reflects of white light.
    pub(crate) albedo: Vec3,
    /// Whether what is seen in it, rather than itself, is what the eye sees.
    pub(crate) is_mirror: bool,
}

/// A direction drawn.
pub(crate) struct BsdfSample {
    /// Unit, World.
    pub(crate) wi: Vec3,
    /// BSDF · cos / density.
    pub(crate) weight: Vec3,
    /// Density over solid angle; `None`: straight through.
    pub(crate) pdf: Option<f32>,
    /// The cone of directions it stands for, radians.
    pub(crate) spread_rad: f32,
}

impl Bsdf {
    /// `normal` is the shading normal on the side of `surface.wo`.
    pub(crate) fn new(surface: &Surface, normal: Vec3, p: &Parameters) -> Self {
        let normal = upright(normal, surface.geometric, surface.wo);
        let basis = Basis::about(normal);
        let wo = basis.to_local(surface.wo);
        let cos = wo.z.max(1e-4);
        let wo = Vec3::new(wo.x, wo.y, cos);

        let coat = if p.coat > 0.0 {
            let split = albedo::split(cos, COAT_ALPHA);
            p.coat * (COAT_F0 * split.x + split.y)
        } else {
            0.0
        };
        let under_coat = 1.0 - coat;

        let f0 = Vec3::splat(p.f0).lerp(p.base_color, p.metalness);
        let split = albedo::split(cos, p.alpha);
        let single = split.x + split.y;
        let gain = Vec3::ONE + f0 * ((1.0 - single) / single.max(1e-3));
        let facets = ((f0 * split.x + split.y) * gain).min(Vec3::ONE);

        let inside = (Vec3::ONE - facets) * (1.0 - p.metalness);
        let diffuse = p.base_color * inside * (1.0 - p.transmission);
        let through = p.tint * inside * p.transmission * under_coat;

        let weights = [coat, mean(facets) * under_coat, mean(diffuse) * under_coat, mean(through)];
        let sum: f32 = weights.iter().sum::<f32>().max(1e-6);
        Self {
            basis,
            geometric: surface.geometric,
            wo,
            alpha: p.alpha,
            f0,
            gain,
            coat: p.coat,
            under_coat,
            diffuse,
            translucency: p.translucency,
            through,
            chances: [weights[0] / sum, weights[1] / sum, weights[2] / sum],
            albedo: Vec3::splat(coat) + (facets + diffuse) * under_coat,
            is_mirror: weights[3] > 0.5 * sum || (p.alpha < 0.02 && weights[1] > 0.7 * sum),
        }
    }

    /// BSDF · cos θi and the density with which [`Self::sample`] draws `wi`.
    pub(crate) fn eval(&self, wi_world: Vec3) -> (Vec3, f32) {
        let wi = self.basis.to_local(wi_world);
        let outside = wi_world.dot(self.geometric) > 0.0;
        let [p_coat, p_facets, p_diffuse] = self.chances;
        let lambert = self.diffuse * (self.under_coat * wi.z.abs() / PI);
        let pdf_diffuse = p_diffuse * cosine_pdf(wi.z.abs());
        if !outside || wi.z <= 0.0 {
            // Light that comes from behind reaches the eye only through the leaf.
            return if !outside && wi.z < 0.0 {
                (lambert * self.translucency, pdf_diffuse * self.translucency)
            } else {
                (Vec3::ZERO, 0.0)
            };
        }
        let mut f = lambert * (1.0 - self.translucency);
        let mut pdf = pdf_diffuse * (1.0 - self.translucency);
        let cos_h = wi.dot((wi + self.wo).normalize_or(Vec3::Z));
        if p_facets > 0.0 {
            let (g, density) = ggx::eval(self.wo, wi, self.alpha);
            f += ggx::schlick(self.f0, cos_h) * self.gain * (g * self.under_coat);
            pdf += p_facets * density;
        }
        if p_coat > 0.0 {
            let (g, density) = ggx::eval(self.wo, wi, COAT_ALPHA);
            f += ggx::schlick(Vec3::splat(COAT_F0), cos_h) * (g * self.coat);
            pdf += p_coat * density;
        }
        (f, pdf)
    }

    /// Draws a direction: the lobe with the first number, the direction with the others.
    pub(crate) fn sample(&self, u: [f32; 3]) -> Option<BsdfSample> {
        let [p_coat, p_facets, p_diffuse] = self.chances;
        let [choice, u0, u1] = u;
        let scattered = p_coat + p_facets + p_diffuse;
        if choice >= scattered {
            let chance = 1.0 - scattered;
            let wi = -self.basis.to_world(self.wo);
            return (chance > 1e-6 && self.through != Vec3::ZERO).then(|| BsdfSample {
                wi: wi.normalize(),
                weight: self.through / chance,
                pdf: None,
                spread_rad: 0.0,
            });
        }
        let (wi, spread_rad) = if choice < p_coat {
            (ggx::sample(self.wo, COAT_ALPHA, [u0, u1]), COAT_ALPHA)
        } else if choice < p_coat + p_facets {
            (ggx::sample(self.wo, self.alpha, [u0, u1]), self.alpha)
        } else {
            let wi = cosine_hemisphere([u0, u1]);
            let share = (choice - p_coat - p_facets) / p_diffuse;
            (if share < self.translucency { -wi } else { wi }, 0.5)
        };
        let wi = self.basis.to_world(wi).normalize();
        let (f, pdf) = self.eval(wi);
        (pdf > 0.0 && f != Vec3::ZERO).then(|| BsdfSample { wi, weight: f / pdf, pdf: Some(pdf), spread_rad })
    }
}

fn mean(color: Vec3) -> f32 {
    color.element_sum() / 3.0
}

/// The normal bent so far towards the eye that neither the eye nor its mirror image lies below the true surface
/// (after Keller et al. 2017, section A.3): no black edges.
fn upright(normal: Vec3, geometric: Vec3, wo: Vec3) -> Vec3 {
    const LEAST: f32 = 0.01;
    let mirrored = 2.0 * normal.dot(wo) * normal - wo;
    let height = mirrored.dot(geometric);
    if height >= LEAST && normal.dot(wo) > LEAST {
        return normal;
    }
    let lifted = (mirrored + geometric * (LEAST - height).max(0.0)).normalize_or(geometric);
    (wo + lifted).normalize_or(geometric)
}

#[cfg(test)]
mod tests {
    use glam::Vec2;
    use trove_model::Seed;

    use super::*;

    /// A surface that faces up, seen from an angle with cosine `cos`.
    fn bsdf(cos: f32, p: &Parameters) -> Bsdf {
        let surface = Surface {
            point: Vec3::ZERO,
            wo: Vec3::new((1.0 - cos * cos).sqrt(), 0.0, cos),
            geometric: Vec3::Z,
            shading: Vec3::Z,
            is_front: true,
            uv: Vec2::ZERO,
            uv_axes: None,
        };
        Bsdf::new(&surface, Vec3::Z, p)
    }

    fn white(alpha: f32) -> Parameters {
        Parameters {
            base_color: Vec3::ONE,
            alpha,
            metalness: 0.0,
            f0: 0.04,
            coat: 0.0,
            translucency: 0.0,
            transmission: 0.0,
            tint: Vec3::ONE,
        }
    }

    fn all_sorts() -> Vec<Parameters> {
        let mut all = Vec::new();
        for alpha in [ggx::ALPHA_MIN, 0.01, 0.1, 0.4, 1.0] {
            all.push(white(alpha));
            all.push(Parameters { metalness: 1.0, ..white(alpha) });
            all.push(Parameters { coat: 1.0, ..white(alpha) });
            all.push(Parameters { translucency: 0.5, ..white(alpha) });
            all.push(Parameters { transmission: 1.0, f0: 0.077, ..white(alpha) });
        }
        all
    }

    #[test]
    fn white_surfaces_give_back_what_they_get() {
        let n = 64;
        for p in all_sorts() {
            for cos in [0.2, 0.5, 0.9, 1.0] {
                let bsdf = bsdf(cos, &p);
                let mut random = Seed(1).random();
                let mut sum = 0.0;
                for k in 0..n * n {
                    let u =
                        [random.unit() as f32, ((k % n) as f32 + 0.5) / n as f32, ((k / n) as f32 + 0.5) / n as f32];
                    sum += bsdf.sample(u).map_or(0.0, |s| s.weight.x);
                }
                let albedo = sum / (n * n) as f32;
                assert!((0.93..1.02).contains(&albedo), "{albedo} at {cos} of α {} coat {}", p.alpha, p.coat);
            }
        }
    }

    #[test]
    fn directions_are_drawn_with_the_density_that_is_claimed() {
        let bsdf = bsdf(0.7, &Parameters { translucency: 0.3, ..white(0.3) });
        let (side, draws) = (16usize, 100_000);
        let bin = |d: Vec3| {
            let azimuth = (d.y.atan2(d.x) / std::f32::consts::TAU + 0.5).clamp(0.0, 0.999_999);
            let z = (d.z * 0.5 + 0.5).clamp(0.0, 0.999_999);
            (z * side as f32) as usize * side + (azimuth * side as f32) as usize
        };
        let mut expected = vec![0.0f64; side * side];
        let (rows, columns) = (1600, 1600);
        for i in 0..rows * columns {
            let z = ((i / columns) as f32 + 0.5) / rows as f32 * 2.0 - 1.0;
            let (y, x) = (((i % columns) as f32 + 0.5) / columns as f32 * std::f32::consts::TAU).sin_cos();
            let r = (1.0 - z * z).sqrt();
            let d = Vec3::new(r * x, r * y, z);
            let solid_angle = 4.0 * std::f64::consts::PI / f64::from(rows * columns);
            expected[bin(d)] += f64::from(bsdf.eval(d).1) * solid_angle * f64::from(draws);
        }
        let mut random = Seed(2).random();
        let mut drawn = vec![0.0f64; side * side];
        for _ in 0..draws {
            let u = [random.unit() as f32, random.unit() as f32, random.unit() as f32];
            if let Some(sample) = bsdf.sample(u) {
                drawn[bin(sample.wi)] += 1.0;
            }
        }
        let bins = expected.iter().zip(&drawn).filter(|(e, _)| **e > 5.0);
        let chi2: f64 = bins.map(|(e, n)| (n - e).powi(2) / e).sum();
        assert!(chi2 < 330.5, "χ² = {chi2}"); // 99.9 % of 255 degrees of freedom
    }
}
