//! The ground beyond the height field, to the horizon.

use glam::{DVec2, UVec2, Vec3};
use trove_model::Mesh;

use super::drape::Drape;
use super::land::Land;
use super::terrain::ease;

/// Over a relief steps grow outwards by this, from some cells up to some metres.
const GROWTH: f64 = 1.25;
const FIRST_CELLS: f64 = 2.0;
const LONGEST_M: f64 = 120.0;
/// The field's edge goes over into the relief over so much, metres.
const BLEND_M: f64 = 80.0;

/// Meshes of the ground beyond the field.
pub(crate) struct Apron {
    /// All of it but the sea.
    pub land: Mesh,
    /// Empty without a relief.
    pub sea: Mesh,
}

/// Height of the ground beyond a field: that of the field's edge, or of the land.
pub(crate) fn beyond_m(drape: &Drape<'_>, land: Option<Land<'_>>, p: DVec2) -> f64 {
    let bounds = drape.bounds();
    let edge_m = drape.height_m(p);
    let away_m = p.distance(p.clamp(bounds.min, bounds.max));
    let land_m = land.and_then(|land| land.height_m(p)).unwrap_or(edge_m);
    edge_m + (land_m - edge_m) * ease(away_m / BLEND_M)
}

/// The ground out to `reach_m` beyond a field: as high as the field's edge, or as the land is. Land lies `land_lift_m`
/// above the ground, the sea `sea_lift_m`.
pub(crate) fn apron(
    drape: &Drape<'_>,
    reach_m: f64,
    [land_lift_m, sea_lift_m]: [f64; 2],
    land: Option<Land<'_>>,
) -> Apron {
    let field = drape.field();
    let last = UVec2::new(field.nodes.width - 1, field.nodes.height - 1);
    let outwards = outwards_m(field.cell_m, reach_m, land.is_some());
    let coordinates = |origin: f64, last: u32| -> Vec<f64> {
        let inside = (0..=last).map(|i| origin + f64::from(i) * field.cell_m);
        let end = origin + f64::from(last) * field.cell_m;
        let before = outwards.iter().rev().map(|m| origin - m);
        before.chain(inside).chain(outwards.iter().map(|m| end + m)).collect()
    };
    let (xs, ys) = (coordinates(field.origin.x, last.x), coordinates(field.origin.y, last.y));
    let first = outwards.len();
    let is_inside = |i: usize, j: usize| {
        (first..first + last.x as usize).contains(&i) && (first..first + last.y as usize).contains(&j)
    };
    let at = |i: usize, j: usize| DVec2::new(xs[i], ys[j]);
    let node = |i: usize, j: usize| j * xs.len() + i;
    let nodes = (0..ys.len()).flat_map(|j| (0..xs.len()).map(move |i| (i, j)));
    let is_sea: Vec<bool> = nodes.clone().map(|(i, j)| land.is_some_and(|land| land.is_sea(at(i, j)))).collect();
    let all_sea = |is: [usize; 2], js: [usize; 2]| (js[0]..=js[1]).all(|j| (is[0]..=is[1]).all(|i| is_sea[node(i, j)]));
    let height_m = |(i, j): (usize, usize)| {
        let around = |k: usize, count: usize| [k.saturating_sub(1), (k + 1).min(count - 1)];
        // Land and sea share the vertices of their shore.
        let lift_m = if all_sea(around(i, xs.len()), around(j, ys.len())) { sea_lift_m } else { land_lift_m };
        beyond_m(drape, land, at(i, j)) + lift_m
    };
    let heights_m: Vec<f64> = nodes.map(height_m).collect();
    let normal = |i: usize, j: usize| {
        let slope = |k: [usize; 2], count: &dyn Fn(usize) -> f64, z: &dyn Fn(usize) -> f64| {
            (z(k[1]) - z(k[0])) / (count(k[1]) - count(k[0]))
        };
        let (is, js) =
            ([i.saturating_sub(1), (i + 1).min(xs.len() - 1)], [j.saturating_sub(1), (j + 1).min(ys.len() - 1)]);
        let east = slope(is, &|i| xs[i], &|i| heights_m[node(i, j)]);
        let north = slope(js, &|j| ys[j], &|j| heights_m[node(i, j)]);
        Vec3::new(-east as f32, -north as f32, 1.0).normalize()
    };
    let mut apron = Apron { land: Mesh::default(), sea: Mesh::default() };
    for j in 0..ys.len() - 1 {
        for i in (0..xs.len() - 1).filter(|&i| !is_inside(i, j)) {
            let mesh = if all_sea([i, i + 1], [j, j + 1]) { &mut apron.sea } else { &mut apron.land };
            let first = mesh.positions.len() as u32;
            for (i, j) in [(i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1)] {
                mesh.positions.push(at(i, j).extend(heights_m[node(i, j)]).as_vec3());
                mesh.normals.push(normal(i, j));
                mesh.uvs.push(at(i, j).as_vec2());
            }
            mesh.triangles.extend([[first, first + 1, first + 2], [first, first + 2, first + 3]]);
        }
    }
    apron
}

