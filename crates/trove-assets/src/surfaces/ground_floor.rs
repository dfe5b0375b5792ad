//! Ground floors: shops, entrances, loading bays.

use glam::{Vec2, Vec3, vec2, vec3};
use trove_model::Random;

use super::canvas::{Canvas, Texel};
use super::facade::{Facade, each};
use super::noise::{hash, step};
use super::opening::{Dress, Window, slab, streaks, tinted, window};
use super::wall::{Grid, brick, corrugated, panels, plaster, weather};

const CLEAR: Vec3 = vec3(0.9, 0.97, 0.95);
const DARK: Vec3 = vec3(0.06, 0.06, 0.065);

fn grid(bay_m: f32, storey_m: f32) -> Grid {
    Grid { cells: [4, 1], cell_m: vec2(bay_m, storey_m) }
}

fn pane(size_m: Vec2, panes: [u32; 2], frame: Vec3, dress: Dress) -> Window {
    Window { size_m, panes, frame, frame_m: 0.06, bar_m: 0.05, recess_m: 0.15, glass: CLEAR, dress }
}

/// A door with a panel or a pane.
fn door(canvas: &mut Canvas, low: Vec2, size: Vec2, color: Vec3, glazed: bool, random: &mut Random) {
    if glazed {
        window(canvas, low, &Window { recess_m: 0.18, ..pane(size, [1, 1], color, Dress::Bare) }, random);
    } else {
        canvas.rect(low, low + size, |p, texel| {
            let q = vec2((p.x / size.x * 2.0).fract(), (p.y / size.y * 3.0).fract());
            let sunk = q.min(1.0 - q).min_element() > 0.18;
            let shade = 0.6 + 0.4 * step(0.0, 0.2, size.y - p.y);
            *texel = Texel::new(color * shade * if sunk { 0.88 } else { 1.0 }, 0.45);
            texel.height_m = if sunk { -0.135 } else { -0.12 };
        });
    }
    let knob = low + vec2(size.x - 0.12, 1.0);
    canvas.rect(knob, knob + vec2(0.04, 0.25), |_, texel| *texel = Texel::new(Vec3::splat(0.5), 0.3));
}

/// Words that nobody can read, on a shop's sign.
fn lettering(canvas: &mut Canvas, low: Vec2, size: Vec2, color: Vec3, random: &mut Random) {
    let seed = random.bits() as u32;
    canvas.rect(low, low + size, |p, texel| {
        let q = vec2(p.x / size.y / 0.62, p.y / size.y);
        let (letter, u) = (q.x as i32, q.x.fract());
        let stroke = hash((u * 3.2) as i32, (q.y * 3.0) as i32 + 8 * letter, seed) > 0.42;
        if u < 0.8 && stroke && hash(letter, 99, seed) > 0.12 {
            texel.albedo = color;
        }
    });
}

/// A row of shops, a bay each, with sign bands of their own colours and awnings here and there.
pub(super) fn shops(seed: u32) -> Facade {
    let grid = grid(4.0, 4.2);
    let mut canvas = plaster(grid, vec3(0.34, 0.32, 0.29), seed);
    weather(&mut canvas, 0.2, seed);
    let signs = [vec3(0.3, 0.03, 0.03), vec3(0.03, 0.1, 0.22), vec3(0.03, 0.14, 0.07), vec3(0.4, 0.26, 0.03)];
    each(&mut canvas, grid, seed, |canvas, i, corner, random| {
        let frame = if i % 2 == 0 { DARK } else { vec3(0.45, 0.45, 0.44) };
        window(canvas, corner + vec2(0.3, 0.45), &pane(vec2(2.2, 2.45), [2, 1], frame, Dress::Shop), random);
        door(canvas, corner + vec2(2.6, 0.05), vec2(1.05, 2.35), frame, true, random);
        window(canvas, corner + vec2(2.6, 2.4), &pane(vec2(1.05, 0.5), [1, 1], frame, Dress::Bare), random);
        slab(canvas, corner + vec2(0.3, 0.05), corner + vec2(2.5, 0.45), frame * 1.1, 0.0, 1);
        let (low, high) = (corner + vec2(0.2, 3.0), corner + vec2(3.8, 3.7));
        slab(canvas, low, high, signs[i as usize % 4], 0.12, 1);
        lettering(
            canvas,
            low + vec2(0.4, 0.17),
            vec2(random.range(1.6, 2.8) as f32, 0.36),
            vec3(0.6, 0.58, 0.5),
            random,
        );
        slab(canvas, corner + vec2(0.0, 3.95), corner + vec2(4.0, 4.2), vec3(0.38, 0.36, 0.33), 0.1, 1);
    });
    (canvas, grid)
}

