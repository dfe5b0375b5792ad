//! The rules of ground floors: shops, entrances, loading bays.

use glam::{Vec3, vec2, vec3};
use trove_model::{FacadeDesign, Filling, Fixtures, Interior};

use super::facade::Style;
use super::styles::{CLEAR, DARK, STONE, WHITE_PAINT, course, opening, pane};
use super::wall::{Finish, Grid};

fn grid(bay_m: f32, storey_m: f32) -> Grid {
    Grid { cells: [4, 1], cell_m: vec2(bay_m, storey_m), detail: 1 }
}

/// Shops, a bay each, with signs and awnings here and there.
pub(super) fn shops() -> Style {
    let glass_door = opening(Filling::GlassDoor, [2.68, 0.06], [1.0, 2.84], [1, 2]);
    let design = FacadeDesign {
        bays: vec![vec![pane([0.3, 0.45], [2.2, 2.45], [2, 1]), glass_door]],
        frame: DARK,
        bar_m: 0.05,
        recess_m: 0.16,
        glass: CLEAR,
        interior: Interior::Shop,
        sill_m: [0.06, 0.05],
        courses: vec![course(0.0, 0.3, 0.0, vec3(0.2, 0.19, 0.18)), course(3.95, 4.18, 0.14, vec3(0.38, 0.36, 0.33))],
        fixtures: Fixtures { signs: 0.95, awnings: 0.35, blades: 0.12, ..Fixtures::default() },
        ..FacadeDesign::default()
    };
    Style { grid: grid(4.0, 4.2), finish: Finish::Plaster, color: vec3(0.34, 0.32, 0.29), worn: 0.2, design }
}

/// Brick with doors up a step between windows.
pub(super) fn entrances() -> Style {
    let door = || vec![opening(Filling::Door, [0.95, 0.15], [1.0, 2.1], [1, 1])];
    let window = || vec![pane([0.85, 0.9], [1.2, 1.75], [2, 2])];
    let design = FacadeDesign {
        bays: vec![door(), window(), window(), window()],
        frame: WHITE_PAINT,
        recess_m: 0.16,
        glass: CLEAR,
        trim: STONE,
        sill_m: [0.1, 0.06],
        lintel_m: [0.23, 0.02],
        courses: vec![course(0.0, 0.14, 0.03, STONE * 0.8)],
        fixtures: Fixtures { lamps: 0.8, ..Fixtures::default() },
        ..FacadeDesign::default()
    };
    let color = vec3(0.22, 0.125, 0.085);
    Style { grid: grid(2.9, 3.4), finish: Finish::Brick, color, worn: 0.2, design }
}

/// A rusticated stucco base: a wide door, shops and windows in turn.
pub(super) fn rusticated() -> Style {
    let door = opening(Filling::Door, [0.6, 0.06], [1.4, 2.9], [1, 1]);
    let shop = || vec![pane([0.3, 0.5], [2.0, 2.5], [2, 1])];
    let window = || vec![pane([0.7, 1.0], [1.2, 2.0], [2, 2])];
    let grooves = (1..8).map(|i| course(i as f32 * 0.45 - 0.03, i as f32 * 0.45, 0.0, vec3(0.22, 0.2, 0.17)));
    let base = [course(0.0, 0.35, 0.05, vec3(0.3, 0.28, 0.25)), course(3.55, 3.78, 0.15, vec3(0.45, 0.42, 0.36))];
    let design = FacadeDesign {
        bays: vec![window(), vec![door], shop(), shop()],
        frame: vec3(0.14, 0.08, 0.045),
        frame_m: 0.08,
        recess_m: 0.22,
        glass: CLEAR,
        interior: Interior::Shop,
        trim: vec3(0.45, 0.42, 0.36),
        sill_m: [0.1, 0.08],
        courses: base.into_iter().chain(grooves).collect(),
        fixtures: Fixtures { signs: 0.6, awnings: 0.3, lamps: 0.4, ..Fixtures::default() },
        ..FacadeDesign::default()
    };
    Style { grid: grid(2.6, 3.8), finish: Finish::Plaster, color: vec3(0.4, 0.36, 0.29), worn: 0.25, design }
}

