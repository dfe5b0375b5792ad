//! The lens of a street lamp, lit: its brightness into each direction, from candelas and from what of it is seen there.

use glam::{Vec2, Vec3};
use trove_model::{Asset, Beam, Luminaire, Material, Mesh, Role};

/// Luminance of radiance 1, candelas a square metre.
pub(crate) const UNIT_CD_M2: f32 = 32_000.0;
/// Cells across and up in which what is seen is counted.
const CELLS: usize = 40;
/// What is farther from a lens hides nothing of it, metres.
const BESIDE_M: f32 = 0.5;
/// Where less of a lens is seen than this share of the most, it is no brighter than there.
const LEAST_SEEN: f32 = 0.04;
const AZIMUTH_STEPS: usize = 37;
const ELEVATION_STEPS: usize = 73;

/// Emission into the brightest direction and shares of it of an asset's lenses, so that together they give what its luminaire
/// does; `None` where it has no lens.
pub(super) fn lit(asset: &Asset) -> Option<(Vec3, Beam)> {
    let ordinary = Luminaire::default();
    let luminaire = asset.luminaire.as_deref().unwrap_or(&ordinary);
    let lens = Lens::of(&asset.mesh, |slot| asset.slots.get(usize::from(slot)).map(|slot| &slot.material))?;
    let azimuths_deg = steps_deg(AZIMUTH_STEPS, 180.0);
    let elevations_deg = steps_deg(ELEVATION_STEPS, 90.0);
    let on_grid = |f: &dyn Fn(Vec3) -> f32| Beam::of(&azimuths_deg, &elevations_deg, f);
    let intensity = &luminaire.intensity;
    let seen_m2 = on_grid(&|toward| if intensity.share(toward) > 0.0 { lens.seen_m2(toward) } else { 0.0 })?;
    let least_m2 = LEAST_SEEN * seen_m2.most();
    if least_m2 <= 0.0 {
        return None;
    }
    let brightness = on_grid(&|toward| intensity.share(toward) / seen_m2.share(toward).max(least_m2))?;
    let most = brightness.most();
    let shares = on_grid(&|toward| brightness.share(toward) / most)?;
    // Where little or nothing of the lens is seen light is missing: the other directions get it.
    let given = on_grid(&|toward| shares.share(toward) * seen_m2.share(toward))?.flux();
    let most_cd_m2 = luminaire.lumens / given;
    most_cd_m2.is_finite().then(|| (luminaire.color() * (most_cd_m2 / UNIT_CD_M2), shares))
}

/// From `-most_deg` to `most_deg`.
fn steps_deg(count: usize, most_deg: f32) -> Vec<f32> {
    (0..count).map(|i| most_deg * (2.0 * i as f32 / (count - 1) as f32 - 1.0)).collect()
}

/// The triangles of a lens and those that may hide it.
struct Lens {
    triangles: Vec<([Vec3; 3], bool)>,
}

