//! A scene made ready for rays: checked, its textures filtered, its acceleration structure built.

mod carrier;
mod check;
mod comes_down;

use std::sync::Arc;

use glam::{DAffine3, DVec2, Vec3, bvec3};
use trove_model::{Class, Instance, Mesh, Origin, Placement, Precipitation, Scene, SceneObject};
use trove_trace::{Bears, Fog, Scattering, Surface, exposure};

use crate::RenderError;
use crate::accel::{Accel, Coherence, Kernel, PACKET, Shapes};
use crate::field::LightFields;
use crate::fog::fog;
use crate::light::{Beams, LastSurroundings, Lights, PROBES};
use crate::material::{Opacity, PreparedMaterial};
use crate::motion::Motion;
use crate::placed::{Placed, Sort};
use crate::ray::{Beside, Hit, Ray};
use crate::remote::Place;
use crate::spray::Spray;
use crate::surface::surface;
use crate::texture::Textures;
use comes_down::{ComesDown, bears};

pub(crate) use carrier::Carrier;

/// A scene that can be rendered: from here on nothing can fail.
pub struct PreparedScene {
    pub(crate) shapes: Arc<Shapes>,
    pub(crate) instances: Vec<PreparedInstance>,
    pub(crate) materials: Vec<PreparedMaterial>,
    pub(crate) lights: Lights,
    /// And what falls takes from light.
    pub(crate) fog: Option<Fog>,
    pub(crate) falling: Option<Precipitation>,
    pub(crate) wind_mps: DVec2,
    pub(crate) spray: Spray,
    /// The light around eyes, as far as it was asked for.
    pub(crate) fields: LightFields,
    pub(crate) comes_down: ComesDown,
    accel: Box<dyn Accel>,
    /// What is at the previous and at the next keyframe other than now, as it is then.
    others: [Others; 2],
    /// Whether there is a previous and a next keyframe.
    pub(crate) has_beside: [bool; 2],
    /// Where its light is followed.
    pub(crate) place: Place,
}

/// Shapes that are there at another moment.
struct Others {
    shapes: Arc<Shapes>,
    accel: Box<dyn Accel>,
}

/// What labels tell of an instance.
pub(crate) struct PreparedInstance {
    pub(crate) class: Class,
    pub(crate) bears: Bears,
    /// In the model's precision.
    pub(crate) world_from_mesh: Motion<DAffine3>,
    /// At the moment of the labels.
    pub(crate) mesh_from_world: DAffine3,
    /// At the previous and the next keyframe.
    pub(crate) then: [Then; 2],
    /// What it is; `None` for stuff.
    pub(crate) object: Option<Arc<SceneObject>>,
}

/// An instance at a neighbouring keyframe.
pub(crate) enum Then {
    IsNotThere,
    /// As it stands now.
    Stays,
    /// Elsewhere or in another shape, which has the same triangles; in the model's precision.
    Moves {
        mesh: Arc<Mesh>,
        world_from_mesh: DAffine3,
        /// Takes points from now to then, where the shape is the same.
        then_from_now: Option<Box<DAffine3>>,
    },
}

