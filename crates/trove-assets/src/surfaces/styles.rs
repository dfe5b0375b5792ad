//! The rules of upper storeys, a style each.

use glam::{Vec2, Vec3, vec2, vec3};
use trove_model::{Course, FacadeDesign, Filling, Fixtures, Interior, Opening};

use super::facade::Style;
use super::wall::{Finish, Grid};

pub(super) const STONE: Vec3 = vec3(0.36, 0.34, 0.3);
pub(super) const WHITE_PAINT: Vec3 = vec3(0.62, 0.62, 0.6);
pub(super) const CLEAR: Vec3 = vec3(0.85, 0.95, 0.95);
pub(super) const DARK: Vec3 = vec3(0.06, 0.06, 0.065);

/// Four by four cells.
fn grid(bay_m: f32, storey_m: f32) -> Grid {
    Grid { cells: [4, 4], cell_m: vec2(bay_m, storey_m), detail: 1 }
}

pub(super) fn opening(filling: Filling, low_m: [f32; 2], size_m: [f32; 2], panes: [u32; 2]) -> Opening {
    Opening { filling, low_m: Vec2::from_array(low_m), size_m: Vec2::from_array(size_m), panes }
}

pub(super) fn pane(low_m: [f32; 2], size_m: [f32; 2], panes: [u32; 2]) -> Opening {
    opening(Filling::Window, low_m, size_m, panes)
}

pub(super) fn course(low_m: f32, high_m: f32, out_m: f32, color: Vec3) -> Course {
    Course { between_m: [low_m, high_m], out_m, color }
}

/// Terraced houses of brick with sash windows.
pub(super) fn brick_row() -> Style {
    let design = FacadeDesign {
        bays: vec![vec![pane([0.875, 0.8], [1.15, 1.75], [2, 2])]],
        frame: WHITE_PAINT,
        frame_m: 0.07,
        bar_m: 0.035,
        recess_m: 0.11,
        glass: CLEAR,
        trim: STONE,
        sill_m: [0.1, 0.06],
        lintel_m: [0.22, 0.015],
        cornice_m: [0.4, 0.3],
        fixtures: Fixtures { fire_escapes: 0.2, ..Fixtures::default() },
        paints: vec![Vec3::ONE, vec3(1.15, 0.9, 0.8), vec3(0.8, 0.76, 0.76), vec3(1.5, 1.5, 1.45)],
        ..FacadeDesign::default()
    };
    Style { grid: grid(2.9, 3.1), finish: Finish::Brick, color: vec3(0.22, 0.125, 0.085), worn: 0.18, design }
}

/// An old mill: piers of brick, wide steel windows of many panes.
pub(super) fn brick_mill() -> Style {
    let design = FacadeDesign {
        bays: vec![vec![pane([0.55, 0.8], [2.3, 2.5], [5, 6])]],
        frame: DARK,
        frame_m: 0.05,
        bar_m: 0.035,
        recess_m: 0.18,
        glass: CLEAR,
        interior: Interior::Office,
        trim: vec3(0.26, 0.24, 0.21),
        sill_m: [0.12, 0.06],
        lintel_m: [0.24, 0.012],
        pier_m: [0.56, 0.1],
        cornice_m: [0.5, 0.22],
        fixtures: Fixtures { fire_escapes: 0.15, ..Fixtures::default() },
        paints: vec![Vec3::ONE, vec3(1.1, 1.1, 1.05), vec3(0.85, 0.95, 1.0)],
        ..FacadeDesign::default()
    };
    Style { grid: grid(3.4, 3.9), finish: Finish::Brick, color: vec3(0.21, 0.095, 0.065), worn: 0.25, design }
}