impl Lens {
    fn of<'a>(mesh: &Mesh, material: impl Fn(u16) -> Option<&'a Material>) -> Option<Self> {
        let is_lens = |slot: u16| material(slot).is_some_and(|m| m.role == Some(Role::StreetLamp));
        let is_clear = |slot: u16| material(slot).is_some_and(|m| m.transmission > 0.0);
        let corners = |t: usize| mesh.triangles[t].map(|i| mesh.positions[i as usize]);
        let of_lens = (0..mesh.triangles.len()).filter(|&t| is_lens(mesh.slot(t))).flat_map(corners);
        let (low, high) = of_lens.fold((Vec3::INFINITY, Vec3::NEG_INFINITY), |(l, h), p| (l.min(p), h.max(p)));
        let (low, high) = (low - BESIDE_M, high + BESIDE_M);
        let is_beside = |[a, b, c]: [Vec3; 3]| a.max(b).max(c).cmpge(low).all() && a.min(b).min(c).cmple(high).all();
        let near = (0..mesh.triangles.len()).filter(|&t| !is_clear(mesh.slot(t)) && is_beside(corners(t)));
        let triangles: Vec<_> = near.map(|t| (corners(t), is_lens(mesh.slot(t)))).collect();
        (!triangles.is_empty()).then_some(Self { triangles })
    }

    /// The area that shines into a direction as it is seen from there, without what hides it.
    fn seen_m2(&self, toward: Vec3) -> f32 {
        let (right, up) = toward.any_orthonormal_pair();
        let flat = |p: Vec3| Vec2::new(p.dot(right), p.dot(up));
        let of_lens = self.triangles.iter().filter(|(_, is_lens)| *is_lens).flat_map(|(corners, _)| corners);
        let (low, high) = of_lens
            .fold((Vec2::INFINITY, Vec2::NEG_INFINITY), |(low, high), p| (low.min(flat(*p)), high.max(flat(*p))));
        let cell = (high - low) / CELLS as f32;
        // Of each cell the nearest height, and whether it shines.
        let mut cells = [(f32::NEG_INFINITY, false); CELLS * CELLS];
        for (corners, is_lens) in &self.triangles {
            let [a, b, c] = corners.map(|p| (flat(p) - low) / cell - 0.5);
            let twice = (b - a).perp_dot(c - a);
            let (first, last) =
                (a.min(b).min(c).ceil().max(Vec2::ZERO), a.max(b).max(c).min(Vec2::splat(CELLS as f32 - 1.0)));
            if twice == 0.0 || !(first.is_finite() && last.is_finite()) {
                continue;
            }
            let heights = corners.map(|p| p.dot(toward));
            for y in first.y as usize..(last.y + 1.0).max(0.0) as usize {
                for x in first.x as usize..(last.x + 1.0).max(0.0) as usize {
                    let p = Vec2::new(x as f32, y as f32);
                    let weights =
                        [(b - p).perp_dot(c - p), (c - p).perp_dot(a - p), (a - p).perp_dot(b - p)].map(|w| w / twice);
                    if weights.iter().any(|w| *w < 0.0) {
                        continue;
                    }
                    let height: f32 = weights.iter().zip(heights).map(|(w, h)| w * h).sum();
                    let nearest = &mut cells[y * CELLS + x];
                    if height > nearest.0 {
                        // Its front alone shines.
                        *nearest = (height, *is_lens && twice > 0.0);
                    }
                }
            }
        }
        cells.iter().filter(|(_, shines)| *shines).count() as f32 * cell.element_product()
    }
}

#[cfg(test)]
mod tests {
    use std::f32::consts::{PI, TAU};
    use std::sync::Arc;

    use trove_model::{Kind, Slot};

    use super::*;
    use trove_model::luminance;

