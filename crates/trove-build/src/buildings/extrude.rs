//! Walls and roof of a building's volumes.

use glam::DVec2;
use trove_model::{HeightField, Mesh, Random, Report};

use super::dress::Dress;
use super::roof::roof;
use super::shell::{Shell, Slot};
use super::volumes::{House, Volume};
use super::walls::{Band, Grid, walls};
use crate::roads::KERB_M;

/// Walls go this far into the ground.
const FOOTING_M: f64 = 0.6;
/// What stands on a ground floor is at least this high.
const LEAST_UPPER_M: f64 = 2.4;

/// The mesh of a building in World; slots as in [`Slot`].
pub(super) fn extrude(
    house: &House<'_>,
    dress: &Dress,
    ground: &HeightField,
    random: &mut Random,
    report: &Report,
) -> Mesh {
    let mut shell = Shell::default();
    // All parts stand on one floor, the lowest of the ground around them.
    let floor_m = house
        .volumes
        .iter()
        .flat_map(|v| &v.footprint.exterior)
        .map(|&p| ground.height_m(p))
        .fold(f64::INFINITY, f64::min)
        + KERB_M;
    for volume in &house.volumes {
        add(&mut shell, volume, dress, floor_m, random, report);
    }
    shell.finish()
}

fn add(shell: &mut Shell, volume: &Volume<'_>, dress: &Dress, floor_m: f64, random: &mut Random, report: &Report) {
    let top = roof(shell, volume, floor_m, random, report);
    let footprint = &volume.footprint;
    let bottom = floor_m + volume.bottom_m;
    let wall_top = footprint.exterior.iter().map(|&p| top.at(p)).fold(f64::NEG_INFINITY, f64::max);
    if wall_top <= bottom {
        return;
    }
    let grounded = volume.bottom_m <= 0.0;
    let first_storey = random.index(4) as f64;
    let upper = |from: f64, below: f64| Band {
        slot: Slot::Facade,
        grid: dress.facade,
        bottom_m: below,
        floor_m: from,
        top_m: wall_top,
        storeys: storeys(volume, dress.facade, wall_top - from, from > bottom),
        first_storey,
    };
    match dress.ground_floor {
        Some(grid) if grounded && wall_top - bottom >= grid.storey_m + LEAST_UPPER_M => {
            let first_top = bottom + grid.storey_m;
            let band = Band {
                slot: Slot::GroundFloor,
                grid,
                bottom_m: bottom - FOOTING_M,
                floor_m: bottom,
                top_m: first_top,
                storeys: 1.0,
                first_storey: 0.0,
            };
            walls(shell, footprint, &band, |_| first_top);
            walls(shell, footprint, &upper(first_top, first_top), |p: DVec2| top.at(p).max(first_top));
        }
        _ => {
            let below = if grounded { bottom - FOOTING_M } else { bottom };
            walls(shell, footprint, &upper(bottom, below), |p: DVec2| top.at(p));
        }
    }
    if !grounded {
        shell.cover(Slot::Trim, std::slice::from_ref(footprint), |_| bottom, false);
    }
}

