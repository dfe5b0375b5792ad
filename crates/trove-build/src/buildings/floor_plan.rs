//! The plan of a model: where its walls stand, without its balconies, steps and awnings.

use glam::{DVec2, DVec3, Vec2};
use trove_model::{Asset, Mesh};

/// Points along a side at which a model is looked at from above.
const POINTS: usize = 160;
/// A line across a model that is covered by less of it runs before its walls.
const WALLED_SHARE: f64 = 0.6;
/// More than this share of a plan before its walls is no balconies.
const BEFORE_WALLS_SHARE: f64 = 0.2;

/// A model and the box around its walls.
pub(super) struct Plan<'a> {
    pub asset: &'a Asset,
    /// Of the box, in the mesh's frame, metres.
    pub centre: DVec2,
    /// Along x, y and z, metres.
    pub size_m: DVec3,
    /// The share of the box that the model covers.
    pub filled: f64,
}

impl<'a> Plan<'a> {
    /// `None` for a model whose walls do not stand along a box.
    pub(super) fn new(asset: &'a Asset) -> Option<Self> {
        let (low, high) = asset.mesh.bounds()?;
        let cell = ((high - low).truncate() / POINTS as f32).max(Vec2::splat(1e-6));
        let covered = seen_from_above(&asset.mesh, low.truncate(), cell);
        let row = |y: usize| (0..POINTS).filter(|x| covered[y * POINTS + x]).count();
        let column = |x: usize| (0..POINTS).filter(|y| covered[y * POINTS + x]).count();
        let (columns, rows) = (walled(column)?, walled(row)?);
        let inside = rows.clone().map(|y| columns.clone().filter(|x| covered[y * POINTS + x]).count()).sum::<usize>();
        let before_walls = covered.iter().filter(|c| **c).count() - inside;
        if before_walls as f64 > BEFORE_WALLS_SHARE * inside as f64 {
            return None;
        }
        let place = |x: usize, y: usize| (low.truncate() + Vec2::new(x as f32, y as f32) * cell).as_dvec2();
        let (from, to) = (place(columns.start, rows.start), place(columns.end, rows.end));
        Some(Self {
            asset,
            centre: (from + to) / 2.0,
            size_m: (to - from).extend(asset.size_m.z),
            filled: inside as f64 / (columns.len() * rows.len()) as f64,
        })
    }
}

/// From the first to the last line whose covered points are enough to be walls.
fn walled(covered: impl Fn(usize) -> usize) -> Option<std::ops::Range<usize>> {
    let most = (0..POINTS).map(&covered).max()?;
    let is_walled = |i: &usize| most > 0 && covered(*i) as f64 >= WALLED_SHARE * most as f64;
    Some((0..POINTS).find(is_walled)?..(0..POINTS).rfind(is_walled)? + 1)
}

/// The cells of a grid whose middles a mesh covers, row by row.
fn seen_from_above(mesh: &Mesh, low: Vec2, cell: Vec2) -> Vec<bool> {
    let mut covered = vec![false; POINTS * POINTS];
    let last = Vec2::splat((POINTS - 1) as f32);
    for t in &mesh.triangles {
        let p = t.map(|i| (mesh.positions[i as usize].truncate() - low) / cell - 0.5);
        let area = (p[1] - p[0]).perp_dot(p[2] - p[0]);
        let (from, to) = (p[0].min(p[1]).min(p[2]).ceil().max(Vec2::ZERO), p[0].max(p[1]).max(p[2]).floor().min(last));
        if area == 0.0 || to.min_element() < 0.0 {
            continue;
        }
        for y in from.y as usize..=to.y as usize {
            for x in from.x as usize..=to.x as usize {
                let at = Vec2::new(x as f32, y as f32);
                let is_inside = (0..3).all(|i| (p[i] - at).perp_dot(p[(i + 1) % 3] - at) / area >= 0.0);
                covered[y * POINTS + x] |= is_inside;
            }
        }
    }
    covered
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing;
    use std::sync::Arc;
    use trove_model::Kind;

    #[test]
    fn a_balcony_is_outside_the_plan_and_a_triangle_has_none() {
        let mut house = testing::asset("building/a", Kind::Building, [20.0, 10.0, 9.0]);
        let plan = Plan::new(&house).unwrap();
        assert!((plan.size_m - DVec3::new(20.0, 10.0, 9.0)).length() < 0.01 && plan.filled == 1.0);
        // Before a third of the front.
        let mesh = Arc::make_mut(&mut house.mesh);
        let first = mesh.positions.len() as u32;
        mesh.positions
            .extend([[-3.0, -7.0], [3.0, -7.0], [3.0, -5.0], [-3.0, -5.0]].map(|[x, y]| glam::vec3(x, y, 3.0)));
        mesh.triangles.extend([[first, first + 1, first + 2], [first, first + 2, first + 3]]);
        let plan = Plan::new(&house).unwrap();
        assert!((plan.size_m.y - 10.0).abs() < 0.16 && plan.centre.length() < 0.08, "{} {}", plan.size_m, plan.centre);
        assert!(plan.filled > 0.99);
        // Half of the roof alone.
        Arc::make_mut(&mut house.mesh).triangles = vec![[4, 5, 6]];
        assert!(Plan::new(&house).is_none());
        Arc::make_mut(&mut house.mesh).triangles.clear();
        assert!(Plan::new(&house).is_none());
    }
}
