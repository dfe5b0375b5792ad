//! Where a cut-out texture is there: one bit a cell.

use glam::Vec2;

/// Cells of a repeating texture, in blocks of 8×8 bits.
#[derive(Clone, Copy)]
pub struct Mask<'a> {
    /// Cells along u and v: powers of two, at least 8.
    pub size: [i32; 2],
    /// Bit 8·y + x of a block; rows run up with v.
    pub blocks: &'a [u64],
}

impl Mask<'_> {
    /// Whether the surface is there at `uv`.
    #[inline(always)]
    pub fn covers(&self, uv: Vec2) -> bool {
        let [width, height] = self.size;
        let (x, y) = (floor(uv.x * width as f32) & (width - 1), floor(uv.y * height as f32) & (height - 1));
        // Blocks in a row of them are a power of two too.
        let block = ((y >> 3) << (width.trailing_zeros() - 3)) | (x >> 3);
        self.blocks[block as usize] >> (((y & 7) << 3) | (x & 7)) & 1 != 0
    }
}

/// The largest whole number that is not above `x`; the library's `floor` is a call on many processors.
fn floor(x: f32) -> i32 {
    let whole = x as i32;
    whole - i32::from(whole as f32 > x)
}
