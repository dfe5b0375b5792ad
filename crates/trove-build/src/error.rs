//! What can be wrong with what a scene is built from.

/// Why a scene cannot be built.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum BuildError {
    /// The drive has nothing to build around.
    #[error("drive {drive}: expected at least one keyframe, found none; choose another scene")]
    EmptyDrive {
        /// The dataset's name of it.
        drive: String,
    },
    /// A number that everything hangs on is not finite.
    #[error(
        "drive {drive}, keyframe {keyframe}: expected a finite vehicle pose, found {found}; leave that keyframe out"
    )]
    BadPose {
        /// The dataset's name of the drive.
        drive: String,
        /// Index of the keyframe.
        keyframe: usize,
        /// The pose as read.
        found: String,
    },
    /// A place that no street's worth of memory holds, from a pose or box far away from the others.
    #[error(
        "drive {drive}: expected a place of at most {limit_m:.0} m, found one of {side_m:.0} m; leave out the keyframes \
         or boxes that are far away"
    )]
    TooLarge {
        /// The dataset's name of the drive.
        drive: String,
        /// Side of its square, metres; not a number where a box has none.
        side_m: f64,
        /// The most that can be built, metres.
        limit_m: f64,
    },
    /// A place without a road to stand on.
    #[error("place {place}: expected a road for cars within {size_m:.0} m, found none; move the place or enlarge it")]
    NoRoads {
        /// Name of the place.
        place: String,
        /// Side of the square that was searched, metres.
        size_m: f64,
    },
}
