//! The objects that points, detections or cells belong to.

use std::collections::BTreeMap;

use trove_model::{Class, InstanceId, Scene, SceneObject};

/// An object, and how much belongs to it.
pub(crate) struct Counted<'s> {
    pub id: InstanceId,
    pub class: Class,
    pub object: &'s SceneObject,
    pub count: u32,
}

/// The objects to which something belongs, in the order of their ids; one of `ids` for each thing, 0 where it belongs to none.
pub(crate) fn counted(scene: &Scene, ids: impl Iterator<Item = InstanceId>) -> impl Iterator<Item = Counted<'_>> {
    let mut counts: BTreeMap<InstanceId, u32> = BTreeMap::new();
    ids.filter(|id| id.0 != 0).for_each(|id| *counts.entry(id).or_default() += 1);
    let mut found: BTreeMap<InstanceId, Counted> = BTreeMap::new();
    for instance in &scene.instances {
        let (Some(object), Some(&count)) = (instance.object.as_deref(), counts.get(&instance.id)) else { continue };
        let (id, class) = (instance.id, instance.class);
        found.entry(id).or_insert(Counted { id, class, object, count });
    }
    found.into_values()
}