/// Distances from the field of what is told beyond it, the last of them `reach_m`.
fn outwards_m(cell_m: f64, reach_m: f64, has_relief: bool) -> Vec<f64> {
    let mut outwards = Vec::new();
    let (mut step_m, mut at_m) = (FIRST_CELLS * cell_m, 0.0);
    while has_relief && at_m + 1.5 * step_m < reach_m {
        at_m += step_m;
        outwards.push(at_m);
        step_m = (step_m * GROWTH).min(LONGEST_M);
    }
    outwards.push(reach_m);
    outwards
}

#[cfg(test)]
mod tests {
    use super::*;
    use trove_model::{HeightField, Raster, Relief};

    fn area_m2(mesh: &Mesh) -> f32 {
        let corners = mesh.triangles.iter().map(|t| t.map(|i| mesh.positions[i as usize].truncate()));
        corners.map(|[a, b, c]| (b - a).perp_dot(c - a) / 2.0).sum()
    }

    fn field() -> HeightField {
        let nodes = Raster::from_fn(21, 21, |x, y| ((x * 7 + y * 13) % 5) as f32 * 0.1);
        HeightField { origin: DVec2::splat(-20.0), cell_m: 2.0, nodes }
    }

    #[test]
    fn without_a_relief_the_ground_goes_on_where_the_field_ends() {
        let field = field();
        let apron = apron(&Drape::new(&field), 100.0, [0.0, -1.0], None);
        assert!((area_m2(&apron.land) - (240.0 * 240.0 - 40.0 * 40.0)).abs() < 1.0 && apron.sea.triangles.is_empty());
    }

    #[test]
    fn with_a_relief_it_rises_to_the_hills_and_the_sea_lies_flat_without_a_gap() {
        let field = field();
        // A coast along x = −100: the sea to the west, a slope to the east.
        let nodes = Raster::from_fn(81, 81, |x, _| (x as f32 - 30.0).max(0.0) * 5.0);
        let relief = Relief { origin: DVec2::splat(-400.0), cell_m: DVec2::splat(10.0), nodes, sources: Vec::new() };
        let land = Land { relief: &relief, datum_m: -50.0 };
        let apron = apron(&Drape::new(&field), 350.0, [0.12, -0.8], Some(land));
        assert_eq!((apron.land.defect(), apron.sea.defect()), (None, None));
        assert!((area_m2(&apron.land) + area_m2(&apron.sea) - (740.0 * 740.0 - 40.0 * 40.0)).abs() < 10.0);
        let top = apron.land.positions.iter().find(|p| p.x > 369.0).unwrap();
        assert!((top.z - (0.5 * (370.0 + 100.0) - 50.0 + 0.12)).abs() < 0.1, "{top}");
        assert!(apron.sea.positions.iter().all(|p| p.x < -99.0 && p.z < -49.8));
        assert!(apron.sea.positions.iter().any(|p| (p.z + 50.8).abs() < 1e-3));
    }
}
