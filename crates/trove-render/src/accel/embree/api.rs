//! The part of Embree 4's C interface that is used, loaded at run time.
//!
//! Names and numbers are those of its headers `rtcore_*.h`; `Api::load` asks a question with a known answer before
//! the library is trusted.

use std::ffi::{c_char, c_int, c_void};
use std::path::{Path, PathBuf};

use libloading::Library;

use crate::accel::PACKET;
use crate::shared_library::shared_library;

pub(super) type Handle = *mut c_void;

pub(super) const GEOMETRY_TRIANGLE: c_int = 0;
pub(super) const GEOMETRY_INSTANCE: c_int = 121;
pub(super) const BUFFER_INDEX: c_int = 0;
pub(super) const BUFFER_VERTEX: c_int = 1;
pub(super) const FORMAT_UINT3: c_int = 0x5003;
pub(super) const FORMAT_FLOAT3: c_int = 0x9003;
pub(super) const FORMAT_FLOAT3X4_COLUMN_MAJOR: c_int = 0x9234;
pub(super) const SCENE_ROBUST: c_int = 1 << 2;
pub(super) const SCENE_FILTER_IN_ARGUMENTS: c_int = 1 << 3;
pub(super) const QUALITY_MEDIUM: c_int = 1;
pub(super) const FEATURES_ALL: c_int = -1;
pub(super) const QUERY_COHERENT: c_int = 1 << 16;
pub(super) const INVALID_ID: u32 = u32::MAX;
pub(super) const ERROR_NONE: c_int = 0;
const PROPERTY_VERSION: [c_int; 3] = [1, 2, 3];

/// `RTCRay` and `RTCHit`, with room for the fields that builds with instance arrays have.
#[repr(C, align(16))]
pub(super) struct RayHit {
    pub(super) ray: RawRay,
    pub(super) hit: RawHit,
    pub(super) room: [u32; 4],
}

/// `RTCRay`.
#[repr(C, align(16))]
#[derive(Clone, Copy)]
pub(super) struct RawRay {
    pub(super) origin: [f32; 3],
    pub(super) t_min: f32,
    pub(super) direction: [f32; 3],
    pub(super) time: f32,
    pub(super) t_max: f32,
    pub(super) mask: u32,
    pub(super) id: u32,
    pub(super) flags: u32,
}

/// `RTCHit` up to the first instance's id.
#[repr(C)]
#[derive(Clone, Copy)]
pub(super) struct RawHit {
    pub(super) normal: [f32; 3],
    pub(super) u: f32,
    pub(super) v: f32,
    pub(super) primitive: u32,
    pub(super) geometry: u32,
    pub(super) instance: u32,
}

/// `RTCRayHit16` up to the first instance's ids, with room for the fields that builds with instance arrays have; a field
/// of all rays lies together.
#[repr(C, align(64))]
pub(super) struct Packet {
    pub(super) ray: PacketRays,
    pub(super) hit: PacketHits,
    pub(super) room: [u32; PACKET],
}

/// `RTCRay16`.
#[repr(C, align(64))]
pub(super) struct PacketRays {
    pub(super) origin: [[f32; PACKET]; 3],
    pub(super) t_min: [f32; PACKET],
    pub(super) direction: [[f32; PACKET]; 3],
    pub(super) time: [f32; PACKET],
    pub(super) t_max: [f32; PACKET],
    pub(super) mask: [u32; PACKET],
    pub(super) id: [u32; PACKET],
    pub(super) flags: [u32; PACKET],
}

/// `RTCHit16` up to the first instance's ids.
#[repr(C, align(64))]
pub(super) struct PacketHits {
    pub(super) normal: [[f32; PACKET]; 3],
    pub(super) u: [f32; PACKET],
    pub(super) v: [f32; PACKET],
    pub(super) primitive: [u32; PACKET],
    pub(super) geometry: [u32; PACKET],
    pub(super) instance: [u32; PACKET],
}

/// `RTCRayQueryContext` with room behind it, and what the filter needs.
#[repr(C)]
pub(super) struct Context {
    pub(super) ids: [u32; 4],
    pub(super) user: *mut c_void,
}

/// `RTCFilterFunctionNArguments`.
#[repr(C)]
pub(super) struct FilterArguments {
    pub(super) valid: *mut c_int,
    pub(super) geometry_user: *mut c_void,
    pub(super) context: *mut Context,
    /// `n` rays: their first fields, then their second ones, and so on; so too the hits.
    pub(super) ray: *const u32,
    pub(super) hit: *const u32,
    pub(super) n: u32,
}

pub(super) type ErrorFunction = unsafe extern "C" fn(*mut c_void, c_int, *const c_char);

pub(super) type Filter = unsafe extern "C" fn(*const FilterArguments);

