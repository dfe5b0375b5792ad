//! Walls with whole bays and whole storeys.

use glam::{DVec2, DVec3};
use trove_model::{Polygon, Surface};

use super::shell::{Shell, Slot};

/// Edges that meet at less than this make one wall, radians: round fronts keep their rhythm of windows.
const SAME_WALL_RAD: f64 = 0.35;
/// Of a wall narrower than this share of a bay only the pier between two bays is shown.
const NARROWEST_BAY: f64 = 0.55;

/// How a surface's texture is divided.
#[derive(Clone, Copy, Debug)]
pub(super) struct Grid {
    pub bay_m: f64,
    pub storey_m: f64,
}

impl Grid {
    pub(super) fn of(surface: &Surface) -> Self {
        let cell = |i: usize| f64::from(surface.size_m[i]) / f64::from(surface.cells[i].max(1));
        Self { bay_m: cell(0).max(0.1), storey_m: cell(1).max(0.1) }
    }

    /// Texture coordinate of both ends of a wall: an integer number of bays, or a pier.
    fn along(&self, length_m: f64, first_bay: f64) -> (f64, f64) {
        if length_m < NARROWEST_BAY * self.bay_m {
            return (first_bay * self.bay_m - length_m / 2.0, first_bay * self.bay_m + length_m / 2.0);
        }
        let bays = (length_m / self.bay_m).round().max(1.0);
        (first_bay * self.bay_m, (first_bay + bays) * self.bay_m)
    }
}

/// A horizontal strip of walls.
pub(super) struct Band {
    pub slot: Slot,
    pub grid: Grid,
    pub bottom_m: f64,
    /// The texture starts here; below it, in the ground, its lowest row goes on.
    pub floor_m: f64,
    pub top_m: f64,
    /// Storeys between floor and top; as many of the texture's are shown.
    pub storeys: f64,
    /// Storey of the texture that comes first.
    pub first_storey: f64,
}

impl Band {
    fn v(&self, z: f64) -> f64 {
        let share = if self.top_m > self.floor_m { (z - self.floor_m) / (self.top_m - self.floor_m) } else { 0.0 };
        (self.first_storey + share.max(0.0) * self.storeys) * self.grid.storey_m
    }
}

/// The walls of a footprint between a band's bottom and top; `top` may lower or raise the upper edge.
pub(super) fn walls(shell: &mut Shell, footprint: &Polygon, band: &Band, top: impl Fn(DVec2) -> f64) {
    for (which, ring) in footprint.rings().enumerate() {
        for (number, wall) in runs(ring).into_iter().enumerate() {
            let length_m: f64 = wall.windows(2).map(|w| w[0].distance(w[1])).sum();
            // Walls start at different bays, so that a house's sides differ.
            let (u0, u1) = band.grid.along(length_m, ((which * 5 + number * 3) % 8) as f64);
            let mut at_m = 0.0;
            for pair in wall.windows(2) {
                let next_m = at_m + pair[0].distance(pair[1]);
                let u = [at_m, next_m].map(|m| u0 + (u1 - u0) * m / length_m);
                let corner = |p: DVec2, u: f64, z: f64| -> (DVec3, DVec2) { (p.extend(z), DVec2::new(u, band.v(z))) };
                let (a, b) = (pair[0], pair[1]);
                let mut heights = vec![band.bottom_m];
                if band.bottom_m < band.floor_m {
                    heights.push(band.floor_m);
                }
                for k in 0..heights.len() {
                    let low = heights[k];
                    let (za, zb) = match heights.get(k + 1) {
                        Some(&z) => (z, z),
                        None => (top(a), top(b)),
                    };
                    shell.face(
                        band.slot,
                        &[corner(a, u[0], low), corner(b, u[1], low), corner(b, u[1], zb), corner(a, u[0], za)],
                    );
                }
                at_m = next_m;
            }
        }
    }
}

/// A closed ring as walls: runs of edges that hardly turn.
fn runs(ring: &[DVec2]) -> Vec<Vec<DVec2>> {
    let n = ring.len();
    let turns = |i: usize| {
        let (before, after) = (ring[i] - ring[(i + n - 1) % n], ring[(i + 1) % n] - ring[i]);
        before.angle_to(after).abs() > SAME_WALL_RAD
    };
    let Some(start) = (0..n).find(|&i| turns(i)) else {
        return vec![ring.iter().chain(ring.first()).copied().collect()];
    };
    let mut walls: Vec<Vec<DVec2>> = Vec::new();
    for k in 0..n {
        let i = (start + k) % n;
        if turns(i) {
            walls.push(vec![ring[i]]);
        }
        if let Some(wall) = walls.last_mut() {
            wall.push(ring[(i + 1) % n]);
        }
    }
    walls
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_wall_shows_whole_bays() {
        let grid = Grid { bay_m: 3.0, storey_m: 3.2 };
        assert_eq!(grid.along(10.0, 0.0), (0.0, 9.0));
        assert_eq!(grid.along(11.0, 2.0), (6.0, 18.0));
        assert_eq!(grid.along(1.0, 1.0), (2.5, 3.5));
    }

    #[test]
    fn a_round_tower_is_one_wall_and_a_square_house_four() {
        let ring = |n: u32| -> Vec<DVec2> {
            (0..n).map(|i| DVec2::from_angle(std::f64::consts::TAU * f64::from(i) / f64::from(n)) * 5.0).collect()
        };
        assert_eq!(runs(&ring(24)).len(), 1);
        assert_eq!(runs(&ring(4)).len(), 4);
        assert!(runs(&ring(4)).iter().all(|wall| wall.len() == 2));
    }
}
