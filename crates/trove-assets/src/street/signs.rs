//! Traffic signs: a painted face that looks along x, on a grey post.

use std::f32::consts::{FRAC_PI_2, PI};

use glam::{Quat, Vec2, Vec3, vec2, vec3};
use rayon::prelude::*;
use trove_model::{Asset, Class, Kind, Lettering, Material, Role};

use super::finish::{galvanised, painted, polygon, post, rounded, rust_at_foot, upright};
use crate::shape::{Model, Shape};
use crate::surfaces::{Canvas, Noise, Texel, step};

const WHITE: Vec3 = vec3(0.66, 0.66, 0.65);
const RED: Vec3 = vec3(0.44, 0.018, 0.022);
const BLUE: Vec3 = vec3(0.018, 0.075, 0.3);
const GREEN: Vec3 = vec3(0.012, 0.13, 0.06);
const BLACK: Vec3 = vec3(0.022, 0.022, 0.022);

/// What is painted on a face: a point (metres from the face's middle) to a colour.
type Picture = Box<dyn Fn(Vec2) -> Vec3>;

/// A plate on a post.
struct Plate {
    outline: Vec<Vec2>,
    size_m: Vec2,
    /// Height of its middle.
    up_m: f32,
    picture: Picture,
}

/// Limits on round signs, in km/h or (in Britain) mph, and on America's, in mph.
const DISC_LIMITS: [u32; 14] = [5, 10, 20, 30, 40, 50, 60, 70, 80, 90, 100, 110, 120, 130];
const BOARD_LIMITS: [u32; 13] = [10, 15, 20, 25, 30, 35, 40, 45, 50, 55, 60, 65, 70];

/// Tagged `us` after the Manual on Uniform Traffic Control Devices, `vienna` after the Vienna Convention.
pub(super) fn assets() -> Vec<Asset> {
    let discs = DISC_LIMITS.par_iter().map(|limit| {
        sign(&format!("disc/speed-{limit}"), vec![disc(0.32, 2.5, speed_limit(&limit.to_string()))])
            .tagged(["vienna", &format!("speed-{limit}")])
    });
    let boards = BOARD_LIMITS.par_iter().map(|limit| {
        us(&format!("speed-{limit}"), vec![board(vec2(0.61, 0.76), 2.45, us_speed_limit(&limit.to_string()))])
    });
    #[rustfmt::skip]
    let others: [fn() -> Asset; 20] = [
        || us("stop", vec![stop()]),
        || us("yield", vec![give_way(true)]),
        || us("one-way-left", vec![board(vec2(0.91, 0.31), 2.4, us_one_way(PI))]),
        || us("one-way-right", vec![board(vec2(0.91, 0.31), 2.4, us_one_way(0.0))]),
        || us("do-not-enter", vec![board(vec2(0.76, 0.76), 2.4, do_not_enter())]),
        || us("no-parking", vec![board(vec2(0.3, 0.46), 2.3, us_no_parking())]),
        || us("crossing", vec![us_crossing()]),
        || us("bus-stop", vec![board(vec2(0.46, 0.61), 2.45, bus("BUS STOP", BLUE, WHITE))]),
        || vienna("stop", vec![stop()]),
        || vienna("give-way", vec![give_way(false)]),
        || vienna("no-entry", vec![disc(0.32, 2.5, no_entry())]),
        || vienna("no-stopping", vec![disc(0.28, 2.4, no_stopping(true))]),
        || vienna("no-parking", vec![disc(0.28, 2.4, no_stopping(false))]),
        || vienna("one-way", vec![board(vec2(0.6, 0.6), 2.45, one_way())]),
        || vienna("parking", vec![board(vec2(0.6, 0.6), 2.45, parking())]),
        || vienna("crossing", vec![board(vec2(0.6, 0.6), 2.45, crossing())]),
        || vienna("warning", vec![warning()]),
        || vienna("bus-stop", vec![board(vec2(0.4, 0.55), 2.6, bus("BUS", vec3(0.55, 0.4, 0.02), BLACK))]),
        || vienna("haltestelle", vec![disc(0.25, 2.6, haltestelle())]),
        street_name,
    ];
    let others = others.par_iter().map(|sign| sign());
    discs.chain(boards).chain(others).collect()
}

