//! Houses that touch: without the others each would show what stood between them.

use trove_model::{Bounds, Polygon};

use super::volumes::House;
use crate::geometry::near::Near;

/// Houses nearer to each other than this touch, metres.
const TOUCHING_M: f64 = 0.3;

/// Of each house the first of those that it touches, or that these touch.
pub(super) fn blocks(houses: &[House<'_>]) -> Vec<usize> {
    let parts = houses.iter().enumerate().flat_map(|(i, house)| house.volumes.iter().map(move |v| (i, &v.footprint)));
    let parts: Vec<(usize, &Polygon)> = parts.collect();
    let boxes: Vec<Option<Bounds>> = parts.iter().map(|(_, footprint)| footprint.bounds()).collect();
    let near = Near::new(boxes.iter().copied());
    let mut first: Vec<usize> = (0..houses.len()).collect();
    for (part, bounds) in boxes.iter().enumerate() {
        let Some(bounds) = bounds else { continue };
        for other in near.at(bounds.grown(TOUCHING_M)).filter(|other| *other < part) {
            let ((a, footprint), (b, beside)) = (parts[part], parts[other]);
            let (a, b) = (root(&first, a), root(&first, b));
            if a != b && touch(footprint, beside) {
                first[a.max(b)] = a.min(b);
            }
        }
    }
    (0..houses.len()).map(|i| root(&first, i)).collect()
}

fn root(first: &[usize], mut i: usize) -> usize {
    while first[i] != i {
        i = first[i];
    }
    i
}

fn touch(a: &Polygon, b: &Polygon) -> bool {
    let reaches =
        |a: &Polygon, b: &Polygon| a.exterior.iter().any(|&p| b.contains(p) || b.edge_distance_m(p) < TOUCHING_M);
    reaches(a, b) || reaches(b, a)
}
