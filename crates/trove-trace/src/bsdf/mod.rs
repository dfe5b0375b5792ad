//! One principled surface, from above: lacquer or water, fibres, facets of metal or of a dielectric, and below them what
//! scatters, transmits or lets light through.
//!
//! Every layer gets what those above leave of the light, by their reflectance for the outgoing direction alone: energy
//! is kept to within some percent, and the sum is not quite reciprocal though each lobe is.

mod diffuse;
pub mod ggx;
mod lobes;
mod sheen;

use core::f32::consts::PI;

use glam::Vec3;

use crate::math::{unit, unit_or};
use crate::sampling::{Basis, cosine_hemisphere, cosine_pdf};
use diffuse::Diffuse;
use ggx::Facet;

pub use lobes::{Lobes, reflected};

/// Facets from this GGX α on are matt.
const MATT_ALPHA: f32 = 0.3;

/// A smooth layer on top of everything.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
pub struct Coat {
    /// Shading normal on the side of the eye; what is below may be rougher.
    pub normal: Vec3,
    /// Share of the surface that has it.
    pub share: f32,
    /// GGX α.
    pub alpha: f32,
    /// Normal reflectance.
    pub f0: f32,
}

/// A material at a point; shares are from 0 to 1.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
pub struct Parameters {
    /// Reflectance of metal, and of what scatters in the body.
    pub base_color: Vec3,
    /// GGX α.
    pub alpha: f32,
    /// Of the diffuse lobe, 0 (Lambert) to 1.
    pub diffuse_roughness: f32,
    /// Share of the surface that is bare metal.
    pub metalness: f32,
    /// Normal reflectance of the dielectric.
    pub f0: f32,
    /// What lies on top.
    pub coat: Coat,
    /// Colour of the fibres, black for none.
    pub sheen: Vec3,
    /// Share of what scatters that does so deep inside.
    pub subsurface: f32,
    /// Share of it that comes out on the other side.
    pub translucency: f32,
    /// Share of what enters that goes straight through.
    pub transmission: f32,
    /// Colour of what goes straight through.
    pub tint: Vec3,
}

/// How light scatters at a point, for one outgoing direction.
#[derive(Clone, Copy)]
#[repr(C)]
pub struct Bsdf {
    normal: Vec3,
    geometric: Vec3,
    wo: Vec3,
    cos_o: f32,
    alpha: f32,
    f0: Vec3,
    /// Light that single reflection loses between facets, given back (Turquin 2019), times what the layers above leave.
    gain: Vec3,
    coat: Coat,
    coat_cos_o: f32,
    sheen: Vec3,
    diffuse: Diffuse,
    /// Diffuse light on the other side.
    behind: Vec3,
    translucency: f32,
    through: Vec3,
    /// Chances of the lobes: coat, facets, fibres and diffuse; the rest is straight through.
    chances: [f32; 3],
    /// For the denoiser: all that it reflects of white light.
    pub albedo: Vec3,
    /// Whether what is seen in it, rather than itself, is what the eye sees.
    pub is_mirror: bool,
    /// Whether directions that lie `MATT_ALPHA` apart are much the same to it.
    pub is_matt: bool,
}

/// A direction drawn.
pub struct BsdfSample {
    /// Unit, World.
    pub wi: Vec3,
    /// BSDF · cos / density.
    pub weight: Vec3,
    /// Density over solid angle; `None`: straight through.
    pub pdf: Option<f32>,
    /// The cone of directions it stands for, radians.
    pub spread_rad: f32,
}

impl Bsdf {
    /// Seen along `wo` from the side of the unit vector `geometric`, which stands upright on the surface; `normal` is the
    /// shading normal on that side.
    #[inline]
    pub fn new(lobes: &Lobes, wo: Vec3, geometric: Vec3, normal: Vec3, p: &Parameters) -> Self {
        // Taken apart whole: a new layer does not compile until it has its share of the light.
        let Parameters {
            base_color,
            alpha,
            diffuse_roughness,
            metalness,
            f0: dielectric_f0,
            coat,
            sheen: fibres,
            subsurface,
            translucency,
            transmission,
            tint,
        } = p;
        let normal = upright(normal, geometric, wo);
        let cos_o = wo.dot(normal).max(1e-4);

        let (mut coat, mut coat_cos_o, mut coated) = (*coat, cos_o, 0.0);
        if coat.share > 0.0 {
            coat.normal = upright(coat.normal, geometric, wo);
            coat_cos_o = wo.dot(coat.normal).max(1e-4);
            let split = lobes.split(coat_cos_o, coat.alpha);
            coated = coat.share * reflected(Vec3::splat(coat.f0), split).x;
        }
        let mut left = 1.0 - coated;

        let (mut sheen, mut fuzzed) = (Vec3::ZERO, Vec3::ZERO);
        if *fibres != Vec3::ZERO {
            sheen = *fibres * left;
            fuzzed = sheen * lobes.of_fibres(cos_o);
            left -= fuzzed.max_element();
        }

        let f0 = Vec3::splat(*dielectric_f0).lerp(*base_color, *metalness);
        let split = lobes.split(cos_o, *alpha);
        let single = split.x + split.y;
        let lost = (1.0 - single) / single.max(1e-3);
        let whole = |f0: Vec3| reflected(f0, split) * (Vec3::ONE + f0 * lost);
        let dielectric = whole(Vec3::splat(*dielectric_f0)).min(Vec3::ONE);
        let facets = dielectric.lerp(whole(*base_color).min(Vec3::ONE), *metalness);
        let gain = facets / reflected(f0, split).max(Vec3::splat(1e-6));

        // Only the share that is no metal lets light in, and only past its own facets.
        let inside = (1.0 - dielectric.x) * (1.0 - metalness) * left;
        let scattered = inside * (1.0 - transmission);
        let diffuse = base_color * scattered;
        let through = tint * (inside * transmission);
        let here = scattered * (1.0 - translucency);

        let weights = [coated, mean(facets) * left, mean(diffuse + fuzzed), mean(through)];
        let sum: f32 = weights.iter().sum::<f32>().max(1e-6);
        Self {
            normal,
            geometric,
            wo,
            cos_o,
            alpha: *alpha,
            f0,
            gain: gain * left,
            coat,
            coat_cos_o,
            sheen,
            diffuse: Diffuse::new(*base_color, here, *diffuse_roughness, *subsurface, cos_o),
            behind: diffuse * *translucency,
            translucency: *translucency,
            through,
            chances: [weights[0] / sum, weights[1] / sum, weights[2] / sum],
            albedo: Vec3::splat(coated) + fuzzed + facets * left + diffuse,
            is_matt: coated == 0.0 && weights[3] == 0.0 && *alpha >= MATT_ALPHA,
            is_mirror: weights[3] > 0.5 * sum || (*alpha < 0.02 && weights[1] > 0.7 * sum),
        }
    }

