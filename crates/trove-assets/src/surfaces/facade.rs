//! Upper storeys: a wall, and in every bay and storey its windows, no two alike.

use glam::{Vec2, Vec3, vec2, vec3};
use trove_model::{Random, Seed};

use super::canvas::{Canvas, Texel};
use super::noise::step;
use super::opening::{Dress, Window, slab, streaks, tinted, window};
use super::wall::{Grid, brick, corrugated, panels, plaster, weather};

/// A facade's texture and its grid.
pub(super) type Facade = (Canvas, Grid);

const STONE: Vec3 = vec3(0.36, 0.34, 0.3);
const WHITE_PAINT: Vec3 = vec3(0.62, 0.62, 0.6);
const CLEAR: Vec3 = vec3(0.85, 0.95, 0.95);

fn grid(bay_m: f32, storey_m: f32) -> Grid {
    Grid { cells: [4, 4], cell_m: vec2(bay_m, storey_m) }
}

/// Calls a painter for every cell with random numbers of its own.
pub(super) fn each(
    canvas: &mut Canvas,
    grid: Grid,
    seed: u32,
    mut paint: impl FnMut(&mut Canvas, u64, Vec2, &mut Random),
) {
    for (i, corner) in grid.corners() {
        let mut random = Seed(u64::from(seed)).child("cell").nth(i).random();
        paint(canvas, i, corner, &mut random);
    }
}

/// A punched window in the middle of the cell, `up_m` above the floor, with a sill.
fn punched(canvas: &mut Canvas, corner: Vec2, cell_m: Vec2, up_m: f32, make: &Window, sill: Vec3, random: &mut Random) {
    let low = corner + vec2((cell_m.x - make.size_m.x) / 2.0, up_m);
    window(canvas, low, make, random);
    slab(canvas, low - vec2(0.08, 0.1), low + vec2(make.size_m.x + 0.08, 0.0), sill, 0.05, 3);
    streaks(canvas, low - vec2(0.08, 0.1), make.size_m.x + 0.16, up_m - 0.1, random);
}

/// Terraced houses of brick with sash windows.
pub(super) fn brick_row(color: Vec3, seed: u32) -> Facade {
    let grid = grid(2.9, 3.1);
    let mut canvas = brick(grid, color, vec3(0.3, 0.28, 0.25), seed);
    weather(&mut canvas, 0.18, seed);
    let make = Window {
        size_m: vec2(1.15, 1.75),
        panes: [2, 2],
        frame: WHITE_PAINT,
        frame_m: 0.07,
        bar_m: 0.035,
        recess_m: 0.1,
        glass: CLEAR,
        dress: Dress::Home,
    };
    each(&mut canvas, grid, seed, |canvas, _, corner, random| {
        punched(canvas, corner, grid.cell_m, 0.8, &make, STONE, random);
        let low = corner + vec2((grid.cell_m.x - 1.15) / 2.0, 0.8);
        slab(canvas, low + vec2(-0.12, 1.75), low + vec2(1.27, 1.98), STONE, 0.015, 4);
        // The meeting rail of the sashes.
        canvas.rect(low + vec2(0.0, 0.84), low + vec2(1.15, 0.92), |_, texel| {
            *texel = Texel { height_m: -0.06, ..Texel::new(WHITE_PAINT * 0.9, 0.55) };
        });
    });
    (canvas, grid)
}

/// An old mill: piers of brick, wide steel windows of many panes.
pub(super) fn brick_mill(seed: u32) -> Facade {
    let grid = grid(3.4, 3.9);
    let mut canvas = brick(grid, vec3(0.21, 0.095, 0.065), vec3(0.24, 0.21, 0.18), seed);
    weather(&mut canvas, 0.25, seed);
    let make = Window {
        size_m: vec2(2.3, 2.5),
        panes: [5, 6],
        frame: vec3(0.05, 0.06, 0.06),
        frame_m: 0.05,
        bar_m: 0.035,
        recess_m: 0.16,
        glass: CLEAR,
        dress: Dress::Office,
    };
    each(&mut canvas, grid, seed, |canvas, _, corner, random| {
        punched(canvas, corner, grid.cell_m, 0.8, &make, vec3(0.26, 0.24, 0.21), random);
        // Header bricks on end over the opening.
        let low = corner + vec2(0.45, 3.3);
        canvas.rect(low, low + vec2(2.5, 0.24), |p, texel| {
            let brick = (p.x / 0.078).fract();
            let tone = 0.8 + 0.4 * super::noise::hash((p.x / 0.078) as i32, 0, seed);
            *texel = Texel { height_m: 0.004, ..Texel::new(vec3(0.19, 0.085, 0.06) * tone, 0.88) };
            texel.tint(vec3(0.24, 0.21, 0.18), 0.8 * step(0.1, 0.04, brick.min(1.0 - brick)));
        });
        // Piers stand out between the bays.
        canvas.rect(corner - vec2(0.28, 0.0), corner + vec2(0.28, grid.cell_m.y), |p, texel| {
            texel.height_m += 0.1;
            texel.albedo *= 0.93 + 0.1 * step(0.0, 0.03, p.x);
        });
        canvas.rect(corner + vec2(0.28, 0.0), corner + vec2(0.34, grid.cell_m.y), |_, texel| texel.albedo *= 0.75);
    });
    (canvas, grid)
}