fn us(name: &str, plates: Vec<Plate>) -> Asset {
    sign(&format!("us/{name}"), plates).tagged(["us", name])
}

fn vienna(name: &str, plates: Vec<Plate>) -> Asset {
    sign(name, plates).tagged(["vienna", name])
}

fn sign(name: &str, plates: Vec<Plate>) -> Asset {
    let id = format!("sign/{name}");
    let top = |p: &Plate| p.up_m + p.outline.iter().map(|corner| corner.y).fold(0.0, f32::max);
    let top_m = plates.iter().map(top).fold(0.0, f32::max);
    let mut model = Model::default();
    let steel = model.slot(galvanised(), &[]);
    let back = model.slot(painted(Vec3::splat(0.27)), &[]);
    model.add(steel, post(Vec3::ZERO, 0.038, top_m - 0.04, 16));
    mount(&mut model, back, &id, plates, vec2(0.0, 0.055));
    rust_at_foot(&mut model, steel, 0.08);
    model.asset(&id, Kind::TrafficSign, Class::TrafficSign)
}

/// Hangs plates at (y, x).
fn mount(model: &mut Model, back: u16, id: &str, plates: Vec<Plate>, at: Vec2) {
    for (i, plate) in plates.into_iter().enumerate() {
        let name = format!("{id}-{i}");
        let canvas = weathered(plate.size_m, plate.picture);
        let material = Material {
            base_color_map: Some(canvas.color(&name)),
            dirt: 0.25,
            ..Material::plain(&name, Vec3::ONE, 0.35)
        };
        let front = model.slot(material, &[]);
        let place = vec3(at.y, at.x, plate.up_m);
        model.add(back, upright(Shape::extruded(&plate.outline, 0.004)).moved(place));
        let mut face = upright(Shape::flat(&plate.outline)).moved(place + Vec3::X * 0.0055);
        face.uvs.iter_mut().for_each(|uv| *uv = *uv / plate.size_m + 0.5);
        model.add(front, face);
        for dz in [-0.3, 0.3] {
            let clamp = Shape::block(vec3(0.06, 0.09, 0.03));
            model.add(back, clamp.moved(place + vec3(-0.03, 0.0, dz * plate.size_m.y)));
        }
    }
}

/// A face about the origin that looks along x; its uvs run from 0 to 1.
pub(super) fn face(size_m: Vec2) -> Shape {
    let half = size_m / 2.0;
    let mut shape = Shape::flat(&[-half, vec2(half.x, -half.y), half, vec2(-half.x, half.y)]);
    shape.uvs.iter_mut().for_each(|uv| *uv = *uv / size_m + 0.5);
    upright(shape)
}

/// A picture with grime and fading.
pub(super) fn weathered(size_m: Vec2, picture: Picture) -> Canvas {
    let px = (size_m / size_m.max_element() * 192.0).as_uvec2().max(glam::UVec2::splat(48));
    let grime = Noise::new(size_m, 0.2, 77);
    let texel_m = size_m / px.as_vec2() / 4.0;
    Canvas::new(px.to_array(), size_m.to_array(), move |p| {
        let p = p - size_m / 2.0;
        let spread = [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)];
        let color: Vec3 = spread.iter().map(|&(x, y)| picture(p + vec2(x, y) * texel_m)).sum::<Vec3>() / 4.0;
        Texel::new(color * (1.0 - 0.12 * step(-0.2, 0.8, grime.fbm(p + size_m, 3))), 0.35)
    })
}

fn disc(radius_m: f32, up_m: f32, picture: Picture) -> Plate {
    Plate { outline: polygon(40, radius_m, 0.0), size_m: Vec2::splat(2.0 * radius_m), up_m, picture }
}

