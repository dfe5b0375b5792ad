//! Embree 4: one Embree scene for each mesh that is placed, and one over them, in which meshes that already lie in World
//! are as they are.

use std::cell::RefCell;
use std::collections::BTreeMap;
use std::ffi::{CStr, c_char, c_int, c_void};
use std::path::PathBuf;
use std::ptr;
use std::sync::{Arc, OnceLock};

use glam::{Affine3A, DAffine3, Vec3};
use trove_model::{ColorSpace, InstanceId, Mesh, Texture};

use super::embree_api::{
    self as api, Api, Context, FilterArguments, Handle, Packet, PacketHits, PacketRays, QueryArguments, RawHit, RawRay,
    RayHit,
};
use super::{Accel, Coherence, Kernel, PACKET, Shapes, obvhs};
use crate::RenderError;
use crate::cache::Cache;
use crate::material::Opacity;
use crate::motion::Motion;
use crate::placed::Placed;
use crate::ray::{Hit, Ray};
use crate::texture::{MipMap, OpacityMask};

/// The loaded library and its device.
struct Device {
    api: Api,
    handle: Handle,
}

// SAFETY: Embree's documentation allows devices to be used from several threads.
unsafe impl Send for Device {}
// SAFETY: as above.
unsafe impl Sync for Device {}

impl Drop for Device {
    fn drop(&mut self) {
        // SAFETY: the handle came from `new_device` and is released once.
        unsafe { (self.api.release_device)(self.handle) }
    }
}

thread_local! {
    /// What Embree last said of an error in this thread; its codes, too, are a thread's own.
    static SAID: RefCell<String> = const { RefCell::new(String::new()) };
}

/// Takes down what Embree says of an error.
///
/// # Safety
/// To be called by Embree, with a C string or null.
unsafe extern "C" fn take_down(_user: *mut c_void, _code: c_int, message: *const c_char) {
    if message.is_null() {
        return;
    }
    // SAFETY: Embree passes a C string.
    let message = unsafe { CStr::from_ptr(message) }.to_string_lossy().into_owned();
    // A thread that is ending has nobody left to tell.
    let _ = SAID.try_with(|said| said.replace(message));
}

/// Refuses an error of this thread since the last one was read; `device` may be null, where none could be made.
fn check(api: &Api, device: Handle, doing: &str) -> Result<(), String> {
    // SAFETY: the device is alive or null, for which Embree keeps errors of its own.
    let code = unsafe { (api.device_error)(device) };
    if code == api::ERROR_NONE {
        return Ok(());
    }
    let said = SAID.take();
    Err(format!("{doing}: {}{}{said}", api::error_name(code), if said.is_empty() { "" } else { ": " }))
}

/// Refuses null.
fn made<T>(api: &Api, device: Handle, what: &str, made: *mut T) -> Result<*mut T, String> {
    if made.is_null() {
        check(api, device, what)?;
        return Err(format!("{what}: got nothing, and no reason"));
    }
    Ok(made)
}

/// A scene; once it is committed, it is not changed any more.
struct BuiltScene {
    device: Arc<Device>,
    handle: Handle,
}

// SAFETY: a committed scene is only read, which Embree's documentation allows from several threads.
unsafe impl Send for BuiltScene {}
// SAFETY: as above.
unsafe impl Sync for BuiltScene {}

impl Drop for BuiltScene {
    fn drop(&mut self) {
        // SAFETY: the handle came from `new_scene` and is released once; Embree counts references of instances itself.
        unsafe { (self.device.api.release_scene)(self.handle) }
    }
}

impl BuiltScene {
    /// An empty one, not committed.
    fn new(device: &Arc<Device>) -> Result<Self, String> {
        let api = &device.api;
        // SAFETY: the device is alive; flags and quality are Embree's.
        let handle = unsafe { (api.new_scene)(device.handle) };
        let scene = Self { device: device.clone(), handle: made(api, device.handle, "making a scene", handle)? };
        // SAFETY: as above.
        unsafe {
            (api.set_scene_flags)(scene.handle, api::SCENE_ROBUST | api::SCENE_FILTER_IN_ARGUMENTS);
            (api.set_scene_quality)(scene.handle, api::QUALITY_MEDIUM);
        }
        Ok(scene)
    }

    /// Of one mesh.
    fn of(device: &Arc<Device>, mesh: &Mesh, judged: bool) -> Result<Self, String> {
        let scene = Self::new(device)?;
        scene.attach_mesh(mesh, judged, 0)?;
        scene.commit()?;
        Ok(scene)
    }