/// Painted stucco with shutters and French windows.
pub(super) fn mediterranean() -> Style {
    let window = || vec![pane([1.0, 0.75], [1.0, 1.7], [2, 3])];
    let french = || vec![pane([0.95, 0.16], [1.1, 2.29], [2, 3])];
    let design = FacadeDesign {
        bays: vec![window(), french(), window(), french()],
        stagger: 2,
        frame: WHITE_PAINT,
        bar_m: 0.03,
        recess_m: 0.18,
        glass: CLEAR,
        trim: vec3(0.5, 0.48, 0.42),
        sill_m: [0.1, 0.07],
        surround_m: [0.12, 0.02],
        courses: vec![course(0.0, 0.14, 0.06, vec3(0.5, 0.47, 0.4))],
        cornice_m: [0.35, 0.4],
        shutters: Some(vec3(0.05, 0.1, 0.075)),
        paints: vec![
            Vec3::ONE,
            vec3(1.15, 1.2, 1.3),
            vec3(1.1, 0.85, 0.72),
            vec3(1.15, 0.98, 0.95),
            vec3(1.12, 1.0, 0.7),
        ],
        fixtures: Fixtures { balconies: 0.75, conditioners: 0.06, ..Fixtures::default() },
        ..FacadeDesign::default()
    };
    Style { grid: grid(3.0, 3.2), finish: Finish::Plaster, color: vec3(0.5, 0.42, 0.29), worn: 0.14, design }
}

/// Pale brick, stone surrounds, a cornice on every floor, bays that stand out.
pub(super) fn victorian() -> Style {
    let design = FacadeDesign {
        bays: vec![vec![pane([0.825, 0.75], [1.05, 2.1], [1, 2])]],
        frame: WHITE_PAINT,
        frame_m: 0.08,
        bar_m: 0.06,
        recess_m: 0.15,
        glass: CLEAR,
        trim: STONE * 1.12,
        sill_m: [0.1, 0.08],
        lintel_m: [0.16, 0.12],
        surround_m: [0.16, 0.03],
        courses: vec![course(0.0, 0.16, 0.07, STONE), course(0.16, 0.26, 0.12, STONE * 1.1)],
        cornice_m: [0.7, 0.5],
        paints: vec![Vec3::ONE, vec3(0.85, 0.75, 0.75), vec3(1.1, 1.1, 1.15)],
        fixtures: Fixtures { oriels: 0.3, ..Fixtures::default() },
        ..FacadeDesign::default()
    };
    Style { grid: grid(2.7, 3.6), finish: Finish::Brick, color: vec3(0.27, 0.2, 0.125), worn: 0.28, design }
}

/// A city house of about 1900: stucco with surrounds, hoods, string courses and a deep cornice.
pub(super) fn ornate() -> Style {
    let window = || vec![pane([0.72, 0.85], [1.16, 2.15], [2, 2])];
    let french = || vec![pane([0.65, 0.22], [1.3, 2.78], [2, 2])];
    let design = FacadeDesign {
        bays: vec![window(), window(), french(), window()],
        frame: WHITE_PAINT,
        frame_m: 0.07,
        bar_m: 0.05,
        recess_m: 0.2,
        glass: CLEAR,
        trim: vec3(0.52, 0.5, 0.45),
        sill_m: [0.12, 0.12],
        lintel_m: [0.16, 0.2],
        surround_m: [0.18, 0.06],
        courses: vec![course(0.0, 0.16, 0.1, vec3(0.5, 0.48, 0.43))],
        cornice_m: [0.7, 0.6],
        paints: vec![
            Vec3::ONE,
            vec3(1.05, 1.12, 1.25),
            vec3(1.05, 0.92, 0.72),
            vec3(0.85, 0.95, 0.95),
            vec3(1.1, 0.9, 0.85),
            vec3(0.62, 0.64, 0.68),
        ],
        fixtures: Fixtures { balconies: 0.55, oriels: 0.08, ..Fixtures::default() },
        ..FacadeDesign::default()
    };
    Style { grid: grid(2.6, 3.7), finish: Finish::Plaster, color: vec3(0.46, 0.41, 0.33), worn: 0.22, design }
}

