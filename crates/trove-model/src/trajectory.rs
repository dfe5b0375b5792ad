//! Where something was over time.

use crate::{Frame, Pose};

/// Poses `dst_from_src` over time, each later than the one before.
#[derive(Clone, Debug, PartialEq)]
pub struct Trajectory<Dst: Frame, Src: Frame>(Vec<(i64, Pose<Dst, Src>)>);

/// What was wrong with the order of a trajectory's poses.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Disorder {
    /// Poses that were put before one that they followed.
    pub backwards: usize,
    /// Poses of a time that one before them has, which were left out.
    pub duplicates: usize,
}

impl<Dst: Frame, Src: Frame> Trajectory<Dst, Src> {
    /// Between poses farther apart in time than this nothing is known, nanoseconds.
    pub const LONGEST_GAP_NS: i64 = 300_000_000;

    /// From times, nanoseconds since 1970 UTC, and poses, which are put in order; the first of several of one time stands.
    pub fn new(mut moments: Vec<(i64, Pose<Dst, Src>)>) -> (Self, Disorder) {
        let backwards = moments.windows(2).filter(|pair| pair[1].0 < pair[0].0).count();
        moments.sort_by_key(|(time_ns, _)| *time_ns);
        let count = moments.len();
        moments.dedup_by_key(|(time_ns, _)| *time_ns);
        let duplicates = count - moments.len();
        (Self(moments), Disorder { backwards, duplicates })
    }

    /// Times, nanoseconds since 1970 UTC, and poses, in the order of time.
    pub fn moments(&self) -> &[(i64, Pose<Dst, Src>)] {
        &self.0
    }

    /// The pose at a time, between those before and after; `None` before the first, after the last, and in a gap longer
    /// than [`Trajectory::LONGEST_GAP_NS`].
    pub fn at(&self, time_ns: i64) -> Option<Pose<Dst, Src>> {
        let next = self.0.partition_point(|(t, _)| *t < time_ns);
        let (after_ns, after) = self.0.get(next)?;
        if *after_ns == time_ns {
            return Some(*after);
        }
        let (before_ns, before) = self.0.get(next.checked_sub(1)?)?;
        let gap_ns = after_ns.saturating_sub(*before_ns);
        let share = time_ns.saturating_sub(*before_ns) as f64 / gap_ns as f64;
        (gap_ns <= Self::LONGEST_GAP_NS).then(|| before.interpolate(after, share))
    }

    /// Every pose as a function of its time and itself.
    pub fn map<To: Frame, From: Frame>(
        &self,
        mut pose: impl FnMut(i64, &Pose<Dst, Src>) -> Pose<To, From>,
    ) -> Trajectory<To, From> {
        Trajectory(self.0.iter().map(|(time_ns, old)| (*time_ns, pose(*time_ns, old))).collect())
    }

    /// The same poses, all so much later, nanoseconds.
    pub fn later(mut self, by_ns: i64) -> Self {
        self.0.iter_mut().for_each(|(time_ns, _)| *time_ns = time_ns.saturating_add(by_ns));
        self
    }
}

impl<Dst: Frame, Src: Frame> Default for Trajectory<Dst, Src> {
    fn default() -> Self {
        Self(Vec::new())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Ego, World};
    use glam::DVec3;

    fn at(time_ns: i64, x: f64) -> (i64, Pose<World, Ego>) {
        (time_ns, Pose::from_yaw(0.0, DVec3::new(x, 0.0, 0.0)))
    }

    #[test]
    fn something_is_between_its_poses_and_nowhere_beyond_them() {
        let (path, disorder) = Trajectory::new(vec![at(0, 0.0), at(100_000_000, 1.0), at(600_000_000, 9.0)]);
        assert_eq!(disorder, Disorder::default());
        assert_eq!(path.at(100_000_000).unwrap().translation.x, 1.0);
        assert!((path.at(25_000_000).unwrap().translation.x - 0.25).abs() < 1e-12);
        assert!(path.at(-1).is_none() && path.at(600_000_001).is_none());
        assert!(path.at(300_000_000).is_none(), "half a second without a pose");
        assert!(Trajectory::<World, Ego>::default().at(0).is_none());
    }

    #[test]
    fn poses_are_put_in_order_and_the_first_of_a_time_stands() {
        let (path, disorder) = Trajectory::new(vec![at(5, 5.0), at(1, 1.0), at(3, 3.0), at(3, 30.0), at(2, 2.0)]);
        assert_eq!(disorder, Disorder { backwards: 2, duplicates: 1 });
        let found: Vec<_> = path.moments().iter().map(|(time_ns, pose)| (*time_ns, pose.translation.x)).collect();
        assert_eq!(found, [(1, 1.0), (2, 2.0), (3, 3.0), (5, 5.0)]);
        let later =
            path.later(10).map(|time_ns, pose| Pose::<World, World>::from_yaw(0.0, DVec3::X * time_ns as f64) * *pose);
        assert_eq!(later.moments()[0], at(11, 12.0));
    }
}
