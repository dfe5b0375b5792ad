//! What the words of OpenStreetMap's tags mean: a table a key.
//!
//! Words are compared in lower case, with `_` for spaces; of a list (`marble;glass`) the first that has a meaning counts.

use trove_model::{
    BarrierStyle, BuildingKind, CrossingMarking, LampMount, LeafType, MappedSign, RoadSurface, RoofMaterial, RoofShape,
    WallMaterial,
};

/// The words for the values of some keys.
pub(super) struct Vocabulary<T: 'static> {
    /// Each meaning with its words.
    words: &'static [(T, &'static [&'static str])],
    /// Words that are right and tell nothing more.
    silent: &'static [&'static str],
}

/// What a tag's value says.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Said<T> {
    Meaning(T),
    /// Nothing that is of use.
    Nothing,
    /// Something that no table has.
    Unknown,
}

impl<T: Copy> Vocabulary<T> {
    pub(super) fn read(&self, value: &str) -> Said<T> {
        let words = || value.split(';').map(|word| word.trim().to_lowercase().replace(' ', "_"));
        let meaning = |word: String| self.words.iter().find(|(_, all)| all.contains(&word.as_str())).map(|row| row.0);
        match words().find_map(meaning) {
            Some(meaning) => Said::Meaning(meaning),
            None if words().all(|word| word.is_empty() || self.silent.contains(&word.as_str())) => Said::Nothing,
            None => Said::Unknown,
        }
    }
}

/// `building`, `building:part`.
pub(super) const BUILDINGS: Vocabulary<BuildingKind> = Vocabulary {
    words: &[
        (BuildingKind::House, &["house", "detached", "semidetached_house", "farm", "villa"]),
        (BuildingKind::Bungalow, &["bungalow", "cabin"]),
        (BuildingKind::Terrace, &["terrace"]),
        (BuildingKind::Apartments, &["apartments", "dormitory", "flats"]),
        (BuildingKind::Residential, &["residential"]),
        (BuildingKind::Hotel, &["hotel"]),
        (BuildingKind::Office, &["office", "offices"]),
        (BuildingKind::Commercial, &["commercial"]),
        (BuildingKind::Retail, &["retail", "shop"]),
        (BuildingKind::Supermarket, &["supermarket"]),
        (BuildingKind::Industrial, &["industrial", "factory", "manufacture"]),
        (BuildingKind::Warehouse, &["warehouse"]),
        (BuildingKind::Hangar, &["hangar"]),
        (BuildingKind::Public, &["public", "civic", "government", "townhall"]),
        (BuildingKind::School, &["school", "college"]),
        (BuildingKind::University, &["university"]),
        (BuildingKind::Hospital, &["hospital"]),
        (BuildingKind::Transport, &["train_station", "transportation", "bus_station"]),
        (BuildingKind::Worship, &["church", "cathedral", "mosque", "temple", "synagogue"]),
        (BuildingKind::Chapel, &["chapel"]),
        (BuildingKind::Stadium, &["stadium"]),
        (BuildingKind::Garage, &["garage", "garages"]),
        (BuildingKind::Carport, &["carport"]),
        (BuildingKind::Parking, &["parking"]),
        (BuildingKind::Canopy, &["roof", "canopy"]),
        (BuildingKind::Shed, &["shed"]),
        (BuildingKind::Hut, &["hut"]),
        (BuildingKind::Kiosk, &["kiosk"]),
        (BuildingKind::Service, &["service", "toilets"]),
        (BuildingKind::Greenhouse, &["greenhouse"]),
        (BuildingKind::Construction, &["construction"]),
    ],
    silent: &["yes", "no"],
};

