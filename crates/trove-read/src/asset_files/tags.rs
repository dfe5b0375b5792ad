//! The tags of models and texture sets that nobody wrote, by their names and those of their materials.

use trove_model::{Kind, SurfaceKind};

use super::library_file::Guess;
use super::words::{match_of, words};

/// A tag that the builder asks for, and the phrases of names that stand for it.
type Row = (&'static str, &'static str);

const BUILDINGS: &[Row] = &[
    ("house", "house|cottage|villa|bungalow|haus|maison|casa|房子"),
    ("row", "row house|terraced house|townhouse|reihenhaus"),
    ("apartments", "apartment|apartments|flats|residential block|wohnhaus|wohnblock|immeuble"),
    ("office", "office|office building|skyscraper|bürogebäude|hochhaus"),
    ("warehouse", "warehouse|factory|industrial|lagerhalle|fabrik|entrepôt"),
    ("hotel", "hotel"),
    ("shops", "shop|store|supermarket|laden|geschäft|magasin|tienda"),
];
const LAMPS: &[Row] = &[
    ("curved", "curved|bent"),
    ("straight", "straight"),
    ("cobra", "cobra"),
    ("mast", "mast"),
    ("post-top", "post top|garden|park"),
    ("historic", "historic|antique|victorian|lantern|gas lamp|laterne"),
];
const SIGNS: &[Row] = &[
    ("us", "us|usa|american|mutcd"),
    ("vienna", "vienna|eu|europe|european|german|germany|uk|british"),
    ("stop", "stop|stop sign"),
    ("yield", "yield"),
    ("give-way", "give way|vorfahrt gewähren"),
    ("no-entry", "no entry"),
    ("do-not-enter", "do not enter"),
    ("one-way", "one way"),
    ("no-parking", "no parking"),
    ("no-stopping", "no stopping"),
    ("parking", "parking"),
    ("crossing", "crossing|crosswalk|zebra"),
    ("bus-stop", "bus stop"),
    ("street-name", "street name"),
    ("warning", "warning"),
];
const FURNITURE: &[Row] = &[
    ("mailbox", "mailbox|mail box|postbox|post box|letter box|briefkasten|boîte aux lettres|buzón|邮箱"),
    ("cabinet", "cabinet|utility box"),
    ("parking-meter", "parking meter|parkuhr"),
    ("news-box", "news box|newspaper"),
    ("planter", "planter|flower pot"),
    ("telephone", "telephone|phone booth|telephone booth"),
    ("advertising", "advertising|billboard|poster"),
    ("flagpole", "flagpole|flag pole"),
    ("picnic-table", "picnic table"),
    ("cafe", "cafe|bistro"),
    ("table", "table|tisch"),
    ("parasol", "parasol|umbrella"),
    ("red", "red"),
    ("blue", "blue"),
    ("yellow", "yellow"),
    ("green", "green"),
    ("single", "single"),
    ("station", "station"),
    ("round", "round"),
    ("trough", "trough"),
    ("slim", "slim|narrow"),
    ("wide", "wide"),
];
const FENCES: &[Row] = &[
    ("bars", "bars|iron|railing|metal fence"),
    ("chain-link", "chain link|wire|mesh"),
    ("wood", "wood|wooden|planks|holz|bois|madera"),
    ("picket", "picket"),
    ("panel", "panel"),
    ("hoarding", "hoarding"),
    ("site", "construction fence|site fence|bauzaun"),
];
const WALLS: &[Row] = &[
    ("brick", "brick|bricks|ziegel"),
    ("concrete", "concrete|beton"),
    ("stone", "stone|stones|rock"),
    ("garden", "garden"),
    ("railed", "railed"),
];
const RAILS: &[Row] = &[
    ("w-beam", "guard rail|guardrail|crash barrier|leitplanke"),
    ("railing", "railing|handrail|geländer"),
    ("parapet", "parapet|jersey"),
];
const BINS: &[Row] = &[("post", "post|pole"), ("round", "round|barrel")];
const HYDRANTS: &[Row] = &[("pillar", "hydrant"), ("yellow", "yellow")];
const BENCHES: &[Row] = &[("slatted", "slatted|wood|wooden"), ("stone", "stone|granite")];
const SURFACES: &[Row] = &[
    ("brick", "brick|bricks|ziegel"),
    ("plaster", "plaster|stucco|painted plaster|putz"),
    ("concrete", "concrete|cement|beton"),
    ("metal", "metal|steel|zinc"),
    ("corrugated", "corrugated|corrugated steel|corrugated iron"),
    ("boards", "planks|boards|clapboard|siding|wood"),
    ("tiles", "ceramic tiles"),
    ("glass", "glass"),
    ("slabs", "slabs|paving stones"),
    ("bricks", "paving bricks|brick paving"),
    ("herringbone", "herringbone"),
    ("setts", "setts|cobblestone|cobble|pflaster"),
    ("mosaic", "mosaic"),
    ("granite", "granite"),
    ("worn", "worn|old|cracked|damaged"),
    ("new", "new|clean|fresh"),
    ("slate", "slate|schiefer"),
    ("shingle", "shingle|shingles"),
    ("red", "red|clay"),
    ("dark", "dark|black"),
    ("copper", "copper"),
    ("gravel", "gravel"),
    ("bitumen", "bitumen|felt"),
];

