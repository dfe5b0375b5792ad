//! Buildings and their parts.

use glam::Vec3;

use crate::Polygon;

/// What a building was built as.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum BuildingKind {
    /// Detached, semi-detached or a farmhouse.
    House,
    /// A house of one storey.
    Bungalow,
    /// A row of houses.
    Terrace,
    /// Flats or a dormitory.
    Apartments,
    /// Dwellings of some kind.
    Residential,
    /// A hotel.
    Hotel,
    /// Offices.
    Office,
    /// Business of some kind.
    Commercial,
    /// Shops.
    Retail,
    /// A supermarket.
    Supermarket,
    /// A factory or workshop.
    Industrial,
    /// A warehouse.
    Warehouse,
    /// A hangar.
    Hangar,
    /// A town hall, ministry or other public building.
    Public,
    /// A school or college.
    School,
    /// A university.
    University,
    /// A hospital.
    Hospital,
    /// A station or terminal.
    Transport,
    /// A church, mosque, temple or synagogue.
    Worship,
    /// A chapel.
    Chapel,
    /// A stadium.
    Stadium,
    /// One garage or several.
    Garage,
    /// A roof over parked cars.
    Carport,
    /// A car park of several storeys.
    Parking,
    /// A roof on posts.
    Canopy,
    /// A shed.
    Shed,
    /// A hut.
    Hut,
    /// A kiosk.
    Kiosk,
    /// A substation, toilets or the like.
    Service,
    /// A greenhouse.
    Greenhouse,
    /// Being built.
    Construction,
    /// Something that has no name here.
    Other,
}

impl BuildingKind {
    /// Whether a family lives in it, with no wall shared but to one side.
    pub fn is_house(self) -> bool {
        matches!(self, Self::House | Self::Bungalow)
    }

    /// Whether it is a roof on posts.
    pub fn is_canopy(self) -> bool {
        matches!(self, Self::Canopy | Self::Carport)
    }

    /// Whether it is a hall in which goods are made or kept.
    pub fn is_works(self) -> bool {
        matches!(self, Self::Industrial | Self::Warehouse | Self::Hangar)
    }
}

/// What outer walls are made of, as far as it is seen.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
#[allow(missing_docs)] // the names are the definition
pub enum WallMaterial {
    Brick,
    Concrete,
    Glass,
    Metal,
    Plaster,
    Stone,
    Tiles,
    Wood,
}

/// What a roof is covered with.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum RoofMaterial {
    /// Tiles of clay or concrete.
    Tiles,
    /// Slates.
    Slate,
    /// Stone slabs, or stones on a flat roof.
    Stone,
    /// Shingles of wood or of an unknown kind.
    Shingle,
    /// Tar paper, asphalt, and shingles of it.
    Bitumen,
    /// Sheets of metal or fibre cement.
    Metal,
    /// Copper.
    Copper,
    /// Gravel.
    Gravel,
    /// Concrete.
    Concrete,
    /// Glass.
    Glass,
    /// Plants.
    Plants,
}

/// A roof's form.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(rename_all = "kebab-case"))]
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
    /// What it was built as; `None` where the map says no more than that it is a building.
    pub kind: Option<BuildingKind>,
    /// It stands in for the outline that it lies in.
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
    /// What its walls are made of, where tagged.
    pub material: Option<WallMaterial>,
    /// The walls' colour, linear RGB, where tagged.
    pub color: Option<Vec3>,
    /// The roof's colour, linear RGB, where tagged.
    pub roof_color: Option<Vec3>,
    /// Name; empty where it has none.
    pub name: String,
    /// What its roof is covered with, where tagged.
    pub roof_material: Option<RoofMaterial>,
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
    /// A building of which nothing but outline and kind is known.
    pub fn new(id: i64, footprint: Polygon, kind: Option<BuildingKind>) -> Self {
        Self {
            id,
            footprint,
            kind,
            part: false,
            height_m: None,
            min_height_m: 0.0,
            levels: None,
            roof: None,
            roof_height_m: None,
            material: None,
            color: None,
            roof_color: None,
            name: String::new(),
            roof_material: None,
            roof_levels: None,
            roof_direction_rad: None,
            ridge_across: false,
            year: None,
            shop: false,
        }
    }
}
