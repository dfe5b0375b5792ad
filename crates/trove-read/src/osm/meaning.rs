//! What a tagged thing is to us: one table a kind, in the order in which they are asked.

use trove_model::{FurnitureKind, LandKind, LineKind, RoadKind};

use super::raw::Tags;

/// What a thing's geometry can stand for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Outline {
    /// A way that does not close.
    Line,
    /// A way that closes: a loop or an area, as its tags say.
    Ring,
    /// A multipolygon.
    Area,
}

/// What a way or a multipolygon is built as.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Meaning {
    Building,
    Land(LandKind),
    Road(RoadKind),
    Furniture(FurnitureKind),
    /// Several along a line.
    Row(FurnitureKind),
    /// Nothing, for this reason.
    Nothing(&'static str),
}

pub(super) fn meaning(tags: &Tags, outline: Outline) -> Meaning {
    let closed = outline != Outline::Line;
    let underground = tags.get("location") == "underground" || tags.get("parking") == "underground" || layer(tags) < 0;
    if tags.has("building") || tags.has("building:part") {
        return match (closed, underground) {
            (true, false) => Meaning::Building,
            (true, true) => Meaning::Nothing("underground"),
            (false, _) => Meaning::Nothing("building's outline is not closed"),
        };
    }
    let highway = tags.get("highway");
    if !highway.is_empty() {
        let area = outline == Outline::Area || (closed && tags.get("area") == "yes");
        return match (road_kind(tags), area) {
            _ if tags.has("indoor") => Meaning::Nothing("indoors"),
            (_, true) if underground => Meaning::Nothing("underground"),
            (Some(_), true) => Meaning::Land(LandKind::Paved),
            (None, _) if closed && highway == "platform" => Meaning::Land(LandKind::Paved),
            (Some(kind), false) => Meaning::Road(kind),
            (None, _) => Meaning::Nothing("highway that does not exist or is not a road"),
        };
    }
    if let Some(kind) = land_kind(tags).filter(|_| closed) {
        return if underground { Meaning::Nothing("underground") } else { Meaning::Land(kind) };
    }
    if tags.get("natural") == "tree_row" {
        return Meaning::Row(FurnitureKind::Tree);
    }
    match furniture_kind(tags) {
        Some(_) if underground => Meaning::Nothing("underground"),
        Some(FurnitureKind::Bollard) if !closed => Meaning::Row(FurnitureKind::Bollard),
        Some(kind) => Meaning::Furniture(kind),
        None => Meaning::Nothing(""),
    }
}

/// The vertical order: as tagged, else as implied.
pub(super) fn layer(tags: &Tags) -> i32 {
    stated_layer(tags.get("layer")).unwrap_or_else(|| implied_layer(tags))
}

/// A `layer`; OpenStreetMap's own go from −5 to 5.
pub(super) fn stated_layer(text: &str) -> Option<i32> {
    text.parse().ok().map(|layer: i32| layer.clamp(-5, 5))
}

/// Above for bridges and below for tunnels.
pub(super) fn implied_layer(tags: &Tags) -> i32 {
    i32::from(tags.has("bridge")) - i32::from(in_tunnel(tags))
}

/// Below the ground; a passage through a building is not.
pub(super) fn in_tunnel(tags: &Tags) -> bool {
    tags.has("tunnel") && tags.get("tunnel") != "building_passage"
}

fn road_kind(tags: &Tags) -> Option<RoadKind> {
    let crossing = ["footway", "path", "cycleway"].iter().any(|key| tags.get(key) == "crossing");
    Some(match tags.get("highway") {
        "motorway" | "motorway_link" => RoadKind::Motorway,
        "trunk" | "trunk_link" => RoadKind::Trunk,
        "primary" | "primary_link" => RoadKind::Primary,
        "secondary" | "secondary_link" => RoadKind::Secondary,
        "tertiary" | "tertiary_link" => RoadKind::Tertiary,
        "residential" | "living_street" => RoadKind::Residential,
        "unclassified" | "road" | "busway" | "bus_guideway" | "raceway" => RoadKind::Minor,
        "service" | "track" | "escape" | "emergency_bay" => RoadKind::Service,
        "pedestrian" => RoadKind::Pedestrian,
        "cycleway" | "footway" | "path" if crossing => RoadKind::Crossing,
        "cycleway" => RoadKind::Cycleway,
        "footway" | "path" | "steps" | "bridleway" => RoadKind::Footway,
        _ => return None,
    })
}

