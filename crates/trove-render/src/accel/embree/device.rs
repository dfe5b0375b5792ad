//! What is made with Embree, and how it tells that it could not.

use std::cell::RefCell;
use std::ffi::{CStr, c_char, c_int, c_void};
use std::ptr;
use std::sync::Arc;

use glam::Affine3A;
use trove_model::Mesh;

use super::api::{self, Api, Handle};

/// The loaded library and its device.
pub(super) struct Device {
    pub(super) api: Api,
    pub(super) handle: Handle,
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
pub(super) unsafe extern "C" fn take_down(_user: *mut c_void, _code: c_int, message: *const c_char) {
    if message.is_null() {
        return;
    }
    // SAFETY: Embree passes a C string.
    let message = unsafe { CStr::from_ptr(message) }.to_string_lossy().into_owned();
    // A thread that is ending has nobody left to tell.
    let _ = SAID.try_with(|said| said.replace(message));
}

/// Refuses an error of this thread since the last one was read; `device` may be null, where none could be made.
pub(super) fn check(api: &Api, device: Handle, doing: &str) -> Result<(), String> {
    // SAFETY: the device is alive or null, for which Embree keeps errors of its own.
    let code = unsafe { (api.device_error)(device) };
    if code == api::ERROR_NONE {
        return Ok(());
    }
    let said = SAID.take();
    Err(format!("{doing}: {}{}{said}", api::error_name(code), if said.is_empty() { "" } else { ": " }))
}

/// Refuses null.
pub(super) fn made<T>(api: &Api, device: Handle, what: &str, made: *mut T) -> Result<*mut T, String> {
    if made.is_null() {
        check(api, device, what)?;
        return Err(format!("{what}: failed without a reason"));
    }
    Ok(made)
}

/// A scene; once it is committed, it is not changed any more.
pub(super) struct BuiltScene {
    pub(super) device: Arc<Device>,
    pub(super) handle: Handle,
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
    pub(super) fn new(device: &Arc<Device>) -> Result<Self, String> {
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
    pub(super) fn of(device: &Arc<Device>, mesh: &Mesh, judged: bool) -> Result<Self, String> {
        let scene = Self::new(device)?;
        scene.attach_mesh(mesh, judged, 0, u32::MAX)?;
        scene.commit()?;
        Ok(scene)
    }

    /// Builds what is attached; tells of whatever has gone wrong with it.
    pub(super) fn commit(&self) -> Result<(), String> {
        // SAFETY: the scene is alive and complete.
        unsafe { (self.device.api.commit_scene)(self.handle) };
        check(&self.device.api, self.device.handle, "building a scene")
    }

    /// Attaches a mesh, under an id that is not taken, for rays that share a bit with its mask.
    pub(super) fn attach_mesh(&self, mesh: &Mesh, judged: bool, id: u32, mask: u32) -> Result<(), String> {
        if mesh.triangles.is_empty() {
            return Ok(());
        }
        let api = &self.device.api;
        let geometry = Geometry::new(&self.device, api::GEOMETRY_TRIANGLE)?;
        geometry.fill(api::BUFFER_VERTEX, api::FORMAT_FLOAT3, mesh.positions.as_ptr().cast(), mesh.positions.len())?;
        geometry.fill(api::BUFFER_INDEX, api::FORMAT_UINT3, mesh.triangles.as_ptr().cast(), mesh.triangles.len())?;
        // SAFETY: the geometry is alive.
        unsafe { (api.filter_from_arguments)(geometry.handle, judged) };
        geometry.attach(self, id, mask);
        Ok(())
    }

    /// Attaches a scene that moves through some placements, likewise.
    pub(super) fn attach_instance(&self, bottom: &Self, steps: &[Affine3A], id: u32, mask: u32) -> Result<(), String> {
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
        geometry.attach(self, id, mask);
        Ok(())
    }
}

/// A geometry that is being made; scenes keep what is attached to them.
pub(super) struct Geometry<'a> {
    device: &'a Device,
    pub(super) handle: Handle,
}

impl Drop for Geometry<'_> {
    fn drop(&mut self) {
        // SAFETY: the handle came from `new_geometry` and is released once.
        unsafe { (self.device.api.release_geometry)(self.handle) }
    }
}

impl<'a> Geometry<'a> {
    pub(super) fn new(device: &'a Device, kind: c_int) -> Result<Self, String> {
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

    fn attach(self, scene: &BuiltScene, id: u32, mask: u32) {
        // SAFETY: both handles are alive; the caller's ids are distinct.
        unsafe {
            (self.device.api.set_mask)(self.handle, mask);
            (self.device.api.commit_geometry)(self.handle);
            (self.device.api.attach_by_id)(scene.handle, self.handle, id);
        }
    }
}
