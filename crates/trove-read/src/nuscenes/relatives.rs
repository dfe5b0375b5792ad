//! The datasets that share nuScenes' schema, from `relatives.toml`.

use std::cmp::Reverse;
use std::collections::BTreeMap;
use std::sync::LazyLock;

use glam::DVec3;
use serde::Deserialize;
use trove_model::{EgoBody, Kind};

static RELATIVES: LazyLock<Relatives> =
    LazyLock::new(|| toml::from_str(include_str!("relatives.toml")).expect("a test reads the built-in table"));

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Relatives {
    relative: Vec<Relative>,
}

/// What a dataset's tables do not say.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Relative {
    /// The dataset's name in drives.
    pub(super) name: String,
    /// Licence of its records, with whom to name.
    pub(super) licence: String,
    ego_centre_m: [f64; 3],
    ego_size_m: [f64; 3],
    place: Vec<Place>,
    kinds: BTreeMap<String, Kind>,
}

/// Where on earth a log's location is.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Place {
    name: String,
    pub(super) lat_deg: f64,
    pub(super) lon_deg: f64,
    /// Whether global coordinates begin there; otherwise it is only whereabouts.
    #[serde(default)]
    pub(super) is_origin: bool,
}

impl Relative {
    /// The dataset that has most of some categories.
    pub(super) fn of<'a>(categories: impl Iterator<Item = &'a str> + Clone) -> &'static Self {
        let known = |relative: &&Self| categories.clone().filter(|name| relative.kind(name).is_some()).count();
        let nearest = RELATIVES.relative.iter().min_by_key(|relative| Reverse(known(relative)));
        nearest.expect("the built-in table has rows")
    }

    /// The recording vehicle.
    pub(super) fn ego_body(&self) -> EgoBody {
        EgoBody { centre_ego: DVec3::from_array(self.ego_centre_m), size_m: DVec3::from_array(self.ego_size_m) }
    }

    /// `None` for a location that the table does not have.
    pub(super) fn place(&self, location: &str) -> Option<&Place> {
        self.place.iter().find(|place| place.name == location)
    }

    /// What a category is, a cycle without its rider; `None` for a name that is not the dataset's.
    pub(super) fn kind(&self, category: &str) -> Option<Kind> {
        self.kinds.get(category).copied()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_dataset_is_told_by_its_categories() {
        let of = |names: &[&'static str]| Relative::of(names.iter().copied());
        assert_eq!(of(&["vehicle.car", "animal", "flat.terrain"]).name, "nuscenes");
        assert_eq!(of(&["car", "animal", "pedestrian"]).name, "lyft");
        assert_eq!((of(&[]).name.as_str(), of(&["animal"]).name.as_str()), ("nuscenes", "nuscenes"));
    }

    #[test]
    fn every_category_has_one_kind_and_other_names_have_none() {
        let (nuscenes, lyft) = (Relative::of(["vehicle.car"].into_iter()), Relative::of(["car"].into_iter()));
        assert_eq!((nuscenes.kinds.len(), lyft.kinds.len()), (23, 9));
        assert_eq!(nuscenes.kind("vehicle.bus.bendy"), Some(Kind::ArticulatedBus));
        assert_eq!((nuscenes.kind("vehicle.hovercraft"), nuscenes.kind("car")), (None, None));
        assert_eq!((lyft.kind("other_vehicle"), lyft.kind("vehicle.car")), (Some(Kind::Truck), None));
        assert!(nuscenes.place("boston-seaport").is_some_and(|place| place.is_origin));
        assert!(
            lyft.place("Palo Alto").is_some_and(|place| !place.is_origin) && lyft.place("boston-seaport").is_none()
        );
    }
}
