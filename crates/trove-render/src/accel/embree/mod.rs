//! Embree 4: one Embree scene for each mesh that is placed, and one over them, in which meshes that already lie in World
//! are as they are.

mod api;
mod device;
mod query;
#[cfg(test)]
mod tests;

use std::collections::BTreeMap;
use std::path::PathBuf;
use std::ptr;
use std::sync::{Arc, OnceLock};

use glam::{Affine3A, DAffine3, DVec3, Vec3};
use trove_model::{ColorSpace, InstanceId, Mesh, Texture};

use self::api::Api;
use self::device::{BuiltScene, Device, made, take_down};
use self::query::{is_masked, mask};
use super::kernel::{Accel, Coherence, Kernel, PACKET};
use super::obvhs;
use super::shapes::Shapes;
use crate::RenderError;
use crate::cache::Cache;
use crate::material::Opacity;
use crate::motion::Motion;
use crate::placed::{Placed, Sort};
use crate::ray::{Beside, Hit, Ray};
use crate::texture::{MipMap, OpacityMask};

/// Embree with what it built of the meshes so far.
pub(super) struct Embree {
    device: Arc<Device>,
    /// Whether hits are judged is a property of what is built: without judging, with it.
    built: [Cache<Mesh, BuiltScene>; 2],
}

/// A two-level scene.
struct Scene {
    shapes: Arc<Shapes>,
    top: BuiltScene,
    /// By index of the instance.
    bottoms: Vec<Bottom>,
}

/// What an instance shows, on its own.
enum Bottom {
    /// A scene that may be placed several times, with its `mesh_from_world`.
    Placed(Arc<BuiltScene>, Affine3A),
    /// Triangles that lie in the top scene, in World; what traces them alone is built when it is first asked for.
    InTop(OnceLock<Alone>),
}

/// One mesh of the top scene.
enum Alone {
    Built(BuiltScene),
    /// Where Embree could not: pictures are being taken, and what has begun must not fail.
    BuiltIn(obvhs::Top),
}

impl Embree {
    /// Loads the library and asks it a question with a known answer.
    pub(super) fn load(search: &[PathBuf]) -> Result<Self, RenderError> {
        let refuse = |problem: String| RenderError::Library { library: "Embree 4", problem, looked: search.to_vec() };
        Api::load(search).and_then(Self::with).map_err(refuse)
    }

    fn with(api: Api) -> Result<Self, String> {
        // One thread builds: the same tree, and so the same choice among equally near hits, in every run.
        // SAFETY: the configuration is a C string.
        let handle = unsafe { (api.new_device)(c"threads=1,set_affinity=0".as_ptr()) };
        let handle = made(&api, ptr::null_mut(), "it has no device for this processor", handle)?;
        // SAFETY: the device is alive, and the function keeps to what Embree expects of it.
        unsafe { (api.set_error_function)(handle, Some(take_down), ptr::null_mut()) };
        let kernel = Self { device: Arc::new(Device { api, handle }), built: Default::default() };
        if kernel.device.api.version(handle)[0] != 4 || !kernel.answers_correctly()? {
            return Err(format!("{} does not answer as Embree 4 does", kernel.name()));
        }
        Ok(kernel)
    }

