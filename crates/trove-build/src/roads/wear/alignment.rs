//! Paving that follows the street: texture coordinates along the nearest road instead of east and north.

use std::collections::BTreeMap;

use glam::{DVec2, Vec3};
use trove_model::{Mesh, Polygon};

use crate::geometry::segments::SegmentIndex;

/// Paving further from a road than this lies as the compass does, metres.
const REACH_M: f64 = 25.0;
/// A kerb stone's top lies this near to its edge, metres.
const EDGE_REACH_M: f64 = 0.6;
/// Directions are rounded to this, so that neighbouring segments of a bent street share one, radians.
const STEP_RAD: f64 = 0.05;

/// Turns the texture coordinates of level triangles, World's x and y in metres, along the nearest of some lines.
pub(super) fn align(mesh: &mut Mesh, lines: &SegmentIndex) {
    let mut copies: BTreeMap<(u32, i32), u32> = BTreeMap::new();
    for t in 0..mesh.triangles.len() {
        let corners = mesh.triangles[t];
        let middle = corners.map(|i| mesh.positions[i as usize]).iter().sum::<Vec3>() / 3.0;
        let Some(near) = lines.nearest(middle.truncate().as_dvec2(), REACH_M) else { continue };
        // A quarter turn brings a joint onto a joint.
        let angle = near.along.y.atan2(near.along.x).rem_euclid(std::f64::consts::FRAC_PI_2);
        let step = (angle / STEP_RAD).round() as i32;
        if step == 0 {
            continue;
        }
        mesh.triangles[t] = corners.map(|i| {
            *copies.entry((i, step)).or_insert_with(|| {
                let p = mesh.positions[i as usize].truncate().as_dvec2();
                copy(mesh, i, DVec2::from_angle(-f64::from(step) * STEP_RAD).rotate(p))
            })
        });
    }
}

/// Gives level triangles beside an area's edges texture coordinates that go on those of the faces below: metres along
/// the edge, and away from it. Edges for which `skip` holds have no faces.
pub(in crate::roads) fn follow_edges(mesh: &mut Mesh, area: &[Polygon], skip: impl Fn(DVec2, DVec2) -> bool) {
    let mut edges: Vec<[DVec2; 2]> = Vec::new();
    let mut starts_m: Vec<f64> = Vec::new();
    for ring in area.iter().flat_map(Polygon::rings) {
        let mut along_m = 0.0;
        for i in 0..ring.len() {
            let (a, b) = (ring[i], ring[(i + 1) % ring.len()]);
            if !skip(a, b) {
                edges.push([a, b]);
                starts_m.push(along_m);
                along_m += a.distance(b);
            }
        }
    }
    let index = SegmentIndex::new(edges.iter().map(|edge| &edge[..]));
    let mut copies: BTreeMap<(u32, usize), u32> = BTreeMap::new();
    for t in 0..mesh.triangles.len() {
        let corners = mesh.triangles[t];
        let middle = corners.map(|i| mesh.positions[i as usize]).iter().sum::<Vec3>() / 3.0;
        let Some(near) = index.nearest(middle.truncate().as_dvec2(), EDGE_REACH_M) else { continue };
        let from = edges[near.line][0];
        mesh.triangles[t] = corners.map(|i| {
            *copies.entry((i, near.line)).or_insert_with(|| {
                let p = mesh.positions[i as usize].truncate().as_dvec2() - from;
                let uv = DVec2::new(starts_m[near.line] + p.dot(near.along), p.perp_dot(near.along).abs());
                copy(mesh, i, uv)
            })
        });
    }
}

/// A vertex once more, with other texture coordinates.
fn copy(mesh: &mut Mesh, vertex: u32, uv: DVec2) -> u32 {
    let i = vertex as usize;
    mesh.positions.push(mesh.positions[i]);
    mesh.normals.push(mesh.normals[i]);
    mesh.uvs.push(uv.as_vec2());
    if !mesh.tints.is_empty() {
        mesh.tints.push(mesh.tints[i]);
    }
    mesh.positions.len() as u32 - 1
}

#[cfg(test)]
mod tests {
    use super::*;

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

    #[test]
    fn a_kerbs_top_goes_on_where_its_face_is() {
        let area =
            [crate::geometry::plane::rectangle(trove_model::Bounds { min: DVec2::ZERO, max: DVec2::new(10.0, 20.0) })];
        let corners = [DVec2::new(10.0, 4.0), DVec2::new(10.15, 4.0), DVec2::new(10.0, 6.0)];
        let mut mesh = Mesh {
            positions: corners.map(|p| p.extend(0.12).as_vec3()).to_vec(),
            normals: vec![Vec3::Z; 3],
            uvs: corners.map(|p| p.as_vec2()).to_vec(),
            triangles: vec![[0, 1, 2]],
            ..Mesh::default()
        };
        follow_edges(&mut mesh, &area, |_, _| false);
        let uvs = mesh.triangles[0].map(|i| mesh.uvs[i as usize].as_dvec2());
        // Ten metres of southern edge come first.
        for (uv, expected) in uvs.iter().zip([DVec2::new(14.0, 0.0), DVec2::new(14.0, 0.15), DVec2::new(16.0, 0.0)]) {
            assert!(uv.distance(expected) < 1e-4, "{uv}");
        }
    }
}