    /// Builds what is attached; tells of whatever has gone wrong with it.
    fn commit(&self) -> Result<(), String> {
        // SAFETY: the scene is alive and complete.
        unsafe { (self.device.api.commit_scene)(self.handle) };
        check(&self.device.api, self.device.handle, "building a scene")
    }

    /// Attaches a mesh, under an id that is not taken.
    fn attach_mesh(&self, mesh: &Mesh, judged: bool, id: u32) -> Result<(), String> {
        if mesh.triangles.is_empty() {
            return Ok(());
        }
        let api = &self.device.api;
        let geometry = Geometry::new(&self.device, api::GEOMETRY_TRIANGLE)?;
        geometry.fill(api::BUFFER_VERTEX, api::FORMAT_FLOAT3, mesh.positions.as_ptr().cast(), mesh.positions.len())?;
        geometry.fill(api::BUFFER_INDEX, api::FORMAT_UINT3, mesh.triangles.as_ptr().cast(), mesh.triangles.len())?;
        // SAFETY: the geometry is alive.
        unsafe { (api.filter_from_arguments)(geometry.handle, judged) };
        geometry.attach(self, id);
        Ok(())
    }

    /// Attaches a scene that moves through some placements, likewise.
    fn attach_instance(&self, bottom: &Self, steps: &[Affine3A], id: u32) -> Result<(), String> {
        let api = &self.device.api;
        let geometry = Geometry::new(&self.device, api::GEOMETRY_INSTANCE)?;
        // SAFETY: all handles are alive; a transform is 12 floats, column by column.
        unsafe {
            (api.set_instanced_scene)(geometry.handle, bottom.handle);
            (api.set_time_steps)(geometry.handle, steps.len() as u32);
            for (step, world_from_mesh) in (0..).zip(steps) {
                let columns = world_from_mesh.to_cols_array();
                let format = api::FORMAT_FLOAT3X4_COLUMN_MAJOR;
                (api.set_transform)(geometry.handle, step, format, columns.as_ptr().cast());
            }
        }
        geometry.attach(self, id);
        Ok(())
    }
}

/// A geometry that is being made; scenes keep what is attached to them.
struct Geometry<'a> {
    device: &'a Device,
    handle: Handle,
}

impl Drop for Geometry<'_> {
    fn drop(&mut self) {
        // SAFETY: the handle came from `new_geometry` and is released once.
        unsafe { (self.device.api.release_geometry)(self.handle) }
    }
}

impl<'a> Geometry<'a> {
    fn new(device: &'a Device, kind: c_int) -> Result<Self, String> {
        // SAFETY: the device is alive; the kind is one of Embree's.
        let handle = unsafe { (device.api.new_geometry)(device.handle, kind) };
        Ok(Self { device, handle: made(&device.api, device.handle, "making a geometry", handle)? })
    }

    /// Copies `n` items of 12 bytes into a buffer of its own.
    fn fill(&self, buffer: c_int, format: c_int, from: *const u8, n: usize) -> Result<(), String> {
        let Device { api, handle: device } = self.device;
        // SAFETY: the geometry is alive; Embree's own buffer has room for exactly what is copied into it.
        unsafe {
            let to = (api.new_buffer)(self.handle, buffer, 0, format, 12, n);
            let to = made(api, *device, &format!("making a buffer of {} bytes", 12 * n), to)?;
            ptr::copy_nonoverlapping(from, to.cast(), 12 * n);
        }
        Ok(())
    }

