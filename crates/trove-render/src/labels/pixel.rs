//! What every pixel shows first.

/// Indices of no instance: the sky, and what lies outside the lens's image circle.
pub(super) const SKY: u32 = u32::MAX;
pub(super) const OUTSIDE: u32 = u32::MAX - 1;

/// What the pixels of a picture show first, row by row.
pub(super) struct Shown {
    pub width: u32,
    /// Indices into the scene's instances, [`SKY`] or [`OUTSIDE`].
    pub instance: Vec<u32>,
    /// From the camera, infinite where there is nothing.
    pub range_m: Vec<f64>,
}

impl Shown {
    /// Instance and range of a pixel.
    pub(super) fn at(&self, x: u32, y: u32) -> (u32, f64) {
        let i = y as usize * self.width as usize + x as usize;
        (self.instance[i], self.range_m[i])
    }
}
