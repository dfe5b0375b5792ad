//! Fences, walls and guard rails: a piece of each, repeated along x by who builds. A post stands at the piece's beginning,
//! and y is across; the side towards +y is the outer one.

use std::f32::consts::FRAC_PI_2;

use glam::{Quat, Vec2, Vec3, vec2, vec3};
use serde::Deserialize;
use trove_model::{Asset, Class, Kind, Material};

use super::finish::{bar, board, concrete, galvanised, grey_timber, painted, plastic, rubber, swept};
use super::plan::Finish;
use super::posters::{SIZE_M, poster};
use super::signs::face;
use crate::measure::{Wrong, ordinary, within};
use crate::shape::{Model, Shape};
use crate::surfaces::{self, Canvas, Texel, hash};

/// Pieces tagged `far` are for where a camera sees no bars.
pub(super) fn assets() -> Vec<Asset> {
    vec![
        chain_link(),
        bars(true),
        bars(false),
        wood(),
        panels(),
        hoarding(false),
        hoarding(true),
        site_fence(),
        picket(),
        railed(true),
        railed(false),
        w_beam(),
        railing("railing", galvanised(), &[]),
        railing("railing-painted", painted(GREEN), &[GREEN, vec3(0.4, 0.4, 0.39)]).tagged(["railing", "painted"]),
        parapet(),
    ]
}

/// A wall under a coping: a `[[wall]]` of a file of plans. Lengths are metres.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct WallPlan {
    /// Unique in its library.
    pub(crate) id: String,
    /// Words that say what it is.
    #[serde(default)]
    tags: Vec<String>,
    #[serde(default = "ordinary")]
    commonness: f32,
    finish: Finish,
    /// Of what can have any, linear RGB.
    #[serde(default = "white")]
    color: [f32; 3],
    height_m: f32,
    thick_m: f32,
}

fn white() -> [f32; 3] {
    [1.0; 3]
}

impl WallPlan {
    /// The key of a value that no wall can have, with what was expected and what it is.
    pub(crate) fn check(&self) -> Result<(), Wrong> {
        within("commonness", "a number from 0 to 1000", 0.0..=1000.0, [&self.commonness])?;
        within("color", "linear RGB from 0 to 1", 0.0..=1.0, &self.color)?;
        within("height_m", "metres from 0.2 to 10", 0.2..=10.0, [&self.height_m])?;
        within("thick_m", "metres from 0.02 to 2", 0.02..=2.0, [&self.thick_m])
    }
}

const GREEN: Vec3 = vec3(0.02, 0.085, 0.045);

fn fence(model: Model, name: &str) -> Asset {
    model.asset(&format!("fence/{name}"), Kind::Fence, Class::Barrier).tagged([name])
}

/// Something long from x = 0 to `length_m`.
fn rail(length_m: f32, y: f32, z: f32, size: Vec2) -> Shape {
    Shape::block(vec3(length_m, size.x, size.y)).moved(vec3(length_m / 2.0, y, z))
}

/// A standing bar, its left edge at x.
fn standing(x: f32, y: f32, low_m: f32, high_m: f32, size: Vec2) -> Shape {
    Shape::block(vec3(size.x, size.y, high_m - low_m)).moved(vec3(x + size.x / 2.0, y, (low_m + high_m) / 2.0))
}

/// Both sides of an upright sheet in the x–z plane, uvs in metres.
fn sheet(length_m: f32, y: f32, low_m: f32, high_m: f32) -> Shape {
    let corners = [vec2(0.0, low_m), vec2(length_m, low_m), vec2(length_m, high_m), vec2(0.0, high_m)];
    let front = Shape::flat(&corners).turned(Quat::from_rotation_x(FRAC_PI_2));
    front.clone().and(front.inside_out()).moved(Vec3::Y * y)
}

/// Wires that cross at right angles, upright or on their corners.
fn netting(name: &str, color: Vec3, cell: Vec2, wire_m: f32, slanting: bool) -> Material {
    let size = cell * 4.0;
    let px = (size / size.max_element() * 128.0).as_uvec2().to_array();
    let canvas = Canvas::new(px, size.to_array(), |p| {
        let q = if slanting { vec2(p.x / cell.x + p.y / cell.y, p.x / cell.x - p.y / cell.y) } else { p / cell };
        let off = (q - q.round()).abs() * if slanting { cell / std::f32::consts::SQRT_2 } else { cell };
        let alpha = if off.min_element() < wire_m / 2.0 { 1.0 } else { 0.0 };
        Texel { alpha, ..Texel::new(Vec3::ONE, 0.5) }
    });
    Material {
        base_color_map: Some(canvas.color(name)),
        alpha_cutoff: 0.4,
        metalness: 0.4,
        dirt: 0.4,
        uv_scale: 1.0 / size,
        ..Material::plain(name, color, 0.5)
    }
}

