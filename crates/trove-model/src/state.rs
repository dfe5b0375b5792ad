//! What road users do.

/// What someone or something does at a moment, as far as the recording tells.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum State {
    /// A vehicle that drives.
    Moving,
    /// A vehicle that stands; for how long is not known.
    Stopped,
    /// A vehicle that the annotator calls parked, and that stands.
    Parked,
    /// A vehicle that slows down by so much that brake lamps have to be lit ([`State::BRAKES_MPS2`]).
    Braking,
    /// Someone rides a cycle.
    Riding,
    /// Someone walks.
    Walking,
    /// Someone runs.
    Running,
    /// Someone stands.
    Standing,
    /// Someone sits.
    Sitting,
}

impl State {
    /// Every state with its name in files.
    pub const ALL: [Self; 9] = [
        Self::Moving,
        Self::Stopped,
        Self::Parked,
        Self::Braking,
        Self::Riding,
        Self::Walking,
        Self::Running,
        Self::Standing,
        Self::Sitting,
    ];

    /// What slows down by more than this has to show it, metres per second squared (UN Regulation 13-H, 5.2.22.4).
    pub const BRAKES_MPS2: f64 = 1.3;

    /// Slower than this, a vehicle stands, metres per second.
    pub const STANDS_MPS: f64 = 0.2;

    /// Its name in files.
    pub fn name(self) -> &'static str {
        match self {
            Self::Moving => "moving",
            Self::Stopped => "stopped",
            Self::Parked => "parked",
            Self::Braking => "braking",
            Self::Riding => "riding",
            Self::Walking => "walking",
            Self::Running => "running",
            Self::Standing => "standing",
            Self::Sitting => "sitting",
        }
    }
}