/// `building:material`, `building:facade:material`, `building:cladding`, `material`.
pub(super) const WALLS: Vocabulary<WallMaterial> = Vocabulary {
    words: &[
        (WallMaterial::Brick, &["brick", "bricks"]),
        (WallMaterial::Concrete, &["concrete", "reinforced_concrete", "cement_block", "concrete_block"]),
        (WallMaterial::Glass, &["glass", "mirror"]),
        (WallMaterial::Metal, &["metal", "steel", "metal_plates", "aluminium"]),
        (WallMaterial::Plaster, &["plaster", "stucco", "render", "adobe", "mud", "loam", "clay", "rammed_earth"]),
        (WallMaterial::Stone, &["stone", "sandstone", "limestone", "granite", "marble"]),
        (WallMaterial::Tiles, &["tiles"]),
        (WallMaterial::Wood, &["wood", "timber_framing"]),
    ],
    silent: &[],
};

/// `roof:material`.
pub(super) const ROOFS: Vocabulary<RoofMaterial> = Vocabulary {
    words: &[
        (RoofMaterial::Tiles, &["roof_tiles", "tile", "tiles", "clay"]),
        (RoofMaterial::Slate, &["slate"]),
        (RoofMaterial::Stone, &["stone"]),
        (RoofMaterial::Shingle, &["shingle", "wood"]),
        (RoofMaterial::Bitumen, &["tar_paper", "bitumen", "asphalt", "asphalt_shingle"]),
        (RoofMaterial::Metal, &["metal", "metal_sheet", "tin", "zinc", "steel", "aluminium", "eternit", "corrugated"]),
        (RoofMaterial::Copper, &["copper"]),
        (RoofMaterial::Gravel, &["gravel"]),
        (RoofMaterial::Concrete, &["concrete", "cement"]),
        (RoofMaterial::Glass, &["glass"]),
        (RoofMaterial::Plants, &["grass", "plants", "green"]),
    ],
    silent: &[],
};

/// `roof:shape`.
pub(super) const ROOF_SHAPES: Vocabulary<RoofShape> = Vocabulary {
    words: &[
        (RoofShape::Flat, &["flat"]),
        (
            RoofShape::Gabled,
            &["gabled", "pitched", "saltbox", "gabled_height_moved", "double_saltbox", "crosspitched", "cross_gabled"],
        ),
        (RoofShape::Hipped, &["hipped", "side_hipped"]),
        (RoofShape::HalfHipped, &["half-hipped", "half_hipped", "side_half-hipped", "hipped-and-gabled"]),
        (RoofShape::Pyramidal, &["pyramidal"]),
        (RoofShape::Gambrel, &["gambrel"]),
        (RoofShape::Mansard, &["mansard"]),
        (RoofShape::Skillion, &["skillion", "lean_to", "monopitch", "quadruple_saltbox", "sawtooth"]),
        (RoofShape::Dome, &["dome"]),
        (RoofShape::Cone, &["cone", "conical"]),
        (RoofShape::Onion, &["onion"]),
        (RoofShape::Round, &["round", "barrel"]),
    ],
    silent: &[],
};

/// `surface` of roads and paths.
pub(super) const ROAD_SURFACES: Vocabulary<RoadSurface> = Vocabulary {
    words: &[
        (RoadSurface::Asphalt, &["asphalt", "chipseal"]),
        (RoadSurface::Concrete, &["concrete", "concrete:plates", "concrete:lanes"]),
        (RoadSurface::Setts, &["sett", "cobblestone", "unhewn_cobblestone", "cobblestone:flattened"]),
        (RoadSurface::PavingStones, &["paving_stones", "paving_stones:lanes", "bricks", "brick"]),
        (RoadSurface::Gravel, &["gravel", "fine_gravel", "compacted", "pebblestone"]),
        (RoadSurface::Earth, &["unpaved", "ground", "dirt", "earth", "sand", "mud", "grass"]),
    ],
    silent: &["paved"],
};

/// `crossing:markings`, `crossing_ref`, `crossing`.
pub(super) const CROSSINGS: Vocabulary<CrossingMarking> = Vocabulary {
    words: &[
        (CrossingMarking::Unmarked, &["no", "unmarked", "surface", "informal"]),
        (CrossingMarking::Zebra, &["zebra", "zebra:bicolour", "zebra:double", "zebra:paired", "tiger"]),
        (CrossingMarking::Ladder, &["ladder", "ladder:skewed", "ladder:paired"]),
        (CrossingMarking::Lines, &["lines", "lines:paired", "lines:rainbow"]),
        (CrossingMarking::Dashes, &["dashes", "dots"]),
        (CrossingMarking::Usual, &["yes", "marked", "uncontrolled"]),
        (CrossingMarking::Signals, &["traffic_signals", "pelican", "toucan", "puffin", "pegasus"]),
    ],
    silent: &[],
};