    /// BSDF · cos θi and the density with which [`Self::sample`] draws `wi`.
    #[inline]
    pub fn eval(&self, wi: Vec3) -> (Vec3, f32) {
        let cos_i = wi.dot(self.normal);
        let outside = wi.dot(self.geometric) > 0.0;
        let [p_coat, p_facets, p_diffuse] = self.chances;
        let pdf_diffuse = p_diffuse * cosine_pdf(cos_i.abs());
        if !outside {
            // Light that comes from behind reaches the eye only through the leaf.
            return if cos_i < 0.0 {
                (self.behind * (-cos_i / PI), pdf_diffuse * self.translucency)
            } else {
                (Vec3::ZERO, 0.0)
            };
        }
        let h = unit_or(wi + self.wo, self.normal);
        let cos_h = wi.dot(h);
        let (mut f, mut pdf) = (Vec3::ZERO, 0.0);
        if cos_i > 0.0 {
            let facet = Facet::new(h, self.normal);
            f = self.diffuse.eval(cos_i, wi.dot(self.wo)) * (cos_i / PI);
            pdf = pdf_diffuse * (1.0 - self.translucency);
            if self.sheen != Vec3::ZERO {
                f += self.sheen * sheen::eval(self.cos_o, cos_i, facet);
            }
            if p_facets > 0.0 {
                let (g, density) = ggx::eval(self.cos_o, cos_i, facet, self.alpha);
                f += ggx::schlick(self.f0, cos_h) * self.gain * g;
                pdf += p_facets * density;
            }
        }
        if p_coat > 0.0 {
            let cos_i = wi.dot(self.coat.normal);
            if cos_i > 0.0 {
                let facet = Facet::new(h, self.coat.normal);
                let (g, density) = ggx::eval(self.coat_cos_o, cos_i, facet, self.coat.alpha);
                f += ggx::schlick(Vec3::splat(self.coat.f0), cos_h) * (g * self.coat.share);
                pdf += p_coat * density;
            }
        }
        (f, pdf)
    }

    /// Draws a direction: the lobe with the first number, the direction with the others.
    #[inline]
    pub fn sample(&self, u: [f32; 3]) -> Option<BsdfSample> {
        let [p_coat, p_facets, p_diffuse] = self.chances;
        let [choice, u0, u1] = u;
        let scattered = p_coat + p_facets + p_diffuse;
        if choice >= scattered {
            let chance = 1.0 - scattered;
            return (chance > 1e-6 && self.through != Vec3::ZERO).then(|| BsdfSample {
                wi: -self.wo,
                weight: self.through / chance,
                pdf: None,
                spread_rad: 0.0,
            });
        }
        let mirrored = |normal: Vec3, cos_o: f32, alpha: f32| {
            let basis = Basis::about(normal);
            let wo = basis.to_local(self.wo).with_z(cos_o);
            basis.to_world(ggx::sample(wo, alpha, [u0, u1]))
        };
        let is_diffuse = choice >= p_coat + p_facets;
        let (wi, spread_rad) = if choice < p_coat {
            (mirrored(self.coat.normal, self.coat_cos_o, self.coat.alpha), self.coat.alpha)
        } else if !is_diffuse {
            (mirrored(self.normal, self.cos_o, self.alpha), self.alpha)
        } else {
            let wi = Basis::about(self.normal).to_world(cosine_hemisphere([u0, u1]));
            let share = (choice - p_coat - p_facets) / p_diffuse;
            (if share < self.translucency { -wi } else { wi }, 0.5)
        };
        let wi = unit(wi);
        // A facet may mirror light into the surface, where it is lost; it never comes out behind.
        if !is_diffuse && wi.dot(self.geometric) <= 0.0 {
            return None;
        }
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
    let lifted = unit_or(mirrored + geometric * (LEAST - height).max(0.0), geometric);
    unit_or(wo + lifted, geometric)
}

#[cfg(test)]
mod tests;
