//! What Waymo's numbers and names mean, from `vocabulary.toml`.

use std::sync::LazyLock;

use glam::DVec3;
use serde::Deserialize;
use trove_model::Kind;

static VOCABULARY: LazyLock<Vocabulary> =
    LazyLock::new(|| toml::from_str(include_str!("vocabulary.toml")).expect("a test reads the built-in table"));

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Vocabulary {
    licence: String,
    camera: Vec<CameraName>,
    kind: Vec<KindRow>,
    place: Vec<Place>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct CameraName {
    number: i64,
    name: String,
}

/// What boxes of a type and size are.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct KindRow {
    #[serde(rename = "type")]
    number: i64,
    /// The dataset's word.
    pub(super) category: String,
    pub(super) kind: Kind,
    /// At least so long, wide and high.
    #[serde(default)]
    from_m: [f64; 3],
    /// Less than so long, wide and high.
    #[serde(default = "any_size")]
    below_m: [f64; 3],
}

/// Whereabouts segments of a location were recorded.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Place {
    name: String,
    pub(super) lat_deg: f64,
    pub(super) lon_deg: f64,
}

fn any_size() -> [f64; 3] {
    [f64::INFINITY; 3]
}

pub(super) fn licence() -> &'static str {
    &VOCABULARY.licence
}

/// `None` for a number that no camera has.
pub(super) fn camera_name(number: i64) -> Option<&'static str> {
    VOCABULARY.camera.iter().find(|camera| camera.number == number).map(|camera| camera.name.as_str())
}

/// `None` for a name that no camera has.
pub(super) fn camera_number(name: &str) -> Option<i64> {
    VOCABULARY.camera.iter().find(|camera| camera.name == name).map(|camera| camera.number)
}

/// What a box of a type with a length, width and height is; `None` for a type that there is not.
pub(super) fn kind(number: i64, size_m: DVec3) -> Option<&'static KindRow> {
    let fits = |row: &&KindRow| {
        row.number == number
            && size_m.cmpge(DVec3::from_array(row.from_m)).all()
            && size_m.cmplt(DVec3::from_array(row.below_m)).all()
    };
    VOCABULARY.kind.iter().find(fits)
}

/// `None` for a location that the table does not have.
pub(super) fn place(location: &str) -> Option<&'static Place> {
    VOCABULARY.place.iter().find(|place| place.name == location)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_vehicle_is_what_its_size_says() {
        let kind_of = |number, size: [f64; 3]| kind(number, DVec3::from_array(size)).map(|row| row.kind);
        assert_eq!(kind_of(1, [4.6, 2.0, 1.6]), Some(Kind::Car));
        assert_eq!(kind_of(1, [2.2, 0.9, 1.5]), Some(Kind::MotorcycleWithRider));
        assert_eq!(kind_of(1, [7.5, 2.5, 3.2]), Some(Kind::Truck));
        assert_eq!(kind_of(1, [12.2, 2.9, 3.2]), Some(Kind::Bus));
        assert_eq!(kind_of(1, [18.0, 2.9, 3.2]), Some(Kind::ArticulatedBus));
        assert_eq!(kind_of(2, [0.8, 0.8, 1.1]), Some(Kind::Child));
        assert_eq!(kind_of(4, [1.8, 0.8, 1.7]), Some(Kind::BicycleWithRider));
        assert_eq!(kind_of(0, [1.0; 3]), None);
    }

    #[test]
    fn cameras_and_cities_are_known_by_their_names() {
        assert_eq!((camera_name(4), camera_number("SIDE_RIGHT")), (Some("SIDE_LEFT"), Some(5)));
        assert_eq!(camera_name(0), None);
        assert!(place("location_phx").is_some_and(|place| place.lat_deg < 34.0) && place("").is_none());
        assert!(licence().contains("Non-Commercial"));
    }
}
