//! Kinds and classes as `library.toml` writes them.

use trove_model::{Class, Kind, Outdoors, Role, SurfaceKind};

use super::fault::Fault;

/// A kind as `library.toml` writes it.
pub(super) fn kind_name(kind: Option<Kind>) -> String {
    kind.map_or("none", Kind::name).into()
}

/// A surface's kind as `library.toml` writes it.
pub(super) fn surface_kind_name(kind: Option<SurfaceKind>) -> String {
    kind.map_or("none", SurfaceKind::name).into()
}

/// The kind of a name: `None` without a name, `Some(None)` for `none`.
pub(super) fn kind_named(name: Option<&str>, place: &str) -> Result<Option<Option<Kind>>, Fault> {
    let all: Vec<(String, Kind)> = Kind::ALL.iter().map(|k| (kind_name(Some(*k)), *k)).collect();
    looked_up(name, &all, place, "kind")
}

pub(super) fn surface_kind_named(name: Option<&str>, place: &str) -> Result<Option<Option<SurfaceKind>>, Fault> {
    let all: Vec<(String, SurfaceKind)> = SurfaceKind::ALL
        .iter()
        .filter(|(kind, _)| *kind != SurfaceKind::Thing)
        .map(|(kind, name)| ((*name).to_owned(), *kind))
        .collect();
    looked_up(name, &all, place, "kind")
}

pub(super) fn class_named(name: Option<&str>, place: &str) -> Result<Option<Option<Class>>, Fault> {
    let all: Vec<(String, Class)> = trove_model::CLASSES.iter().map(|row| (row.name.to_owned(), row.class)).collect();
    looked_up(name, &all, place, "class")
}

pub(super) fn role_named(name: &str, place: &str) -> Result<Role, Fault> {
    Role::from_name(name).ok_or_else(|| {
        let known: Vec<&str> = Role::ALL.iter().map(|(_, name)| *name).collect();
        let expected = format!("roles out of {}", known.join(", "));
        Fault::new(format!("{place}: roles"), &expected, format!("{name:?}"), "correct it")
    })
}

/// What clothes of this name are worn in.
pub(super) fn outdoors_named(name: &str, place: &str) -> Result<Outdoors, Fault> {
    Outdoors::from_name(name).ok_or_else(|| {
        let expected = format!("some of {}", Outdoors::ALL.map(Outdoors::name).join(", "));
        Fault::new(format!("{place}: worn_in"), &expected, format!("{name:?}"), "correct it")
    })
}

fn looked_up<T: Copy>(
    name: Option<&str>,
    all: &[(String, T)],
    place: &str,
    key: &str,
) -> Result<Option<Option<T>>, Fault> {
    let Some(name) = name else { return Ok(None) };
    if name == "none" {
        return Ok(Some(None));
    }
    if let Some((_, value)) = all.iter().find(|(n, _)| n == name) {
        return Ok(Some(Some(*value)));
    }
    let close = all.iter().max_by(|a, b| strsim::jaro(&a.0, name).total_cmp(&strsim::jaro(&b.0, name)));
    let remedy = close.map_or(String::new(), |(n, _)| format!("did you mean {n:?}?"));
    Err(Fault::new(format!("{place}: {key}"), format!("a {key} of TRoVE or \"none\""), format!("{name:?}"), remedy))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_kind_has_a_name_of_its_own() {
        for kind in Kind::ALL {
            assert_eq!(kind_named(Some(&kind_name(Some(kind))), "").unwrap(), Some(Some(kind)));
        }
        assert_eq!(kind_name(Some(Kind::TrafficCone)), "traffic_cone");
    }
}
