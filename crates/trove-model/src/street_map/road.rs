//! Ways that are driven or walked on.

use glam::DVec2;

/// What a way is for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
#[allow(missing_docs)] // OpenStreetMap's own names
pub enum RoadKind {
    Motorway,
    Trunk,
    Primary,
    Secondary,
    Tertiary,
    Residential,
    /// Unclassified and everything else for cars.
    Minor,
    Service,
    /// Shared or pedestrian street.
    Pedestrian,
    Cycleway,
    /// Footway, path, steps.
    Footway,
    /// A footway across a road.
    Crossing,
}

impl RoadKind {
    /// Whether cars drive on it.
    pub fn is_for_cars(self) -> bool {
        self <= Self::Service
    }
}

/// Which sides have a sidewalk, seen in the way's direction; `None` where the map does not say.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct SidewalkSides {
    /// On the left.
    pub left: Option<bool>,
    /// On the right.
    pub right: Option<bool>,
}

/// A way.
#[derive(Clone, Debug, PartialEq)]
pub struct Road {
    /// OpenStreetMap's id.
    pub id: i64,
    /// What it is for.
    pub kind: RoadKind,
    /// At least two vertices, metres.
    pub centreline: Vec<DVec2>,
    /// All lanes of both directions, where tagged.
    pub lanes: Option<u32>,
    /// Carriageway width, where tagged.
    pub width_m: Option<f64>,
    /// Traffic runs in the way's direction only.
    pub oneway: bool,
    /// Sidewalks, where tagged.
    pub sidewalk: SidewalkSides,
    /// Vertical order; 0 is the ground.
    pub layer: i32,
    /// On a bridge.
    pub bridge: bool,
    /// In a tunnel.
    pub tunnel: bool,
    /// What it is paved with; `None` where the map does not say.
    pub surface: Option<RoadSurface>,
    /// The street's name; `None` where it has none.
    pub name: Option<String>,
    /// Lanes of all that run against the way's direction, where tagged; 0 on a one-way street.
    pub lanes_backward: Option<u32>,
    /// Where each lane in the way's direction leads, from left to right as driven; empty where not tagged.
    pub turns_forward: Vec<Turns>,
    /// The same against the way's direction, from left to right as driven.
    pub turns_backward: Vec<Turns>,
    /// What is parked on the left and on the right, seen in the way's direction; `None` where the map does not say.
    pub parking: Sides<Option<Parking>>,
    /// Cycle lanes on the left and on the right, seen in the way's direction.
    pub cycleway: Sides<Option<Cycleway>>,
    /// Part of a roundabout.
    pub roundabout: bool,
    /// A ramp between roads (`*_link`).
    pub link: bool,
    /// Stairs.
    pub steps: bool,
    /// Has street lamps, where tagged.
    pub lit: Option<bool>,
    /// Speed limit, where tagged.
    pub speed_limit_kmh: Option<f64>,
    /// How a crossing is marked; `None` where the map does not say.
    pub crossing: Option<CrossingMarking>,
}

impl Road {
    /// A two-way road of which nothing else is known.
    pub fn new(id: i64, kind: RoadKind, centreline: Vec<DVec2>) -> Self {
        Self {
            id,
            kind,
            centreline,
            lanes: None,
            width_m: None,
            oneway: false,
            sidewalk: SidewalkSides::default(),
            layer: 0,
            bridge: false,
            tunnel: false,
            surface: None,
            name: None,
            lanes_backward: None,
            turns_forward: Vec::new(),
            turns_backward: Vec::new(),
            parking: Sides::default(),
            cycleway: Sides::default(),
            roundabout: false,
            link: false,
            steps: false,
            lit: None,
            speed_limit_kmh: None,
            crossing: None,
        }
    }
}

/// What a way is paved with.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum RoadSurface {
    /// Asphalt or chip seal.
    Asphalt,
    /// Cast or in slabs.
    Concrete,
    /// Setts and cobblestones.
    Setts,
    /// Paving stones and bricks.
    PavingStones,
    /// Loose or compacted stones.
    Gravel,
    /// Earth, sand or grass: nothing was laid.
    Earth,
}

/// How a crossing is marked on the road.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum CrossingMarking {
    /// Nothing is painted.
    Unmarked,
    /// Bars along the road.
    Zebra,
    /// Bars between two lines.
    Ladder,
    /// Two lines.
    Lines,
    /// Two broken or dotted lines.
    Dashes,
    /// As is usual in the country; the map does not say how.
    Usual,
    /// As is usual in the country for crossings with traffic signals.
    Signals,
}

/// Something for the left and for the right side of a way, seen in its direction.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Sides<T> {
    /// On the left.
    pub left: T,
    /// On the right.
    pub right: T,
}

/// Where a lane leads at the next junction (`turn:lanes`); all `false` where it is marked with nothing.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Turns {
    /// Left, sharply or slightly too.
    pub left: bool,
    /// Straight on.
    pub through: bool,
    /// Right, sharply or slightly too.
    pub right: bool,
    /// Back.
    pub reverse: bool,
}

/// How cars stand at the side of a road.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[allow(missing_docs)] // OpenStreetMap's own names
pub enum ParkingOrientation {
    Parallel,
    Diagonal,
    Perpendicular,
}

/// Parking at one side of a road (`parking:left` and so on).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Parking {
    /// Cars must not stand here.
    No,
    /// On the carriageway, within its width.
    Lane(ParkingOrientation),
    /// In bays beside the carriageway.
    Bays(ParkingOrientation),
    /// On the kerb or half on it.
    Kerb(ParkingOrientation),
}

/// What there is for bicycles at one side of a road.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Cycleway {
    /// Nothing.
    No,
    /// A marked lane on the carriageway.
    Lane,
    /// A path beside the carriageway.
    Track,
    /// Symbols on a lane for cars or for buses.
    Shared,
}