fn land_kind(tags: &Tags) -> Option<LandKind> {
    let by_landuse = match tags.get("landuse") {
        "grass" | "meadow" | "village_green" | "recreation_ground" | "greenfield" => Some(LandKind::Grass),
        "flowerbed" | "allotments" | "plant_nursery" => Some(LandKind::Garden),
        "forest" => Some(LandKind::Wood),
        "cemetery" => Some(LandKind::Park),
        "farmland" | "farmyard" | "orchard" | "vineyard" => Some(LandKind::Farmland),
        "basin" | "reservoir" => Some(LandKind::Water),
        "construction" | "brownfield" => Some(LandKind::Construction),
        "residential" | "garages" => Some(LandKind::Residential),
        "commercial" | "retail" | "education" | "institutional" | "religious" => Some(LandKind::Commercial),
        "industrial" | "railway" | "port" | "landfill" | "quarry" => Some(LandKind::Industrial),
        _ => None,
    };
    let by_leisure = || match tags.get("leisure") {
        "park" | "dog_park" => Some(LandKind::Park),
        "garden" => Some(LandKind::Garden),
        "pitch" | "playground" | "track" => Some(LandKind::Pitch),
        "golf_course" | "common" => Some(LandKind::Grass),
        "swimming_pool" => Some(LandKind::Water),
        _ => None,
    };
    let by_nature = || match tags.get("natural") {
        "wood" => Some(LandKind::Wood),
        "scrub" | "heath" | "shrubbery" | "wetland" => Some(LandKind::Scrub),
        "grassland" => Some(LandKind::Grass),
        "sand" | "beach" | "shingle" | "scree" | "bare_rock" => Some(LandKind::Sand),
        "water" => Some(LandKind::Water),
        _ => None,
    };
    let by_rest = || match (tags.get("amenity"), tags.get("waterway"), tags.get("place"), tags.get("man_made")) {
        ("parking" | "motorcycle_parking", ..) if tags.get("parking") != "multi-storey" => Some(LandKind::Parking),
        ("marketplace", ..) | (_, _, "square", _) | (.., "pier") => Some(LandKind::Paved),
        _ if "platform" == tags.first(&["public_transport", "railway"]) => Some(LandKind::Paved),
        ("fountain", ..) | (_, "riverbank" | "dock", ..) => Some(LandKind::Water),
        ("school" | "university" | "college" | "hospital" | "kindergarten", ..) => Some(LandKind::Commercial),
        _ => None,
    };
    let by_cover = || match tags.first(&["landcover", "area:highway", "traffic_calming"]) {
        "traffic_island" | "island" => Some(LandKind::TrafficIsland),
        "grass" => Some(LandKind::Grass),
        "trees" => Some(LandKind::Wood),
        "parking" => Some(LandKind::Parking),
        "footway" | "pedestrian" | "cycleway" => Some(LandKind::Paved),
        _ if tags.get("barrier") == "hedge" && tags.get("area") == "yes" => Some(LandKind::Scrub),
        _ => None,
    };
    by_landuse.or_else(by_nature).or_else(by_leisure).or_else(by_rest).or_else(by_cover)
}

/// What a way is drawn as along its course, beside what it is built as: a playground may have a fence.
pub(super) fn line_kind(tags: &Tags) -> Option<LineKind> {
    let buried = in_tunnel(tags) || tags.get("location") == "underground" || layer(tags) < 0;
    if buried || tags.has("building") || tags.has("indoor") {
        return None;
    }
    Some(match (tags.get("barrier"), tags.get("power"), tags.get("railway")) {
        ("fence" | "handrail" | "chain" | "railing" | "cable_barrier" | "rope", ..) => LineKind::Fence,
        ("wall" | "retaining_wall" | "city_wall" | "sound_barrier" | "noise_barrier", ..) => LineKind::Wall,
        ("hedge", ..) if tags.get("area") != "yes" => LineKind::Hedge,
        ("guard_rail" | "jersey_barrier", ..) => LineKind::GuardRail,
        (_, "line" | "minor_line", _) => LineKind::PowerLine,
        (.., "tram") => LineKind::Tram,
        (.., "rail" | "light_rail" | "subway" | "narrow_gauge" | "funicular" | "monorail" | "preserved") => {
            LineKind::Railway
        }
        _ => return None,
    })
}

