//! A line that is measured along.

use glam::DVec2;

/// A line with the length up to each vertex.
pub(crate) struct Path<'a> {
    line: &'a [DVec2],
    along_m: Vec<f64>,
}

impl<'a> Path<'a> {
    /// Of a line of at least two vertices.
    pub(crate) fn new(line: &'a [DVec2]) -> Self {
        let mut sum_m = 0.0;
        let lengths = line.windows(2).map(|w| {
            sum_m += w[0].distance(w[1]);
            sum_m
        });
        let along_m = std::iter::once(0.0).chain(lengths).collect();
        Self { line, along_m }
    }

    pub(crate) fn length_m(&self) -> f64 {
        self.along_m.last().copied().unwrap_or(0.0)
    }

    /// Length up to a vertex.
    pub(crate) fn vertex_m(&self, i: usize) -> f64 {
        self.along_m[i]
    }

    /// The segment that holds a length, and how far into it, 0 to 1.
    fn segment(&self, s_m: f64) -> (usize, f64) {
        let last = self.line.len().saturating_sub(2);
        let i = self.along_m.partition_point(|&a| a <= s_m).saturating_sub(1).min(last);
        let length_m = self.along_m[i + 1] - self.along_m[i];
        (i, if length_m > 0.0 { ((s_m - self.along_m[i]) / length_m).clamp(0.0, 1.0) } else { 0.0 })
    }

    /// Point and unit direction at a length; the ends' beyond them.
    pub(crate) fn at(&self, s_m: f64) -> (DVec2, DVec2) {
        let (i, t) = self.segment(s_m);
        (self.line[i].lerp(self.line[i + 1], t), (self.line[i + 1] - self.line[i]).normalize_or(DVec2::X))
    }

    /// The point `offset_m` to the left at a length.
    pub(crate) fn beside(&self, s_m: f64, offset_m: f64) -> DVec2 {
        let (at, along) = self.at(s_m);
        at + along.perp() * offset_m
    }

    /// The line between two lengths, moved to its left; empty where nothing lies between.
    pub(crate) fn part(&self, from_m: f64, to_m: f64, offset_m: f64) -> Vec<DVec2> {
        let (from_m, to_m) = (from_m.max(0.0), to_m.min(self.length_m()));
        if to_m - from_m < 0.05 {
            return Vec::new();
        }
        let inside = (0..self.line.len()).filter(|&i| self.along_m[i] > from_m + 0.01 && self.along_m[i] < to_m - 0.01);
        let mut points = vec![self.at(from_m).0];
        points.extend(inside.map(|i| self.line[i]));
        points.push(self.at(to_m).0);
        shifted(&points, offset_m)
    }
}

/// The line moved to its left by `distance_m`.
pub(crate) fn shifted(line: &[DVec2], distance_m: f64) -> Vec<DVec2> {
    let direction = |i: usize| (line[i + 1] - line[i]).normalize_or_zero();
    (0..line.len())
        .map(|i| {
            let before = if i > 0 { direction(i - 1) } else { direction(0) };
            let after = if i + 1 < line.len() { direction(i) } else { before };
            line[i] + (before + after).normalize_or(after).perp() * distance_m
        })
        .collect()
}

/// A ring with its first place again at its end.
pub(crate) fn closed(ring: &[DVec2]) -> Vec<DVec2> {
    ring.iter().chain(ring.first()).copied().collect()
}

/// The line with a point at least every `step_m`; its own vertices stay.
pub(crate) fn resampled(line: &[DVec2], step_m: f64) -> Vec<DVec2> {
    let mut points: Vec<DVec2> = line.first().copied().into_iter().collect();
    for pair in line.windows(2) {
        let steps = (pair[0].distance(pair[1]) / step_m).ceil().max(1.0);
        points.extend((1..=steps as usize).map(|i| pair[0].lerp(pair[1], i as f64 / steps)));
    }
    points
}