/// A plain rendered wall, as houses of the last century and courtyards have.
pub(super) fn plain() -> Style {
    let design = FacadeDesign {
        bays: vec![
            vec![pane([0.9, 0.85], [1.2, 1.45], [2, 1])],
            vec![pane([0.7, 0.85], [1.6, 1.45], [2, 1])],
            vec![pane([0.9, 0.85], [1.2, 1.45], [2, 1])],
            vec![pane([0.9, 0.16], [1.2, 2.14], [1, 1])],
        ],
        frame: WHITE_PAINT,
        frame_m: 0.08,
        bar_m: 0.09,
        recess_m: 0.14,
        glass: CLEAR,
        sill_m: [0.05, 0.06],
        paints: vec![Vec3::ONE, vec3(0.95, 0.85, 0.68), vec3(0.75, 0.78, 0.78), vec3(0.95, 0.9, 0.85)],
        fixtures: Fixtures { balconies: 0.9, ..Fixtures::default() },
        ..FacadeDesign::default()
    };
    Style { grid: grid(3.0, 3.0), finish: Finish::Plaster, color: vec3(0.47, 0.45, 0.4), worn: 0.2, design }
}

/// A curtain wall: two panes a bay, an opaque band at every floor.
pub(super) fn curtain_wall(glass: Vec3, band: Vec3, fin: Vec3) -> Style {
    let design = FacadeDesign {
        bays: vec![vec![pane([0.03, 0.98], [1.44, 2.76], [1, 1]), pane([1.53, 0.98], [1.44, 2.76], [1, 1])]],
        frame: fin,
        frame_m: 0.025,
        recess_m: 0.05,
        glass,
        interior: Interior::Office,
        trim: fin,
        courses: vec![course(0.02, 0.08, 0.05, fin), course(0.91, 0.97, 0.05, fin)],
        pier_m: [0.06, 0.09],
        ..FacadeDesign::default()
    };
    Style { grid: grid(3.0, 3.8), finish: Finish::Metal([1.5, 3.8]), color: band, worn: 0.05, design }
}

/// Concrete with a ribbon of windows on every floor.
pub(super) fn ribbon() -> Style {
    let design = FacadeDesign {
        bays: vec![vec![pane([0.04, 1.02], [1.42, 1.8], [1, 2]), pane([1.54, 1.02], [1.42, 1.8], [1, 2])]],
        frame: vec3(0.09, 0.085, 0.08),
        frame_m: 0.04,
        bar_m: 0.05,
        recess_m: 0.22,
        glass: CLEAR * 0.9,
        interior: Interior::Office,
        courses: vec![course(0.92, 0.99, 0.06, vec3(0.36, 0.35, 0.33))],
        ..FacadeDesign::default()
    };
    let color = vec3(0.33, 0.32, 0.295);
    Style { grid: grid(3.0, 3.6), finish: Finish::Concrete([3.0, 3.6]), color, worn: 0.2, design }
}

/// A slab block of large concrete panels with balconies.
pub(super) fn slab_block() -> Style {
    let window = || vec![pane([0.65, 0.9], [1.9, 1.4], [2, 1])];
    let design = FacadeDesign {
        bays: vec![window(), window(), vec![pane([0.5, 0.16], [2.2, 2.15], [3, 1])], window()],
        frame: WHITE_PAINT * 0.9,
        bar_m: 0.06,
        recess_m: 0.14,
        glass: CLEAR,
        sill_m: [0.05, 0.05],
        paints: vec![Vec3::ONE, vec3(1.15, 1.05, 0.9), vec3(0.85, 0.92, 0.98), vec3(1.1, 0.95, 0.85)],
        fixtures: Fixtures { balconies: 0.4, glass_balconies: 0.6, ..Fixtures::default() },
        ..FacadeDesign::default()
    };
    let color = vec3(0.43, 0.42, 0.39);
    Style { grid: grid(3.2, 2.8), finish: Finish::Concrete([3.2, 2.8]), color, worn: 0.25, design }
}