/// Whole storeys in a wall: as tagged where that gives storeys of a plausible height, else as the facade's.
fn storeys(volume: &Volume<'_>, grid: Grid, height_m: f64, above_ground_floor: bool) -> f64 {
    let tagged = volume.building.levels.map(|l| l.round() - f64::from(u8::from(above_ground_floor)));
    tagged
        .filter(|&n| n >= 1.0 && volume.building.min_height_m <= 0.0 && (2.4..6.0).contains(&(height_m / n)))
        .unwrap_or_else(|| (height_m / grid.storey_m).round())
        .max(1.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeMap;
    use trove_model::{Bounds, Building, Material, Polygon, RoofShape, Seed};

    fn dress() -> Dress {
        let grid = Grid { bay_m: 3.0, storey_m: 3.2 };
        Dress {
            materials: vec![Material::default(); 5],
            facade: grid,
            ground_floor: Some(Grid { storey_m: 4.0, ..grid }),
        }
    }

    fn mesh(footprint: Polygon, roof: RoofShape, bottom_m: f64) -> Mesh {
        let building = Building::new(1, Polygon::default(), "yes");
        let footprint = crate::plane::union(&[footprint]).remove(0);
        let volume = Volume { building: &building, footprint, bottom_m, eaves_m: 14.0, top_m: 18.0, roof };
        let house = House { building: &building, volumes: vec![volume] };
        let ground = HeightField::flat(Bounds::square(DVec2::ZERO, 100.0), 0.0);
        extrude(&house, &dress(), &ground, &mut Seed(1).random(), &Report::default())
    }

    /// Edges that only one triangle has, and the volume that the triangles enclose.
    fn open_edges_and_volume(mesh: &Mesh) -> (Vec<[[u32; 3]; 2]>, f64) {
        let mut edges: BTreeMap<[[u32; 3]; 2], i32> = BTreeMap::new();
        let mut volume = 0.0;
        for t in &mesh.triangles {
            let p = t.map(|i| mesh.positions[i as usize]);
            let [a, b, c] = p.map(|p| p.as_dvec3());
            volume += a.dot(b.cross(c)) / 6.0;
            // Adding 0 makes −0 and 0 one.
            let key = p.map(|p| (p + 0.0).to_array().map(f32::to_bits));
            for (i, j) in [(0, 1), (1, 2), (2, 0)] {
                *edges.entry([key[i], key[j]]).or_default() += 1;
                *edges.entry([key[j], key[i]]).or_default() -= 1;
            }
        }
        (edges.into_iter().filter(|(_, n)| *n > 0).map(|(e, _)| e).collect(), volume)
    }

    fn rectangle() -> Polygon {
        let corners = [(-10., -6.), (10., -6.), (10., 6.), (-10., 6.)];
        Polygon::simple(corners.map(|(x, y)| DVec2::from_angle(0.3).rotate(DVec2::new(x, y))).into())
    }

    #[test]
    fn a_part_above_the_ground_is_closed_under_every_roof_and_looks_outwards() {
        let shapes = [
            (RoofShape::Flat, 240.0 * 8.0),
            (RoofShape::Gabled, 240.0 * 6.0),
            (RoofShape::Hipped, 240.0 * 5.2),
            (RoofShape::Pyramidal, 240.0 * 5.33),
            (RoofShape::Dome, 240.0 * 6.4),
            (RoofShape::Skillion, 240.0 * 6.0),
            (RoofShape::Mansard, 240.0 * 7.0),
        ];
        for (shape, expected) in shapes {
            let mesh = mesh(rectangle(), shape, 10.0);
            assert_eq!(mesh.defect(), None);
            let (open, volume) = open_edges_and_volume(&mesh);
            assert!(open.is_empty(), "{shape:?}: {} open edges", open.len());
            assert!((volume / expected - 1.0).abs() < 0.12, "{shape:?}: {volume} m³ of {expected}");
        }
    }

    #[test]
    fn a_courtyard_stays_open_to_the_sky() {
        let corners = [(-3., -3.), (-3.2, 3.1), (3., 2.7), (3.1, -3.3)];
        let court = corners.map(|(x, y)| DVec2::new(x, y)).into();
        let mesh = mesh(Polygon { holes: vec![court], ..rectangle() }, RoofShape::Flat, 10.0);
        let (open, volume) = open_edges_and_volume(&mesh);
        assert!(open.is_empty(), "{} open edges", open.len());
        assert!(volume < 203.0 * 8.0 && volume > 203.0 * 6.9, "{volume}");
    }

    #[test]
    fn a_standing_building_is_open_in_the_ground_only() {
        let mesh = mesh(rectangle(), RoofShape::Flat, 0.0);
        let (open, _) = open_edges_and_volume(&mesh);
        assert!(!open.is_empty());
        for [a, b] in open {
            assert!(f32::from_bits(a[2]) < 0.0 && f32::from_bits(b[2]) < 0.0);
        }
    }
}