/// `fence_type`, `wall`, `material` of fences, walls and guard rails.
pub(super) const BARRIER_STYLES: Vocabulary<BarrierStyle> = Vocabulary {
    words: &[
        (BarrierStyle::Handrail, &["handrail"]),
        (
            BarrierStyle::Wire,
            &["chain_link", "chain-link", "chain", "wire", "barbed_wire", "wire_mesh", "mesh", "electric"],
        ),
        (
            BarrierStyle::Wood,
            &["wood", "wooden", "split_rail", "picket", "pole", "roundpole", "wattle", "post_and_rail"],
        ),
        (BarrierStyle::Bars, &["bars", "metal_bars", "railing", "railings", "metal", "iron", "wrought_iron", "steel"]),
        (
            BarrierStyle::Panels,
            &["panel", "panels", "corrugated_metal", "corrugated", "slat", "slats", "slatted", "concrete_panel"],
        ),
        (BarrierStyle::Hoarding, &["hoarding", "construction"]),
        (BarrierStyle::Brick, &["brick", "bricks"]),
        (
            BarrierStyle::Stone,
            &["stone", "dry_stone", "sandstone", "limestone", "granite", "gabion", "stone_bank", "castle_wall"],
        ),
        (
            BarrierStyle::Concrete,
            &["concrete", "reinforced_concrete", "concrete_block", "noise_barrier", "jersey_barrier", "flood_wall"],
        ),
    ],
    silent: &["yes"],
};

/// `barrier`, where no other key says how it is made.
pub(super) const BARRIERS: Vocabulary<BarrierStyle> = Vocabulary {
    words: &[
        (BarrierStyle::Handrail, &["handrail", "chain"]),
        (BarrierStyle::Wire, &["cable_barrier"]),
        (BarrierStyle::Bars, &["railing"]),
        (BarrierStyle::Stone, &["city_wall"]),
        (BarrierStyle::Concrete, &["retaining_wall", "sound_barrier", "noise_barrier", "jersey_barrier"]),
    ],
    silent: &["fence", "rope", "wall", "hedge", "guard_rail"],
};

/// `lamp_mount`, `support`.
pub(super) const LAMPS: Vocabulary<LampMount> = Vocabulary {
    words: &[
        (LampMount::StraightMast, &["straight_mast"]),
        (LampMount::BentMast, &["bent_mast", "high_mast"]),
        (LampMount::Wall, &["wall_mounted", "wall", "ceiling"]),
        (LampMount::Wires, &["suspended"]),
        (LampMount::Ground, &["ground"]),
    ],
    silent: &["pole", "mast", "street_lamp"],
};

/// `leaf_type`.
pub(super) const LEAVES: Vocabulary<LeafType> = Vocabulary {
    words: &[(LeafType::Broad, &["broadleaved"]), (LeafType::Needle, &["needleleaved"])],
    silent: &["mixed", "leafless"],
};

/// Words in `species`, `taxon` or `genus` that tell the leaves.
pub(super) const PLANT_GROUPS: Vocabulary<LeafType> = Vocabulary {
    words: &[
        (LeafType::Frond, &["palm", "palms", "arecaceae", "palmae"]),
        (LeafType::Needle, &["conifer", "conifers", "coniferous"]),
    ],
    silent: &[],
};

/// `traffic_sign` in words that are the same everywhere.
pub(super) const SIGNS: Vocabulary<MappedSign> = Vocabulary {
    words: &[
        (MappedSign::Stop, &["stop"]),
        (MappedSign::GiveWay, &["give_way", "yield"]),
        (MappedSign::NoEntry, &["no_entry"]),
        (MappedSign::OneWay, &["oneway"]),
        (MappedSign::NoStopping, &["no_stopping"]),
        (MappedSign::NoParking, &["no_parking"]),
        (MappedSign::Parking, &["parking"]),
        (MappedSign::PedestrianCrossing, &["pedestrian_crossing"]),
        (MappedSign::Danger, &["hazard"]),
    ],
    silent: &["yes"],
};