/// `RTCIntersectArguments` and `RTCOccludedArguments`, which have the same fields.
#[repr(C)]
pub(super) struct QueryArguments {
    pub(super) flags: c_int,
    pub(super) features: c_int,
    pub(super) context: *mut Context,
    pub(super) filter: Option<Filter>,
    pub(super) user_geometry: *mut c_void,
    /// Only read by builds with minimum curve widths.
    pub(super) min_width: f32,
}

// Types as in Embree 4's headers.
shared_library! {
    new_device = b"rtcNewDevice": fn(*const c_char) -> Handle;
    release_device = b"rtcReleaseDevice": fn(Handle);
    device_error = b"rtcGetDeviceError": fn(Handle) -> c_int;
    set_error_function = b"rtcSetDeviceErrorFunction": fn(Handle, Option<ErrorFunction>, *mut c_void);
    device_property = b"rtcGetDeviceProperty": fn(Handle, c_int) -> isize;
    new_scene = b"rtcNewScene": fn(Handle) -> Handle;
    release_scene = b"rtcReleaseScene": fn(Handle);
    set_scene_flags = b"rtcSetSceneFlags": fn(Handle, c_int);
    set_scene_quality = b"rtcSetSceneBuildQuality": fn(Handle, c_int);
    commit_scene = b"rtcCommitScene": fn(Handle);
    new_geometry = b"rtcNewGeometry": fn(Handle, c_int) -> Handle;
    release_geometry = b"rtcReleaseGeometry": fn(Handle);
    new_buffer = b"rtcSetNewGeometryBuffer": fn(Handle, c_int, u32, c_int, usize, usize) -> *mut c_void;
    filter_from_arguments = b"rtcSetGeometryEnableFilterFunctionFromArguments": fn(Handle, bool);
    set_instanced_scene = b"rtcSetGeometryInstancedScene": fn(Handle, Handle);
    set_time_steps = b"rtcSetGeometryTimeStepCount": fn(Handle, u32);
    set_transform = b"rtcSetGeometryTransform": fn(Handle, u32, c_int, *const c_void);
    set_mask = b"rtcSetGeometryMask": fn(Handle, u32);
    commit_geometry = b"rtcCommitGeometry": fn(Handle);
    attach_by_id = b"rtcAttachGeometryByID": fn(Handle, Handle, u32);
    intersect1 = b"rtcIntersect1": fn(Handle, *mut RayHit, *mut QueryArguments);
    occluded1 = b"rtcOccluded1": fn(Handle, *mut RawRay, *mut QueryArguments);
    intersect16 = b"rtcIntersect16": fn(*const c_int, Handle, *mut Packet, *mut QueryArguments);
    occluded16 = b"rtcOccluded16": fn(*const c_int, Handle, *mut PacketRays, *mut QueryArguments);
}

impl Api {
    /// Loads the first Embree 4 found in `search` (files, or folders such as Python's site-packages), then the
    /// system's; the error says what went wrong with the last candidate.
    pub(super) fn load(search: &[PathBuf]) -> Result<Self, String> {
        let mut problem = "not found".to_owned();
        let system = [PathBuf::from(if cfg!(windows) { "embree4.dll" } else { "libembree4.so.4" })];
        for path in search.iter().flat_map(|place| candidates(place)).chain(system) {
            // SAFETY: loading Embree (and the oneTBB beside it, which it finds itself) runs their own initialisers only.
            let library = unsafe { Library::new(&path) };
            match library.and_then(Self::from_library) {
                Ok(api) => return Ok(api),
                Err(error) if path.is_file() => problem = error.to_string(),
                Err(_) => {}
            }
        }
        Err(problem)
    }

    /// (major, minor, patch).
    pub(super) fn version(&self, device: Handle) -> [isize; 3] {
        // SAFETY: `device` is alive, and these properties exist in every Embree 4.
        PROPERTY_VERSION.map(|property| unsafe { (self.device_property)(device, property) })
    }
}

/// What one of Embree's error codes means.
pub(super) fn error_name(code: c_int) -> String {
    match code {
        2 => "invalid argument".into(),
        3 => "invalid operation".into(),
        4 => "out of memory".into(),
        5 => "this processor is not supported".into(),
        6 => "cancelled".into(),
        _ => format!("unknown error {code}"),
    }
}

/// The files in which Embree may lie, given a file or a folder.
fn candidates(place: &Path) -> Vec<PathBuf> {
    if place.is_file() {
        return vec![place.into()];
    }
    let is_embree = |name: &str| {
        (name.starts_with("libembree4") || name.starts_with("embree4"))
            && [".so", ".dylib", ".dll"].iter().any(|end| name.contains(end))
    };
    let mut found = Vec::new();
    for folder in ["", "embreex.libs", "embreex/.dylibs"].map(|sub| place.join(sub)) {
        let entries = std::fs::read_dir(folder).into_iter().flatten().flatten();
        found.extend(entries.filter(|e| e.file_name().to_str().is_some_and(is_embree)).map(|e| e.path()));
    }
    found.sort();
    found
}