pub(super) fn furniture_kind(tags: &Tags) -> Option<FurnitureKind> {
    let by_highway = match tags.get("highway") {
        "street_lamp" => Some(FurnitureKind::StreetLamp),
        "traffic_signals" => Some(FurnitureKind::TrafficSignal),
        "stop" => Some(FurnitureKind::StopSign),
        "give_way" => Some(FurnitureKind::GiveWaySign),
        "traffic_sign" => Some(FurnitureKind::TrafficSign),
        "crossing" => Some(FurnitureKind::Crossing),
        "bus_stop" => Some(FurnitureKind::BusStop),
        _ => None,
    };
    let by_amenity = || match tags.get("amenity") {
        "bench" | "lounger" => Some(FurnitureKind::Bench),
        "waste_basket" | "waste_disposal" | "recycling" => Some(FurnitureKind::Bin),
        "bicycle_parking" | "bicycle_rental" => Some(FurnitureKind::BicycleParking),
        "post_box" => Some(FurnitureKind::Mailbox),
        "telephone" => Some(FurnitureKind::Telephone),
        "fountain" => Some(FurnitureKind::Fountain),
        _ => None,
    };
    let by_making = || match (tags.get("man_made"), tags.get("power")) {
        ("street_cabinet", _) | (_, "cabinet") => Some(FurnitureKind::StreetCabinet),
        ("flagpole", _) => Some(FurnitureKind::Flagpole),
        ("manhole", _) => Some(FurnitureKind::Manhole),
        ("utility_pole" | "telegraph_pole", _) | (_, "pole") => Some(FurnitureKind::UtilityPole),
        ("tree", _) => Some(FurnitureKind::Tree),
        _ => None,
    };
    let by_rest = || match (tags.get("natural"), tags.get("leisure"), tags.get("advertising"), tags.get("barrier")) {
        ("tree", ..) => Some(FurnitureKind::Tree),
        ("shrub", ..) => Some(FurnitureKind::Shrub),
        (_, "picnic_table", ..) => Some(FurnitureKind::PicnicTable),
        (_, _, "column", _) => Some(FurnitureKind::AdvertisingColumn),
        (.., "bollard") => Some(FurnitureKind::Bollard),
        _ if tags.get("emergency") == "fire_hydrant" && tags.get("fire_hydrant:type") != "underground" => {
            Some(FurnitureKind::Hydrant)
        }
        _ if tags.get("public_transport") == "platform" && tags.get("bus") == "yes" => Some(FurnitureKind::BusStop),
        _ if tags.has("traffic_sign") => Some(FurnitureKind::TrafficSign),
        _ => None,
    };
    by_highway.or_else(by_amenity).or_else(by_making).or_else(by_rest)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn tags(text: &str) -> Tags {
        let mut tags = Tags::default();
        for (key, value) in text.split(' ').filter_map(|tag| tag.split_once('=')) {
            tags.push(key, value);
        }
        tags
    }

    #[test]
    fn things_are_what_their_tags_say() {
        let check = |text: &str, outline, expect| assert_eq!(meaning(&tags(text), outline), expect, "{text}");
        check("building=yes amenity=parking", Outline::Ring, Meaning::Building);
        check("building=no landuse=grass", Outline::Ring, Meaning::Land(LandKind::Grass));
        check("building:part=yes", Outline::Ring, Meaning::Building);
        check("building=yes", Outline::Line, Meaning::Nothing("building's outline is not closed"));
        check("building=yes layer=-1", Outline::Ring, Meaning::Nothing("underground"));
        check("highway=pedestrian", Outline::Ring, Meaning::Road(RoadKind::Pedestrian));
        check("highway=pedestrian area=yes", Outline::Ring, Meaning::Land(LandKind::Paved));
        check("highway=service", Outline::Area, Meaning::Land(LandKind::Paved));
        check("highway=primary_link", Outline::Line, Meaning::Road(RoadKind::Primary));
        check("highway=footway footway=crossing", Outline::Line, Meaning::Road(RoadKind::Crossing));
        check("highway=footway indoor=yes", Outline::Line, Meaning::Nothing("indoors"));
        check("highway=proposed", Outline::Line, Meaning::Nothing("highway that does not exist or is not a road"));
        check("natural=water landuse=basin", Outline::Area, Meaning::Land(LandKind::Water));
        check("natural=water", Outline::Line, Meaning::Nothing(""));
        check("amenity=parking parking=underground", Outline::Ring, Meaning::Nothing("underground"));
        check("amenity=bench", Outline::Line, Meaning::Furniture(FurnitureKind::Bench));
        check("natural=tree_row", Outline::Line, Meaning::Row(FurnitureKind::Tree));
        check("barrier=bollard", Outline::Line, Meaning::Row(FurnitureKind::Bollard));
        check("area:highway=traffic_island", Outline::Ring, Meaning::Land(LandKind::TrafficIsland));
        check("railway=rail", Outline::Line, Meaning::Nothing(""));
    }

    #[test]
    fn lines_are_drawn_above_the_ground_alone() {
        let check = |text: &str, expect| assert_eq!(line_kind(&tags(text)), expect, "{text}");
        check("barrier=retaining_wall", Some(LineKind::Wall));
        check("leisure=playground barrier=fence", Some(LineKind::Fence));
        check("barrier=hedge area=yes", None);
        check("power=minor_line", Some(LineKind::PowerLine));
        check("railway=tram", Some(LineKind::Tram));
        check("railway=subway tunnel=yes", None);
        check("railway=abandoned", None);
        check("barrier=kerb", None);
    }

    #[test]
    fn bridges_are_above_and_tunnels_below_where_no_layer_is_tagged() {
        assert_eq!(layer(&tags("bridge=yes")), 1);
        assert_eq!(layer(&tags("tunnel=yes")), -1);
        assert_eq!(layer(&tags("tunnel=building_passage")), 0);
        assert_eq!(layer(&tags("bridge=yes layer=3")), 3);
    }
}
