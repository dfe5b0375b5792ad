//! NVIDIA's driver, loaded at run time: the few functions of its API that are used.

use std::ffi::{CStr, c_char, c_int, c_uint, c_void};
use std::marker::PhantomData;
use std::mem::ManuallyDrop;
use std::ptr;
use std::sync::Arc;

use libloading::Library;

use crate::shared_library::shared_library;

/// `CUcontext`, `CUmodule`, `CUfunction`, `CUevent` and `CUstream`.
type Handle = *mut c_void;

const SUCCESS: c_int = 0;
/// `CU_DEVICE_ATTRIBUTE_…`.
const MULTIPROCESSORS: c_int = 16;
const COMPUTE_MAJOR: c_int = 75;
const COMPUTE_MINOR: c_int = 76;
/// `CU_FUNC_ATTRIBUTE_…`.
const LOCAL_BYTES: c_int = 3;
const REGISTERS: c_int = 4;

// Types as in `cuda.h`.
shared_library! {
    init = b"cuInit": fn(c_uint) -> c_int;
    error_text = b"cuGetErrorString": fn(c_int, *mut *const c_char) -> c_int;
    driver_version = b"cuDriverGetVersion": fn(*mut c_int) -> c_int;
    device_count = b"cuDeviceGetCount": fn(*mut c_int) -> c_int;
    device_get = b"cuDeviceGet": fn(*mut c_int, c_int) -> c_int;
    device_name = b"cuDeviceGetName": fn(*mut c_char, c_int, c_int) -> c_int;
    device_memory = b"cuDeviceTotalMem_v2": fn(*mut usize, c_int) -> c_int;
    device_attribute = b"cuDeviceGetAttribute": fn(*mut c_int, c_int, c_int) -> c_int;
    context_retain = b"cuDevicePrimaryCtxRetain": fn(*mut Handle, c_int) -> c_int;
    context_release = b"cuDevicePrimaryCtxRelease_v2": fn(c_int) -> c_int;
    context_set = b"cuCtxSetCurrent": fn(Handle) -> c_int;
    module_load = b"cuModuleLoadData": fn(*mut Handle, *const c_void) -> c_int;
    module_unload = b"cuModuleUnload": fn(Handle) -> c_int;
    module_function = b"cuModuleGetFunction": fn(*mut Handle, Handle, *const c_char) -> c_int;
    function_attribute = b"cuFuncGetAttribute": fn(*mut c_int, c_int, Handle) -> c_int;
    occupancy = b"cuOccupancyMaxActiveBlocksPerMultiprocessor": fn(*mut c_int, Handle, c_int, usize) -> c_int;
    allocate = b"cuMemAlloc_v2": fn(*mut u64, usize) -> c_int;
    free = b"cuMemFree_v2": fn(u64) -> c_int;
    upload = b"cuMemcpyHtoD_v2": fn(u64, *const c_void, usize) -> c_int;
    download = b"cuMemcpyDtoH_v2": fn(*mut c_void, u64, usize) -> c_int;
    launch = b"cuLaunchKernel":
        fn(Handle, c_uint, c_uint, c_uint, c_uint, c_uint, c_uint, c_uint, Handle, *mut *mut c_void, *mut *mut c_void) -> c_int;
    event_create = b"cuEventCreate": fn(*mut Handle, c_uint) -> c_int;
    event_destroy = b"cuEventDestroy_v2": fn(Handle) -> c_int;
    event_record = b"cuEventRecord": fn(Handle, Handle) -> c_int;
    event_synchronize = b"cuEventSynchronize": fn(Handle) -> c_int;
    event_ms = b"cuEventElapsedTime": fn(*mut f32, Handle, Handle) -> c_int;
}

/// A card with a program on it.
pub(super) struct Device {
    api: Api,
    device: c_int,
    context: Handle,
    module: Handle,
    /// What it is called.
    pub(super) name: String,
    /// What it is, for people.
    pub(super) about: String,
    pub(super) multiprocessors: u32,
}

// SAFETY: the driver may be called by any thread, and the handles are the process's; each call makes the context its thread's.
unsafe impl Send for Device {}
// SAFETY: as above.
unsafe impl Sync for Device {}

impl Drop for Device {
    fn drop(&mut self) {
        // SAFETY: both were made when it was opened; a card that is lost refuses, and nothing is left to do then.
        unsafe {
            (self.api.context_set)(self.context);
            (self.api.module_unload)(self.module);
            (self.api.context_release)(self.device);
        }
    }
}

/// A program's function on a card.
#[derive(Clone, Copy)]
pub(super) struct Function<'a> {
    device: &'a Device,
    handle: Handle,
}

/// Values in a card's memory.
pub(super) struct Buffer<T> {
    device: Arc<Device>,
    address: u64,
    count: usize,
    holds: PhantomData<T>,
}

impl<T> Drop for Buffer<T> {
    fn drop(&mut self) {
        if self.address != 0 && self.device.enter().is_ok() {
            // SAFETY: it was allocated and is freed once.
            unsafe { (self.device.api.free)(self.address) };
        }
    }
}