/// Roller doors, and a door with a window.
pub(super) fn loading() -> Style {
    let roller = || vec![opening(Filling::Roller, [0.65, 0.06], [3.2, 3.9], [1, 1])];
    let office = vec![opening(Filling::Door, [1.2, 0.06], [1.0, 2.1], [1, 1]), pane([2.7, 1.2], [1.4, 0.95], [2, 1])];
    let design = FacadeDesign {
        bays: vec![roller(), roller(), office, roller()],
        frame: Vec3::splat(0.3),
        recess_m: 0.12,
        glass: CLEAR,
        interior: Interior::Office,
        fixtures: Fixtures { lamps: 0.6, ..Fixtures::default() },
        ..FacadeDesign::default()
    };
    Style { grid: grid(4.5, 5.0), finish: Finish::Corrugated, color: vec3(0.33, 0.35, 0.36), worn: 0.25, design }
}

/// Garage doors side by side.
pub(super) fn garage() -> Style {
    let design = FacadeDesign {
        bays: vec![vec![opening(Filling::Roller, [0.25, 0.06], [2.4, 2.1], [1, 1])]],
        recess_m: 0.14,
        interior: Interior::Bare,
        paints: vec![Vec3::ONE, vec3(1.1, 0.95, 0.8)],
        ..FacadeDesign::default()
    };
    Style { grid: grid(2.9, 2.8), finish: Finish::Plaster, color: vec3(0.42, 0.4, 0.36), worn: 0.25, design }
}

/// Columns before a walk with shops at its back.
pub(super) fn arcade() -> Style {
    let glass_door = opening(Filling::GlassDoor, [2.6, 0.06], [0.8, 2.35], [1, 1]);
    let design = FacadeDesign {
        bays: vec![vec![pane([0.25, 0.4], [2.2, 2.3], [2, 1]), glass_door]],
        frame: Vec3::splat(0.3),
        recess_m: 0.1,
        glass: CLEAR,
        interior: Interior::Shop,
        courses: vec![course(3.3, 3.96, 0.05, vec3(0.38, 0.36, 0.33))],
        arcade_m: 2.6,
        fixtures: Fixtures { signs: 0.9, blades: 0.55, ..Fixtures::default() },
        ..FacadeDesign::default()
    };
    Style { grid: grid(3.6, 4.0), finish: Finish::Tiles, color: vec3(0.42, 0.4, 0.36), worn: 0.25, design }
}

/// The open ground level of public flats.
pub(super) fn void_deck() -> Style {
    let door = opening(Filling::Door, [1.0, 0.06], [1.0, 2.1], [1, 1]);
    let design = FacadeDesign {
        bays: vec![vec![], vec![], vec![door], vec![]],
        recess_m: 0.1,
        courses: vec![course(0.3, 0.9, 0.0, vec3(0.2, 0.3, 0.36))],
        arcade_m: 5.0,
        ..FacadeDesign::default()
    };
    Style { grid: grid(3.2, 3.4), finish: Finish::Plaster, color: vec3(0.5, 0.49, 0.45), worn: 0.25, design }
}

/// An office's lobby: tall glass in metal, doors in every second bay.
pub(super) fn lobby() -> Style {
    let fixed = |x: f32| pane([x, 0.12], [1.42, 3.5], [1, 2]);
    let door = |x: f32| opening(Filling::GlassDoor, [x, 0.06], [1.42, 3.56], [1, 2]);
    let design = FacadeDesign {
        bays: vec![vec![fixed(0.05), fixed(1.53)], vec![door(0.05), door(1.53)]],
        frame: Vec3::splat(0.12),
        frame_m: 0.05,
        bar_m: 0.05,
        recess_m: 0.14,
        glass: CLEAR,
        interior: Interior::Office,
        courses: vec![course(3.75, 4.0, 0.25, vec3(0.3, 0.3, 0.31))],
        ..FacadeDesign::default()
    };
    let color = vec3(0.22, 0.22, 0.23);
    Style { grid: grid(3.0, 4.5), finish: Finish::Metal([1.5, 0.75]), color, worn: 0.05, design }
}