/// A tropical block of public flats: painted bands, ledges for air conditioners, laundry.
pub(super) fn public_flats() -> Style {
    let wall = vec3(0.55, 0.54, 0.5);
    let design = FacadeDesign {
        bays: vec![
            vec![pane([0.65, 0.95], [1.9, 1.35], [3, 1])],
            vec![pane([0.5, 0.95], [1.5, 1.35], [2, 1]), pane([2.3, 1.4], [0.5, 0.9], [1, 2])],
        ],
        frame: vec3(0.3, 0.3, 0.29),
        frame_m: 0.05,
        bar_m: 0.05,
        glass: vec3(0.8, 0.92, 0.95),
        trim: wall * 0.95,
        sill_m: [0.08, 0.05],
        lintel_m: [0.1, 0.35],
        courses: vec![course(0.06, 0.82, 0.0, vec3(0.2, 0.3, 0.36)), course(0.0, 0.06, 0.06, wall)],
        pier_m: [0.24, 0.1],
        paints: vec![Vec3::ONE, vec3(1.0, 0.93, 0.82), vec3(0.92, 1.0, 0.95), vec3(1.0, 0.92, 0.92)],
        fixtures: Fixtures { conditioners: 0.5, laundry: 0.25, ..Fixtures::default() },
        ..FacadeDesign::default()
    };
    Style { grid: grid(3.2, 2.8), finish: Finish::Plaster, color: wall, worn: 0.25, design }
}

/// Tiled flats of an East Asian city: aluminium windows in cages, canopies, air conditioners.
pub(super) fn tiled_flats() -> Style {
    let wide = || vec![pane([0.6, 0.9], [2.2, 1.45], [3, 1])];
    let design = FacadeDesign {
        bays: vec![wide(), vec![pane([0.5, 0.9], [1.2, 1.45], [2, 1]), pane([2.2, 1.3], [0.7, 1.05], [1, 1])], wide()],
        stagger: 0,
        frame: vec3(0.42, 0.42, 0.41),
        frame_m: 0.05,
        bar_m: 0.05,
        recess_m: 0.12,
        glass: vec3(0.72, 0.85, 0.82),
        trim: vec3(0.4, 0.39, 0.36),
        sill_m: [0.06, 0.06],
        lintel_m: [0.08, 0.45],
        courses: vec![course(0.0, 0.3, 0.04, vec3(0.38, 0.36, 0.33))],
        paints: vec![
            Vec3::ONE,
            vec3(0.85, 0.8, 0.72),
            vec3(0.78, 0.6, 0.52),
            vec3(0.7, 0.75, 0.7),
            vec3(0.95, 0.88, 0.85),
        ],
        fixtures: Fixtures { conditioners: 0.6, cages: 0.45, laundry: 0.05, ..Fixtures::default() },
        ..FacadeDesign::default()
    };
    // Three patterns in four bays: the texture starts anew after three.
    let grid = Grid { cells: [3, 4], cell_m: vec2(3.4, 3.2), detail: 1 };
    Style { grid, finish: Finish::Tiles, color: vec3(0.46, 0.45, 0.41), worn: 0.3, design }
}

/// A grid of deep frames with a full window in each.
pub(super) fn hotel() -> Style {
    let design = FacadeDesign {
        bays: vec![vec![pane([0.3, 0.4], [2.7, 2.5], [3, 1])]],
        frame: Vec3::splat(0.1),
        frame_m: 0.05,
        bar_m: 0.06,
        recess_m: 0.4,
        glass: vec3(0.75, 0.85, 0.88),
        paints: vec![Vec3::ONE, vec3(0.8, 0.75, 0.68), vec3(0.6, 0.6, 0.62)],
        ..FacadeDesign::default()
    };
    Style { grid: grid(3.3, 3.2), finish: Finish::Plaster, color: vec3(0.5, 0.49, 0.47), worn: 0.12, design }
}

/// A shed of corrugated metal with a strip of windows now and then.
pub(super) fn warehouse() -> Style {
    let design = FacadeDesign {
        bays: vec![vec![pane([0.4, 2.4], [3.2, 0.9], [4, 1])], vec![]],
        frame: Vec3::splat(0.3),
        bar_m: 0.05,
        recess_m: 0.06,
        glass: CLEAR,
        interior: Interior::Bare,
        paints: vec![Vec3::ONE, vec3(0.7, 0.9, 1.2), vec3(1.3, 1.25, 1.1), vec3(0.8, 1.0, 0.85)],
        ..FacadeDesign::default()
    };
    let grid = Grid { cells: [4, 2], cell_m: vec2(4.0, 4.0), detail: 1 };
    Style { grid, finish: Finish::Corrugated, color: vec3(0.36, 0.38, 0.39), worn: 0.2, design }
}

