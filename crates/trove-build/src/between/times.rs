//! When the moments of a drive are.

use trove_model::Keyframe;

/// Keyframes further apart than this are not neighbours, nanoseconds: what moved between them cannot be told.
pub(crate) const MAX_STEP_NS: i64 = 2_000_000_000;

/// When a moment is.
#[derive(Clone, Copy, Debug)]
pub(super) struct When {
    /// Nanoseconds since 1970 UTC.
    pub time_ns: i64,
    /// The recorded keyframe at it or before it.
    pub keyframe: usize,
    /// The share of the time to the next; 0 at the keyframe itself.
    pub share: f64,
}

/// The moments of a drive: each keyframe, and those between it and the next.
pub(super) fn times(keyframes: &[Keyframe], rate_hz: f64) -> Vec<When> {
    let mut times = Vec::new();
    for (keyframe, now) in keyframes.iter().enumerate() {
        let apart_ns = keyframes.get(keyframe + 1).map_or(0, |next| next.time_ns.saturating_sub(now.time_ns));
        let parts = (apart_ns as f64 * 1e-9 * rate_hz).round().max(1.0) as i64;
        let parts = if (1..=MAX_STEP_NS).contains(&apart_ns) { parts } else { 1 };
        times.extend((0..parts).map(|part| {
            let share = part as f64 / parts as f64;
            When { time_ns: now.time_ns + (apart_ns as f64 * share).round() as i64, keyframe, share }
        }));
    }
    times
}

/// Seconds since a time.
pub(super) fn seconds(time_ns: i64, since_ns: i64) -> f64 {
    time_ns.saturating_sub(since_ns) as f64 * 1e-9
}