fn chain_link() -> Asset {
    let mut model = Model::default();
    let zinc = vec3(0.36, 0.37, 0.38);
    let paints = [zinc, GREEN, zinc];
    let steel = model.slot(galvanised(), &paints);
    let net = model.slot(netting("chain link", zinc, vec2(0.07, 0.07), 0.009, true), &paints);
    let length_m = 2.5;
    model.add(net, sheet(length_m, 0.025, 0.04, 1.78));
    model.add(steel, Shape::tube(&[vec3(0.03, 0.0, 0.0), vec3(0.03, 0.0, 1.85)], 0.03, 10));
    for z in [0.08, 1.76] {
        model.add(steel, Shape::tube(&[vec3(0.0, 0.0, z), vec3(length_m, 0.0, z)], 0.016, 6));
    }
    fence(model, "chain-link")
}

/// Upright bars between two rails; from afar a stripe for three of them.
fn bars(near: bool) -> Asset {
    let mut model = Model::default();
    let black = Vec3::splat(0.022);
    let paint = model.slot(painted(black), &[black, black, GREEN, vec3(0.13, 0.135, 0.14)]);
    let length_m = 2.4;
    model.add(paint, standing(0.0, 0.0, 0.0, 1.32, Vec2::splat(0.06)));
    for z in [0.14, 1.12] {
        model.add(paint, rail(length_m, 0.0, z, vec2(0.025, 0.04)));
    }
    let (count, width_m) = if near { (20, 0.018) } else { (6, 0.06) };
    for i in 1..count {
        let x = 0.02 + length_m * i as f32 / count as f32;
        model.add(paint, standing(x, 0.0, 0.08, 1.22, vec2(width_m, 0.018)));
    }
    let id = if near { "fence/bars" } else { "fence/bars-far" };
    let asset = model.asset(id, Kind::Fence, Class::Barrier).tagged(["bars"]);
    if near { asset } else { asset.tagged(["far"]) }
}

/// Boards side by side on two rails.
fn wood() -> Asset {
    let mut model = Model::default();
    let tone = Vec3::ONE;
    let boards = model.slot(grey_timber(), &[tone, vec3(0.85, 0.75, 0.65), vec3(0.6, 0.4, 0.27)]);
    let length_m = 2.0;
    model.add(boards, board(vec3(0.045, -0.05, 0.825), vec3(0.09, 0.09, 1.65)));
    for z in [0.35, 1.35] {
        model.add(boards, board(vec3(length_m / 2.0, -0.03, z), vec3(length_m, 0.04, 0.09)));
    }
    for i in 0..16 {
        let lift = 0.012 * (hash(i, 3, 5) - 0.5);
        let x = length_m * (i as f32 + 0.5) / 16.0;
        model.add(boards, board(vec3(x, 0.0, 0.885 + lift / 2.0), vec3(length_m / 16.0 - 0.008, 0.02, 1.67 + lift)));
    }
    fence(model, "wood")
}

/// Pointed boards apart from each other.
fn picket() -> Asset {
    let mut model = Model::default();
    let white = vec3(0.66, 0.65, 0.62);
    let paint = model.slot(painted(white), &[white, white, vec3(0.16, 0.11, 0.075), vec3(0.05, 0.075, 0.055)]);
    let (length_m, count) = (2.0, 16);
    model.add(paint, standing(0.0, -0.055, 0.0, 0.95, Vec2::splat(0.08)));
    for z in [0.25, 0.75] {
        model.add(paint, rail(length_m, -0.025, z, vec2(0.03, 0.07)));
    }
    for i in 0..count {
        let x = length_m * (i as f32 + 0.5) / count as f32;
        let corners = [vec2(-0.035, 0.06), vec2(0.035, 0.06), vec2(0.035, 0.93), vec2(0.0, 1.0), vec2(-0.035, 0.93)];
        model.add(paint, swept(&corners, 0.02).moved(vec3(x, 0.0, 0.0)));
    }
    fence(model, "picket")
}

/// Closed panels between posts.
fn panels() -> Asset {
    let mut model = Model::default();
    let grey = vec3(0.17, 0.175, 0.18);
    let steel = model.slot(galvanised(), &[]);
    let panel = model.slot(painted(grey), &[grey, GREEN, vec3(0.32, 0.31, 0.28)]);
    model.add(steel, standing(0.0, 0.0, 0.0, 1.85, Vec2::splat(0.07)));
    for i in 0..6 {
        model.add(panel, rail(2.4, 0.0, 0.2 + 0.29 * i as f32, vec2(0.035, 0.28)));
    }
    fence(model, "panel")
}

