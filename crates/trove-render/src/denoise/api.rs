//! The part of Open Image Denoise 2's C interface that is used, loaded at run time.
//!
//! Names and numbers are those of its header `oidn.h`.

use std::ffi::{CStr, c_char, c_int, c_void};
use std::path::{Path, PathBuf};

use libloading::Library;

use crate::shared_library::shared_library;

pub(super) type Handle = *mut c_void;

pub(super) const DEVICE_CPU: c_int = 1;
pub(super) const FORMAT_FLOAT3: c_int = 3;
pub(super) const QUALITY_FAST: c_int = 4;
pub(super) const QUALITY_HIGH: c_int = 6;
pub(super) const ERROR_NONE: c_int = 0;

// Types as in version 2's `oidn.h`.
shared_library! {
    new_device = b"oidnNewDevice": fn(c_int) -> Handle;
    set_device_bool = b"oidnSetDeviceBool": fn(Handle, *const c_char, bool);
    set_device_int = b"oidnSetDeviceInt": fn(Handle, *const c_char, c_int);
    get_device_int = b"oidnGetDeviceInt": fn(Handle, *const c_char) -> c_int;
    commit_device = b"oidnCommitDevice": fn(Handle);
    release_device = b"oidnReleaseDevice": fn(Handle);
    device_error = b"oidnGetDeviceError": fn(Handle, *mut *const c_char) -> c_int;
    new_filter = b"oidnNewFilter": fn(Handle, *const c_char) -> Handle;
    set_shared_image = b"oidnSetSharedFilterImage":
        fn(Handle, *const c_char, *mut c_void, c_int, usize, usize, usize, usize, usize);
    set_filter_bool = b"oidnSetFilterBool": fn(Handle, *const c_char, bool);
    set_filter_int = b"oidnSetFilterInt": fn(Handle, *const c_char, c_int);
    commit_filter = b"oidnCommitFilter": fn(Handle);
    execute_filter = b"oidnExecuteFilter": fn(Handle);
    release_filter = b"oidnReleaseFilter": fn(Handle);
}

impl Api {
    /// Loads the first Open Image Denoise 2 found in `search` (files, or folders such as Python's site-packages), then
    /// the system's; the error says what went wrong with the last candidate.
    pub(super) fn load(search: &[PathBuf]) -> Result<Self, String> {
        let mut problem = "not found".to_owned();
        let system = match std::env::consts::OS {
            "windows" => "OpenImageDenoise.dll",
            "macos" => "libOpenImageDenoise.2.dylib",
            _ => "libOpenImageDenoise.so.2",
        };
        for path in search.iter().flat_map(|place| candidates(place)).chain([PathBuf::from(system)]) {
            // SAFETY: loading Open Image Denoise runs its own initialisers only; its other parts lie beside it, where
            // it looks for them itself.
            let loaded = unsafe { Library::new(&path) }.and_then(Self::from_library);
            match loaded {
                Ok(api) => return Ok(api),
                Err(error) if path.is_file() => problem = format!("{}: {error}", path.display()),
                Err(_) => {}
            }
        }
        Err(problem)
    }

    /// What went wrong since the last time it was asked; `device` is null for what has no device yet.
    pub(super) fn error(&self, device: Handle) -> Result<(), String> {
        let mut message = std::ptr::null();
        // SAFETY: `device` is alive or null, both of which the function takes, and it writes one pointer.
        let code = unsafe { (self.device_error)(device, &raw mut message) };
        if code == ERROR_NONE {
            return Ok(());
        }
        if message.is_null() {
            return Err(format!("error {code}"));
        }
        // SAFETY: the message is a C string that lives until the next call on this thread.
        Err(unsafe { CStr::from_ptr(message) }.to_string_lossy().into_owned())
    }
}

/// The files in which the library may lie, given a file or a folder, in the order of their names.
fn candidates(place: &Path) -> Vec<PathBuf> {
    if place.is_file() {
        return vec![place.into()];
    }
    let mut found = Vec::new();
    for sub in ["", "lib", "pyoidn/oidn/lib", "pyoidn/oidn/bin"] {
        let entries = std::fs::read_dir(place.join(sub)).into_iter().flatten().flatten();
        let mut files: Vec<PathBuf> = entries.map(|entry| entry.path()).filter(|path| is_library(path)).collect();
        files.sort();
        found.extend(files);
    }
    found
}

/// The library itself; its core and its devices are named `…_core` and `…_device_…`.
pub(super) fn is_library(path: &Path) -> bool {
    let name = path.file_name().and_then(|name| name.to_str()).unwrap_or_default();
    let rest = name.strip_prefix("lib").unwrap_or(name).strip_prefix("OpenImageDenoise.");
    rest.is_some_and(|rest| rest.contains("so") || rest.contains("dylib") || rest == "dll")
}