/// `traffic_sign` in the numbers of Germany's catalogue (`DE:206`).
pub(super) const GERMAN_SIGNS: Vocabulary<MappedSign> = Vocabulary {
    words: &[
        (MappedSign::Stop, &["206"]),
        (MappedSign::GiveWay, &["205"]),
        (MappedSign::NoEntry, &["267"]),
        (MappedSign::OneWay, &["220"]),
        (MappedSign::NoStopping, &["283"]),
        (MappedSign::NoParking, &["286"]),
        (MappedSign::Parking, &["314"]),
        (MappedSign::PedestrianCrossing, &["350"]),
        (MappedSign::Danger, &["101"]),
    ],
    silent: &[],
};

/// `traffic_sign` in the numbers of America's manual (`US:R1-1`).
pub(super) const AMERICAN_SIGNS: Vocabulary<MappedSign> = Vocabulary {
    words: &[
        (MappedSign::Stop, &["r1-1"]),
        (MappedSign::GiveWay, &["r1-2"]),
        (MappedSign::NoEntry, &["r5-1"]),
        (MappedSign::OneWay, &["r6-1", "r6-2"]),
        (MappedSign::NoParking, &["r7-1", "r8-3"]),
        (MappedSign::PedestrianCrossing, &["w11-2"]),
    ],
    silent: &[],
};

#[cfg(test)]
mod tests {
    use std::fmt::Debug;

    use super::*;

    /// No word stands twice, and every word can be found.
    fn sound<T: Copy + Debug + PartialEq>(vocabulary: &Vocabulary<T>) {
        let all: Vec<&str> = vocabulary.words.iter().flat_map(|row| row.1).chain(vocabulary.silent).copied().collect();
        for (i, word) in all.iter().enumerate() {
            assert!(!all[..i].contains(word), "{word} stands twice");
            assert_eq!(*word, word.trim().to_lowercase().replace([' ', ';'], "_"), "{word} is never found");
        }
        for (meaning, words) in vocabulary.words {
            assert!(words.iter().all(|word| vocabulary.read(word) == Said::Meaning(*meaning)), "{meaning:?}");
        }
    }

    #[test]
    fn a_word_has_one_meaning() {
        sound(&BUILDINGS);
        sound(&WALLS);
        sound(&ROOFS);
        sound(&ROOF_SHAPES);
        sound(&ROAD_SURFACES);
        sound(&CROSSINGS);
        sound(&BARRIER_STYLES);
        sound(&BARRIERS);
        sound(&LAMPS);
        sound(&LEAVES);
        sound(&PLANT_GROUPS);
        sound(&SIGNS);
        sound(&GERMAN_SIGNS);
        sound(&AMERICAN_SIGNS);
    }

    #[test]
    fn words_are_read_whole_in_any_case_and_of_a_list_the_first_that_is_known() {
        let wall = |text: &str| WALLS.read(text);
        assert_eq!(wall("Reinforced concrete"), Said::Meaning(WallMaterial::Concrete));
        assert_eq!(wall("marble;glass"), Said::Meaning(WallMaterial::Stone));
        assert_eq!(wall("unobtainium; glass"), Said::Meaning(WallMaterial::Glass));
        assert_eq!(wall("glasshouse"), Said::Unknown);
        assert_eq!(BUILDINGS.read("yes"), Said::Nothing);
        assert_eq!(BUILDINGS.read(" ; "), Said::Nothing);
        assert_eq!(CROSSINGS.read("dots;surface"), Said::Meaning(CrossingMarking::Dashes));
        // Sheets, not bars.
        assert_eq!(BARRIER_STYLES.read("corrugated_metal"), Said::Meaning(BarrierStyle::Panels));
    }
}