/// Corrugated sheets around a building site, bare or with two posters pasted on each.
fn hoarding(pasted: bool) -> Asset {
    let mut model = Model::default();
    let white = vec3(0.5, 0.5, 0.48);
    let sheet =
        model.slot(painted(white), &[white, vec3(0.03, 0.12, 0.07), vec3(0.04, 0.1, 0.24), vec3(0.38, 0.38, 0.37)]);
    let steel = model.slot(galvanised(), &[]);
    let (length_m, waves) = (2.4, 12);
    let row = |z: f32| -> Vec<Vec3> {
        let at = |i: usize| i as f32 / (4 * waves) as f32;
        let depth = |i: usize| if i % 4 < 2 { 0.0 } else { 0.025 };
        (0..=4 * waves).map(|i| vec3(length_m * at(i), depth(i), z)).collect()
    };
    let front = Shape::sheet(&[row(0.03), row(2.1)]);
    model.add(sheet, front.clone().and(front.inside_out()));
    for z in [0.12, 1.1, 2.05] {
        model.add(steel, rail(length_m, 0.045, z, vec2(0.03, 0.06)));
    }
    model.add(steel, standing(0.0, 0.07, 0.0, 2.12, Vec2::splat(0.06)));
    if !pasted {
        return fence(model, "hoarding");
    }
    let white = model.slot(painted(Vec3::splat(0.4)), &[]);
    model.add(white, rail(length_m, -0.01, 1.1, vec2(0.012, 1.9)));
    for (i, which) in [1, 3].into_iter().enumerate() {
        let sheet = face(SIZE_M).turned(Quat::from_rotation_z(-FRAC_PI_2));
        let poster = model.slot(poster(which), &[]);
        model.add(poster, sheet.moved(vec3(0.62 + 1.1 * i as f32, -0.018, 1.08)));
    }
    fence(model, "hoarding-pasted").tagged(["pasted"])
}

/// A movable steel fence on concrete feet.
fn site_fence() -> Asset {
    let mut model = Model::default();
    let steel = model.slot(galvanised(), &[]);
    let zinc = vec3(0.36, 0.37, 0.38);
    let net = model.slot(netting("wire mesh", zinc, vec2(0.1, 0.2), 0.008, false), &[]);
    let feet = model.slot(concrete(), &[]);
    let length_m = 3.5;
    model.add(net, sheet(length_m, 0.0, 0.14, 1.98));
    for x in [0.021, length_m - 0.021] {
        model.add(steel, Shape::tube(&[vec3(x, 0.0, 0.05), vec3(x, 0.0, 2.0)], 0.021, 8));
    }
    for z in [0.16, 1.98] {
        model.add(steel, Shape::tube(&[vec3(0.0, 0.0, z), vec3(length_m, 0.0, z)], 0.016, 8));
    }
    model.add(feet, bar(vec3(0.115, 0.0, 0.07), vec3(0.23, 0.7, 0.14)));
    fence(model, "site")
}

/// A wall under a coping.
pub(super) fn wall(plan: &WallPlan) -> Asset {
    let (height_m, thick_m) = (plan.height_m, plan.thick_m);
    let mut model = Model::default();
    let body = plan.finish.material(plan.color.into());
    let body = model.slot(Material { dirt: 0.8, ..body }, &[]);
    let coping = model.slot(concrete(), &[]);
    let length_m = 2.0;
    model.add(body, rail(length_m, 0.0, (height_m - 0.08) / 2.0, vec2(thick_m, height_m - 0.08)));
    let half = thick_m / 2.0 + 0.04;
    let profile = [vec2(-half, 0.0), vec2(half, 0.0), vec2(half, 0.05), vec2(0.0, 0.08), vec2(-half, 0.05)];
    model.add(coping, along_x(&profile, length_m).moved(Vec3::Z * (height_m - 0.08)));
    let asset = model.asset(&plan.id, Kind::Wall, Class::Barrier);
    Asset { commonness: plan.commonness, ..asset }.tagged(&plan.tags)
}

