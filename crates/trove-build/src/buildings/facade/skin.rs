//! A wall with rectangular holes, without gaps or T-junctions: neighbouring pieces share their vertices.

use glam::{DVec2, DVec3};

use super::ink::ring;

/// A point of the wall: where it is, and where on the wall's plane (x along, y up).
#[derive(Clone, Copy, Debug)]
pub(super) struct Vertex {
    pub world: DVec3,
    pub local: DVec2,
}

/// A piece of a row; holes lie strictly within their cell.
#[derive(Clone, Copy, Debug)]
pub(super) struct Cell {
    pub x: [f64; 2],
    pub hole: Option<[DVec2; 2]>,
}

/// Cells side by side; all rows of a wall reach from the same x to the same x.
#[derive(Clone, Debug)]
pub(super) struct Row {
    pub y: [f64; 2],
    pub cells: Vec<Cell>,
}

impl Row {
    /// The cells' borders from left to right.
    fn borders(&self, y: f64) -> Vec<DVec2> {
        let first = self.cells.iter().take(1).map(|c| c.x[0]);
        first.chain(self.cells.iter().map(|c| c.x[1])).map(|x| DVec2::new(x, y)).collect()
    }
}

/// Covers a wall but for its holes, in triangles and quads that run counter-clockwise. The outline's sides are bottom,
/// right, top and left, each from corner to corner, counter-clockwise.
pub(super) fn skin(
    outline: &[Vec<Vertex>; 4],
    rows: &[Row],
    place: impl Fn(DVec2) -> DVec3,
    mut face: impl FnMut(&[Vertex]),
) {
    let at = |p: DVec2| Vertex { world: place(p), local: p };
    let chain = |points: Vec<DVec2>| points.into_iter().map(at).collect::<Vec<_>>();
    let (Some(first), Some(last)) = (rows.first(), rows.last()) else {
        return face(&outline.iter().flat_map(|side| &side[..side.len() - 1]).copied().collect::<Vec<_>>());
    };
    for row in rows {
        for cell in &row.cells {
            let outer = ring(DVec2::new(cell.x[0], row.y[0]), DVec2::new(cell.x[1], row.y[1])).map(at);
            match cell.hole {
                None => face(&outer),
                Some([low, high]) => {
                    let inner = ring(low, high).map(at);
                    for k in 0..4 {
                        let next = (k + 1) % 4;
                        face(&[outer[k], outer[next], inner[next], inner[k]]);
                    }
                }
            }
        }
    }
    for pair in rows.windows(2) {
        zip(&chain(pair[0].borders(pair[0].y[1])), &chain(pair[1].borders(pair[1].y[0])), &mut face);
    }
    let end = |right: bool| {
        let x = |row: &Row| if right { row.cells[row.cells.len() - 1].x[1] } else { row.cells[0].x[0] };
        rows.iter().flat_map(|row| row.y.map(|y| DVec2::new(x(row), y))).collect::<Vec<_>>()
    };
    let reversed = |mut points: Vec<DVec2>| {
        points.reverse();
        points
    };
    let inner =
        [first.borders(first.y[0]), end(true), reversed(last.borders(last.y[1])), reversed(end(false))].map(chain);
    for (outer, inner) in outline.iter().zip(&inner) {
        zip(outer, inner, &mut face);
    }
}

/// Triangles between two chains that run the same way, the second on the left of the first.
fn zip(right: &[Vertex], left: &[Vertex], face: &mut impl FnMut(&[Vertex])) {
    let along = match (right.first(), right.last()) {
        (Some(a), Some(b)) => b.local - a.local,
        _ => return,
    };
    let (mut i, mut k) = (0, 0);
    while i + 1 < right.len() || k + 1 < left.len() {
        let reach = |chain: &[Vertex], at: usize| chain.get(at + 1).map(|v| v.local.dot(along));
        let advance_right = match (reach(right, i), reach(left, k)) {
            (Some(a), Some(b)) => a < b,
            (a, _) => a.is_some(),
        };
        if advance_right {
            face(&[right[i], right[i + 1], left[k]]);
            i += 1;
        } else {
            face(&[right[i], left[k + 1], left[k]]);
            k += 1;
        }
    }
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeMap;

    use super::*;

    #[test]
    fn a_wall_with_holes_has_open_edges_at_its_outline_and_at_its_holes_only() {
        let place = |p: DVec2| DVec3::new(p.x, 0.0, p.y);
        let vertex = |x: f64, y: f64| Vertex { world: place(DVec2::new(x, y)), local: DVec2::new(x, y) };
        let outline = [
            vec![vertex(0.0, 0.0), vertex(4.0, 0.0), vertex(9.0, 0.0)],
            vec![vertex(9.0, 0.0), vertex(9.0, 1.0), vertex(9.0, 7.0)],
            vec![vertex(9.0, 7.0), vertex(0.0, 8.0)],
            vec![vertex(0.0, 8.0), vertex(0.0, 0.0)],
        ];
        let hole = |x: f64, y: f64| Some([DVec2::new(x, y), DVec2::new(x + 1.0, y + 1.0)]);
        let rows = [
            Row { y: [0.1, 3.0], cells: vec![Cell { x: [0.1, 8.9], hole: hole(2.0, 1.0) }] },
            Row {
                y: [3.1, 6.0],
                cells: vec![Cell { x: [0.1, 3.0], hole: hole(1.0, 4.0) }, Cell { x: [3.0, 8.9], hole: None }],
            },
        ];
        let (mut edges, mut area) = (BTreeMap::<[[u64; 2]; 2], i32>::new(), 0.0);
        skin(&outline, &rows, place, |face| {
            for i in 0..face.len() {
                let [a, b] = [face[i].local, face[(i + 1) % face.len()].local];
                area += a.perp_dot(b) / 2.0;
                let key = [a, b].map(|p| [p.x.to_bits(), p.y.to_bits()]);
                *edges.entry(key).or_default() += 1;
                *edges.entry([key[1], key[0]]).or_default() -= 1;
            }
        });
        assert!((area - (9.0 * 7.5 - 2.0)).abs() < 1e-9, "{area}");
        assert_eq!(edges.values().filter(|&&n| n == 1).count(), 6 + 8);
        assert!(edges.values().all(|n| n.abs() <= 1));
    }
}