impl PreparedScene {
    pub(crate) fn new(
        scene: &Scene,
        kernel: &dyn Kernel,
        textures: &Textures,
        last: &LastSurroundings,
    ) -> Result<Self, RenderError> {
        check::check(scene)?;
        textures.make_all(&scene.materials);
        let mut beams = Beams::default();
        let (materials, opacities): (Vec<_>, Vec<_>) =
            scene.materials.iter().map(|m| PreparedMaterial::new(m, textures, &mut beams)).unzip();
        let opacities: Arc<[_]> = opacities.into();
        let instances: Vec<_> = scene.instances.iter().map(|i| PreparedInstance::new(scene, i)).collect();
        let bounds: Vec<_> = scene.meshes.iter().map(|m| m.bounds()).collect();
        let foot_z = |mesh: usize| bounds[mesh].map_or(0.0, |(low, _)| low.z);
        let place = |i: &Instance, now: Placement, way: &Motion<DAffine3>, stays: [bool; 2]| {
            let materials = i.materials.iter().map(|&m| m as u32).collect();
            Placed::new(i.id, scene.meshes[now.mesh].clone(), foot_z(now.mesh), materials, way, stays, sort(i))
        };
        let placed = scene.instances.iter().zip(&instances).map(|(instance, prepared)| {
            let stays = prepared.then.each_ref().map(|then| matches!(then, Then::Stays));
            place(instance, instance.now(), &prepared.world_from_mesh, stays)
        });
        let shapes = Arc::new(Shapes::new(placed.collect(), opacities.clone()));
        let (accel, around) = rayon::join(|| kernel.build(&shapes), || last.get(&scene.light.environment));
        let accel = accel?;
        let lights = Lights::new(scene, &|index| materials[index].shines(), beams, around, &|instance, rays| {
            let mut hits = [None; PROBES];
            accel.closest(rays, Coherence::Incoherent, &mut hits);
            hits.map(|hit| hit.is_none_or(|hit: Hit| hit.instance != instance))
        });
        let others = |beside: Beside| -> Result<Others, RenderError> {
            let moved = scene.instances.iter().filter_map(|i| {
                let then = [i.previous, i.next][beside as usize]?;
                (then != i.now()).then_some((i, then))
            });
            let others = moved.chain(scene.others[beside as usize].iter().map(|i| (i, i.now())));
            let placed =
                others.map(|(i, then)| place(i, then, &Motion { middle: then.world_from_mesh, ends: None }, [true; 2]));
            let shapes = Arc::new(Shapes::new(placed.collect(), opacities.clone()));
            Ok(Others { accel: kernel.build(&shapes)?, shapes })
        };
        let others = [others(Beside::Previous)?, others(Beside::Next)?];
        let has_beside = scene.keyframes_apart_s.map(f64::is_finite);
        let fog = fog(&scene.light, lowest_z(scene, &bounds));
        let (falling, comes_down) = (scene.light.falling, ComesDown::new(&scene.light));
        let (wind_mps, spray) = (scene.light.wind_mps, Spray::new(&scene.light.spray));
        Ok(Self {
            shapes,
            instances,
            materials,
            lights,
            fog,
            falling,
            wind_mps,
            spray,
            fields: LightFields::default(),
            comes_down,
            accel,
            others,
            has_beside,
            place: Place::Here,
        })
    }

    /// What stands where, now or at a keyframe beside.
    pub(crate) fn all(&self, beside: Option<Beside>) -> impl Iterator<Item = &Placed> {
        let stays = move |p: &&Placed| beside.is_none_or(|beside| p.stays[beside as usize]);
        let others = beside.into_iter().flat_map(|beside| &self.others[beside as usize].shapes.placed);
        self.shapes.placed.iter().filter(stays).chain(others)
    }

    /// Whether each of up to [`PACKET`] rays that run alike meets something at a keyframe beside.
    pub(crate) fn blocks_then(&self, beside: Beside, rays: &[Ray]) -> [bool; PACKET] {
        let mut looking = [Ray::new(Vec3::ZERO, Vec3::Z); PACKET];
        looking.iter_mut().zip(rays).for_each(|(to, ray)| *to = Ray { beside: Some(beside), ..*ray });
        let mut blocked = [[false; PACKET]; 2];
        for (accel, blocked) in [&self.accel, &self.others[beside as usize].accel].into_iter().zip(&mut blocked) {
            accel.blocked(&looking[..rays.len()], Coherence::Coherent, &mut blocked[..rays.len()]);
        }
        std::array::from_fn(|i| blocked[0][i] || blocked[1][i])
    }

    /// The shape of an instance.
    pub(crate) fn placed(&self, instance: u32) -> &Placed {
        &self.shapes.placed[instance as usize]
    }

    /// The nearest surfaces, as [`Accel::closest`] finds them.
    pub(crate) fn closest(&self, rays: &[Ray], coherence: Coherence, hits: &mut [Option<Hit>]) {
        self.accel.closest(rays, coherence, hits);
    }

    /// What passes of the light along rays, as [`Accel::any`] finds it.
    pub(crate) fn any(&self, rays: &[Ray], coherence: Coherence, light: &mut [Vec3]) {
        self.accel.any(rays, coherence, light);
    }

    /// Which of some rays meet an instance, if nothing else were there.
    pub(crate) fn meets(&self, instance: u32, rays: &[Ray]) -> Vec<bool> {
        let mut hits = vec![None; rays.len()];
        self.accel.closest_on(instance, rays, &mut hits);
        hits.iter().map(Option::is_some).collect()
    }

