//! Nodes of a hierarchy: two boxes side by side, one line of a cache.

use glam::{Vec3, Vec4};

/// Most triangles or instances of a leaf.
pub const LEAF_MOST: u32 = 15;
/// Bits of a child that say where it is.
const PLACE_BITS: u32 = 28;

/// Two boxes and what lies in each.
#[derive(Clone, Copy, Debug, Default)]
#[repr(C, align(64))]
pub struct Pair {
    /// Along x, y and z: where the first and the second box begin, where they end.
    pub(crate) bounds: [Vec4; 3],
    /// As [`inner`] and [`leaf`] give them.
    pub(crate) children: [u32; 2],
}

impl Pair {
    /// Of two boxes, each by its lowest and highest corner.
    pub fn new(boxes: [[Vec3; 2]; 2], children: [u32; 2]) -> Self {
        let [[low, high], [low_of_second, high_of_second]] = boxes;
        let along = |axis: usize| Vec4::new(low[axis], low_of_second[axis], high[axis], high_of_second[axis]);
        Self { bounds: [along(0), along(1), along(2)], children }
    }
}

/// A child that is another pair.
pub fn inner(index: u32) -> u32 {
    debug_assert!(index >> PLACE_BITS == 0);
    index
}

/// A child that is `count` triangles or instances from `first` on, 1 to [`LEAF_MOST`].
pub fn leaf(first: u32, count: u32) -> u32 {
    debug_assert!(first >> PLACE_BITS == 0 && (1..=LEAF_MOST).contains(&count));
    count << PLACE_BITS | first
}

/// The first place and the number of a leaf's; the number is 0 for a pair, whose index the first is.
pub(crate) fn places(child: u32) -> (u32, u32) {
    (child & ((1 << PLACE_BITS) - 1), child >> PLACE_BITS)
}
