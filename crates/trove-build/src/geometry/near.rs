//! Finds what is near among many rectangles.

use std::collections::HashMap;

use trove_model::Bounds;

/// Side of a bucket, metres: about a building's.
const BUCKET_M: f64 = 24.0;

/// Rectangles in square buckets.
pub(crate) struct Near {
    boxes: Vec<Option<Bounds>>,
    // Only looked up; what is found is sorted.
    buckets: HashMap<[i64; 2], Vec<usize>>,
}

impl Near {
    pub(crate) fn new(boxes: impl Iterator<Item = Option<Bounds>>) -> Self {
        let mut near = Self { boxes: boxes.collect(), buckets: HashMap::new() };
        for (i, bounds) in near.boxes.iter().enumerate() {
            for key in bounds.iter().flat_map(keys) {
                near.buckets.entry(key).or_default().push(i);
            }
        }
        near
    }

    /// Those that share a point with `bounds`, in the order given.
    pub(crate) fn at(&self, bounds: Bounds) -> impl Iterator<Item = usize> + '_ {
        let mut found: Vec<usize> = keys(&bounds).filter_map(|key| self.buckets.get(&key)).flatten().copied().collect();
        found.sort_unstable();
        found.dedup();
        found.into_iter().filter(move |&i| self.boxes[i].is_some_and(|b| b.overlaps(&bounds)))
    }
}

fn keys(bounds: &Bounds) -> impl Iterator<Item = [i64; 2]> + use<> {
    let [low, high] = [bounds.min, bounds.max].map(|p| (p / BUCKET_M).floor().as_i64vec2());
    (low.x..=high.x).flat_map(move |x| (low.y..=high.y).map(move |y| [x, y]))
}