fn board(size_m: Vec2, up_m: f32, picture: Picture) -> Plate {
    let corner_m = (0.08 * size_m.min_element()).max(0.02);
    Plate { outline: rounded(size_m, corner_m), size_m, up_m, picture }
}

pub(super) fn choose(inside: bool, yes: Vec3, no: Vec3) -> Vec3 {
    if inside { yes } else { no }
}

fn speed_limit(number: &str) -> Picture {
    let writing = Lettering::new(number);
    Box::new(move |p| {
        let r = p.length();
        let ink = writing.distance(p / vec2(0.19, 0.25)) < 0.12;
        choose(r > 0.305, WHITE, choose(r > 0.225, RED, choose(ink, BLACK, WHITE)))
    })
}

fn no_entry() -> Picture {
    Box::new(|p| choose(p.length() > 0.305 || (p.x.abs() < 0.23 && p.y.abs() < 0.05), WHITE, RED))
}

fn stop() -> Plate {
    let writing = Lettering::new("STOP");
    let picture = Box::new(move |p: Vec2| {
        // Distance from the middle across the octagon's sides.
        let across = (0..4).map(|k| p.dot(Vec2::from_angle(PI / 4.0 * k as f32)).abs()).fold(0.0, f32::max);
        let ink = writing.distance(p / vec2(0.155, 0.25)) < 0.115;
        choose(across > 0.345 || ink, WHITE, RED)
    });
    let radius = 0.375 / (PI / 8.0).cos();
    Plate { outline: polygon(8, radius, PI / 8.0), size_m: Vec2::splat(0.75), up_m: 2.4, picture }
}

/// Distance inwards from the sides of an upright triangle of a circumradius.
fn inside_triangle(p: Vec2, radius: f32, first_rad: f32) -> f32 {
    let side = |k: usize| {
        let out = Vec2::from_angle(first_rad + PI / 3.0 + 2.0 * PI / 3.0 * k as f32);
        radius / 2.0 - p.dot(out)
    };
    (0..3).map(side).fold(f32::INFINITY, f32::min)
}

fn triangle(radius: f32, first_rad: f32, picture: Picture) -> Plate {
    let outline = polygon(3, radius, first_rad);
    Plate { outline, size_m: Vec2::splat(2.0 * radius), up_m: 2.45, picture }
}

/// With a word in it or without.
fn give_way(word: bool) -> Plate {
    let first = -FRAC_PI_2;
    let (writing, rim) = (Lettering::new(if word { "YIELD" } else { "" }), if word { 0.1 } else { 0.085 });
    let picture = move |p: Vec2| {
        let depth = inside_triangle(p, 0.48, first);
        let ink = writing.distance((p - vec2(0.0, 0.09)) / 0.075) < 0.11;
        choose(depth < 0.015, WHITE, choose(depth < rim || ink, RED, WHITE))
    };
    triangle(0.48, first, Box::new(picture))
}

fn warning() -> Plate {
    let writing = Lettering::new("!");
    let first = FRAC_PI_2;
    triangle(
        0.46,
        first,
        Box::new(move |p| {
            let depth = inside_triangle(p, 0.46, first);
            let ink = writing.distance((p + vec2(0.0, 0.02)) / 0.3) < 0.11;
            choose(depth < 0.01, WHITE, choose(depth < 0.065, RED, choose(ink, BLACK, WHITE)))
        }),
    )
}

fn us_speed_limit(number: &str) -> Picture {
    let words = [("SPEED", 0.25, 0.1), ("LIMIT", 0.09, 0.1), (number, -0.16, 0.26)]
        .map(|(text, up, height)| (Lettering::new(text), up, height));
    Box::new(move |p| {
        let rim = (vec2(0.305, 0.38) - p.abs()).min_element();
        let ink =
            words.iter().any(|(w, up, height)| w.distance((p - vec2(0.0, *up)) / (vec2(0.85, 1.0) * *height)) < 0.1);
        choose(ink || (0.012..0.022).contains(&rim), BLACK, WHITE)
    })
}

