//! What a map (OpenStreetMap) knows of a place, in World.

use glam::{DVec2, Vec3};

use crate::Polygon;

/// Roads, buildings, land and furniture of a place.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct StreetMap {
    /// Ways that are driven or walked on.
    pub roads: Vec<Road>,
    /// Buildings and their parts.
    pub buildings: Vec<Building>,
    /// Land use and cover.
    pub land: Vec<Land>,
    /// Single things.
    pub furniture: Vec<Furniture>,
    /// Things drawn as lines.
    pub lines: Vec<MapLine>,
    /// Licence, with whom to name (`© OpenStreetMap contributors, ODbL 1.0`).
    pub licence: String,
}

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
    /// OpenStreetMap's `surface`; empty where not tagged.
    pub surface: String,
    /// Name; empty where it has none.
    pub name: String,
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
    /// How a crossing is marked: `crossing:markings`, else `crossing` (`zebra`, `lines`, `no`, `unmarked`, …); empty where
    /// not tagged.
    pub crossing: String,
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
            surface: String::new(),
            name: String::new(),
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
            crossing: String::new(),
        }
    }
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

/// A roof's form.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[allow(missing_docs)] // OpenStreetMap's own names
pub enum RoofShape {
    Flat,
    Gabled,
    Hipped,
    HalfHipped,
    Pyramidal,
    Gambrel,
    Mansard,
    Skillion,
    Dome,
    Cone,
    Onion,
    Round,
}

/// A building, or a part that stands for some of it.
#[derive(Clone, Debug, PartialEq)]
pub struct Building {
    /// OpenStreetMap's id; negative for a relation.
    pub id: i64,
    /// Outline on the ground.
    pub footprint: Polygon,
    /// The value of `building` or `building:part` (`yes`, `apartments`, `office`, …).
    pub kind: String,
    /// A `building:part`: it stands in for the outline that it lies in.
    pub part: bool,
    /// Height of the top above ground with the roof, where tagged.
    pub height_m: Option<f64>,
    /// Height of the bottom above ground, where tagged (0 otherwise).
    pub min_height_m: f64,
    /// Storeys without the roof's, where tagged.
    pub levels: Option<f64>,
    /// Roof's form, where tagged.
    pub roof: Option<RoofShape>,
    /// Roof's own height, where tagged.
    pub roof_height_m: Option<f64>,
    /// `building:material`; empty where not tagged.
    pub material: String,
    /// `building:colour`, linear RGB.
    pub color: Option<Vec3>,
    /// `roof:colour`, linear RGB.
    pub roof_color: Option<Vec3>,
    /// Name; empty where it has none.
    pub name: String,
    /// `roof:material`; empty where not tagged.
    pub roof_material: String,
    /// Storeys within the roof, where tagged.
    pub roof_levels: Option<f64>,
    /// Direction that a skillion roof falls to, radians counter-clockwise from east, where tagged.
    pub roof_direction_rad: Option<f64>,
    /// Whether the ridge runs across the longer side (`roof:orientation=across`).
    pub ridge_across: bool,
    /// Year in which it was built, where tagged.
    pub year: Option<i32>,
    /// A shop, restaurant or the like is in it, by its own tags or by a mapped place within it.
    pub shop: bool,
}

impl Building {
    /// A building of which nothing but the outline is known.
    pub fn new(id: i64, footprint: Polygon, kind: &str) -> Self {
        Self {
            id,
            footprint,
            kind: kind.to_owned(),
            part: false,
            height_m: None,
            min_height_m: 0.0,
            levels: None,
            roof: None,
            roof_height_m: None,
            material: String::new(),
            color: None,
            roof_color: None,
            name: String::new(),
            roof_material: String::new(),
            roof_levels: None,
            roof_direction_rad: None,
            ridge_across: false,
            year: None,
            shop: false,
        }
    }
}

/// What a piece of land is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
#[allow(missing_docs)] // the names are the definition
pub enum LandKind {
    Grass,
    Park,
    Garden,
    Wood,
    Scrub,
    Farmland,
    Sand,
    Water,
    Parking,
    /// Square or pedestrian area.
    Paved,
    /// Raised above the carriageway within it.
    TrafficIsland,
    Pitch,
    Construction,
    Residential,
    Commercial,
    Industrial,
}

/// A piece of land.
#[derive(Clone, Debug, PartialEq)]
pub struct Land {
    /// OpenStreetMap's id; negative for a relation.
    pub id: i64,
    /// What it is.
    pub kind: LandKind,
    /// Outline.
    pub polygon: Polygon,
}

/// What a single mapped thing is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
#[allow(missing_docs)] // the names are the definition
pub enum FurnitureKind {
    StreetLamp,
    TrafficSignal,
    TrafficSign,
    StopSign,
    GiveWaySign,
    Crossing,
    Tree,
    Shrub,
    Bench,
    PicnicTable,
    Bin,
    Hydrant,
    Bollard,
    BusStop,
    UtilityPole,
    BicycleParking,
    Mailbox,
    StreetCabinet,
    Telephone,
    AdvertisingColumn,
    Fountain,
    Flagpole,
    /// A cover in the road.
    Manhole,
}

/// A single mapped thing.
#[derive(Clone, Debug, PartialEq)]
pub struct Furniture {
    /// OpenStreetMap's id.
    pub id: i64,
    /// What it is.
    pub kind: FurnitureKind,
    /// Where it stands, metres.
    pub position: DVec2,
    /// Direction it faces, radians counter-clockwise from east, where tagged.
    pub heading_rad: Option<f64>,
    /// Height, where tagged.
    pub height_m: Option<f64>,
    /// What of its kind it is; empty where not tagged. A tree's species or genus, then its `leaf_type` (`Tilia cordata
    /// broadleaved`); a sign's `traffic_sign`; a crossing's marking (see [`Road::crossing`]); where a lamp is mounted.
    pub detail: String,
}

impl Furniture {
    /// A thing of which nothing but kind and place is known.
    pub fn new(id: i64, kind: FurnitureKind, position: DVec2) -> Self {
        Self { id, kind, position, heading_rad: None, height_m: None, detail: String::new() }
    }
}

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
    /// What of its kind it is (`fence_type`, `material`); empty where not tagged.
    pub detail: String,
}
