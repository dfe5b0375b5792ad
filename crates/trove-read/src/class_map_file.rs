//! A user's class map → `ClassMap`: TOML, as docs/judge.md describes it.

use std::num::NonZero;
use std::path::Path;

use serde::Deserialize;
use trove_files::{LARGEST_TEXT, read_text};
use trove_model::{CLASSES, ClassMap, ClassMapEntry, InstanceCoding, Kind, Role};

use crate::ReadError;
use crate::toml_fault::{self, nearest};

const REMEDY: &str = "correct it as docs/judge.md describes, Class maps";
/// The number where nothing is labelled, where the file names none.
const UNLABELLED: u8 = 255;
/// The colour of a class for which the file names none.
const GREY: [u8; 3] = [128; 3];

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct File {
    name: Option<String>,
    like: Option<String>,
    unlabelled: Option<u8>,
    instance_divisor: Option<NonZero<u16>>,
    #[serde(default)]
    class: Vec<Row>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Row {
    id: u8,
    name: String,
    #[serde(default)]
    thing: bool,
    #[serde(default)]
    ignored: bool,
    #[serde(default = "grey")]
    rgb: [u8; 3],
    #[serde(default)]
    trove: Vec<String>,
    #[serde(default)]
    kinds: Vec<String>,
    #[serde(default)]
    parts: Vec<String>,
    paper13: Option<String>,
}

fn grey() -> [u8; 3] {
    GREY
}

/// A mistake in a file.
#[derive(Debug)]
struct Fault {
    place: String,
    expected: String,
    found: String,
}

/// Reads a class map.
///
/// # Errors
/// A file that cannot be read, is no TOML, has keys, classes, kinds or parts that are not known (with the nearest that is), or
/// ids, names, classes, kinds or parts twice.
pub fn read_class_map(path: &Path) -> Result<ClassMap, ReadError> {
    let text = read_text(path, LARGEST_TEXT).map_err(|source| ReadError::io(path, source))?;
    let name = path.file_stem().unwrap_or_default().to_string_lossy();
    parse(&text, &name).map_err(|Fault { place, expected, found }| ReadError::Format {
        path: path.to_owned(),
        place,
        expected,
        found,
        remedy: REMEDY.to_owned(),
    })
}

/// The map of a text, of which the file is called `name`.
fn parse(text: &str, name: &str) -> Result<ClassMap, Fault> {
    let file: File = toml::from_str(text).map_err(|error| Fault {
        place: toml_fault::place(text, &error),
        expected: "a class map (TOML)".into(),
        found: format!("{}{}", error.message(), toml_fault::hint(error.message())),
    })?;
    let fault = |place: &str, expected: &str, found: String| {
        Err(Fault { place: place.into(), expected: expected.into(), found })
    };
    let name = file.name.as_deref().unwrap_or(name);
    if let Some(like) = &file.like {
        let Some(mut map) = ClassMap::named(like) else {
            let hint = nearest(like, ClassMap::NAMES.into_iter());
            return fault("like", &format!("one of {}", ClassMap::NAMES.join(", ")), format!("{like:?}{hint}"));
        };
        if !file.class.is_empty() || file.unlabelled.is_some() {
            return fault("like", "no [[class]] and no unlabelled beside it", "one".into());
        }
        map.instances = file.instance_divisor.map_or(map.instances, InstanceCoding::Divisor);
        return Ok(map);
    }
    if ClassMap::named(name).is_some() {
        return fault("name", "a name that no built-in map has", format!("{name:?}"));
    }
    let entries = file.class.into_iter().map(entry).collect::<Result<Vec<_>, _>>()?;
    if entries.iter().all(|entry| entry.ignored) {
        return fault("[[class]]", "at least one class that counts", "none".into());
    }
    let instances = file.instance_divisor.map_or(InstanceCoding::Beside, InstanceCoding::Divisor);
    ClassMap::new(name, file.unlabelled.unwrap_or(UNLABELLED), instances, entries).map_err(|fault| Fault {
        place: format!("class {:?}", fault.class),
        expected: fault.expected,
        found: fault.found,
    })
}

fn entry(row: Row) -> Result<ClassMapEntry, Fault> {
    let place = |key: &str| format!("class {:?}, {key}", row.name);
    let classes: Vec<_> = CLASSES.iter().map(|row| (row.class, row.name)).collect();
    let ours = known(&row.trove, &classes, &place("trove"), "names of TRoVE's 20 classes")?;
    let kinds = Kind::ALL.map(|kind| (kind, kind.name()));
    let kinds = known(&row.kinds, &kinds, &place("kinds"), "kinds of objects, as in frame.json")?;
    let parts = known(&row.parts, &Role::ALL, &place("parts"), "parts of objects, as in the manifest")?;
    let paper13 = row.paper13.as_ref().map(|name| {
        let paper = ClassMap::named("paper13").expect("a built-in map");
        let known = paper.classes.iter().find(|class| class.name == *name).map(|class| class.id);
        known.ok_or_else(|| Fault {
            place: place("paper13"),
            expected: "a name of the paper's 13 classes".into(),
            found: format!("{name:?}{}", nearest(name, paper.classes.iter().map(|class| class.name.as_str()))),
        })
    });
    Ok(ClassMapEntry {
        ours,
        kinds,
        parts,
        paper13: paper13.transpose()?,
        id: row.id,
        thing: row.thing,
        ignored: row.ignored,
        rgb: row.rgb,
        name: row.name,
    })
}

/// What names stand for.
fn known<T: Copy>(names: &[String], all: &[(T, &str)], place: &str, expected: &str) -> Result<Vec<T>, Fault> {
    let find = |name: &String| {
        all.iter().find(|(_, known)| known == name).map(|(known, _)| *known).ok_or_else(|| Fault {
            place: place.into(),
            expected: expected.into(),
            found: format!("{name:?}{}", nearest(name, all.iter().map(|(_, name)| *name))),
        })
    };
    names.iter().map(find).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;
    use trove_model::Class;

    const MAP: &str = r#"
unlabelled = 0
[[class]]
id = 3
name = "vehicle"
thing = true
rgb = [0, 0, 142]
trove = ["car", "jeep", "van", "bus"]
[[class]]
id = 1
name = "drivable"
trove = ["road"]
[[class]]
id = 9
name = "post"
kinds = ["street_lamp", "utility_pole"]
parts = ["kerb"]
paper13 = "traffic_pole"
[[class]]
id = 5
name = "rest"
ignored = true
trove = ["void", "traffic_cone"]
"#;

    fn error(text: &str) -> String {
        let Fault { place, expected, found } = parse(text, "mine").unwrap_err();
        format!("{place}: expected {expected}, found {found}")
    }

    #[test]
    fn a_file_names_classes_and_what_belongs_to_them() {
        let map = parse(MAP, "mine").unwrap();
        assert_eq!(map.name, "mine");
        let ids: Vec<_> = map.classes.iter().map(|class| (class.id, class.train_id, class.paper13)).collect();
        // Cars and buses are two of the thirteen.
        assert_eq!(ids, [(1, Some(0), Some(6)), (3, Some(1), None), (5, None, None), (9, Some(2), Some(9))]);
        let of = [Class::Bus, Class::Road, Class::TrafficCone, Class::Sky].map(|class| map.id(class));
        assert_eq!(of, [3, 1, 5, 0]);
        assert_eq!(map.object_id(Class::TrafficSign, Kind::StreetLamp), 9);
        assert_eq!(map.object_id(Class::TrafficSign, Kind::TrafficSign), 0);
        assert_eq!(map.part_id(Class::Road, None, Some(Role::Kerb)), 9);
        let vehicle = map.class(3).unwrap();
        assert!(vehicle.thing && vehicle.rgb == [0, 0, 142] && map.class(1).unwrap().rgb == GREY);
    }

    #[test]
    fn a_file_may_be_like_a_built_in_map_with_another_divisor() {
        let map = parse("like = \"waymo\"\ninstance_divisor = 256", "class_map").unwrap();
        assert_eq!((map.name.as_str(), map.instances), ("waymo", InstanceCoding::Divisor(NonZero::new(256).unwrap())));
        assert_eq!(parse("like = \"waymo\"", "class_map").unwrap(), ClassMap::named("waymo").unwrap());
    }

    #[test]
    fn mistakes_are_told_with_what_may_be_meant() {
        let check = |from: &str, to: &str, parts: &[&str]| {
            assert!(MAP.contains(from), "{from}");
            let message = error(&MAP.replacen(from, to, 1));
            assert!(parts.iter().all(|part| message.contains(part)), "{parts:?} in {message}");
        };
        check("thing = true", "things = true", &["line 6", "unknown field `things`", "did you mean \"thing\"?"]);
        check("\"jeep\"", "\"jep\"", &["class \"vehicle\", trove", "TRoVE's 20", "\"jep\"; did you mean \"jeep\"?"]);
        check("street_lamp", "streetlamp", &["class \"post\", kinds", "did you mean \"street_lamp\"?"]);
        check("\"kerb\"", "\"curb\"", &["class \"post\", parts", "parts of objects", "did you mean \"kerb\"?"]);
        check("\"traffic_pole\"", "\"pole\"", &["paper13", "did you mean"]);
        check("id = 9", "id = 3", &["class \"post\"", "that of \"vehicle\""]);
        check("id = 9", "id = 0", &["class \"post\"", "unlabelled", "0"]);
        check("id = 9", "id = 900", &["line ", "900"]);
        check("\"void\"", "\"road\"", &["that no other class lists", "road"]);
        check("unlabelled = 0", "name = \"coco\"", &["name", "built-in", "coco"]);
        check("unlabelled = 0", "like = \"coco\"", &["like", "no [[class]]"]);
        let message = error("like = \"wymo\"");
        assert!(message.contains("did you mean \"waymo\"?"), "{message}");
        assert!(error("").contains("at least one class that counts"));
    }

    proptest! {
        #[test]
        fn any_text_is_read_or_refused(text in ".{0,200}", at in 0..MAP.len(), new in "[ -~\n]{0,8}") {
            let _ = parse(&text, "mine");
            let _ = parse(&format!("{}{new}{}", &MAP[..at], &MAP[at..]), "mine");
        }
    }
}