/// A white arrow on black, with the words in it.
fn us_one_way(turn_rad: f32) -> Picture {
    let writing = Lettering::new("ONE WAY");
    Box::new(move |p| {
        let q = Vec2::from_angle(-turn_rad).rotate(p);
        let arrow = (q.y.abs() < 0.06 && (-0.4..0.27).contains(&q.x)) || (q.x > 0.2 && q.y.abs() < (0.41 - q.x) * 0.62);
        let ink = writing.distance((p + vec2(0.05 * turn_rad.cos(), 0.0)) / vec2(0.062, 0.075)) < 0.12;
        choose(arrow && !ink, WHITE, BLACK)
    })
}

fn do_not_enter() -> Picture {
    let words = [("DO NOT", 0.2), ("ENTER", -0.2)].map(|(text, up)| (Lettering::new(text), up));
    Box::new(move |p| {
        let bar = p.x.abs() < 0.28 && p.y.abs() < 0.055;
        let ink = words.iter().any(|(w, up)| w.distance((p - vec2(0.0, *up)) / 0.085) < 0.12);
        choose(p.length() < 0.37 && !bar && !ink, RED, WHITE)
    })
}

fn us_no_parking() -> Picture {
    let words = [("NO", 0.13), ("PARKING", 0.02)].map(|(text, up)| (Lettering::new(text), up));
    Box::new(move |p| {
        let rim = (vec2(0.15, 0.23) - p.abs()).min_element();
        let big = words[0].0.distance((p - vec2(0.0, words[0].1)) / 0.09) < 0.12;
        let small = words[1].0.distance((p - vec2(0.0, words[1].1)) / vec2(0.036, 0.055)) < 0.13;
        let arrow = p.x.abs() < 0.1 && (p.y + 0.12).abs() < 0.01
            || (0.06..0.11).contains(&p.x.abs()) && (p.y + 0.12).abs() < (0.11 - p.x.abs()) * 0.7;
        choose(big || small || arrow || (0.008..0.014).contains(&rim), RED, WHITE)
    })
}

/// Distance to someone who walks, one unit high.
fn walker(p: Vec2) -> f32 {
    const LIMBS: [[[f32; 2]; 2]; 7] = [
        [[0.0, 0.22], [0.02, -0.02]],
        [[0.02, -0.02], [0.14, -0.24]],
        [[0.14, -0.24], [0.13, -0.46]],
        [[0.02, -0.02], [-0.08, -0.24]],
        [[-0.08, -0.24], [-0.2, -0.45]],
        [[0.0, 0.2], [0.18, 0.02]],
        [[0.0, 0.2], [-0.17, 0.0]],
    ];
    let limb = |[a, b]: [[f32; 2]; 2]| {
        let (a, b) = (Vec2::from_array(a), Vec2::from_array(b));
        let t = ((p - a).dot(b - a) / (b - a).length_squared()).clamp(0.0, 1.0);
        p.distance(a.lerp(b, t)) - 0.045
    };
    LIMBS.into_iter().map(limb).fold(p.distance(vec2(0.0, 0.38)) - 0.085, f32::min)
}

/// A diamond in fluorescent yellow-green.
fn us_crossing() -> Plate {
    let green = vec3(0.4, 0.55, 0.02);
    let picture = move |p: Vec2| {
        let depth = 0.53 - p.x.abs() - p.y.abs();
        choose(walker(p / 0.6) < 0.0 || (0.02..0.04).contains(&depth), BLACK, green)
    };
    Plate { outline: polygon(4, 0.53, 0.0), size_m: Vec2::splat(1.06), up_m: 2.5, picture: Box::new(picture) }
}

