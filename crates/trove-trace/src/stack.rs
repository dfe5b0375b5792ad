//! What a ray has still to visit.

use core::mem::MaybeUninit;

/// Most pairs from a hierarchy's root to a leaf.
pub const DEPTH: usize = 64;
/// A ray goes down one hierarchy over instances and one over triangles, and leaves one child behind at each pair.
const ROOM: usize = 2 * DEPTH;

/// Children and where the ray enters them. Its entries are written before they are read, so none is made at the start.
pub(crate) struct Stack {
    /// Distance in the upper half, so that both are read and written together.
    entries: [MaybeUninit<u64>; ROOM],
    pub(crate) len: usize,
}

impl Stack {
    #[inline(always)]
    pub(crate) fn new() -> Self {
        Self { entries: [const { MaybeUninit::uninit() }; ROOM], len: 0 }
    }

    #[inline(always)]
    pub(crate) fn push(&mut self, t: f32, child: u32) {
        self.entries[self.len] = MaybeUninit::new(u64::from(t.to_bits()) << 32 | u64::from(child));
        self.len += 1;
    }

    #[inline(always)]
    pub(crate) fn pop(&mut self) -> (f32, u32) {
        self.len -= 1;
        // SAFETY: `len` only counts entries that were pushed.
        let entry = unsafe { self.entries[self.len].assume_init() };
        (f32::from_bits((entry >> 32) as u32), entry as u32)
    }
}
