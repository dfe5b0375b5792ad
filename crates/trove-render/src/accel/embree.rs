//! Embree 4: one Embree scene for each mesh that is placed, and one over them, in which meshes that already lie in World
//! are as they are.

use std::collections::BTreeMap;
use std::ffi::{c_int, c_void};
use std::path::PathBuf;
use std::ptr;
use std::sync::{Arc, OnceLock};

use glam::Affine3A;
use trove_model::Mesh;

use super::embree_api::{
    self as api, Api, Context, FilterArguments, Handle, Packet, PacketHits, PacketRays, QueryArguments, RawHit, RawRay,
    RayHit,
};
use super::{Accept, Hit, Motion, PACKET, Placed, Ray};
use crate::RenderError;
use crate::cache::Cache;

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

/// A committed scene, which is not changed any more.
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

/// Embree with what it built of the meshes so far.
pub(crate) struct Kernel {
    device: Arc<Device>,
    /// Whether hits are tested is a property of what is built: without tests, with tests.
    built: [Cache<Mesh, BuiltScene>; 2],
}

/// A two-level scene.
pub(crate) struct Accel {
    top: BuiltScene,
    /// By index of the instance.
    bottoms: Vec<Bottom>,
}

/// What an instance shows, on its own.
enum Bottom {
    /// A scene that may be placed several times, with its `mesh_from_world`.
    Placed(Arc<BuiltScene>, Affine3A),
    /// Triangles that lie in the top scene, in World; a scene of their own is built when it is first asked for.
    InTop { mesh: Arc<Mesh>, tested: bool, alone: OnceLock<BuiltScene> },
}

impl Kernel {
    /// Loads the library and asks it a question with a known answer.
    pub(super) fn load(search: &[PathBuf]) -> Result<Self, RenderError> {
        let refuse = |problem: String| RenderError::Library { library: "Embree 4", problem, looked: search.to_vec() };
        let api = Api::load(search).map_err(refuse)?;
        // One thread builds: the same tree, and so the same choice among equally near hits, in every run.
        // SAFETY: the configuration is a C string.
        let handle = unsafe { (api.new_device)(c"threads=1,set_affinity=0".as_ptr()) };
        if handle.is_null() {
            return Err(refuse("it has no device for this processor".into()));
        }
        let device = Arc::new(Device { api, handle });
        let kernel = Self { device, built: Default::default() };
        if kernel.device.api.version(handle)[0] != 4 || !kernel.answers_correctly() {
            return Err(refuse(format!("{} does not answer as Embree 4 does", kernel.name())));
        }
        Ok(kernel)
    }

    pub(super) fn name(&self) -> String {
        let [major, minor, patch] = self.device.api.version(self.device.handle);
        format!("Embree {major}.{minor}.{patch}")
    }

    /// Two instances of one triangle, of which the nearer one is refused: guards against another binary interface.
    fn answers_correctly(&self) -> bool {
        let mesh = Arc::new(Mesh {
            positions: vec![glam::Vec3::ZERO, glam::Vec3::X, glam::Vec3::Y],
            triangles: vec![[0, 1, 2]],
            ..Mesh::default()
        });
        let at = |z: f32| Placed {
            mesh: mesh.clone(),
            world_from_mesh: Motion { middle: Affine3A::from_translation(glam::Vec3::Z * z), ends: None },
            tested: true,
        };
        let accel = self.build(&[at(1.0), at(3.0)]);
        let ray = Ray::new(glam::Vec3::new(0.25, 0.5, 0.0), glam::Vec3::Z);
        let mut asked = [false; 2];
        let hit = accel.intersect(&ray, &mut |_, hit| {
            asked[hit.instance as usize & 1] = true;
            hit.instance == 1
        });
        asked[0] && hit == Some(Hit { t: 3.0, instance: 1, triangle: 0, u: 0.25, v: 0.5 })
    }