/// What the builder asks for of a kind, and whether the names of materials tell it.
fn rows_of(kind: Kind) -> Option<(&'static [Row], bool)> {
    Some(match kind {
        Kind::Building => (BUILDINGS, false),
        Kind::StreetLamp => (LAMPS, false),
        Kind::TrafficSign => (SIGNS, false),
        Kind::StreetFurniture => (FURNITURE, false),
        Kind::Fence => (FENCES, true),
        Kind::Wall => (WALLS, true),
        Kind::GuardRail => (RAILS, false),
        Kind::Bin => (BINS, false),
        Kind::Hydrant => (HYDRANTS, false),
        Kind::Bench => (BENCHES, true),
        _ => return None,
    })
}

/// The tags that an asset of a kind has to have one of to be placed; none where any of the kind will do.
pub(super) fn needed(kind: Kind) -> Vec<&'static str> {
    let is_placed_by_tags =
        matches!(kind, Kind::TrafficSign | Kind::StreetFurniture | Kind::Fence | Kind::Wall | Kind::GuardRail);
    let rows = rows_of(kind).filter(|_| is_placed_by_tags);
    rows.iter().flat_map(|(rows, _)| *rows).map(|row| row.0).collect()
}

/// The tags of a model: in its file's own name, or else in what its materials are called. Folders say nothing of a model.
pub(super) fn of_model<'m>(
    file: &str,
    kind: Kind,
    materials: impl Iterator<Item = &'m str>,
) -> Option<(Vec<String>, Guess)> {
    let (rows, by_material) = rows_of(kind)?;
    let stem = super::scan::stem_of(file);
    let mut found = in_name(rows, stem);
    if kind == Kind::TrafficSign {
        found.extend(speed_limit(stem));
    }
    if !found.is_empty() {
        return Some(guess(found, 0.75, "its name"));
    }
    let materials: Vec<&str> = materials.filter(|_| by_material).collect();
    let found = in_name(rows, &materials.join(" "));
    (!found.is_empty()).then(|| guess(found, 0.6, "the names of its materials"))
}

/// The tags of a texture set, in its name.
pub(super) fn of_surface(name: &str, kind: SurfaceKind) -> Option<(Vec<String>, Guess)> {
    let found = in_name(SURFACES, name);
    // What every surface of the kind is tells nothing.
    let found: Vec<String> = found.into_iter().filter(|tag| *tag != format!("{kind:?}").to_lowercase()).collect();
    (!found.is_empty()).then(|| guess(found, 0.75, "its name"))
}

fn in_name(rows: &[Row], name: &str) -> Vec<String> {
    let words = words(name);
    let is_said = |row: &&Row| row.1.split('|').any(|phrase| match_of(&words, phrase) > phrase.chars().count());
    rows.iter().filter(is_said).map(|row| row.0.to_owned()).collect()
}

/// `speed-30` of `speed_limit_30`.
fn speed_limit(stem: &str) -> Option<String> {
    if !words(stem).iter().any(|w| matches!(w.as_str(), "speed" | "speedlimit" | "limit" | "maxspeed")) {
        return None;
    }
    let number: u32 = stem.split(|c: char| !c.is_ascii_digit()).find(|part| !part.is_empty())?.parse().ok()?;
    (number.is_multiple_of(5) && (5..=130).contains(&number)).then(|| format!("speed-{number}"))
}

fn guess(tags: Vec<String>, confidence: f32, place: &str) -> (Vec<String>, Guess) {
    let quoted: Vec<String> = tags.iter().map(|tag| format!("{tag:?}")).collect();
    let value = format!("[{}]", quoted.join(", "));
    (tags, Guess { key: "tags", value, confidence, reason: format!("words in {place}") })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn tags(file: &str, kind: Kind, materials: &[&str]) -> Vec<String> {
        of_model(file, kind, materials.iter().copied()).map(|(tags, _)| tags).unwrap_or_default()
    }

    #[test]
    fn names_and_materials_give_tags_and_folders_none() {
        for (file, kind, materials, expected) in [
            ("Cottage_03.glb", Kind::Building, &[][..], &["house"][..]),
            ("houses/Town_Hall.glb", Kind::Building, &[], &[]),
            ("houses/block.glb", Kind::Building, &["house wall"], &[]),
            ("pack/Warehouse.fbx", Kind::Building, &[], &["warehouse"]),
            ("SM_Sign_SpeedLimit_30_EU.glb", Kind::TrafficSign, &[], &["vienna", "speed-30"]),
            ("Stop_Sign_US.glb", Kind::TrafficSign, &[], &["us", "stop"]),
            ("fence_04.glb", Kind::Fence, &["Wood.001", "Nails"], &["wood"]),
            ("mailbox_red.glb", Kind::StreetFurniture, &[], &["mailbox", "red"]),
            ("sedan_red.glb", Kind::Car, &[], &[]),
        ] {
            assert_eq!(tags(file, kind, materials), expected, "{file}");
        }
    }

    #[test]
    fn a_set_of_textures_is_not_tagged_with_what_its_kind_says_already() {
        let of = |name: &str, kind| of_surface(name, kind).map(|(tags, _)| tags).unwrap_or_default();
        assert_eq!(of("brick_wall_001", SurfaceKind::Wall), ["brick"]);
        assert_eq!(of("concrete_floor", SurfaceKind::Concrete), [""; 0]);
        assert_eq!(of("concrete_floor", SurfaceKind::Paving), ["concrete"]);
    }
}
