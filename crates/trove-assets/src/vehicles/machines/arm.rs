//! Booms, sticks and buckets.

use glam::{Vec2, Vec3, vec2, vec3};

use crate::shape::Shape;
use crate::vehicles::workshop::{Workshop, block, cut_out};

/// A welded box beam in the plane at y through points (x, z) with depths, plates standing out along its edges.
pub(super) fn beam(points: &[(f32, f32, f32)], y: f32, width_m: f32) -> Shape {
    let at = |k: usize| vec2(points[k].0, points[k].1);
    let ring = |i: usize, out: f32, w: f32| -> Vec<Vec3> {
        let along = (at((i + 1).min(points.len() - 1)) - at(i.saturating_sub(1))).normalize_or(Vec2::X);
        let up = along.perp() * (points[i].2 / 2.0 + out);
        // Counter-clockwise seen from where the beam goes to.
        [(up, w), (up, -w), (-up, -w), (-up, w)].map(|(u, dy)| vec3(at(i).x + u.x, y + dy, at(i).y + u.y)).to_vec()
    };
    let web: Vec<Vec<Vec3>> = (0..points.len()).map(|i| ring(i, -0.012, width_m / 2.0 - 0.015)).collect();
    // Flanges above and below, a little wider than the webs.
    let flange = |sign: f32| {
        let rings: Vec<Vec<Vec3>> = (0..points.len())
            .map(|i| {
                let along = (at((i + 1).min(points.len() - 1)) - at(i.saturating_sub(1))).normalize_or(Vec2::X);
                let (w, d) = (width_m / 2.0, points[i].2 / 2.0 * sign);
                let edge = |depth: f32| at(i) + along.perp() * depth;
                let (a, b) = (edge(d + 0.008), edge(d - 0.014));
                [(a, w), (a, -w), (b, -w), (b, w)].map(|(p, dy)| vec3(p.x, y + dy, p.y)).to_vec()
            })
            .collect();
        Shape::loft(&rings).smooth(0.25)
    };
    Shape::join([Shape::loft(&web).smooth(0.25), flange(1.0), flange(-1.0)])
}

/// A pin across a joint.
pub(super) fn pin(work: &mut Workshop, at: Vec3, radius_m: f32, width_m: f32) {
    let w = Vec3::Y * width_m / 2.0;
    work.add(work.slots.frame, Shape::tube(&[at - w, at + w], radius_m, 16));
    work.add(work.slots.steel, Shape::tube(&[at - w * 1.06, at + w * 1.06], radius_m * 0.55, 12));
}

/// A curved shell between cheeks with teeth on its lip; points (x, z) of its back from the hinge to the lip.
pub(super) fn bucket(work: &mut Workshop, back: &[Vec2], y: f32, width_m: f32, teeth: usize) {
    let slots = work.slots;
    let smooth: Vec<Vec2> = back
        .windows(2)
        .enumerate()
        .flat_map(|(i, w)| {
            let before = if i == 0 { w[0] } else { back[i - 1] };
            let after = back.get(i + 2).copied().unwrap_or(w[1]);
            // Catmull and Rom's cubic through the points.
            [0.0, 0.33, 0.67].map(|t: f32| {
                0.5 * (2.0 * w[0]
                    + (w[1] - before) * t
                    + (2.0 * before - 5.0 * w[0] + 4.0 * w[1] - after) * t * t
                    + (3.0 * w[0] - before - 3.0 * w[1] + after) * t * t * t)
            })
        })
        .chain(back.last().copied())
        .collect();
    let row = |dy: f32| smooth.iter().map(|p| vec3(p.x, y + dy, p.y)).collect::<Vec<_>>();
    let shell = Shape::sheet(&[row(-width_m / 2.0), row(width_m / 2.0)]).smooth(0.6);
    work.add(slots.steel, shell.plate(0.025));
    let mut cheek = smooth.clone();
    let mouth = (smooth[0] + smooth[smooth.len() - 1]) / 2.0;
    cheek.push(mouth.lerp(smooth[smooth.len() / 2], 0.12));
    for side in [-1.0, 1.0] {
        let plate = cut_out(&cheek, 0.03).moved(Vec3::Y * (y + side * width_m / 2.0));
        work.add(slots.frame, plate);
    }
    let (lip, before) = (smooth[smooth.len() - 1], smooth[smooth.len() - 2]);
    let out = (lip - before).normalize_or(Vec2::X);
    for i in 0..teeth {
        let dy = (i as f32 / (teeth - 1).max(1) as f32 - 0.5) * width_m * 0.92;
        let (a, b) = (lip - out * 0.06, lip + out * 0.15);
        let tooth =
            [(vec3(a.x, y + dy, a.y), 0.05), (vec3(lip.x, y + dy, lip.y), 0.05), (vec3(b.x, y + dy, b.y), 0.014)];
        work.add(slots.steel, Shape::tapered_tube(&tooth, 5));
    }
    let edge = block([0.16, width_m, 0.03], [0.0; 3], 0.008);
    let turn = glam::Quat::from_rotation_y(-out.y.atan2(out.x));
    work.add(slots.steel, edge.turned(turn).moved(vec3(lip.x, y, lip.y)));
}

/// Hoses along a path beside a boom.
pub(super) fn hoses(work: &mut Workshop, points: &[Vec3], count: usize) {
    for k in 0..count {
        let path: Vec<Vec3> = points.iter().map(|p| *p + vec3(0.0, 0.035 * k as f32, 0.0)).collect();
        work.add(work.slots.trim, Shape::tube(&path, 0.014, 5));
    }
}