    pub(super) fn build(&self, placed: &[Placed]) -> Accel {
        self.built.iter().for_each(Cache::forget_unused);
        let api = &self.device.api;
        let top = BuiltScene { device: self.device.clone(), handle: new_scene(&self.device) };
        let mut bottoms = Vec::with_capacity(placed.len());
        let mut uses: BTreeMap<*const Mesh, usize> = BTreeMap::new();
        placed.iter().for_each(|p| *uses.entry(Arc::as_ptr(&p.mesh)).or_default() += 1);
        for (i, p) in placed.iter().enumerate() {
            // Ground, roads and houses overlap: as instances, a ray would have to enter one after the other.
            let Motion { middle, ends } = p.world_from_mesh;
            if middle == Affine3A::IDENTITY && ends.is_none() && uses[&Arc::as_ptr(&p.mesh)] == 1 {
                attach_mesh(&top, &p.mesh, p.tested, i as u32);
                bottoms.push(Bottom::InTop { mesh: p.mesh.clone(), tested: p.tested, alone: OnceLock::new() });
                continue;
            }
            let cache = &self.built[usize::from(p.tested)];
            let bottom = cache.get(&p.mesh, |mesh| build_mesh(&self.device, mesh, p.tested));
            let steps = ends.map_or(vec![middle], |[before, after]| vec![before, middle, after]);
            // SAFETY: all handles are alive; a transform is 12 floats, column by column; ids are distinct.
            unsafe {
                let geometry = (api.new_geometry)(self.device.handle, api::GEOMETRY_INSTANCE);
                (api.set_instanced_scene)(geometry, bottom.handle);
                (api.set_time_steps)(geometry, steps.len() as u32);
                for (step, world_from_mesh) in (0..).zip(&steps) {
                    let columns = world_from_mesh.to_cols_array();
                    let format = api::FORMAT_FLOAT3X4_COLUMN_MAJOR;
                    (api.set_transform)(geometry, step, format, columns.as_ptr().cast());
                }
                (api.commit_geometry)(geometry);
                (api.attach_by_id)(top.handle, geometry, i as u32);
                (api.release_geometry)(geometry);
            }
            bottoms.push(Bottom::Placed(bottom, middle.inverse()));
        }
        // SAFETY: the scene is alive and complete.
        unsafe { (api.commit_scene)(top.handle) };
        Accel { top, bottoms }
    }
}

fn new_scene(device: &Device) -> Handle {
    let api = &device.api;
    // SAFETY: the device is alive; flags and quality are Embree's.
    unsafe {
        let scene = (api.new_scene)(device.handle);
        (api.set_scene_flags)(scene, api::SCENE_ROBUST | api::SCENE_FILTER_IN_ARGUMENTS);
        (api.set_scene_quality)(scene, api::QUALITY_MEDIUM);
        scene
    }
}

fn build_mesh(device: &Arc<Device>, mesh: &Mesh, tested: bool) -> BuiltScene {
    let scene = BuiltScene { device: device.clone(), handle: new_scene(device) };
    attach_mesh(&scene, mesh, tested, 0);
    // SAFETY: the scene is alive and complete.
    unsafe { (device.api.commit_scene)(scene.handle) };
    scene
}

/// Puts a mesh into a scene that is not committed yet, under an id that is not taken.
fn attach_mesh(scene: &BuiltScene, mesh: &Mesh, tested: bool, id: u32) {
    if mesh.triangles.is_empty() {
        return;
    }
    let (api, device) = (&scene.device.api, scene.device.handle);
    // SAFETY: handles are alive; Embree's own buffers have room for exactly the vertices (12 bytes) and triangles
    // (12 bytes) that are copied into them.
    unsafe {
        let geometry = (api.new_geometry)(device, api::GEOMETRY_TRIANGLE);
        let vertices = mesh.positions.len();
        let to = (api.new_buffer)(geometry, api::BUFFER_VERTEX, 0, api::FORMAT_FLOAT3, 12, vertices);
        ptr::copy_nonoverlapping(mesh.positions.as_ptr().cast::<u8>(), to.cast(), 12 * vertices);
        let triangles = mesh.triangles.len();
        let to = (api.new_buffer)(geometry, api::BUFFER_INDEX, 0, api::FORMAT_UINT3, 12, triangles);
        ptr::copy_nonoverlapping(mesh.triangles.as_ptr().cast::<u8>(), to.cast(), 12 * triangles);
        (api.filter_from_arguments)(geometry, tested);
        (api.commit_geometry)(geometry);
        (api.attach_by_id)(scene.handle, geometry, id);
        (api.release_geometry)(geometry);
    }
}

/// What the filter is given: the caller's closure, and the instance where Embree does not know it.
struct Question<'a> {
    accept: Accept<'a>,
    instance: Option<u32>,
}

/// Puts candidates to the closure.
///
/// # Safety
/// To be called by Embree with a context made by [`context`].
unsafe extern "C" fn filter(arguments: *const FilterArguments) {
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
            if !(question.accept)(ray(10) as usize, &hit) {
                *valid = 0;
            }
        }
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

