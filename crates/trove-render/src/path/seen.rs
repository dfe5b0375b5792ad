//! A scene as paths find it.

use glam::Vec3;
use trove_trace::field::LightField;
use trove_trace::path::World;
use trove_trace::{Fog, Hit, Lookups, Material, Spray, Surface};

use crate::PreparedScene;
use crate::light::LightsOf;
use crate::lookups::LOOKUPS;
use crate::texture::MapOf;
use crate::{field, ray};

/// A scene, and a field of the light in its air if that is to be read.
pub(crate) struct Seen<'a> {
    scene: &'a PreparedScene,
    pub(crate) lights: LightsOf<'a>,
    field: Option<LightField<'a>>,
    spray: Option<Spray<'a>>,
}

impl<'a> Seen<'a> {
    pub(crate) fn new(scene: &'a PreparedScene, field: Option<&'a field::LightField>) -> Self {
        let spray = Some(scene.spray.view()).filter(|spray| !spray.plumes.is_empty());
        Self { scene, lights: scene.lights.view(), field: field.map(field::LightField::view), spray }
    }
}

impl World for Seen<'_> {
    type Map = MapOf;

    fn lookups(&self) -> &Lookups {
        &LOOKUPS
    }

    fn lights(&self) -> &LightsOf<'_> {
        &self.lights
    }

    fn surface(&self, hit: &Hit, ray: &trove_trace::Ray) -> (Surface, &Material<MapOf>) {
        let (surface, material) = self.scene.surface(hit, &ray::Ray::from(*ray));
        (surface, &material.scatters)
    }

    fn direction_mesh(&self, instance: u32, direction: Vec3) -> Vec3 {
        self.scene.placed(instance).world_from_mesh.middle.inverse().transform_vector3(direction)
    }

    fn fog(&self) -> Option<&Fog> {
        self.scene.fog.as_ref()
    }

    fn field(&self) -> Option<&LightField<'_>> {
        self.field.as_ref()
    }

    fn spray(&self) -> Option<&Spray<'_>> {
        self.spray.as_ref()
    }
}
