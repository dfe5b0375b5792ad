//! Which slabs of a building may stand several times.

use std::collections::BTreeMap;

use glam::{Vec2, Vec3};
use trove_model::Mesh;

/// Planes are tried at this distance.
const STEP_M: f32 = 0.05;
/// Planes lie this near to a border of bays.
const BESIDE_M: f32 = 0.45;
/// No plane is nearer to an end than this.
const MARGIN_M: f32 = 0.3;
/// Outlines of two sections whose lengths in a slot differ by less than this, and whose middles by about as much, are the
/// same, metres.
const LIKE_M: f32 = 0.02;

/// A slab across an axis, `period_m` thick, of whose triangles there are as few as can be: the model looks the same on
/// both of its planes, so that the next can stand on it. It lies between `low_m` and `high_m`, near the middle of them, and
/// begins where a bay or a storey does: there is one at `border_m`. Textures of walls differ from bay to bay and go on only
/// there.
pub(super) fn repeat(
    mesh: &Mesh,
    axis: usize,
    period_m: f32,
    [low_m, high_m]: [f32; 2],
    border_m: f32,
) -> Option<[f64; 2]> {
    let count = ((high_m - low_m - period_m - 2.0 * MARGIN_M) / STEP_M).floor();
    if period_m <= 0.0 || count.is_nan() || count < 0.0 {
        return None;
    }
    let spans: Vec<[f32; 2]> = mesh
        .triangles
        .iter()
        .map(|t| t.map(|i| mesh.positions[i as usize][axis]))
        .map(|z| [z.iter().copied().fold(f32::MAX, f32::min), z.iter().copied().fold(f32::MIN, f32::max)])
        .collect();
    let middle = (low_m + high_m - period_m) / 2.0;
    let beside_m = |from: f32| ((from - border_m + period_m / 2.0).rem_euclid(period_m) - period_m / 2.0).abs();
    let mut planes: Vec<(usize, f32)> = (0..=count as usize)
        .map(|i| low_m + MARGIN_M + STEP_M * i as f32)
        .filter(|from| beside_m(*from) <= BESIDE_M)
        .map(|from| (spans.iter().filter(|s| s[1] > from && s[0] < from + period_m).count(), from))
        .collect();
    let far_m = |from: f32| (from - middle).abs() + 100.0 * beside_m(from);
    planes.sort_by(|a, b| a.0.cmp(&b.0).then(far_m(a.1).total_cmp(&far_m(b.1))));
    let like = |from: f32| {
        let (here, there) = (section(mesh, &spans, axis, from), section(mesh, &spans, axis, from + period_m));
        let known = here.keys().chain(there.keys());
        let of = |s: &BTreeMap<u16, Vec3>, slot: &u16| s.get(slot).copied().unwrap_or_default();
        known.into_iter().all(|slot| {
            let (a, b) = (of(&here, slot), of(&there, slot));
            let moment = (a - b).truncate().abs().max_element();
            (a.z - b.z).abs() < LIKE_M && moment < LIKE_M * (1.0 + a.z)
        })
    };
    let from = planes.into_iter().map(|(_, from)| from).find(|from| like(*from))?;
    Some([f64::from(from), f64::from(from + period_m)])
}

/// What a plane cuts of every slot: the length of the outline in z and its first moment in x and y.
fn section(mesh: &Mesh, spans: &[[f32; 2]], axis: usize, at_m: f32) -> BTreeMap<u16, Vec3> {
    let flat = |p: Vec3| match axis {
        0 => Vec2::new(p.y, p.z),
        1 => Vec2::new(p.x, p.z),
        _ => Vec2::new(p.x, p.y),
    };
    let mut found: BTreeMap<u16, Vec3> = BTreeMap::new();
    for (t, corners) in mesh.triangles.iter().enumerate().filter(|(t, _)| spans[*t][0] < at_m && spans[*t][1] >= at_m) {
        let corners = corners.map(|i| mesh.positions[i as usize]);
        let mut ends = Vec::with_capacity(2);
        for (a, b) in [(0, 1), (1, 2), (2, 0)].map(|(i, j)| (corners[i], corners[j])) {
            if (a[axis] < at_m) != (b[axis] < at_m) {
                ends.push(flat(a.lerp(b, (at_m - a[axis]) / (b[axis] - a[axis]))));
            }
        }
        if let [a, b] = ends[..] {
            let length = a.distance(b);
            *found.entry(mesh.slot(t)).or_default() += ((a + b) / 2.0 * length).extend(length);
        }
    }
    found
}

#[cfg(test)]
mod tests {
    use glam::Vec3;

    use super::repeat;
    use crate::shape::Shape;

    /// A wall of 20 m with piers at these places.
    fn wall(piers: &[f32]) -> trove_model::Mesh {
        let pier = |x: &f32| Shape::block(Vec3::new(0.5, 1.0, 3.0)).moved(Vec3::X * *x);
        Shape::join(std::iter::once(Shape::block(Vec3::new(20.0, 0.3, 3.0))).chain(piers.iter().map(pier))).into_mesh()
    }

    #[test]
    fn a_slab_is_cut_where_least_crosses_its_planes() {
        let [from, to] = repeat(&wall(&[-8.0, -4.0, 0.0, 4.0, 8.0]), 0, 4.0, [-10.0, 10.0], -10.0).unwrap();
        assert!((to - from - 4.0).abs() < 1e-3);
        for pier in [-8.0, -4.0, 0.0, 4.0, 8.0] {
            assert!((from - pier).abs() > 0.2 && (to - pier).abs() > 0.2, "{from} to {to}");
        }
        // Bays begin at −10, −6, −2 and so on.
        assert!(((from + 2.0) / 4.0 - ((from + 2.0) / 4.0).round()).abs() < 0.06, "{from}");
    }

    #[test]
    fn a_duct_that_ends_within_a_slab_is_seen_beside_a_large_outline() {
        // The duct has 2 m of outline, the hall around it 60.
        let hall = Shape::block(Vec3::new(20.0, 20.0, 10.0));
        let duct = Shape::block(Vec3::new(9.6, 0.5, 0.5)).moved(Vec3::new(5.0, 0.0, 5.3));
        assert_eq!(repeat(&Shape::join([hall, duct]).into_mesh(), 0, 10.5, [-10.0, 10.0], -9.0), None);
    }

    #[test]
    fn there_is_no_slab_where_both_sides_differ() {
        let ramp = Shape::extruded(&[glam::vec2(-9.0, 0.0), glam::vec2(9.0, 0.0), glam::vec2(9.0, 6.0)], 3.0);
        assert_eq!(repeat(&ramp.into_mesh(), 0, 4.0, [-9.0, 9.0], -9.0), None);
        assert_eq!(repeat(&wall(&[]), 0, 30.0, [-10.0, 10.0], -10.0), None);
        assert_eq!(repeat(&wall(&[]), 0, 0.0, [-10.0, 10.0], -10.0), None);
    }
}