/// Painted plaster with shutters, some of them closed.
pub(super) fn plaster_shutters(color: Vec3, shutter: Vec3, seed: u32) -> Facade {
    let grid = grid(3.0, 3.2);
    let mut canvas = plaster(grid, color, seed);
    weather(&mut canvas, 0.14, seed);
    let make = Window {
        size_m: vec2(1.0, 1.7),
        panes: [2, 3],
        frame: WHITE_PAINT,
        frame_m: 0.06,
        bar_m: 0.03,
        recess_m: 0.16,
        glass: CLEAR,
        dress: Dress::Home,
    };
    each(&mut canvas, grid, seed, |canvas, _, corner, random| {
        let low = corner + vec2(1.0, 0.75);
        slab(canvas, low - 0.12, low + vec2(1.12, 1.84), color.lerp(WHITE_PAINT, 0.6), 0.015, 6);
        punched(canvas, corner, grid.cell_m, 0.75, &make, STONE, random);
        let closed = random.chance(0.15);
        let sides = if closed { [0.0, 0.5] } else { [-0.56, 1.06] };
        for x in sides {
            louvres(canvas, low + vec2(x, 0.0), vec2(0.5, 1.7), shutter);
        }
    });
    (canvas, grid)
}

/// A leaf of a shutter.
fn louvres(canvas: &mut Canvas, low: Vec2, size: Vec2, color: Vec3) {
    canvas.rect(low - vec2(0.0, 0.05), low, |_, texel| texel.albedo *= 0.6);
    canvas.rect(low, low + size, |p, texel| {
        let rim = p.min(size - p).min_element() < 0.055;
        let slat = (p.y / 0.06).fract();
        *texel = Texel::new(color * if rim { 1.0 } else { 0.55 + 0.5 * slat }, 0.6);
        texel.height_m = if rim { 0.05 } else { 0.025 + 0.02 * slat };
    });
}

/// Pale brick, stone surrounds, a cornice on every floor.
pub(super) fn victorian(seed: u32) -> Facade {
    let grid = grid(2.7, 3.6);
    let mut canvas = brick(grid, vec3(0.27, 0.2, 0.125), vec3(0.3, 0.28, 0.25), seed);
    weather(&mut canvas, 0.28, seed);
    let make = Window {
        size_m: vec2(1.05, 2.1),
        panes: [1, 2],
        frame: WHITE_PAINT,
        frame_m: 0.08,
        bar_m: 0.06,
        recess_m: 0.14,
        glass: CLEAR,
        dress: Dress::Home,
    };
    each(&mut canvas, grid, seed, |canvas, _, corner, random| {
        let low = corner + vec2((grid.cell_m.x - 1.05) / 2.0, 0.75);
        slab(canvas, low - vec2(0.16, 0.0), low + vec2(1.21, 2.3), STONE * 1.1, 0.03, 5);
        slab(canvas, low + vec2(-0.28, 2.3), low + vec2(1.33, 2.46), STONE * 1.15, 0.12, 5);
        slab(canvas, low + vec2(0.4, 2.08), low + vec2(0.65, 2.34), STONE * 1.2, 0.08, 5);
        punched(canvas, corner, grid.cell_m, 0.75, &make, STONE * 1.1, random);
        slab(canvas, corner, corner + vec2(grid.cell_m.x, 0.16), STONE, 0.07, 5);
        slab(canvas, corner + vec2(0.0, 0.16), corner + vec2(grid.cell_m.x, 0.26), STONE * 1.1, 0.12, 5);
    });
    (canvas, grid)
}

/// A curtain wall: two panes a bay, an opaque band at every floor.
pub(super) fn curtain_wall(glass: Vec3, band: Vec3, fin: Vec3, seed: u32) -> Facade {
    let grid = grid(3.0, 3.8);
    let mut canvas = panels(grid, band, vec2(1.5, 3.8), 0.3, seed);
    canvas.all(|_, texel| texel.roughness = 0.12);
    each(&mut canvas, grid, seed, |canvas, _, corner, random| {
        let shared = random.range(0.8, 1.1) as f32;
        for x in [0.0, 1.5] {
            let make = tinted(glass * shared * random.range(0.9, 1.1) as f32, 0.02, vec2(1.5, 2.75));
            window(canvas, corner + vec2(x, 0.95), &make, random);
        }
        for x in [0.0, 1.5] {
            slab(canvas, corner + vec2(x - 0.03, 0.0), corner + vec2(x + 0.03, grid.cell_m.y), fin, 0.08, 8);
        }
        for y in [0.0, 0.92] {
            slab(canvas, corner + vec2(0.0, y), corner + vec2(grid.cell_m.x, y + 0.06), fin, 0.05, 8);
        }
    });
    canvas.all(|_, texel| {
        if texel.height_m > 0.03 {
            texel.roughness = 0.4;
        }
    });
    (canvas, grid)
}

