//! Finds the nearest of many line segments.

use std::collections::HashMap;

use glam::DVec2;

use crate::geometry::plane_raster::bucket;

/// Segments in square buckets.
#[derive(Clone, Debug, Default)]
pub(crate) struct SegmentIndex {
    segments: Vec<[DVec2; 2]>,
    /// The line that each segment is of.
    lines: Vec<usize>,
    // Only ever looked up, so the order inside does not reach a result.
    buckets: HashMap<[i64; 2], Vec<usize>>,
}

/// The nearest segment.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Nearest {
    /// From the point to the segment, metres.
    pub distance_m: f64,
    /// The nearest position on it.
    pub position: DVec2,
    /// Its direction, unit; zero for a segment without length.
    pub along: DVec2,
    /// Which of the lines it is of, in the order given.
    pub line: usize,
}

/// Side of a bucket, metres.
const BUCKET_M: f64 = 20.0;

impl SegmentIndex {
    /// All segments of some lines.
    pub(crate) fn new<'a>(lines: impl IntoIterator<Item = &'a [DVec2]>) -> Self {
        let mut index = Self::default();
        let lines = lines.into_iter().enumerate();
        for (line, pair) in lines.flat_map(|(i, line)| line.windows(2).map(move |pair| (i, pair))) {
            let [a, b] = [pair[0], pair[1]];
            let (low, high) = (bucket(a.min(b), BUCKET_M), bucket(a.max(b), BUCKET_M));
            for x in low[0]..=high[0] {
                for y in low[1]..=high[1] {
                    index.buckets.entry([x, y]).or_default().push(index.segments.len());
                }
            }
            index.segments.push([a, b]);
            index.lines.push(line);
        }
        index
    }

    /// The nearest segment within `reach_m`; of equally near ones the first given.
    pub(crate) fn nearest(&self, p: DVec2, reach_m: f64) -> Option<Nearest> {
        // Most have one near; what is found within a radius is the nearest of all.
        let mut radius_m = BUCKET_M.min(reach_m);
        loop {
            let found = self.nearest_within(p, radius_m);
            if found.is_some() || radius_m >= reach_m {
                return found;
            }
            radius_m = (3.0 * radius_m).min(reach_m);
        }
    }

    fn nearest_within(&self, p: DVec2, reach_m: f64) -> Option<Nearest> {
        let (low, high) = (bucket(p - reach_m, BUCKET_M), bucket(p + reach_m, BUCKET_M));
        let mut best: Option<(f64, usize)> = None;
        for x in low[0]..=high[0] {
            for y in low[1]..=high[1] {
                for &i in self.buckets.get(&[x, y]).into_iter().flatten() {
                    let distance_m = self.on(i, p).distance(p);
                    let nearer = best.is_none_or(|(d, j)| distance_m < d || (distance_m == d && i < j));
                    if distance_m <= reach_m && nearer {
                        best = Some((distance_m, i));
                    }
                }
            }
        }
        let (distance_m, i) = best?;
        let [a, b] = self.segments[i];
        let along = (b - a).normalize_or_zero();
        Some(Nearest { distance_m, position: self.on(i, p), along, line: self.lines[i] })
    }

    /// The line's number and the ends of all segments that may lie within `reach_m` along both axes, in the order given.
    pub(crate) fn around(&self, p: DVec2, reach_m: f64) -> Vec<(usize, [DVec2; 2])> {
        let (low, high) = (bucket(p - reach_m, BUCKET_M), bucket(p + reach_m, BUCKET_M));
        let buckets = (low[0]..=high[0]).flat_map(|x| (low[1]..=high[1]).map(move |y| [x, y]));
        let in_bucket = buckets.filter_map(|bucket| self.buckets.get(&bucket));
        let mut numbers: Vec<usize> = in_bucket.flatten().copied().collect();
        numbers.sort_unstable();
        numbers.dedup();
        numbers.into_iter().map(|i| (self.lines[i], self.segments[i])).collect()
    }

    /// The position on a segment that is nearest to a point.
    fn on(&self, segment: usize, p: DVec2) -> DVec2 {
        let [a, b] = self.segments[segment];
        let ab = b - a;
        let length2 = ab.length_squared();
        let t = if length2 > 0.0 { ((p - a).dot(ab) / length2).clamp(0.0, 1.0) } else { 0.0 };
        a + ab * t
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_nearest_segment_is_found_across_buckets_and_not_beyond_reach() {
        let lines = [
            vec![DVec2::new(-100.0, 0.0), DVec2::new(100.0, 0.0)],
            vec![DVec2::new(50.0, 30.0), DVec2::new(50.0, 90.0)],
        ];
        let index = SegmentIndex::new(lines.iter().map(Vec::as_slice));
        let near = index.nearest(DVec2::new(47.0, 28.0), 40.0).unwrap();
        assert_eq!((near.position, near.along), (DVec2::new(50.0, 30.0), DVec2::Y));
        assert_eq!(index.nearest(DVec2::new(0.0, 12.0), 40.0).unwrap().distance_m, 12.0);
        assert_eq!(index.nearest(DVec2::new(0.0, 50.0), 40.0), None);
    }
}
