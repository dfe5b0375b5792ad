//! Advertisements, with no words in them.

use std::f32::consts::PI;

use glam::{Vec2, Vec3, vec2, vec3};
use trove_model::Material;

use super::signs::{choose, weathered};
use crate::surfaces::hash;

/// How many there are.
pub(super) const POSTERS: u32 = 5;
/// Their width and height, metres.
pub(super) const SIZE_M: Vec2 = vec2(0.95, 1.75);

const WHITE: Vec3 = vec3(0.7, 0.7, 0.68);

/// Ground below and above, what is pictured, and its accent, linear RGB.
const COLORS: [[Vec3; 4]; POSTERS as usize] = [
    [vec3(0.5, 0.32, 0.16), vec3(0.08, 0.2, 0.36), vec3(0.04, 0.09, 0.07), vec3(0.6, 0.45, 0.2)],
    [vec3(0.55, 0.05, 0.04), vec3(0.45, 0.03, 0.05), vec3(0.62, 0.6, 0.55), vec3(0.03, 0.03, 0.03)],
    [vec3(0.6, 0.5, 0.06), vec3(0.62, 0.55, 0.12), vec3(0.03, 0.03, 0.035), vec3(0.5, 0.06, 0.05)],
    [vec3(0.02, 0.025, 0.05), vec3(0.05, 0.03, 0.1), vec3(0.4, 0.1, 0.35), vec3(0.1, 0.4, 0.45)],
    [vec3(0.62, 0.6, 0.56), vec3(0.5, 0.55, 0.58), vec3(0.05, 0.2, 0.12), vec3(0.55, 0.25, 0.04)],
];

/// One of them; a sheet whose uvs run from 0 to 1 is covered by it.
pub(super) fn poster(which: u32) -> Material {
    let which = which % POSTERS;
    let [low, high, thing, accent] = COLORS[which as usize];
    let picture = Box::new(move |p: Vec2| {
        let q = p / SIZE_M + 0.5;
        let from_middle = (q - vec2(0.5, 0.5)) * vec2(1.0, SIZE_M.y / SIZE_M.x);
        let (is_thing, is_accent) = match which {
            // A landscape, a bottle, stripes, a stage's beams, a plant.
            0 => (q.y < 0.3 + 0.1 * (q.x * 7.0).sin() + 0.05 * (q.x * 17.0).sin(), q.distance(vec2(0.65, 0.62)) < 0.16),
            1 => {
                let half = if from_middle.y < 0.15 { 0.16 } else { 0.05 };
                let is_thing = from_middle.x.abs() < half && from_middle.y.abs() < 0.5;
                (is_thing, is_thing && (-0.25..0.0).contains(&from_middle.y))
            }
            2 => (((q.x + q.y) * 6.0).fract() < 0.35 && q.y < 0.7, from_middle.length() < 0.24),
            3 => {
                let angle = (vec2(q.x - 0.5, 1.1 - q.y)).to_angle();
                ((angle * 9.0 / PI).fract() < 0.4 && q.y > 0.25, q.y < 0.25 && (q.x * 9.0).sin() > 4.0 * q.y - 0.6)
            }
            _ => {
                let stalk = from_middle.x.abs() < 0.02 && (-0.5..0.1).contains(&from_middle.y);
                let leaf = (from_middle - vec2(0.0, 0.1)).length() < 0.3 + 0.06 * (from_middle.to_angle() * 7.0).sin();
                (stalk || leaf, from_middle.length() < 0.14)
            }
        };
        let line = |from: f32, to: f32, cells: f32, salt: u32| {
            let inked = hash((q.x * cells) as i32, which as i32, salt) > 0.25;
            (from..to).contains(&q.y) && inked && (0.1..0.86).contains(&q.x)
        };
        let words = line(0.84, 0.93, 13.0, 3) || line(0.78, 0.805, 40.0, 4) || line(0.06, 0.085, 50.0, 5);
        let ink = if low.max_element() > 0.52 && high.max_element() > 0.52 { Vec3::splat(0.03) } else { WHITE };
        let ground = low.lerp(high, q.y);
        choose(words, ink, choose(is_accent, accent, choose(is_thing, thing, ground)))
    });
    let canvas = weathered(SIZE_M, picture);
    let name = format!("poster {which}");
    Material { base_color_map: Some(canvas.color(&name)), ..Material::plain(&name, Vec3::ONE, 0.25) }
}