/// Concrete with a ribbon of windows on every floor.
pub(super) fn ribbon(seed: u32) -> Facade {
    let grid = grid(3.0, 3.6);
    let mut canvas = panels(grid, vec3(0.33, 0.32, 0.295), vec2(3.0, 3.6), 0.86, seed);
    weather(&mut canvas, 0.2, seed);
    each(&mut canvas, grid, seed, |canvas, _, corner, random| {
        for x in [0.0, 1.5] {
            let make = Window {
                frame: vec3(0.09, 0.085, 0.08),
                frame_m: 0.04,
                panes: [1, 2],
                bar_m: 0.05,
                ..tinted(CLEAR * 0.9, 0.2, vec2(1.5, 1.8))
            };
            window(canvas, corner + vec2(x, 1.0), &make, random);
        }
        slab(canvas, corner + vec2(0.0, 0.93), corner + vec2(grid.cell_m.x, 1.0), vec3(0.36, 0.35, 0.33), 0.05, 2);
        streaks(canvas, corner + vec2(0.0, 0.93), grid.cell_m.x, 0.9, random);
    });
    (canvas, grid)
}

/// A slab block of flats: painted concrete, wide windows, air conditioners, a band of colour.
pub(super) fn slab_block(band: Vec3, seed: u32) -> Facade {
    let grid = grid(3.2, 2.8);
    let wall = vec3(0.5, 0.49, 0.45);
    let mut canvas = plaster(grid, wall, seed);
    weather(&mut canvas, 0.25, seed);
    let make = Window {
        size_m: vec2(1.9, 1.35),
        panes: [3, 1],
        frame: vec3(0.3, 0.3, 0.29),
        frame_m: 0.05,
        bar_m: 0.05,
        recess_m: 0.14,
        glass: vec3(0.8, 0.92, 0.95),
        dress: Dress::Home,
    };
    each(&mut canvas, grid, seed, |canvas, i, corner, random| {
        canvas.rect(corner + vec2(0.0, 0.0), corner + vec2(grid.cell_m.x, 0.85), |p, texel| {
            texel.tint(band, 0.9);
            texel.albedo *= 1.0 - 0.15 * step(0.75, 0.85, p.y);
        });
        punched(canvas, corner, grid.cell_m, 0.95, &make, wall * 0.95, random);
        slab(canvas, corner + vec2(0.45, 2.3), corner + vec2(2.75, 2.42), wall, 0.3, 2);
        slab(canvas, corner, corner + vec2(grid.cell_m.x, 0.08), wall * 0.9, 0.06, 2);
        if random.chance(0.55) {
            let low = corner + vec2(random.range(0.5, 1.9) as f32, 0.15);
            slab(canvas, low - vec2(0.05, 0.06), low + vec2(0.9, 0.0), wall * 0.7, 0.25, 2);
            condenser(canvas, low);
        }
        if i % 2 == 0 {
            slab(canvas, corner + vec2(0.08, 0.0), corner + vec2(0.2, grid.cell_m.y), wall * 0.92, 0.08, 2);
        }
    });
    (canvas, grid)
}

/// The outside half of an air conditioner.
fn condenser(canvas: &mut Canvas, low: Vec2) {
    canvas.rect(low, low + vec2(0.8, 0.56), |p, texel| {
        let radius = p.distance(vec2(0.3, 0.28));
        let grille = radius < 0.22;
        let ring = 0.6 + 0.4 * (radius * 160.0).sin();
        *texel = Texel::new(Vec3::splat(if grille { 0.1 * ring } else { 0.5 }), 0.6);
        texel.height_m = if grille { 0.24 } else { 0.28 };
    });
}