    fn attach(self, scene: &BuiltScene, id: u32) {
        // SAFETY: both handles are alive; the caller's ids are distinct.
        unsafe {
            (self.device.api.commit_geometry)(self.handle);
            (self.device.api.attach_by_id)(scene.handle, self.handle, id);
        }
    }
}

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

    /// Two instances of one triangle, of which the nearer one is nothing but a hole: guards against another binary
    /// interface.
    fn answers_correctly(&self) -> Result<bool, String> {
        let mesh = Arc::new(Mesh {
            positions: vec![Vec3::ZERO, Vec3::X, Vec3::Y],
            triangles: vec![[0, 1, 2]],
            ..Mesh::default()
        });
        let at = |z: f64, material: u32| {
            let way = Motion { middle: DAffine3::from_translation(glam::DVec3::Z * z), ends: None };
            Placed::new(InstanceId(0), mesh.clone(), 0.0, vec![material], &way)
        };
        let clear =
            Texture { name: String::new(), width: 1, height: 1, rgba: vec![[0; 4]], color_space: ColorSpace::Srgb };
        let hole = Opacity::cut_out(OpacityMask::new(&clear, &MipMap::new(&clear), 0.5));
        let leaf = Texture { rgba: vec![[255; 4]], ..clear };
        let leaf = Opacity::cut_out(OpacityMask::new(&leaf, &MipMap::new(&leaf), 0.5));
        let shapes = Shapes { placed: vec![at(1.0, 0), at(3.0, 1)], opacities: vec![hole, leaf] };
        let scene = self.scene(&Arc::new(shapes))?;
        let ray = Ray::new(Vec3::new(0.25, 0.5, 0.0), Vec3::Z);
        let expected = Some(Hit { t: 3.0, instance: 1, triangle: 0, u: 0.25, v: 0.5 });
        Ok([Coherence::Coherent, Coherence::Incoherent].into_iter().all(|coherence| {
            let (mut hits, mut light) = ([None], [Vec3::ONE]);
            scene.closest(&[ray], coherence, &mut hits);
            scene.any(&[ray], coherence, &mut light);
            hits == [expected] && light == [Vec3::ZERO]
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
                top.attach_mesh(&p.mesh, judged, id)?;
                bottoms.push(Bottom::InTop(OnceLock::new()));
                continue;
            }
            let cache = &self.built[usize::from(judged)];
            let bottom = cache.try_get(&p.mesh, |mesh| BuiltScene::of(&self.device, mesh, judged))?;
            let steps = ends.map_or(vec![middle], |[before, after]| vec![before, middle, after]);
            top.attach_instance(&bottom, &steps, id)?;
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

/// What a filter judges by.
struct Question<'a> {
    shapes: &'a Shapes,
    /// The instance, where Embree does not know it.
    instance: Option<u32>,
    /// Rays on their way to light, by their ids, and what is left of it; empty where the closest hit is looked for.
    rays: &'a [Ray],
    light: &'a mut [Vec3],
}

/// Leaves the hits that count, given the ray's id.
///
/// # Safety
/// To be called with what Embree calls a filter with, in a query whose context was made by [`context`].
unsafe fn judge(arguments: *const FilterArguments, counts: impl Fn(&mut Question<'_>, usize, &Hit) -> bool) {
    // SAFETY: Embree passes valid pointers, and the context that the query was made with, whose `user` points to a
    // `Question` that outlives the query.
    let (arguments, question) = unsafe {
        let arguments = &*arguments;
        (arguments, &mut *(*arguments.context).user.cast::<Question<'_>>())
    };
    let n = arguments.n as usize;
    for lane in 0..n {
        // SAFETY: `valid` points to n numbers, `ray` to 12 · n and `hit` to at least 8 · n of four bytes.
        unsafe {
            let valid = arguments.valid.add(lane);
            if *valid == 0 {
                continue;
            }
            let ray = |field: usize| *arguments.ray.add(field * n + lane);
            let hit = |field: usize| *arguments.hit.add(field * n + lane);
            // Fields are numbered as `RawRay` and `RawHit` list them.
            let t = f32::from_bits(ray(8));
            let (u, v) = (f32::from_bits(hit(3)), f32::from_bits(hit(4)));
            let hit = hit_of(t, u, v, [hit(5), hit(6), hit(7)], question.instance);
            if !counts(question, ray(10) as usize, &hit) {
                *valid = 0;
            }
        }
    }
}

/// Holes are not there.
///
/// # Safety
/// As for [`judge`].
unsafe extern "C" fn keep_surfaces(arguments: *const FilterArguments) {
    // SAFETY: the same is asked of the caller.
    unsafe { judge(arguments, |question, _, hit| question.shapes.is_there(hit)) }
}

/// Holes are not there, and panes take their share of the light.
///
/// # Safety
/// As for [`judge`].
unsafe extern "C" fn keep_blockers(arguments: *const FilterArguments) {
    // SAFETY: the same is asked of the caller.
    unsafe {
        judge(arguments, |question, ray, hit| {
            question.shapes.blocks(hit, &question.rays[ray], &mut question.light[ray])
        })
    }
}

/// From Embree's numbers for triangle, geometry and instance.
fn hit_of(t: f32, u: f32, v: f32, [triangle, geometry, instance]: [u32; 3], known: Option<u32>) -> Hit {
    // Triangles of the top scene are attached to it by the instance's index.
    let found = if instance == api::INVALID_ID { geometry } else { instance };
    Hit { t, instance: known.unwrap_or(found), triangle, u, v }
}

/// What a single ray has met.
fn found(RayHit { ray, hit, .. }: &RayHit, known: Option<u32>) -> Option<Hit> {
    (hit.geometry != api::INVALID_ID)
        .then(|| hit_of(ray.t_max, hit.u, hit.v, [hit.primitive, hit.geometry, hit.instance], known))
}

const NO_HIT: RawHit = RawHit {
    normal: [0.0; 3],
    u: 0.0,
    v: 0.0,
    primitive: api::INVALID_ID,
    geometry: api::INVALID_ID,
    instance: api::INVALID_ID,
};

fn raw_ray(ray: &Ray) -> RawRay {
    RawRay {
        origin: ray.origin.to_array(),
        t_min: ray.t_min,
        direction: ray.direction.to_array(),
        time: ray.time,
        t_max: ray.t_max,
        mask: u32::MAX,
        id: 0,
        flags: 0,
    }
}

/// Which rays of a packet are there (−1).
#[repr(align(64))]
struct Valid([c_int; PACKET]);

fn packet(rays: &[Ray]) -> (Valid, PacketRays) {
    let of = |field: fn(&Ray) -> f32| std::array::from_fn(|i| rays.get(i).map_or(0.0, field));
    let packet = PacketRays {
        origin: [of(|r| r.origin.x), of(|r| r.origin.y), of(|r| r.origin.z)],
        t_min: of(|r| r.t_min),
        direction: [of(|r| r.direction.x), of(|r| r.direction.y), of(|r| r.direction.z)],
        time: of(|r| r.time),
        t_max: of(|r| r.t_max),
        mask: [u32::MAX; PACKET],
        id: std::array::from_fn(|i| i as u32),
        flags: [0; PACKET],
    };
    (Valid(std::array::from_fn(|i| if i < rays.len() { -1 } else { 0 })), packet)
}

fn context(question: &mut Question<'_>) -> Context {
    Context { ids: [api::INVALID_ID; 4], user: ptr::from_mut(question).cast::<c_void>() }
}

fn arguments(context: &mut Context, flags: c_int, filter: api::Filter) -> QueryArguments {
    QueryArguments {
        flags,
        features: api::FEATURES_ALL,
        context,
        filter: Some(filter),
        user_geometry: ptr::null_mut(),
        min_width: 0.0,
    }
}

impl BuiltScene {
    /// The nearest surface; `instance` is what it is of where the scene does not know it.
    fn closest(&self, shapes: &Shapes, ray: &Ray, instance: Option<u32>) -> Option<Hit> {
        let mut ray_hit = RayHit { ray: raw_ray(ray), hit: NO_HIT, room: [api::INVALID_ID; 4] };
        let mut question = Question { shapes, instance, rays: &[], light: &mut [] };
        let mut context = context(&mut question);
        let mut arguments = arguments(&mut context, 0, keep_surfaces);
        // SAFETY: the scene is committed; ray, context and arguments are as Embree declares them and outlive the call.
        unsafe { (self.device.api.intersect1)(self.handle, &mut ray_hit, &mut arguments) };
        found(&ray_hit, instance)
    }
}

impl Scene {
    /// The nearest surfaces of up to [`PACKET`] rays that run alike.
    fn closest_packet(&self, rays: &[Ray], hits: &mut [Option<Hit>]) {
        const NONE: [u32; PACKET] = [api::INVALID_ID; PACKET];
        let nothing = PacketHits {
            normal: [[0.0; PACKET]; 3],
            u: [0.0; PACKET],
            v: [0.0; PACKET],
            primitive: NONE,
            geometry: NONE,
            instance: NONE,
        };
        let (valid, ray) = packet(rays);
        let mut packet = Packet { ray, hit: nothing, room: NONE };
        let mut question = Question { shapes: &self.shapes, instance: None, rays: &[], light: &mut [] };
        let mut context = context(&mut question);
        let mut arguments = arguments(&mut context, api::QUERY_COHERENT, keep_surfaces);
        // SAFETY: as for `closest`; `valid` has a number for each ray and is as aligned as Embree demands.
        unsafe { (self.top.device.api.intersect16)(valid.0.as_ptr(), self.top.handle, &mut packet, &mut arguments) };
        for (i, hit) in hits.iter_mut().enumerate() {
            let found = [packet.hit.primitive[i], packet.hit.geometry[i], packet.hit.instance[i]];
            *hit = (found[1] != api::INVALID_ID)
                .then(|| hit_of(packet.ray.t_max[i], packet.hit.u[i], packet.hit.v[i], found, None));
        }
    }

    /// What is left of the light along up to [`PACKET`] rays that run alike.
    fn any_packet(&self, rays: &[Ray], light: &mut [Vec3]) {
        let (valid, mut packet) = packet(rays);
        let mut question = Question { shapes: &self.shapes, instance: None, rays, light };
        let mut context = context(&mut question);
        let mut arguments = arguments(&mut context, api::QUERY_COHERENT, keep_blockers);
        // SAFETY: as for `closest_packet`.
        unsafe { (self.top.device.api.occluded16)(valid.0.as_ptr(), self.top.handle, &mut packet, &mut arguments) };
        extinguish(light, packet.t_max);
    }

    fn any_single(&self, ray: &Ray, light: &mut Vec3) {
        let mut raw = raw_ray(ray);
        let (rays, light) = (std::slice::from_ref(ray), std::slice::from_mut(light));
        let mut question = Question { shapes: &self.shapes, instance: None, rays, light };
        let mut context = context(&mut question);
        let mut arguments = arguments(&mut context, 0, keep_blockers);
        // SAFETY: as for `closest`.
        unsafe { (self.top.device.api.occluded1)(self.top.handle, &mut raw, &mut arguments) };
        extinguish(question.light, [raw.t_max]);
    }
}

/// Embree marks rays that are blocked by a length of −∞.
fn extinguish(light: &mut [Vec3], lengths: impl IntoIterator<Item = f32>) {
    for (light, t_max) in light.iter_mut().zip(lengths) {
        if t_max == f32::NEG_INFINITY {
            *light = Vec3::ZERO;
        }
    }
}

impl Accel for Scene {
    fn closest(&self, rays: &[Ray], coherence: Coherence, hits: &mut [Option<Hit>]) {
        let closest = |ray: &Ray| self.top.closest(&self.shapes, ray, None);
        match coherence {
            Coherence::Coherent => {
                for (rays, hits) in rays.chunks(PACKET).zip(hits.chunks_mut(PACKET)) {
                    self.closest_packet(rays, hits);
                }
            }
            Coherence::Incoherent => rays.iter().zip(&mut *hits).for_each(|(ray, hit)| *hit = closest(ray)),
        }
        for (ray, hit) in rays.iter().zip(hits) {
            *hit = self.shapes.past(ray, *hit, closest);
        }
    }

    fn any(&self, rays: &[Ray], coherence: Coherence, light: &mut [Vec3]) {
        match coherence {
            Coherence::Coherent => {
                for (rays, light) in rays.chunks(PACKET).zip(light.chunks_mut(PACKET)) {
                    self.any_packet(rays, light);
                }
            }
            Coherence::Incoherent => rays.iter().zip(light).for_each(|(ray, light)| self.any_single(ray, light)),
        }
    }

    fn closest_on(&self, instance: u32, rays: &[Ray], hits: &mut [Option<Hit>]) {
        let closest = |ray: &Ray| match &self.bottoms[instance as usize] {
            Bottom::Placed(bottom, mesh_from_world) => {
                let local = Ray {
                    origin: mesh_from_world.transform_point3(ray.origin),
                    direction: mesh_from_world.transform_vector3(ray.direction),
                    ..*ray
                };
                bottom.closest(&self.shapes, &local, Some(instance))
            }
            Bottom::InTop(alone) => match alone.get_or_init(|| self.alone(instance)) {
                Alone::Built(scene) => scene.closest(&self.shapes, ray, Some(instance)),
                Alone::BuiltIn(top) => top.closest(&self.shapes, ray, instance),
            },
        };
        rays.iter().zip(hits).for_each(|(ray, hit)| *hit = closest(ray));
    }

    fn bare_closest(&self, rays: &[Ray]) -> usize {
        let meets = |ray: &&Ray| {
            let mut ray_hit = RayHit { ray: raw_ray(ray), hit: NO_HIT, room: [api::INVALID_ID; 4] };
            // SAFETY: as for `BuiltScene::closest`; without arguments Embree takes its defaults.
            unsafe { (self.top.device.api.intersect1)(self.top.handle, &mut ray_hit, ptr::null_mut()) };
            found(&ray_hit, None).is_some()
        };
        rays.iter().filter(meets).count()
    }

    fn bare_any(&self, rays: &[Ray]) -> usize {
        let is_blocked = |ray: &&Ray| {
            let mut raw = raw_ray(ray);
            // SAFETY: as for `bare_closest`.
            unsafe { (self.top.device.api.occluded1)(self.top.handle, &mut raw, ptr::null_mut()) };
            raw.t_max == f32::NEG_INFINITY
        };
        rays.iter().filter(is_blocked).count()
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
