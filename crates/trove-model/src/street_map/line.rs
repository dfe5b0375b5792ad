//! Things that the map draws as lines.

use glam::DVec2;

/// What a line of the map is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
#[allow(missing_docs)] // the names are the definition
pub enum LineKind {
    Fence,
    Wall,
    Hedge,
    GuardRail,
    /// Wires from pole to pole.
    PowerLine,
    /// Rails in or beside the street.
    Tram,
    Railway,
}

/// How a fence, wall or guard rail is made.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum BarrierStyle {
    /// A rail at the height of a hand.
    Handrail,
    /// Wire mesh or wires between posts.
    Wire,
    /// Boards, poles or pickets of wood.
    Wood,
    /// Bars of metal.
    Bars,
    /// Panels that nobody sees through.
    Panels,
    /// Around a construction site.
    Hoarding,
    /// Brick.
    Brick,
    /// Stone.
    Stone,
    /// Concrete.
    Concrete,
}

/// A thing that the map draws as a line.
#[derive(Clone, Debug, PartialEq)]
pub struct MapLine {
    /// OpenStreetMap's id.
    pub id: i64,
    /// What it is.
    pub kind: LineKind,
    /// At least two vertices, metres.
    pub line: Vec<DVec2>,
    /// Height, where tagged.
    pub height_m: Option<f64>,
    /// How a fence, wall or guard rail is made; `None` where the map does not say.
    pub style: Option<BarrierStyle>,
}