    /// Three instances of one triangle, of which the nearest one is nothing but a hole and the next one leaves: guards
    /// against another binary interface, and against builds without masks of rays.
    fn answers_correctly(&self) -> Result<bool, String> {
        let mesh = Arc::new(Mesh {
            positions: vec![Vec3::ZERO, Vec3::X, Vec3::Y],
            triangles: vec![[0, 1, 2]],
            ..Mesh::default()
        });
        let at = |z: f64, material: u32, stays: [bool; 2]| {
            let way = Motion { middle: DAffine3::from_translation(DVec3::Z * z), ends: None };
            Placed::new(InstanceId(0), mesh.clone(), 0.0, vec![material], &way, stays, Sort::Solid)
        };
        let clear =
            Texture { name: String::new(), width: 1, height: 1, rgba: vec![[0; 4]], color_space: ColorSpace::Srgb };
        let hole = Opacity::cut_out(OpacityMask::new(&clear, &MipMap::new(&clear), 0.5));
        let leaf = Texture { rgba: vec![[255; 4]], ..clear };
        let leaf = Opacity::cut_out(OpacityMask::new(&leaf, &MipMap::new(&leaf), 0.5));
        let placed = vec![at(1.0, 0, [true; 2]), at(2.0, 1, [true, false]), at(3.0, 1, [true; 2])];
        let shapes = Shapes::new(placed, [hole, leaf].into());
        let scene = self.scene(&Arc::new(shapes))?;
        let ray = Ray::new(Vec3::new(0.25, 0.5, 0.0), Vec3::Z);
        let looks = [(None, 1), (Some(Beside::Previous), 1), (Some(Beside::Next), 2)];
        let ways = [Coherence::Coherent, Coherence::Incoherent].into_iter();
        Ok(ways.flat_map(|way| looks.map(|look| (way, look))).all(|(coherence, (beside, expected))| {
            let ray = Ray { beside, ..ray };
            let (mut hits, mut light, mut blocked) = ([None], [Vec3::ONE], [false]);
            scene.closest(&[ray], coherence, &mut hits);
            scene.any(&[ray], coherence, &mut light);
            scene.blocked(&[ray], coherence, &mut blocked);
            // Packets round otherwise.
            let is_near = |a: f32, b: f32| (a - b).abs() < 1e-5;
            let is_found = hits[0].is_some_and(|Hit { t, instance, triangle, u, v }| {
                let is_there = is_near(t, 1.0 + expected as f32) && is_near(u, 0.25) && is_near(v, 0.5);
                (instance, triangle) == (expected, 0) && is_there
            });
            is_found && light == [Vec3::ZERO] && blocked == [true]
        }))
    }

    fn scene(&self, shapes: &Arc<Shapes>) -> Result<Scene, String> {
        self.built.iter().for_each(Cache::forget_unused);
        let top = BuiltScene::new(&self.device)?;
        let mut bottoms = Vec::with_capacity(shapes.placed.len());
        let mut uses: BTreeMap<*const Mesh, usize> = BTreeMap::new();
        shapes.placed.iter().for_each(|p| *uses.entry(Arc::as_ptr(&p.mesh)).or_default() += 1);
        for (id, p) in (0..).zip(&shapes.placed) {
            let judged = shapes.lets_pass(p);
            // Ground, roads and houses overlap: as instances, a ray would have to enter one after the other.
            let Motion { middle, ends } = p.world_from_mesh;
            if middle == Affine3A::IDENTITY && ends.is_none() && uses[&Arc::as_ptr(&p.mesh)] == 1 {
                top.attach_mesh(&p.mesh, judged, id, mask(p))?;
                bottoms.push(Bottom::InTop(OnceLock::new()));
                continue;
            }
            let cache = &self.built[usize::from(judged)];
            let bottom = cache.try_get(&p.mesh, |mesh| BuiltScene::of(&self.device, mesh, judged))?;
            let steps = ends.map_or(vec![middle], |[before, after]| vec![before, middle, after]);
            top.attach_instance(&bottom, &steps, id, mask(p))?;
            bottoms.push(Bottom::Placed(bottom, middle.inverse()));
        }
        top.commit()?;
        Ok(Scene { shapes: shapes.clone(), top, bottoms })
    }
}

impl Kernel for Embree {
    fn name(&self) -> String {
        let [major, minor, patch] = self.device.api.version(self.device.handle);
        format!("Embree {major}.{minor}.{patch}")
    }

    fn build(&self, shapes: &Arc<Shapes>) -> Result<Box<dyn Accel>, RenderError> {
        match self.scene(shapes) {
            Ok(scene) => Ok(Box::new(scene)),
            Err(problem) => Err(RenderError::Kernel { kernel: self.name(), problem }),
        }
    }
}