    /// A square that looks down from a height, and one of twice its side above it, which is no lens.
    fn lamp(side_m: f32, luminaire: Option<Luminaire>) -> Asset {
        let square = |side_m: f32, z: f32| {
            let half = side_m / 2.0;
            [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]].map(|[x, y]| Vec3::new(x * half, y * half, z))
        };
        let mesh = Mesh {
            positions: [square(side_m, 8.0), square(2.0 * side_m, 8.01)].concat(),
            triangles: vec![[0, 2, 1], [0, 3, 2], [4, 5, 6], [4, 6, 7]],
            slots: vec![0, 0, 1, 1],
            ..Mesh::default()
        };
        let lens = Material { role: Some(Role::StreetLamp), ..Material::default() };
        let slots = [lens, Material::default()].map(|material| Slot::new(material, Vec::new()));
        let asset = Asset::new("lamp/a", Kind::StreetLamp, Kind::StreetLamp.class(), mesh, slots.to_vec(), "test");
        Asset { luminaire: luminaire.map(Arc::new), ..asset }
    }

    /// Brightest at 60° along y, a fifth of that across, and nothing above 85° from the nadir.
    fn oval() -> Luminaire {
        let intensity = |toward: Vec3| {
            let gamma = (-toward.z).acos().to_degrees();
            let lobe = (-((gamma - 60.0) / 20.0).powi(2)).exp();
            let around = toward.truncate().normalize_or_zero();
            if gamma > 85.0 { 0.0 } else { 0.5 + lobe * (0.5 + 2.0 * around.y * around.y) }
        };
        let intensity = Beam::of(&steps_deg(73, 180.0), &steps_deg(145, 90.0), intensity).unwrap();
        Luminaire { intensity, lumens: 8000.0, kelvin: 4000.0 }
    }

    /// Candelas that a flat lens gives into an angle from the nadir and one from +x, by its emission.
    fn candelas(side_m: f32, (emission, beam): &(Vec3, Beam), gamma: f32, azimuth: f32) -> f32 {
        let toward = Vec3::new(azimuth.cos() * gamma.sin(), azimuth.sin() * gamma.sin(), -gamma.cos());
        let luminance_cd_m2 = luminance(*emission) * UNIT_CD_M2;
        luminance_cd_m2 * beam.share(toward) * side_m * side_m * gamma.cos()
    }

    #[test]
    fn a_lens_of_any_size_gives_its_lumens_as_its_table_says() {
        for (side_m, luminaire) in [(0.2, Some(oval())), (0.7, Some(oval())), (0.3, None)] {
            let expected = luminaire.clone().unwrap_or_default();
            let lit = lit(&lamp(side_m, luminaire)).unwrap();
            let (rows, columns) = (900, 180);
            let mut lumens = 0.0;
            for gamma in (0..rows).map(|row| (row as f32 + 0.5) / rows as f32 * PI / 2.0) {
                for azimuth in (0..columns).map(|column| (column as f32 + 0.5) / columns as f32 * TAU) {
                    let solid_angle_sr = gamma.sin() * (PI / 2.0 / rows as f32) * (TAU / columns as f32);
                    lumens += candelas(side_m, &lit, gamma, azimuth) * solid_angle_sr;
                }
            }
            assert!((lumens / expected.lumens - 1.0).abs() < 0.01, "{side_m} m: {lumens} lm");
            for (gamma_deg, azimuth_deg) in [(0.0f32, 0.0f32), (30.0, 90.0), (60.0, 90.0), (60.0, 0.0), (75.0, 45.0)] {
                let (gamma, azimuth) = (gamma_deg.to_radians(), azimuth_deg.to_radians());
                let toward = Vec3::new(azimuth.cos() * gamma.sin(), azimuth.sin() * gamma.sin(), -gamma.cos());
                let wanted = expected.intensity.share(toward) * expected.lumens / expected.intensity.flux();
                let found = candelas(side_m, &lit, gamma, azimuth);
                assert!((found / wanted - 1.0).abs() < 0.03, "{gamma_deg}°, {azimuth_deg}°: {found} {wanted}");
            }
        }
    }

    #[test]
    fn what_is_hidden_of_a_lens_is_not_seen() {
        let asset = lamp(0.4, None);
        let lens = Lens::of(&asset.mesh, |slot| Some(&asset.slots[usize::from(slot)].material)).unwrap();
        assert!((lens.seen_m2(Vec3::NEG_Z) / 0.16 - 1.0).abs() < 0.01, "{}", lens.seen_m2(Vec3::NEG_Z));
        let slanted = Vec3::new(0.0, 0.8, -0.6);
        assert!((lens.seen_m2(slanted) / 0.096 - 1.0).abs() < 0.03, "{}", lens.seen_m2(slanted));
        assert_eq!(lens.seen_m2(Vec3::Z), 0.0);
        // A skirt beside it that reaches as far down as the lens is wide hides half of it at a slope of a half.
        let mut skirted = (*asset.mesh).clone();
        let first = skirted.positions.len() as u32;
        let corner = |y: f32, z: f32| Vec3::new(0.2, y, z);
        skirted.positions.extend([corner(-3.0, 8.0), corner(3.0, 8.0), corner(3.0, 7.9), corner(-3.0, 7.9)]);
        skirted.triangles.extend([[first, first + 1, first + 2], [first, first + 2, first + 3]]);
        skirted.slots.extend([1, 1]);
        let lens = Lens::of(&skirted, |slot| Some(&asset.slots[usize::from(slot)].material)).unwrap();
        let toward = Vec3::new(2.0, 0.0, -1.0).normalize();
        let whole = 0.16 * -toward.z;
        assert!((lens.seen_m2(toward) / whole - 0.5).abs() < 0.03, "{} of {whole}", lens.seen_m2(toward));
    }
}
