//! Into which directions a lamp shines.

use std::f32::consts::PI;

use glam::{Vec2, Vec3};

/// How brightly a lamp shines into each direction, relative to a reference, or in candelas; between the directions of its table
/// it is bilinear.
///
/// Directions are those of the mesh: azimuths from +x (a vehicle's front, where a street lamp's arm reaches) towards +y (its
/// left), elevations from the plane of both towards +z.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(try_from = "Table", into = "Table"))]
pub struct Beam {
    table: Table,
    /// The sum over all directions, share × steradians.
    flux: f32,
    /// What it leaves of a matt surface's flux, for one that faces along or against x, y or z.
    flux_shares: [[f32; 2]; 3],
}

/// What a beam is made from.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
struct Table {
    azimuths_deg: Vec<f32>,
    elevations_deg: Vec<f32>,
    /// A row for each elevation.
    shares: Vec<f32>,
}

impl TryFrom<Table> for Beam {
    type Error = &'static str;

    fn try_from(table: Table) -> Result<Self, Self::Error> {
        let Table { azimuths_deg, elevations_deg, shares } = table;
        Self::new(azimuths_deg, elevations_deg, shares).ok_or("not a table of directions that grow and shares")
    }
}

impl From<Beam> for Table {
    fn from(beam: Beam) -> Self {
        beam.table
    }
}

impl Beam {
    /// From a table with azimuths and elevations that grow, one share for each pair of them; `None` for another. Directions
    /// beyond the table have the share at its edge.
    pub fn new(azimuths_deg: Vec<f32>, elevations_deg: Vec<f32>, shares: Vec<f32>) -> Option<Self> {
        let grows = |values: &[f32]| !values.is_empty() && values.is_sorted_by(|a, b| a < b);
        let is_sound = grows(&azimuths_deg)
            && grows(&elevations_deg)
            && shares.len() == azimuths_deg.len() * elevations_deg.len()
            && shares.iter().all(|share| share.is_finite() && *share >= 0.0);
        if !is_sound {
            return None;
        }
        let table = Table { azimuths_deg, elevations_deg, shares };
        let (mut flux, mut flux_shares) = (0.0, [[0.0; 2]; 3]);
        for (direction, solid_angle_sr) in directions() {
            let part = table.share(direction) * solid_angle_sr;
            flux += part;
            for axis in 0..3 {
                let along = direction[axis];
                flux_shares[axis][usize::from(along < 0.0)] += part * along.abs() / PI;
            }
        }
        Some(Self { table, flux, flux_shares })
    }

    /// What `share` gives for each pair of azimuth and elevation, in degrees; `None` where that is no table.
    pub fn of(azimuths_deg: &[f32], elevations_deg: &[f32], share: impl Fn(Vec3) -> f32) -> Option<Self> {
        let rows = elevations_deg.iter().map(|&e| azimuths_deg.iter().map(move |&a| toward(a, e)));
        Self::new(azimuths_deg.to_vec(), elevations_deg.to_vec(), rows.flatten().map(share).collect())
    }

    /// Azimuths, elevations, degrees, and a row of shares for each elevation.
    pub fn table(&self) -> [&[f32]; 3] {
        let Table { azimuths_deg, elevations_deg, shares } = &self.table;
        [azimuths_deg, elevations_deg, shares]
    }

    /// Share into a direction of the mesh, of any length but 0.
    pub fn share(&self, direction: Vec3) -> f32 {
        self.table.share(direction)
    }

    /// The largest share.
    pub fn most(&self) -> f32 {
        self.table.shares.iter().copied().fold(0.0, f32::max)
    }

    /// The sum over all directions: lumens, where shares are candelas.
    pub fn flux(&self) -> f32 {
        self.flux
    }

    /// What a matt surface with this unit normal gives by it, as a share of what it gives without: exact along the axes, and
    /// blended between them.
    pub fn flux_share(&self, normal: Vec3) -> f32 {
        let along = |axis: usize| {
            let cos = normal[axis];
            cos * cos * self.flux_shares[axis][usize::from(cos < 0.0)]
        };
        (0..3).map(along).sum()
    }
}

/// The middles of cells of a degree and their solid angles, all around.
pub(crate) fn directions() -> impl Iterator<Item = (Vec3, f32)> {
    let cell_sr = 1f32.to_radians().powi(2);
    (0..180).flat_map(move |row| {
        let elevation_deg = row as f32 - 89.5;
        let solid_angle_sr = elevation_deg.to_radians().cos() * cell_sr;
        (0..360).map(move |column| (toward(column as f32 - 179.5, elevation_deg), solid_angle_sr))
    })
}