impl Api {
    fn load() -> Result<Self, String> {
        let name = if cfg!(windows) { "nvcuda.dll" } else { "libcuda.so.1" };
        // SAFETY: loading the driver's library runs its own initialisers only.
        let library = unsafe { Library::new(name) };
        let missing = |e: libloading::Error| format!("no driver of an NVIDIA card: {e}");
        library.and_then(Self::from_library).map_err(missing)
    }

    /// Refuses an error.
    fn check(&self, doing: &str, code: c_int) -> Result<(), String> {
        if code == SUCCESS {
            return Ok(());
        }
        let mut text = ptr::null();
        // SAFETY: it writes one pointer, to a C string that is never freed, or null.
        let said = unsafe { (self.error_text)(code, &raw mut text) };
        if said != SUCCESS || text.is_null() {
            return Err(format!("{doing}: error {code}"));
        }
        // SAFETY: as above.
        Err(format!("{doing}: {} (error {code})", unsafe { CStr::from_ptr(text) }.to_string_lossy()))
    }

    /// What a function of the API writes.
    fn got<T>(&self, doing: &str, mut start: T, get: impl FnOnce(*mut T) -> c_int) -> Result<T, String> {
        self.check(doing, get(&raw mut start))?;
        Ok(start)
    }
}

impl Device {
    /// Opens the card of a number and compiles a program in PTX for it.
    pub(super) fn open(number: u32, ptx: &CStr) -> Result<Self, String> {
        let api = Api::load()?;
        // SAFETY: every function gets what `cuda.h` says, and pointers to values of its types.
        unsafe {
            api.check("starting the driver", (api.init)(0))?;
            let version = api.got("asking for the driver's version", 0, |to| (api.driver_version)(to))?;
            let count = api.got("counting cards", 0, |to| (api.device_count)(to))?;
            let number = c_int::try_from(number).unwrap_or(c_int::MAX);
            if number >= count {
                return Err(match count {
                    0 => "the driver finds no card".into(),
                    count => format!("there is no card {number}, since the driver finds {count}, counted from 0"),
                });
            }
            let device = api.got("asking for a card", 0, |to| (api.device_get)(to, number))?;
            let mut name: [c_char; 128] = [0; 128];
            // One less, so that the text ends in any case.
            api.check("asking for a card's name", (api.device_name)(name.as_mut_ptr(), 127, device))?;
            let name = CStr::from_ptr(name.as_ptr()).to_string_lossy().into_owned();
            let bytes = api.got("asking for a card's memory", 0, |to| (api.device_memory)(to, device))?;
            let attribute = |which| api.got("asking about a card", 0, |to| (api.device_attribute)(to, which, device));
            let [major, minor] = [attribute(COMPUTE_MAJOR)?, attribute(COMPUTE_MINOR)?];
            let about = format!(
                "{name}, {:.0} GiB, compute capability {major}.{minor}, driver for CUDA {}.{}",
                bytes as f64 / f64::from(1 << 30),
                version / 1000,
                version % 1000 / 10
            );
            let multiprocessors = attribute(MULTIPROCESSORS)?.max(1) as u32;
            let context = api.got("opening a card", ptr::null_mut(), |to| (api.context_retain)(to, device))?;
            let made = api.check("opening a card", (api.context_set)(context)).and_then(|()| {
                api.got("compiling for a card", ptr::null_mut(), |to| (api.module_load)(to, ptx.as_ptr().cast()))
            });
            match made {
                Ok(module) => Ok(Self { api, device, context, module, name, about, multiprocessors }),
                Err(problem) => {
                    (api.context_release)(device);
                    Err(format!("{about}: {problem}"))
                }
            }
        }
    }

    /// Makes this the card of the calling thread.
    fn enter(&self) -> Result<(), String> {
        // SAFETY: the context is alive.
        self.api.check("turning to a card", unsafe { (self.api.context_set)(self.context) })
    }