/// A grid of deep frames with a full window in each.
pub(super) fn hotel(color: Vec3, seed: u32) -> Facade {
    let grid = grid(3.3, 3.2);
    let mut canvas = plaster(grid, color, seed);
    weather(&mut canvas, 0.12, seed);
    let make = Window {
        size_m: vec2(2.7, 2.55),
        panes: [2, 1],
        frame: vec3(0.1, 0.1, 0.1),
        frame_m: 0.05,
        bar_m: 0.06,
        recess_m: 0.35,
        glass: vec3(0.75, 0.85, 0.88),
        dress: Dress::Home,
    };
    each(&mut canvas, grid, seed, |canvas, i, corner, random| {
        let low = corner + vec2(0.3, 0.3);
        window(canvas, low, &make, random);
        // A solid panel beside the glass, left and right in turn.
        let x = if (i / 4) % 2 == 0 { 0.0 } else { 1.8 };
        let panel = vec3(0.26, 0.19, 0.125);
        canvas.rect(low + vec2(x, 0.0), low + vec2(x + 0.9, 2.55), |p, texel| {
            let groove = step(0.02, 0.008, ((p.x / 0.15).fract() - 0.5).abs() * 0.15);
            *texel = Texel::new(panel * (1.0 - 0.5 * groove) * (0.6 + 0.4 * step(2.55, 2.2, p.y)), 0.6);
            texel.height_m = -0.3;
        });
    });
    (canvas, grid)
}

/// A shed of corrugated metal with a strip of windows now and then.
pub(super) fn warehouse(color: Vec3, seed: u32) -> Facade {
    let grid = Grid { cells: [4, 2], cell_m: vec2(4.0, 4.0) };
    let mut canvas = corrugated(grid, color, seed);
    weather(&mut canvas, 0.2, seed);
    let make = Window {
        size_m: vec2(3.2, 0.9),
        panes: [4, 1],
        frame: vec3(0.3, 0.3, 0.3),
        frame_m: 0.05,
        bar_m: 0.05,
        recess_m: 0.05,
        glass: CLEAR,
        dress: Dress::Bare,
    };
    each(&mut canvas, grid, seed, |canvas, i, corner, random| {
        if i % 2 == 0 {
            window(canvas, corner + vec2(0.4, 2.4), &make, random);
            streaks(canvas, corner + vec2(0.4, 2.4), 3.2, 1.5, random);
        }
    });
    (canvas, grid)
}

/// Flats over shops: fibre-cement panels, French windows behind glass balustrades.
pub(super) fn mixed_use(seed: u32) -> Facade {
    let grid = grid(3.4, 3.1);
    let mut canvas = panels(grid, vec3(0.24, 0.225, 0.205), vec2(1.7, 1.55), 0.75, seed);
    weather(&mut canvas, 0.1, seed);
    let make = Window {
        size_m: vec2(1.7, 2.3),
        panes: [2, 1],
        frame: vec3(0.07, 0.07, 0.075),
        frame_m: 0.06,
        bar_m: 0.06,
        recess_m: 0.2,
        glass: CLEAR,
        dress: Dress::Home,
    };
    let accent = vec3(0.3, 0.16, 0.07);
    each(&mut canvas, grid, seed, |canvas, i, corner, random| {
        let low = corner + vec2(if i % 4 < 2 { 0.4 } else { 1.3 }, 0.3);
        window(canvas, low, &make, random);
        // Balustrade.
        canvas.rect(low, low + vec2(1.7, 1.0), |p, texel| {
            texel.tint(vec3(0.16, 0.19, 0.19), 0.35);
            if p.y > 0.95 || (p.x - 0.85).abs() > 0.82 {
                *texel = Texel { height_m: 0.06, ..Texel::new(Vec3::splat(0.3), 0.35) };
            }
        });
        let x = if i % 4 < 2 { 2.25 } else { 0.35 };
        canvas.rect(corner + vec2(x, 0.3), corner + vec2(x + 0.75, 2.6), |p, texel| {
            let board = (p.y / 0.12).fract();
            *texel = Texel::new(accent * (0.85 + 0.2 * super::noise::hash((p.y / 0.12) as i32, i as i32, seed)), 0.7);
            texel.albedo *= 1.0 - 0.5 * step(0.1, 0.03, board);
            texel.height_m = -0.01 * step(0.1, 0.03, board);
        });
    });
    (canvas, grid)
}

/// Large smooth panels with narrow windows at changing places.
pub(super) fn panel(color: Vec3, roughness: f32, seed: u32) -> Facade {
    let grid = grid(3.0, 3.6);
    let mut canvas = panels(grid, color, vec2(1.5, 1.2), roughness, seed);
    weather(&mut canvas, 0.08, seed);
    each(&mut canvas, grid, seed, |canvas, _, corner, random| {
        let wide = random.chance(0.5);
        let make = Window {
            frame: vec3(0.08, 0.08, 0.085),
            frame_m: 0.045,
            panes: [if wide { 2 } else { 1 }, 1],
            bar_m: 0.05,
            ..tinted(CLEAR, 0.12, vec2(if wide { 1.5 } else { 0.75 }, 2.4))
        };
        let x = [0.0, 0.75, 1.5][random.index(3)];
        window(canvas, corner + vec2(x, 0.6), &make, random);
    });
    (canvas, grid)
}