fn toward(azimuth_deg: f32, elevation_deg: f32) -> Vec3 {
    let (sin, cos) = elevation_deg.to_radians().sin_cos();
    Vec2::from_angle(azimuth_deg.to_radians()).extend(0.0) * cos + Vec3::Z * sin
}

impl Table {
    fn share(&self, direction: Vec3) -> f32 {
        let azimuth = direction.y.atan2(direction.x);
        let elevation = direction.z.atan2(direction.truncate().length());
        self.at(azimuth.to_degrees(), elevation.to_degrees())
    }

    fn at(&self, azimuth_deg: f32, elevation_deg: f32) -> f32 {
        let (x, fx) = between(&self.azimuths_deg, azimuth_deg);
        let (y, fy) = between(&self.elevations_deg, elevation_deg);
        let width = self.azimuths_deg.len();
        let (x1, y1) = ((x + 1).min(width - 1), (y + 1).min(self.elevations_deg.len() - 1));
        let share = |x: usize, y: usize| self.shares[y * width + x];
        let lower = share(x, y) * (1.0 - fx) + share(x1, y) * fx;
        let upper = share(x, y1) * (1.0 - fx) + share(x1, y1) * fx;
        lower * (1.0 - fy) + upper * fy
    }
}

/// Index of the last value that is not beyond `at`, and how far `at` is on its way to the next.
fn between(values: &[f32], at: f32) -> (usize, f32) {
    let above = values.partition_point(|value| *value <= at);
    let below = above.saturating_sub(1);
    match values.get(above) {
        Some(next) if above > 0 => (below, (at - values[below]) / (next - values[below])),
        _ => (below, 0.0),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shares_are_those_of_the_table_bilinear_between_and_constant_beyond() {
        let beam = Beam::new(vec![-10.0, 0.0, 20.0], vec![-5.0, 5.0], vec![0.0, 1.0, 0.5, 0.2, 0.4, 0.6]).unwrap();
        let toward = |azimuth_deg: f32, elevation_deg: f32| {
            let (a, e) = (azimuth_deg.to_radians(), elevation_deg.to_radians());
            beam.share(Vec3::new(a.cos() * e.cos(), a.sin() * e.cos(), e.sin()) * 3.0)
        };
        for ((azimuth_deg, elevation_deg), expected) in [
            ((0.0, -5.0), 1.0),
            ((20.0, 5.0), 0.6),
            ((-5.0, -5.0), 0.5),
            ((10.0, 0.0), 0.625),
            ((90.0, 80.0), 0.6),
            ((-170.0, -60.0), 0.0),
        ] {
            assert!((toward(azimuth_deg, elevation_deg) - expected).abs() < 1e-3, "{azimuth_deg} {elevation_deg}");
        }
        for shares in [vec![1.0; 5], vec![f32::NAN; 6], vec![-1.0; 6]] {
            assert!(Beam::new(vec![-10.0, 0.0, 20.0], vec![-5.0, 5.0], shares).is_none());
        }
        assert!(Beam::new(vec![1.0, 1.0], vec![0.0], vec![1.0; 2]).is_none());
    }

    #[test]
    fn a_matt_front_gives_all_and_a_cone_of_light_its_part() {
        let all = Beam::new(vec![0.0], vec![0.0], vec![1.0]).unwrap();
        for normal in [Vec3::X, -Vec3::X, Vec3::Y, Vec3::NEG_Z, Vec3::ONE.normalize()] {
            assert!((all.flux_share(normal) - 1.0).abs() < 1e-3, "{normal}: {}", all.flux_share(normal));
        }
        assert!((all.flux() / (4.0 * PI) - 1.0).abs() < 1e-3, "{}", all.flux());
        // Within 30° above and below alone: ∫ cos² over elevations times 2, over π.
        let band = vec![-30.01, -30.0, 30.0, 30.01];
        let band = Beam::new(vec![0.0], band, vec![0.0, 1.0, 1.0, 0.0]).unwrap();
        let e = 30.0f32.to_radians();
        let expected = 2.0 * (e + e.sin() * e.cos()) / PI;
        assert!((band.flux_share(Vec3::X) - expected).abs() < 5e-3, "{} {expected}", band.flux_share(Vec3::X));
        // Of what a ceiling gives, it is what leaves within 30° of the horizon: sin².
        let down = band.flux_share(Vec3::NEG_Z);
        assert!((down - 0.25).abs() < 5e-3, "{down}");
    }
}