fn arguments(context: &mut Context, flags: c_int) -> QueryArguments {
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
    fn intersect(&self, ray: &Ray, accept: Accept<'_>, instance: Option<u32>) -> Option<Hit> {
        let mut ray_hit = RayHit { ray: raw_ray(ray), hit: NO_HIT, room: [api::INVALID_ID; 4] };
        let mut question = Question { accept, instance };
        let mut context = context(&mut question);
        let mut arguments = arguments(&mut context, 0);
        // SAFETY: the scene is committed; ray, context and arguments are as Embree declares them and outlive the call.
        unsafe { (self.device.api.intersect1)(self.handle, &mut ray_hit, &mut arguments) };
        found(&ray_hit, instance)
    }
}

impl Accel {
    pub(super) fn intersect(&self, ray: &Ray, accept: Accept<'_>) -> Option<Hit> {
        self.top.intersect(ray, accept, None)
    }

    pub(super) fn occluded(&self, ray: &Ray, accept: Accept<'_>) -> bool {
        let mut raw = raw_ray(ray);
        let mut question = Question { accept, instance: None };
        let mut context = context(&mut question);
        let mut arguments = arguments(&mut context, 0);
        // SAFETY: as for `intersect`.
        unsafe { (self.top.device.api.occluded1)(self.top.handle, &mut raw, &mut arguments) };
        raw.t_max == f32::NEG_INFINITY
    }

    pub(super) fn intersect_bare(&self, ray: &Ray) -> Option<Hit> {
        let mut ray_hit = RayHit { ray: raw_ray(ray), hit: NO_HIT, room: [api::INVALID_ID; 4] };
        // SAFETY: as for `intersect`; without arguments Embree takes its defaults.
        unsafe { (self.top.device.api.intersect1)(self.top.handle, &mut ray_hit, ptr::null_mut()) };
        found(&ray_hit, None)
    }

    pub(super) fn occluded_bare(&self, ray: &Ray) -> bool {
        let mut raw = raw_ray(ray);
        // SAFETY: as for `intersect_bare`.
        unsafe { (self.top.device.api.occluded1)(self.top.handle, &mut raw, ptr::null_mut()) };
        raw.t_max == f32::NEG_INFINITY
    }

    pub(super) fn intersect_packet(&self, rays: &[Ray], hits: &mut [Option<Hit>; PACKET], accept: Accept<'_>) {
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
        let mut question = Question { accept, instance: None };
        let mut context = context(&mut question);
        let mut arguments = arguments(&mut context, api::QUERY_COHERENT);
        // SAFETY: as for `intersect`; `valid` has a number for each ray and is as aligned as Embree demands.
        unsafe { (self.top.device.api.intersect16)(valid.0.as_ptr(), self.top.handle, &mut packet, &mut arguments) };
        for (i, hit) in hits.iter_mut().enumerate() {
            let found = [packet.hit.primitive[i], packet.hit.geometry[i], packet.hit.instance[i]];
            *hit = (found[1] != api::INVALID_ID)
                .then(|| hit_of(packet.ray.t_max[i], packet.hit.u[i], packet.hit.v[i], found, None));
        }
    }

    pub(super) fn occluded_packet(&self, rays: &[Ray], occluded: &mut [bool; PACKET], accept: Accept<'_>) {
        let (valid, mut packet) = packet(rays);
        let mut question = Question { accept, instance: None };
        let mut context = context(&mut question);
        let mut arguments = arguments(&mut context, api::QUERY_COHERENT);
        // SAFETY: as for `intersect_packet`.
        unsafe { (self.top.device.api.occluded16)(valid.0.as_ptr(), self.top.handle, &mut packet, &mut arguments) };
        *occluded = packet.t_max.map(|t| t == f32::NEG_INFINITY);
    }

    pub(super) fn intersect_instance(&self, ray: &Ray, instance: u32, accept: Accept<'_>) -> Option<Hit> {
        match &self.bottoms[instance as usize] {
            Bottom::Placed(bottom, mesh_from_world) => {
                let local = Ray {
                    origin: mesh_from_world.transform_point3(ray.origin),
                    direction: mesh_from_world.transform_vector3(ray.direction),
                    ..*ray
                };
                bottom.intersect(&local, accept, Some(instance))
            }
            Bottom::InTop { mesh, tested, alone } => {
                let build = || build_mesh(&self.top.device, mesh, *tested);
                alone.get_or_init(build).intersect(ray, accept, Some(instance))
            }
        }
    }
}
