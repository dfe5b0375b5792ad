//! Shapes of known form.

use glam::Vec3;
use trove_model::Mesh;

/// Radius 1.
pub(crate) fn ball(rings: u32) -> Mesh {
    let mut mesh = Mesh::default();
    for ring in 0..=rings {
        for side in 0..=2 * rings {
            let (sin, cos) = (ring as f32 / rings as f32 * std::f32::consts::PI).sin_cos();
            let (y, x) = (side as f32 / rings as f32 * std::f32::consts::PI).sin_cos();
            mesh.positions.push(Vec3::new(sin * x, sin * y, -cos));
        }
    }
    for ring in 0..rings {
        for side in 0..2 * rings {
            let a = ring * (2 * rings + 1) + side;
            let b = a + 2 * rings + 1;
            mesh.triangles.extend([[a, a + 1, b + 1], [a, b + 1, b]]);
        }
    }
    mesh
}

/// Side 1 around the origin.
pub(crate) fn cube() -> Mesh {
    let corner = |i: u32| Vec3::new((i & 1) as f32, (i >> 1 & 1) as f32, (i >> 2) as f32) - 0.5;
    Mesh {
        positions: (0..8).map(corner).collect(),
        triangles: [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]]
            .into_iter()
            .flat_map(|[a, b, c, d]| [[a, b, c], [a, c, d]])
            .collect(),
        ..Mesh::default()
    }
}