impl Accel for Scene {
    fn closest(&self, rays: &[Ray], coherence: Coherence, hits: &mut [Option<Hit>]) {
        let closest = |ray: &Ray| self.top.closest(&self.shapes, ray, None);
        match coherence {
            Coherence::Coherent => {
                for (rays, hits) in rays.chunks(PACKET).zip(hits.chunks_mut(PACKET)) {
                    self.top.closest_packet(&self.shapes, rays, None, hits);
                }
            }
            Coherence::Incoherent => rays.iter().zip(&mut *hits).for_each(|(ray, hit)| *hit = closest(ray)),
        }
        for (ray, hit) in rays.iter().zip(hits) {
            // A packet's distances differ from a single ray's in the last digit: what is passed through is met by one.
            let again = coherence == Coherence::Coherent && hit.is_some_and(|h| self.shapes.is_passed(ray, h.instance));
            *hit = self.shapes.past(ray, if again { closest(ray) } else { *hit }, closest);
        }
    }

    fn blocked(&self, rays: &[Ray], coherence: Coherence, blocked: &mut [bool]) {
        match coherence {
            Coherence::Coherent => {
                for (rays, blocked) in rays.chunks(PACKET).zip(blocked.chunks_mut(PACKET)) {
                    self.top.blocked_packet(&self.shapes, rays, blocked);
                }
            }
            Coherence::Incoherent => {
                rays.iter().zip(&mut *blocked).for_each(|(ray, b)| *b = self.top.blocked(&self.shapes, ray));
            }
        }
        // Embree does not say by what: it may be what the ray passes through.
        let is_doubtful = |i: usize| blocked[i] && rays[i].past.is_some() && !is_masked(&self.shapes, &rays[i]);
        let doubtful: Vec<usize> = (0..rays.len()).filter(|&i| is_doubtful(i)).collect();
        if !doubtful.is_empty() {
            let asked: Vec<Ray> = doubtful.iter().map(|&i| rays[i]).collect();
            let mut hits = vec![None; asked.len()];
            self.closest(&asked, coherence, &mut hits);
            doubtful.iter().zip(hits).for_each(|(&i, hit)| blocked[i] = hit.is_some());
        }
    }

    fn any(&self, rays: &[Ray], coherence: Coherence, light: &mut [Vec3]) {
        match coherence {
            Coherence::Coherent => {
                for (rays, light) in rays.chunks(PACKET).zip(light.chunks_mut(PACKET)) {
                    self.top.any_packet(&self.shapes, rays, light);
                }
            }
            Coherence::Incoherent => {
                rays.iter().zip(light).for_each(|(ray, light)| self.top.any(&self.shapes, ray, light))
            }
        }
    }

    fn closest_on(&self, instance: u32, rays: &[Ray], hits: &mut [Option<Hit>]) {
        for (rays, hits) in rays.chunks(PACKET).zip(hits.chunks_mut(PACKET)) {
            match &self.bottoms[instance as usize] {
                Bottom::Placed(bottom, mesh_from_world) => {
                    let local = |ray: &Ray| Ray {
                        origin: mesh_from_world.transform_point3(ray.origin),
                        direction: mesh_from_world.transform_vector3(ray.direction),
                        ..*ray
                    };
                    let local: [Ray; PACKET] = std::array::from_fn(|i| local(&rays[i.min(rays.len() - 1)]));
                    bottom.closest_packet(&self.shapes, &local[..rays.len()], Some(instance), hits);
                }
                Bottom::InTop(alone) => match alone.get_or_init(|| self.alone(instance)) {
                    Alone::Built(scene) => scene.closest_packet(&self.shapes, rays, Some(instance), hits),
                    Alone::BuiltIn(top) => {
                        rays.iter().zip(hits).for_each(|(ray, hit)| *hit = top.closest(&self.shapes, ray, instance));
                    }
                },
            }
        }
    }

    fn bare_closest(&self, rays: &[Ray]) -> usize {
        rays.iter().filter(|ray| self.top.bare_closest(ray)).count()
    }

    fn bare_any(&self, rays: &[Ray]) -> usize {
        rays.iter().filter(|ray| self.top.bare_any(ray)).count()
    }
}

impl Scene {
    fn alone(&self, instance: u32) -> Alone {
        let placed = &self.shapes.placed[instance as usize];
        match BuiltScene::of(&self.top.device, &placed.mesh, self.shapes.lets_pass(placed)) {
            Ok(scene) => Alone::Built(scene),
            Err(problem) => {
                tracing::warn!(instance, problem, "Embree failed; the built-in kernel finds this object's outline");
                Alone::BuiltIn(obvhs::Top::alone(&self.shapes, instance))
            }
        }
    }
}
