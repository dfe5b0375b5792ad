//! Nouns of the model by their names.

/// A module for `#[serde(with = …)]` that writes a noun by its name and reads it back.
macro_rules! by_name {
    ($module:ident, $noun:ty, $all:expr, $name:expr) => {
        pub(crate) mod $module {
            use serde::de::{Deserialize, Deserializer, Error};
            use serde::ser::Serializer;

            fn names() -> impl Iterator<Item = (&'static str, $noun)> {
                $all.into_iter().map(|noun| ($name(noun), noun))
            }

            pub(crate) fn serialize<S: Serializer>(noun: &$noun, serializer: S) -> Result<S::Ok, S::Error> {
                serializer.serialize_str($name(*noun))
            }

            pub(crate) fn deserialize<'de, D: Deserializer<'de>>(deserializer: D) -> Result<$noun, D::Error> {
                let text = std::borrow::Cow::<'de, str>::deserialize(deserializer)?;
                let found = names().find(|(name, _)| *name == text).map(|(_, noun)| noun);
                found.ok_or_else(|| {
                    let known: Vec<&str> = names().map(|(name, _)| name).collect();
                    let what = stringify!($module);
                    D::Error::custom(format_args!("expected a {what} out of {}, found {text:?}", known.join(", ")))
                })
            }

            #[cfg(test)]
            pub(crate) fn schema(_: &mut schemars::SchemaGenerator) -> schemars::Schema {
                let names: Vec<&str> = names().map(|(name, _)| name).collect();
                schemars::json_schema!({ "type": "string", "enum": names })
            }
        }
    };
}

by_name!(kind, trove_model::Kind, trove_model::Kind::ALL, trove_model::Kind::name);
by_name!(class, trove_model::Class, trove_model::CLASSES.map(|row| row.class), |class: trove_model::Class| class
    .row()
    .name);
by_name!(outcome, trove_model::Outcome, trove_model::Outcome::ALL, trove_model::Outcome::name);
by_name!(season, trove_model::Season, trove_model::Season::ALL, trove_model::Season::name);
by_name!(lane_usage, trove_model::LaneUsage, trove_model::LaneUsage::ALL, trove_model::LaneUsage::name);
by_name!(paint, trove_model::Paint, trove_model::Paint::ALL, trove_model::Paint::name);
by_name!(mark_pattern, trove_model::MarkPattern, trove_model::MarkPattern::ALL, trove_model::MarkPattern::name);
by_name!(state, trove_model::State, trove_model::State::ALL, trove_model::State::name);

/// A list of states.
pub(crate) mod states {
    use serde::de::{Deserialize, Deserializer};
    use serde::ser::Serializer;
    use trove_model::State;

    #[derive(serde::Deserialize, serde::Serialize)]
    struct Named(#[serde(with = "super::state")] State);

    pub(crate) fn serialize<S: Serializer>(states: &[State], serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_seq(states.iter().map(|state| Named(*state)))
    }

    pub(crate) fn deserialize<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Vec<State>, D::Error> {
        Ok(Vec::<Named>::deserialize(deserializer)?.into_iter().map(|Named(state)| state).collect())
    }

    #[cfg(test)]
    pub(crate) fn schema(generator: &mut schemars::SchemaGenerator) -> schemars::Schema {
        schemars::json_schema!({ "type": "array", "items": super::state::schema(generator) })
    }
}
