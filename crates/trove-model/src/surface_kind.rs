//! What surfaces are made of.

/// What a surface of the built place is made of.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[allow(missing_docs)] // the names are the definition
pub enum SurfaceKind {
    Asphalt,
    /// White paint on the road.
    MarkingWhite,
    /// Yellow paint on the road.
    MarkingYellow,
    /// An iron cover or grating in the road: its texture is one of them.
    RoadCover,
    Paving,
    Kerb,
    Concrete,
    Grass,
    Soil,
    Gravel,
    Water,
    FlatRoof,
    RoofTiles,
    /// A facade: its texture holds whole bays and whole storeys (see [`Surface::size_m`](crate::Surface::size_m) and [`Surface::cells`](crate::Surface::cells)).
    Facade,
    /// A facade's ground floor: shops, entrances, loading bays.
    FacadeGroundFloor,
    /// A wall without openings.
    Wall,
    /// Names of shops, a cell each.
    ShopSign,
    /// Back walls of rooms, a cell each, in rows: homes, offices, shops.
    RoomBack,
    /// What things are made of (steel, cloth, timber, masonry); nothing that is built in place draws among them.
    Thing,
}

impl SurfaceKind {
    /// Every kind with its name in files.
    pub const ALL: [(Self, &str); 19] = [
        (Self::Asphalt, "asphalt"),
        (Self::MarkingWhite, "marking_white"),
        (Self::MarkingYellow, "marking_yellow"),
        (Self::RoadCover, "road_cover"),
        (Self::Paving, "paving"),
        (Self::Kerb, "kerb"),
        (Self::Concrete, "concrete"),
        (Self::Grass, "grass"),
        (Self::Soil, "soil"),
        (Self::Gravel, "gravel"),
        (Self::Water, "water"),
        (Self::FlatRoof, "flat_roof"),
        (Self::RoofTiles, "roof_tiles"),
        (Self::Facade, "facade"),
        (Self::FacadeGroundFloor, "facade_ground_floor"),
        (Self::Wall, "wall"),
        (Self::ShopSign, "shop_sign"),
        (Self::RoomBack, "room_back"),
        (Self::Thing, "thing"),
    ];

    /// The name in files.
    pub fn name(self) -> &'static str {
        Self::ALL[self as usize].1
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_kind_has_its_name() {
        assert!(SurfaceKind::ALL.iter().enumerate().all(|(i, (kind, _))| *kind as usize == i));
    }
}