/// Pointed iron bars in the coping of a dwarf wall, every eighth a stronger one; from afar a stripe for three of them.
fn railed(near: bool) -> Asset {
    let mut model = Model::default();
    let body = model.slot(Material { dirt: 0.8, ..surfaces::set("brick/flemish") }, &[]);
    let coping = model.slot(concrete(), &[]);
    let black = Vec3::splat(0.02);
    let paint = model.slot(painted(black), &[black, black, black, vec3(0.015, 0.04, 0.025)]);
    let (length_m, wall_m, top_m) = (2.4, 0.5, 1.62);
    model.add(body, rail(length_m, 0.0, wall_m / 2.0, vec2(0.24, wall_m)));
    let profile =
        [vec2(-0.16, 0.0), vec2(0.16, 0.0), vec2(0.16, 0.06), vec2(0.1, 0.1), vec2(-0.1, 0.1), vec2(-0.16, 0.06)];
    model.add(coping, along_x(&profile, length_m).moved(Vec3::Z * wall_m));
    for z in [wall_m + 0.2, top_m - 0.2] {
        model.add(paint, rail(length_m, 0.0, z, vec2(0.012, 0.045)));
    }
    let (count, half_m) = if near { (20, 0.01) } else { (7, 0.026) };
    for i in 0..count {
        let strong = near && i % 8 == 0;
        let half_m = if strong { 0.016 } else { half_m };
        let x = length_m * (i as f32 + 0.5) / count as f32;
        let low_m = wall_m + 0.09;
        let bar = [vec2(-half_m, low_m), vec2(half_m, low_m), vec2(half_m, top_m), vec2(-half_m, top_m)];
        model.add(paint, swept(&bar, 2.0 * half_m).moved(Vec3::X * x));
        if near {
            let wide_m = half_m * 2.0;
            let point =
                [vec2(0.0, top_m), vec2(wide_m, top_m + 0.035), vec2(0.0, top_m + 0.13), vec2(-wide_m, top_m + 0.035)];
            model.add(paint, swept(&point, 1.2 * half_m).moved(Vec3::X * x));
        }
    }
    let id = if near { "wall/railed" } else { "wall/railed-far" };
    let asset = model.asset(id, Kind::Wall, Class::Barrier).tagged(["railed"]);
    if near { asset } else { asset.tagged(["far"]) }
}

/// A (y, z) profile, counter-clockwise seen from +x, swept from x = 0.
fn along_x(profile: &[Vec2], length_m: f32) -> Shape {
    super::finish::upright(Shape::extruded(profile, length_m))
}

fn guard_rail(model: Model, name: &str) -> Asset {
    model.asset(&format!("guard-rail/{name}"), Kind::GuardRail, Class::Barrier).tagged([name])
}

/// A W-shaped steel beam on posts; traffic runs on its −y side.
fn w_beam() -> Asset {
    let mut model = Model::default();
    let steel = model.slot(galvanised(), &[]);
    let length_m = 2.0;
    let waves = [
        (0.0, 0.45),
        (-0.05, 0.49),
        (-0.08, 0.53),
        (-0.05, 0.57),
        (-0.01, 0.605),
        (-0.05, 0.64),
        (-0.08, 0.68),
        (-0.05, 0.72),
        (0.0, 0.76),
    ];
    let front: Vec<Vec2> = waves.iter().rev().map(|&(y, z)| vec2(y, z)).collect();
    let back = front.iter().rev().map(|p| *p + vec2(0.006, 0.0));
    let profile: Vec<Vec2> = front.iter().copied().chain(back).collect();
    model.add(steel, along_x(&profile, length_m));
    model.add(steel, standing(0.0, 0.08, 0.0, 0.72, vec2(0.07, 0.12)));
    let amber = model.slot(plastic(vec3(0.6, 0.3, 0.02)), &[]);
    model.add(amber, bar(vec3(0.035, -0.02, 0.605), vec3(0.05, 0.03, 0.05)));
    guard_rail(model, "w-beam")
}

/// Tubes that keep those on foot from the road.
fn railing(name: &str, material: Material, paints: &[Vec3]) -> Asset {
    let mut model = Model::default();
    let steel = model.slot(material, paints);
    let length_m = 2.0;
    for z in [0.18, 1.02] {
        model.add(steel, Shape::tube(&[vec3(0.0, 0.0, z), vec3(length_m, 0.0, z)], 0.022, 8));
    }
    model.add(steel, Shape::tube(&[vec3(0.025, 0.0, 0.0), vec3(0.025, 0.0, 1.02)], 0.025, 8));
    for i in 1..13 {
        let x = length_m * i as f32 / 13.0;
        model.add(steel, Shape::tube(&[vec3(x, 0.0, 0.18), vec3(x, 0.0, 1.02)], 0.007, 5));
    }
    guard_rail(model, name)
}

/// A concrete parapet as on bridges.
fn parapet() -> Asset {
    let mut model = Model::default();
    let body = model.slot(concrete(), &[]);
    let dark = model.slot(rubber(), &[]);
    let length_m = 3.0;
    let profile =
        [vec2(-0.2, 0.0), vec2(0.2, 0.0), vec2(0.2, 0.86), vec2(-0.06, 0.86), vec2(-0.1, 0.3), vec2(-0.2, 0.08)];
    model.add(body, along_x(&profile, length_m));
    model.add(dark, standing(0.0, 0.0, 0.1, 0.85, vec2(0.012, 0.402)));
    guard_rail(model, "parapet")
}