/// Someone on stripes in a white triangle on blue.
fn crossing() -> Picture {
    Box::new(|p| {
        let depth = inside_triangle(p + vec2(0.0, 0.06), 0.29, FRAC_PI_2);
        let stripes = p.y < -0.12 && (p.x * 14.0).rem_euclid(1.0) < 0.5;
        let ink = walker((p + vec2(0.0, 0.015)) / 0.26) < 0.0 || stripes;
        choose(depth > 0.0, choose(ink, BLACK, WHITE), BLUE)
    })
}

/// A red ring on blue, crossed twice where nobody may even stop.
fn no_stopping(twice: bool) -> Picture {
    Box::new(move |p| {
        let r = p.length();
        let [down, up] = [(p.x + p.y).abs(), (p.x - p.y).abs()];
        let red = r > 0.215 || down < 0.04 || (twice && up < 0.04);
        choose(r > 0.27, WHITE, choose(red, RED, BLUE))
    })
}

/// A white arrow that points up on blue.
fn one_way() -> Picture {
    Box::new(|p| {
        let shaft = p.x.abs() < 0.06 && (-0.23..0.05).contains(&p.y);
        let head = (0.03..0.24).contains(&p.y) && p.x.abs() < (0.24 - p.y) * 0.8;
        let rim = (vec2(0.3, 0.3) - p.abs()).min_element();
        choose(shaft || head || (0.012..0.026).contains(&rim), WHITE, BLUE)
    })
}

/// A bus from its side over a word.
fn bus(word: &str, ground: Vec3, ink: Vec3) -> Picture {
    let writing = Lettering::new(word);
    Box::new(move |p| {
        let q = p - vec2(0.0, 0.07);
        let body = q.x.abs() < 0.15 && q.y.abs() < 0.07;
        let windows = q.x.abs() < 0.135 && (0.005..0.05).contains(&q.y) && (q.x * 22.0).rem_euclid(1.0) > 0.14;
        let wheels = vec2(q.x.abs() - 0.09, q.y + 0.075).length() < 0.028;
        let width = 0.17 / writing.width().max(1.0) * 2.0;
        let written = writing.distance((p + vec2(0.0, 0.15)) / vec2(width.min(0.07), 0.07)) < 0.12;
        choose((body && !windows) || wheels || written, ink, ground)
    })
}

/// A green H in a green ring on yellow.
fn haltestelle() -> Picture {
    let writing = Lettering::new("H");
    Box::new(move |p| {
        let ring = (0.185..0.225).contains(&p.length());
        choose(ring || writing.distance(p / 0.2) < 0.13, GREEN, vec3(0.62, 0.45, 0.01))
    })
}

/// A post with two crossing plates, blank: the builder writes on the sides of both.
fn street_name() -> Asset {
    let mut model = Model::default();
    let steel = model.slot(galvanised(), &[]);
    model.add(steel, post(Vec3::ZERO, 0.032, 2.95, 14));
    let size = vec2(0.96, 0.2);
    let plates = [(Role::NameAlongX, "along x", 2.6, FRAC_PI_2), (Role::NameAlongY, "along y", 2.82, 0.0)];
    for (role, name, up_m, turn) in plates {
        let blank = Material::plain(&format!("street name {name}"), WHITE, 0.35);
        let slot = model.slot(Material { role: Some(role), ..blank }, &[]);
        for back in [0.0, PI] {
            let side = face(size).moved(Vec3::X * 0.008).turned(Quat::from_rotation_z(turn + back));
            model.add(slot, side.moved(Vec3::Z * up_m));
        }
        let plate = Shape::block(vec3(0.015, size.x, size.y)).turned(Quat::from_rotation_z(turn));
        model.add(steel, plate.moved(Vec3::Z * up_m));
    }
    model.asset("sign/street-name", Kind::TrafficSign, Class::TrafficSign).tagged(["street-name"])
}

fn parking() -> Picture {
    let writing = Lettering::new("P");
    Box::new(move |p| {
        let rim = (vec2(0.3, 0.3) - p.abs()).min_element();
        choose(writing.distance(p / 0.38) < 0.1 || (0.012..0.028).contains(&rim), WHITE, BLUE)
    })
}
