//! Paving that follows the street: texture coordinates along the nearest road instead of east and north.

use std::collections::BTreeMap;

use glam::{DVec2, Vec2};
use trove_model::Mesh;

use crate::segments::SegmentIndex;

/// Paving further from a road than this lies as the compass does, metres.
const REACH_M: f64 = 25.0;
/// Directions are rounded to this, so that neighbouring segments of a bent street share one, radians.
const STEP_RAD: f64 = 0.05;

/// Turns the texture coordinates of level triangles, World's x and y in metres, along the nearest of some lines.
pub(super) fn align(mesh: &mut Mesh, lines: &SegmentIndex) {
    let mut copies: BTreeMap<(u32, i32), u32> = BTreeMap::new();
    for t in 0..mesh.triangles.len() {
        let corners = mesh.triangles[t];
        let middle = corners.map(|i| mesh.positions[i as usize]).iter().sum::<glam::Vec3>() / 3.0;
        let Some(near) = lines.nearest(middle.truncate().as_dvec2(), REACH_M) else { continue };
        // A quarter turn brings a joint onto a joint.
        let angle = near.along.y.atan2(near.along.x).rem_euclid(std::f64::consts::FRAC_PI_2);
        let step = (angle / STEP_RAD).round() as i32;
        if step == 0 {
            continue;
        }
        mesh.triangles[t] = corners.map(|i| {
            *copies.entry((i, step)).or_insert_with(|| {
                let p = mesh.positions[i as usize];
                let uv = DVec2::from_angle(-f64::from(step) * STEP_RAD).rotate(p.truncate().as_dvec2());
                mesh.positions.push(p);
                mesh.uvs.push(Vec2::new(uv.x as f32, uv.y as f32));
                mesh.normals.push(mesh.normals[i as usize]);
                if !mesh.tints.is_empty() {
                    mesh.tints.push(mesh.tints[i as usize]);
                }
                mesh.positions.len() as u32 - 1
            })
        });
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::Vec3;

    #[test]
    fn paving_lies_along_its_street_and_keeps_its_scale() {
        let along = DVec2::from_angle(0.6);
        let corners = [DVec2::new(3.0, 4.0), DVec2::new(5.0, 4.0), DVec2::new(3.0, 6.0)];
        let mut mesh = Mesh {
            positions: corners.map(|p| p.extend(0.0).as_vec3()).to_vec(),
            normals: vec![Vec3::Z; 3],
            uvs: corners.map(|p| p.as_vec2()).to_vec(),
            triangles: vec![[0, 1, 2]],
            ..Mesh::default()
        };
        let line = [-along * 50.0, along * 50.0];
        align(&mut mesh, &SegmentIndex::new([&line[..]]));
        assert_eq!(mesh.defect(), None);
        let [a, b, _] = mesh.triangles[0].map(|i| mesh.uvs[i as usize].as_dvec2());
        assert!((a.distance(b) - 2.0).abs() < 1e-5);
        // What runs east lies 0.6 radians to the right of the street.
        assert!(((b - a).y.atan2((b - a).x) + 0.6).abs() < 0.01);
    }
}
