//! Names of the seeds that surfaces are drawn by.

use trove_model::SurfaceKind;

/// Where the choice of a kind's surface is drawn; the names are part of what a recipe's seed means and never change.
pub(super) fn seed_name(kind: SurfaceKind) -> &'static str {
    match kind {
        SurfaceKind::Asphalt => "Asphalt",
        SurfaceKind::MarkingWhite => "MarkingWhite",
        SurfaceKind::MarkingYellow => "MarkingYellow",
        SurfaceKind::RoadCover => "RoadCover",
        SurfaceKind::Paving => "Paving",
        SurfaceKind::Kerb => "Kerb",
        SurfaceKind::Concrete => "Concrete",
        SurfaceKind::Grass => "Grass",
        SurfaceKind::Soil => "Soil",
        SurfaceKind::Gravel => "Gravel",
        SurfaceKind::Water => "Water",
        SurfaceKind::FlatRoof => "FlatRoof",
        SurfaceKind::RoofTiles => "RoofTiles",
        SurfaceKind::Facade => "Facade",
        SurfaceKind::FacadeGroundFloor => "FacadeGroundFloor",
        SurfaceKind::Wall => "Wall",
        SurfaceKind::ShopSign => "ShopSign",
        SurfaceKind::RoomBack => "RoomBack",
        SurfaceKind::Thing => "Thing",
    }
}