/// Brick with doors up a step between windows.
pub(super) fn entrances(color: Vec3, seed: u32) -> Facade {
    let grid = grid(2.9, 3.4);
    let mut canvas = brick(grid, color, vec3(0.3, 0.28, 0.25), seed);
    weather(&mut canvas, 0.2, seed);
    let stone = vec3(0.36, 0.34, 0.3);
    let doors = [vec3(0.02, 0.05, 0.12), vec3(0.2, 0.02, 0.02), vec3(0.02, 0.08, 0.04), vec3(0.03, 0.03, 0.03)];
    each(&mut canvas, grid, seed, |canvas, i, corner, random| {
        if i % 2 == 0 {
            slab(canvas, corner + vec2(0.78, 0.0), corner + vec2(2.12, 2.95), stone, 0.0, 1);
            door(canvas, corner + vec2(0.95, 0.15), vec2(1.0, 2.1), doors[i as usize % 4], false, random);
            let over = Window { recess_m: 0.12, ..pane(vec2(1.0, 0.42), [3, 1], Vec3::splat(0.6), Dress::Home) };
            window(canvas, corner + vec2(0.95, 2.3), &over, random);
        } else {
            let make = pane(vec2(1.2, 1.8), [2, 2], Vec3::splat(0.6), Dress::Home);
            window(canvas, corner + vec2(0.85, 0.9), &make, random);
            slab(canvas, corner + vec2(0.77, 0.8), corner + vec2(2.13, 0.9), stone, 0.05, 1);
            streaks(canvas, corner + vec2(0.77, 0.8), 1.36, 0.7, random);
            slab(canvas, corner + vec2(0.73, 2.7), corner + vec2(2.17, 2.93), stone, 0.015, 1);
        }
        slab(canvas, corner, corner + vec2(grid.cell_m.x, 0.12), stone * 0.8, 0.0, 1);
    });
    (canvas, grid)
}

/// Roller doors with bumpers, a side door, hazard stripes.
pub(super) fn loading(seed: u32) -> Facade {
    let grid = grid(4.5, 5.0);
    let mut canvas = corrugated(grid, vec3(0.33, 0.35, 0.36), seed);
    weather(&mut canvas, 0.25, seed);
    each(&mut canvas, grid, seed, |canvas, i, corner, random| {
        if i == 2 {
            door(canvas, corner + vec2(1.6, 0.05), vec2(1.0, 2.1), vec3(0.1, 0.14, 0.2), false, random);
            let make = pane(vec2(1.4, 0.9), [2, 1], Vec3::splat(0.3), Dress::Office);
            window(canvas, corner + vec2(2.9, 1.2), &make, random);
        } else {
            slab(canvas, corner + vec2(0.5, 0.0), corner + vec2(4.0, 4.1), vec3(0.2, 0.2, 0.2), 0.0, 1);
            let tone = random.range(0.85, 1.15) as f32;
            canvas.rect(corner + vec2(0.65, 0.0), corner + vec2(3.85, 3.95), |p, texel| {
                let slat = (p.y / 0.11).fract();
                *texel = Texel::new(vec3(0.4, 0.4, 0.38) * tone * (0.75 + 0.3 * slat), 0.5);
                texel.albedo *= 0.6 + 0.4 * step(3.95, 3.6, p.y) - 0.2 * step(0.8, 0.0, p.y);
                texel.height_m = -0.1 + 0.015 * (slat * std::f32::consts::PI).sin();
            });
            for x in [0.5, 3.85] {
                canvas.rect(corner + vec2(x, 0.0), corner + vec2(x + 0.15, 1.2), |p, texel| {
                    let stripe = ((p.x + p.y) / 0.25).fract() < 0.5;
                    texel.albedo = if stripe { vec3(0.5, 0.36, 0.02) } else { Vec3::splat(0.03) };
                });
            }
        }
    });
    (canvas, grid)
}

/// Columns before a deep, dark walk with shop windows at its back.
pub(super) fn arcade(seed: u32) -> Facade {
    let grid = grid(3.6, 4.0);
    let mut canvas = plaster(grid, vec3(0.42, 0.4, 0.36), seed);
    weather(&mut canvas, 0.22, seed);
    each(&mut canvas, grid, seed, |canvas, _, corner, random| {
        let make = Window { recess_m: 0.6, ..pane(vec2(3.0, 3.3), [3, 1], DARK, Dress::Shop) };
        window(canvas, corner + vec2(0.3, 0.0), &make, random);
        // It is dark under the storey above, darkest at the top.
        canvas.rect(corner + vec2(0.3, 0.0), corner + vec2(3.3, 3.3), |p, texel| {
            texel.albedo *= 0.75 - 0.5 * step(1.5, 3.3, p.y);
            texel.roughness = texel.roughness.max(0.15);
        });
        slab(canvas, corner + vec2(-0.36, 0.0), corner + vec2(0.36, 0.3), vec3(0.25, 0.24, 0.22), 0.0, 1);
        slab(canvas, corner + vec2(-0.4, 3.1), corner + vec2(0.4, 3.28), vec3(0.42, 0.4, 0.37), 0.08, 1);
        slab(canvas, corner + vec2(0.0, 3.8), corner + vec2(3.6, 4.0), vec3(0.42, 0.4, 0.37), 0.1, 1);
    });
    (canvas, grid)
}

/// An office's lobby: tall glass in metal, doors in every second bay.
pub(super) fn lobby(seed: u32) -> Facade {
    let grid = grid(3.0, 4.5);
    let mut canvas = panels(grid, vec3(0.22, 0.22, 0.23), vec2(1.5, 0.75), 0.35, seed);
    each(&mut canvas, grid, seed, |canvas, i, corner, random| {
        for x in [0.05, 1.5] {
            let make = Window { panes: [1, 2], bar_m: 0.05, ..tinted(CLEAR * 1.3, 0.12, vec2(1.45, 3.6)) };
            window(canvas, corner + vec2(x, 0.1), &make, random);
            if i % 2 == 1 {
                door(canvas, corner + vec2(x + 0.15, 0.05), vec2(1.15, 2.4), vec3(0.3, 0.3, 0.3), true, random);
            }
        }
        slab(canvas, corner + vec2(0.0, 3.7), corner + vec2(3.0, 3.95), vec3(0.3, 0.3, 0.31), 0.2, 1);
    });
    (canvas, grid)
}
