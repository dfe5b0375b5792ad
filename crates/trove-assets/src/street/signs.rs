//! Traffic signs: a painted face that looks along x, on a grey post.

use std::f32::consts::{FRAC_PI_2, PI};

use glam::{Vec2, Vec3, vec2, vec3};
use trove_model::{Asset, Class, Kind, Lettering, Material};

use super::finish::{galvanised, painted, polygon, post, rounded, upright};

use crate::shape::{Model, Shape};
use crate::surfaces::{Canvas, Noise, Texel, hash, step};

const WHITE: Vec3 = vec3(0.66, 0.66, 0.65);
const RED: Vec3 = vec3(0.44, 0.018, 0.022);
const BLUE: Vec3 = vec3(0.018, 0.075, 0.3);
const GREEN: Vec3 = vec3(0.012, 0.13, 0.06);
const AMBER: Vec3 = vec3(0.62, 0.33, 0.015);
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

pub(super) fn assets() -> Vec<Asset> {
    vec![
        sign("sign/speed-limit", vec![disc(0.32, 2.5, speed_limit("50"))]),
        sign("sign/speed-limit-40", vec![disc(0.32, 2.5, speed_limit("40"))]),
        sign("sign/stop", vec![stop()]),
        sign("sign/give-way", vec![give_way()]),
        sign("sign/no-entry", vec![disc(0.32, 2.5, no_entry())]),
        sign("sign/parking", vec![board(vec2(0.6, 0.6), 2.45, parking())]),
        sign("sign/warning", vec![warning()]),
        sign(
            "sign/pedestrians",
            vec![
                board(vec2(0.75, 0.8), 2.35, lines(WHITE, BLACK, &["PEDESTRIANS", "USE", "CROSSING"], 0.075)),
                board(vec2(0.75, 0.2), 1.83, arrow(AMBER, BLACK, 0.0)),
            ],
        ),
        direction(),
    ]
}

fn sign(id: &str, plates: Vec<Plate>) -> Asset {
    let top = |p: &Plate| p.up_m + p.outline.iter().map(|corner| corner.y).fold(0.0, f32::max);
    let top_m = plates.iter().map(top).fold(0.0, f32::max);
    let mut model = Model::default();
    let steel = model.slot(galvanised(), &[]);
    let back = model.slot(painted(Vec3::splat(0.27)), &[]);
    model.add(steel, post(Vec3::ZERO, 0.038, top_m - 0.04, 16));
    mount(&mut model, back, id, plates, vec2(0.0, 0.055));
    model.asset(id, Kind::TrafficSign, Class::TrafficSign)
}

/// Hangs plates at (y, x).
fn mount(model: &mut Model, back: u16, id: &str, plates: Vec<Plate>, at: Vec2) {
    for (i, plate) in plates.into_iter().enumerate() {
        let name = format!("{id}-{i}");
        let canvas = weathered(plate.size_m, plate.picture);
        let material =
            Material { base_color_map: Some(canvas.color(&name)), ..Material::plain(&name, Vec3::ONE, 0.35) };
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
fn weathered(size_m: Vec2, picture: Picture) -> Canvas {
    let px = (size_m / size_m.max_element() * 256.0).as_uvec2().max(glam::UVec2::splat(64));
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

fn choose(inside: bool, yes: Vec3, no: Vec3) -> Vec3 {
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

fn give_way() -> Plate {
    let first = -FRAC_PI_2;
    triangle(
        0.48,
        first,
        Box::new(move |p| {
            let depth = inside_triangle(p, 0.48, first);
            choose(depth < 0.015, WHITE, choose(depth < 0.085, RED, WHITE))
        }),
    )
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

fn parking() -> Picture {
    let writing = Lettering::new("P");
    Box::new(move |p| {
        let rim = (vec2(0.3, 0.3) - p.abs()).min_element();
        choose(writing.distance(p / 0.38) < 0.1 || (0.012..0.028).contains(&rim), WHITE, BLUE)
    })
}

/// Lines of writing, one below the other, with a thin frame.
fn lines(ground: Vec3, ink: Vec3, text: &[&str], height_m: f32) -> Picture {
    let writings: Vec<Lettering> = text.iter().map(|t| Lettering::new(t)).collect();
    let pitch = height_m * 2.0;
    let top = pitch * (text.len() as f32 - 1.0) / 2.0;
    Box::new(move |p| {
        let written = writings
            .iter()
            .enumerate()
            .any(|(i, w)| w.distance((p - vec2(0.0, top - pitch * i as f32)) / vec2(height_m * 0.72, height_m)) < 0.11);
        choose(written, ink, ground)
    })
}

/// An arrow that points to a direction, 0 to the right.
fn arrow(ground: Vec3, ink: Vec3, turn_rad: f32) -> Picture {
    Box::new(move |p| {
        let q = Vec2::from_angle(-turn_rad).rotate(p);
        let shaft = q.x.abs() < 0.26 && q.y.abs() < 0.016;
        let head = (0.16..0.27).contains(&q.x) && (q.y.abs() - (0.27 - q.x) * 0.55).abs() < 0.018;
        choose(shaft || head, ink, ground)
    })
}

/// A large board over two posts with places and arrows.
fn direction() -> Asset {
    let mut model = Model::default();
    let steel = model.slot(galvanised(), &[]);
    let back = model.slot(painted(Vec3::splat(0.27)), &[]);
    for y in [-0.75, 0.75] {
        model.add(steel, post(vec3(0.0, y, 0.0), 0.057, 3.6, 16));
    }
    let size = vec2(2.4, 1.5);
    let words = [Lettering::new("CENTRE"), Lettering::new("HARBOUR"), Lettering::new("AIRPORT")];
    let picture = Box::new(move |p: Vec2| {
        let rim = (size / 2.0 - p.abs()).min_element();
        let rows = words.iter().enumerate().any(|(i, word)| {
            let at = vec2(0.12, 0.42 - 0.42 * i as f32);
            let turn = [FRAC_PI_2, 0.0, PI][i];
            let pointer = arrow(Vec3::ZERO, Vec3::ONE, turn)((p - vec2(-0.95, at.y)) * 1.7).x > 0.5;
            word.distance((p - at) / 0.22) < 0.085 || pointer
        });
        choose(rows || (0.02..0.045).contains(&rim), WHITE, GREEN)
    });
    mount(&mut model, back, "sign/direction", vec![board(size, 2.85, picture)], vec2(0.0, 0.08));
    model.asset("sign/direction", Kind::TrafficSign, Class::TrafficSign)
}

/// An advertisement with no words in it.
pub(super) fn poster() -> Material {
    let size = vec2(0.95, 1.75);
    let picture = Box::new(move |p: Vec2| {
        let q = p / size + 0.5;
        let sky = vec3(0.5, 0.32, 0.16).lerp(vec3(0.08, 0.2, 0.36), q.y);
        let sun = q.distance(vec2(0.65, 0.62)) < 0.16;
        let hill = q.y < 0.3 + 0.1 * (q.x * 7.0).sin() + 0.05 * (q.x * 17.0).sin();
        let words = (0.84..0.93).contains(&q.y) && hash((q.x * 14.0) as i32, 1, 3) > 0.25 && q.x > 0.1 && q.x < 0.8;
        choose(words, WHITE, choose(hill, vec3(0.04, 0.09, 0.07), choose(sun, vec3(0.6, 0.45, 0.2), sky)))
    });
    let canvas = weathered(size, picture);
    Material { base_color_map: Some(canvas.color("poster")), ..Material::plain("poster", Vec3::ONE, 0.25) }
}