    /// A function of the program.
    pub(super) fn function(&self, name: &CStr) -> Result<Function<'_>, String> {
        self.enter()?;
        let find = |to| {
            // SAFETY: the module is loaded and the name a C string.
            unsafe { (self.api.module_function)(to, self.module, name.as_ptr()) }
        };
        Ok(Function { device: self, handle: self.api.got("finding a function", ptr::null_mut(), find)? })
    }

    /// Room for `count` values, whatever lies there.
    pub(super) fn room<T: Copy>(self: &Arc<Self>, count: usize) -> Result<Buffer<T>, String> {
        let bytes = count * size_of::<T>();
        let mut address = 0;
        if bytes > 0 {
            self.enter()?;
            let doing = format!("taking {bytes} bytes of a card's memory");
            // SAFETY: it writes one address.
            address = self.api.got(&doing, 0, |to| unsafe { (self.api.allocate)(to, bytes) })?;
        }
        Ok(Buffer { device: self.clone(), address, count, holds: PhantomData })
    }

    /// Values in the card's memory.
    pub(super) fn hold<T: Copy>(self: &Arc<Self>, values: &[T]) -> Result<Buffer<T>, String> {
        let buffer = self.room(values.len())?;
        buffer.write(values)?;
        Ok(buffer)
    }

    /// Seconds that the card takes for what `work` has it do.
    pub(super) fn timed(&self, work: impl FnOnce() -> Result<(), String>) -> Result<f64, String> {
        let (api, none): (_, Handle) = (&self.api, ptr::null_mut());
        self.enter()?;
        // SAFETY: handles are alive.
        unsafe {
            let event = || api.got("making an event", none, |to| (api.event_create)(to, 0));
            let [before, after] = [event()?, event()?];
            let timed = || {
                api.check("timing", (api.event_record)(before, none))?;
                work()?;
                api.check("timing", (api.event_record)(after, none))?;
                api.check("running a function", (api.event_synchronize)(after))?;
                api.got("timing", 0.0, |to| (api.event_ms)(to, before, after))
            };
            let ms = timed();
            (api.event_destroy)(before);
            (api.event_destroy)(after);
            Ok(f64::from(ms?) * 1e-3)
        }
    }
}

impl<T: Copy> Buffer<T> {
    /// The same room, without saying what lies there.
    pub(super) fn into_bytes(self) -> Buffer<u8> {
        let this = ManuallyDrop::new(self);
        // SAFETY: the other one is never dropped, so that there is one owner as before.
        let device = unsafe { ptr::read(&raw const this.device) };
        Buffer { device, address: this.address, count: this.bytes(), holds: PhantomData }
    }

    pub(super) fn address(&self) -> u64 {
        self.address
    }

    pub(super) fn bytes(&self) -> usize {
        self.count * size_of::<T>()
    }

    /// Other values in the same room, as many as fit.
    pub(super) fn write(&self, values: &[T]) -> Result<(), String> {
        let bytes = size_of_val(values).min(self.bytes());
        if bytes == 0 {
            return Ok(());
        }
        self.device.enter()?;
        // SAFETY: both places are at least so large.
        let code = unsafe { (self.device.api.upload)(self.address, values.as_ptr().cast(), bytes) };
        self.device.api.check("sending to a card", code)
    }

    /// What lies there, which has to be values of the type, instead of what `values` holds.
    pub(super) fn read(&self, values: &mut [T]) -> Result<(), String> {
        let bytes = size_of_val(values).min(self.bytes());
        if bytes == 0 {
            return Ok(());
        }
        self.device.enter()?;
        // SAFETY: both places are at least so large.
        let code = unsafe { (self.device.api.download)(values.as_mut_ptr().cast(), self.address, bytes) };
        self.device.api.check("receiving from a card", code)
    }
}

impl Function<'_> {
    /// Registers and bytes of a thread's own memory.
    pub(super) fn takes(&self) -> Result<[u32; 2], String> {
        let api = &self.device.api;
        let attribute = |which| {
            // SAFETY: the function is the module's.
            api.got("asking about a function", 0, |to| unsafe { (api.function_attribute)(to, which, self.handle) })
        };
        Ok([attribute(REGISTERS)? as u32, attribute(LOCAL_BYTES)? as u32])
    }

    /// Threads that a multiprocessor runs at the same time, in blocks of so many.
    pub(super) fn threads_at_once(&self, block: u32) -> Result<u32, String> {
        let api = &self.device.api;
        let ask = |to| {
            // SAFETY: the function is the module's.
            unsafe { (api.occupancy)(to, self.handle, block as c_int, 0) }
        };
        Ok(api.got("asking about a function", 0, ask)? as u32 * block)
    }

    /// Has it run once for each of as many things as the last number says, after all that the card was told before.
    ///
    /// # Safety
    /// It has to be a function of `trove_trace`'s over these addresses and then these numbers, and what lies at the addresses
    /// what that function wants.
    pub(super) unsafe fn launch(&self, addresses: &[u64], numbers: &[u32], block: u32) -> Result<(), String> {
        let api = &self.device.api;
        let blocks = numbers.last().copied().unwrap_or(0).div_ceil(block);
        if blocks == 0 {
            return Ok(());
        }
        let of_addresses = addresses.iter().map(|address| ptr::from_ref(address).cast_mut().cast());
        let of_numbers = numbers.iter().map(|number| ptr::from_ref(number).cast_mut().cast());
        let mut arguments: Vec<*mut c_void> = of_addresses.chain(of_numbers).collect();
        let (none, nothing): (Handle, _) = (ptr::null_mut(), ptr::null_mut());
        self.device.enter()?;
        // SAFETY: handles are alive, and the arguments are of the types of the function's parameters.
        let code =
            unsafe { (api.launch)(self.handle, blocks, 1, 1, block, 1, 1, 0, none, arguments.as_mut_ptr(), nothing) };
        api.check("starting a function", code)
    }
}