    /// Share of light, scattered so, that the air lets pass along a unit direction for `t` metres.
    pub(crate) fn clear(&self, origin: Vec3, direction: Vec3, t: f32, scattering: Scattering) -> f32 {
        self.fog.map_or(1.0, |fog| fog.scattering(scattering).transmittance(origin, direction, t))
    }

    /// Share of a thing's light that fog and spray let pass straight to an eye.
    pub(crate) fn seen(&self, origin: Vec3, direction: Vec3, t: f32) -> f32 {
        self.clear(origin, direction, t, Scattering::after(0)) * self.spray.view().transmittance(origin, direction, t)
    }

    /// The kernel, to be measured.
    pub(crate) fn accel(&self) -> &dyn Accel {
        &*self.accel
    }

    /// What the surface at a hit lets pass.
    pub(crate) fn opacity(&self, hit: &Hit) -> &Opacity {
        &self.shapes.opacities[self.placed(hit.instance).material(hit)]
    }

    /// The material at a ray's hit.
    pub(crate) fn material(&self, hit: &Hit) -> &PreparedMaterial {
        &self.materials[self.placed(hit.instance).material(hit)]
    }

    /// The surface at a ray's hit, and its material.
    pub(crate) fn surface(&self, hit: &Hit, ray: &Ray) -> (Surface, &PreparedMaterial) {
        let material = self.material(hit);
        let mut surface = surface(self.placed(hit.instance), hit, ray);
        if self.comes_down.has_snow() || material.is_wet() {
            let bears = self.instances[hit.instance as usize].bears;
            surface.exposure = exposure(&self.comes_down.view(), bears, &surface, &ray.plain(), |looking| {
                let mut blocked = [false];
                let looking = Ray { for_shelter: true, ..(*looking).into() };
                self.accel.blocked(&[looking], Coherence::Incoherent, &mut blocked);
                blocked[0]
            });
        }
        (surface, material)
    }
}

fn sort(instance: &Instance) -> Sort {
    match (instance.class, &instance.object) {
        (_, Some(object)) if object.origin == Origin::Carrier => Sort::Carrier,
        (Class::Tree | Class::Bush | Class::Human | Class::CycleRider | Class::MotorcycleRider, _) => Sort::Loose,
        _ => Sort::Solid,
    }
}

/// z of the lowest point, or one below it, World, by the bounds of meshes; where there is nothing, the lowest number.
fn lowest_z(scene: &Scene, bounds: &[Option<(Vec3, Vec3)>]) -> f32 {
    let lowest = |instance: &Instance| {
        let (low, high) = bounds[instance.mesh]?;
        let corners = (0..8).map(|i| bvec3(i & 1 == 0, i & 2 == 0, i & 4 == 0));
        let corners = corners.map(|is_low| Vec3::select(is_low, low, high).as_dvec3());
        corners.map(|corner| instance.world_from_mesh.transform_point3(corner).z as f32).reduce(f32::min)
    };
    scene.instances.iter().filter_map(lowest).reduce(f32::min).unwrap_or(f32::MIN)
}

impl PreparedInstance {
    fn new(scene: &Scene, instance: &Instance) -> Self {
        let mesh_from_world = instance.world_from_mesh.inverse();
        let neighbours = [instance.previous, instance.next];
        let then = |placement: Option<Placement>| match placement {
            None => Then::IsNotThere,
            Some(then) if then == instance.now() => Then::Stays,
            Some(Placement { mesh, world_from_mesh }) => {
                let is_same = Arc::ptr_eq(&scene.meshes[mesh], &scene.meshes[instance.mesh]);
                let then_from_now = is_same.then(|| Box::new(world_from_mesh * mesh_from_world));
                Then::Moves { mesh: scene.meshes[mesh].clone(), world_from_mesh, then_from_now }
            }
        };
        // Shapes change between keyframes, and light follows the motion alone.
        let ways = neighbours.map(|placement| Some(placement?.world_from_mesh));
        Self {
            class: instance.class,
            bears: bears(instance),
            world_from_mesh: Motion::new(instance.world_from_mesh, ways, scene.keyframes_apart_s),
            mesh_from_world,
            then: neighbours.map(then),
            object: instance.object.clone(),
        }
    }
}