/// Flats over shops: fibre-cement panels, French windows behind panes.
pub(super) fn mixed_use() -> Style {
    let french = |x: f32| vec![pane([x, 0.16], [1.7, 2.4], [2, 1])];
    let design = FacadeDesign {
        bays: vec![french(0.4), french(0.4), french(1.3), french(1.3)],
        stagger: 1,
        frame: DARK * 1.1,
        bar_m: 0.06,
        recess_m: 0.2,
        glass: CLEAR,
        courses: vec![course(0.0, 0.1, 0.0, vec3(0.3, 0.16, 0.07))],
        cornice_m: [0.2, 0.1],
        paints: vec![Vec3::ONE, vec3(1.6, 1.55, 1.5), vec3(0.7, 0.72, 0.78), vec3(1.2, 0.9, 0.7)],
        fixtures: Fixtures { glass_balconies: 0.7, ..Fixtures::default() },
        ..FacadeDesign::default()
    };
    let color = vec3(0.24, 0.225, 0.205);
    Style { grid: grid(3.4, 3.1), finish: Finish::Concrete([1.7, 1.55]), color, worn: 0.1, design }
}

/// Large smooth panels with narrow and wide windows at changing places.
pub(super) fn panel(color: Vec3) -> Style {
    let (narrow, wide) = ([0.72, 2.4], [1.46, 2.4]);
    let design = FacadeDesign {
        bays: vec![
            vec![pane([0.02, 0.6], wide, [2, 1])],
            vec![pane([0.77, 0.6], narrow, [1, 1])],
            vec![pane([1.52, 0.6], wide, [2, 1])],
            vec![pane([1.52, 0.6], narrow, [1, 1])],
        ],
        stagger: 1,
        frame: DARK * 1.3,
        frame_m: 0.045,
        bar_m: 0.05,
        recess_m: 0.14,
        glass: CLEAR,
        interior: Interior::Office,
        ..FacadeDesign::default()
    };
    Style { grid: grid(3.0, 3.6), finish: Finish::Metal([1.5, 1.2]), color, worn: 0.08, design }
}

/// A wooden house: painted boards, white surrounds, dark shutters.
pub(super) fn boards() -> Style {
    let design = FacadeDesign {
        bays: vec![vec![pane([0.9, 0.85], [1.0, 1.5], [1, 2])]],
        frame: WHITE_PAINT,
        recess_m: 0.08,
        glass: CLEAR,
        trim: WHITE_PAINT,
        sill_m: [0.06, 0.06],
        surround_m: [0.1, 0.025],
        shutters: Some(vec3(0.03, 0.045, 0.05)),
        paints: vec![
            Vec3::ONE,
            vec3(0.55, 0.65, 0.75),
            vec3(0.9, 0.82, 0.6),
            vec3(0.45, 0.5, 0.42),
            vec3(0.62, 0.2, 0.15),
            vec3(0.5, 0.5, 0.5),
        ],
        ..FacadeDesign::default()
    };
    Style { grid: grid(2.8, 2.9), finish: Finish::Boards, color: vec3(0.56, 0.56, 0.54), worn: 0.12, design }
}

/// Raw concrete with open bays, as in a building that goes up.
pub(super) fn carcass() -> Style {
    let design = FacadeDesign {
        bays: vec![vec![pane([0.3, 0.16], [3.4, 2.7], [1, 1])]],
        frame: STONE,
        frame_m: 0.02,
        recess_m: 0.2,
        glass: CLEAR,
        interior: Interior::Bare,
        ..FacadeDesign::default()
    };
    Style {
        grid: grid(4.0, 3.3),
        finish: Finish::Concrete([2.0, 1.65]),
        color: vec3(0.34, 0.33, 0.31),
        worn: 0.2,
        design,
    }
}
