//! Walls and roof of a building's volumes.

use trove_model::{Mesh, Random, Report, Seed};

use super::dress::Dress;
use super::roof::{canopy, roof};
use super::shell::{Shell, Slot};
use super::sight::{Detail, Sight};
use super::volumes::{House, Volume};
use super::wall::{Band, Grid, Wall};
use super::walls::{raise, walls_of};

/// Walls go this far into the ground.
const FOOTING_M: f64 = 0.6;
/// What stands on a ground floor is at least this high.
const LEAST_UPPER_M: f64 = 2.4;

/// The mesh of a building in World; slots as in [`Slot`].
pub(super) fn extrude(
    house: &House<'_>,
    dress: &Dress,
    sight: &Sight<'_>,
    random: &mut Random,
    report: &Report,
) -> Mesh {
    let mut shell = Shell::default();
    for volume in &house.volumes {
        if volume.is_canopy {
            canopy(&mut shell, volume, house, random, report);
        } else {
            add(&mut shell, volume, dress, house, sight, random, report);
        }
    }
    shell.finish()
}

fn add(
    shell: &mut Shell,
    volume: &Volume<'_>,
    dress: &Dress,
    house: &House<'_>,
    sight: &Sight<'_>,
    random: &mut Random,
    report: &Report,
) {
    let wall_top = roof(shell, volume, house, random, report);
    let footprint = &volume.footprint;
    let bottom = house.floor_m + volume.bottom_m;
    let grounded = volume.bottom_m <= 0.0;
    let first_storey = random.index(4);
    let seed = Seed(random.bits());
    let first_top = match &dress.ground_floor {
        Some(part) if grounded && wall_top - bottom >= part.grid.storey_m + LEAST_UPPER_M => {
            bottom + part.grid.storey_m
        }
        _ => bottom,
    };
    let footing = |level: f64| if grounded && level == bottom { level - FOOTING_M } else { level };
    // Doors and shops where a street is; elsewhere the upper storeys' windows go on.
    let ground = dress.ground_floor.as_ref().filter(|_| first_top > bottom);
    let below = |wall: &Wall| {
        let part = ground?;
        let part = if wall.is_front || wall.detail == Detail::Flat { part } else { &dress.upper };
        let is_ground = !std::ptr::eq(part, &dress.upper);
        Some(Band {
            slot: if is_ground { Slot::GroundFloor } else { Slot::Facade },
            wall: if is_ground { Slot::GroundWall } else { Slot::Wall },
            grid: part.grid,
            design: part.design.as_deref(),
            bottom_m: footing(bottom),
            floor_m: bottom,
            top_m: first_top,
            storeys: 1.0,
            first_storey: if is_ground { 0 } else { first_storey + 3 },
            is_uppermost: false,
        })
    };
    let upper = Band {
        slot: Slot::Facade,
        wall: Slot::Wall,
        grid: dress.upper.grid,
        design: dress.upper.design.as_deref(),
        bottom_m: footing(first_top),
        floor_m: first_top,
        top_m: wall_top,
        storeys: storeys(volume, dress.upper.grid, wall_top - first_top, first_top > bottom),
        first_storey,
        is_uppermost: true,
    };
    for wall in walls_of(volume, wall_top - house.floor_m, sight) {
        if let Some(band) = below(&wall) {
            raise(shell, &wall, &band, seed);
        }
        raise(shell, &wall, &upper, seed);
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
    use super::super::dress::Storeys;
    use super::*;
    use crate::testing::{self, open_edges_and_volume};
    use glam::{DVec2, Vec2};
    use std::sync::Arc;
    use trove_model::{Bounds, Building, FacadeDesign, Filling, HeightField, Opening, Polygon, RoofShape, Seed};

    /// Of rules with a window and a door in a bay, or of textures alone.
    fn dress(has_rules: bool) -> Dress {
        let opening =
            |filling, x: f32, y: f32, size_m| Opening { filling, low_m: Vec2::new(x, y), size_m, panes: [2, 1] };
        let window = opening(Filling::Window, 0.4, 0.9, Vec2::new(1.0, 1.4));
        let french = opening(Filling::Window, 1.7, 0.1, Vec2::new(1.0, 2.5));
        let storeys = |storey_m: f64, arcade_m: f32| {
            let bays = vec![vec![window, french], vec![], vec![window]];
            let design = FacadeDesign { bays, arcade_m, ..FacadeDesign::default() };
            Storeys { grid: Grid { bay_m: 3.0, storey_m }, design: has_rules.then(|| Arc::new(design)) }
        };
        Dress { materials: Vec::new(), upper: storeys(3.2, 0.0), ground_floor: Some(storeys(4.0, 2.4)) }
    }

    /// A building 25 m beside a street with a car on it.
    fn built(footprint: Polygon, roof: RoofShape, bottom_m: f64, dress: &Dress) -> Mesh {
        let building = Building::new(1, Polygon::default(), None);
        let footprint = crate::geometry::plane::union(&[footprint]).remove(0);
        let eaves_m = if roof == RoofShape::Flat { 18.0 } else { 14.0 };
        let volume = Volume { footprint, ..Volume::new(&building, bottom_m, eaves_m, 18.0, roof) };
        let house = House::alone(&building, vec![volume]);
        let drive = testing::drive();
        let streets = testing::surfaces(&drive, &HeightField::flat(Bounds::square(DVec2::ZERO, 600.0), 0.0));
        extrude(&house, dress, &Sight::new(&drive, &streets), &mut Seed(1).random(), &Report::default())
    }

    fn mesh(footprint: Polygon, roof: RoofShape, bottom_m: f64) -> Mesh {
        built(footprint, roof, bottom_m, &dress(false))
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

    #[test]
    fn walls_with_holes_rooms_and_a_walk_behind_columns_are_closed() {
        let moved = |p: &DVec2| *p + DVec2::new(20.0, 24.0);
        let footprint = Polygon::simple(rectangle().exterior.iter().map(moved).collect());
        let mesh = built(footprint, RoofShape::Flat, 0.0, &dress(true));
        assert_eq!(mesh.defect(), None);
        let rooms = mesh.slots.iter().filter(|&&s| s == Slot::RoomFloor as u16).count();
        assert!(rooms > 40, "{rooms} triangles of rooms' floors");
        // Some of them have lamps, which shine down and to the sides.
        let of_lamps = mesh
            .triangles
            .iter()
            .zip(&mesh.slots)
            .filter(|(_, slot)| [Slot::Lampshade, Slot::LightPanel].iter().any(|&lamp| lamp as u16 == **slot));
        let facing = of_lamps.map(|(&corners, _)| {
            let [a, b, c] = corners.map(|i| mesh.positions[i as usize]);
            (b - a).cross(c - a).normalize().z
        });
        let (down, all) = facing.fold((0, 0), |(down, all), z| (down + i32::from(z < -0.99), all + 1));
        assert!(down >= 8 && (down == all || down * 6 == all), "{down} of {all}");
        // Frames, panes and what hangs in the windows are bodies of their own.
        let closed = |&slot: &u16| {
            use Slot::{Dark, GroundWall, RoomBack, RoomFloor, RoomPale, RoomWarm, Slab, Wall};
            let walls = [Wall, GroundWall, Slab, RoomPale, RoomWarm, RoomFloor, RoomBack, Dark];
            slot <= Slot::Glazing as u16 || walls.iter().any(|&w| w as u16 == slot)
        };
        let mut shell = mesh.clone();
        let mut slots = mesh.slots.iter();
        shell.triangles.retain(|_| slots.next().is_some_and(closed));
        let (open, _) = open_edges_and_volume(&shell);
        assert!(!open.is_empty());
        for [a, b] in open {
            let (a, b) = (a.map(f32::from_bits), b.map(f32::from_bits));
            assert!(a[2] < 0.0 && b[2] < 0.0, "{a:?} {b:?}");
        }
    }
}
