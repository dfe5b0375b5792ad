//! Removes the noise that few samples leave, where a denoiser is installed.

mod api;
mod blend;

use std::ffi::{CStr, c_int};
use std::path::PathBuf;
use std::ptr;
use std::sync::{Mutex, PoisonError};

use trove_model::Raster;

use crate::RenderError;
use api::{Api, Handle};
pub(crate) use blend::blended;

/// Samples a pixel from which on albedo and normals are so clean that the filter may trust them to the pixel. Below, the
/// filter that expects noise in them is as good, and takes two fifths of the time.
const CLEAN_SPP: f64 = 16.0;

/// Whether noise is removed, and how.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Denoising {
    /// It stays.
    #[default]
    None,
    /// In a third to two thirds of the best's time and coarser: for many small pictures.
    Fast,
    /// As well as it goes.
    Best,
}

/// Open Image Denoise on the processor.
pub(crate) struct Denoiser {
    /// The library runs one filter a device at a time; a lock says so here.
    device: Mutex<Device>,
    name: String,
}

struct Device {
    api: Api,
    handle: Handle,
    how: Denoising,
    /// For noisy guides and for clean ones; made when first used and kept, with their memory, for all pictures of a size.
    filters: [Option<Handle>; 2],
}

// SAFETY: a device belongs to no thread, by the library's documentation; it is only used under the lock.
unsafe impl Send for Device {}

impl Drop for Device {
    fn drop(&mut self) {
        // SAFETY: filters and device were made by the library and are released once.
        unsafe {
            self.filters.into_iter().flatten().for_each(|filter| (self.api.release_filter)(filter));
            (self.api.release_device)(self.handle);
        }
    }
}

impl Denoiser {
    /// Loads the library; `search` are folders or files in which to look for it.
    pub(crate) fn load(search: &[PathBuf], threads: usize, how: Denoising) -> Result<Self, RenderError> {
        let refuse = |problem: String| RenderError::Library {
            library: "Open Image Denoise 2",
            problem,
            looked: search.to_vec(),
        };
        let api = Api::load(search).map_err(refuse)?;
        // SAFETY: the function takes a kind of device.
        let handle = unsafe { (api.new_device)(api::DEVICE_CPU) };
        if handle.is_null() {
            let problem = api.error(ptr::null_mut()).err();
            return Err(refuse(problem.unwrap_or_else(|| "it has no device for this processor".into())));
        }
        let device = Device { api, handle, how, filters: [None; 2] };
        let threads = c_int::try_from(threads).unwrap_or(c_int::MAX);
        // SAFETY: the device is alive, and the names are those of its parameters. Threads stay where the system puts
        // them, because others render beside this one.
        let number = unsafe {
            (device.api.set_device_int)(handle, c"numThreads".as_ptr(), threads);
            (device.api.set_device_bool)(handle, c"setAffinity".as_ptr(), false);
            (device.api.commit_device)(handle);
            (device.api.get_device_int)(handle, c"version".as_ptr())
        };
        device.api.error(handle).map_err(refuse)?;
        // The version is one number: 20501 is 2.5.1.
        let [major, minor, patch] = [number / 10_000, number / 100 % 100, number % 100];
        if major != 2 {
            return Err(refuse(format!("expected version 2, found {major}.{minor}.{patch}")));
        }
        Ok(Self { device: Mutex::new(device), name: format!("Open Image Denoise {major}.{minor}.{patch}") })
    }

    /// Name and version, for people.
    pub(crate) fn name(&self) -> String {
        self.name.clone()
    }

    /// The picture, of `spp` samples a pixel, without noise; `albedo` and `normal` (World, unit or 0) are guides of the same
    /// size. `None` where the library gives up, as without memory.
    pub(crate) fn denoise(
        &self,
        color: &Raster<[f32; 3]>,
        albedo: &Raster<[f32; 3]>,
        normal: &Raster<[f32; 3]>,
        spp: f64,
    ) -> Option<Raster<[f32; 3]>> {
        let mut device = self.device.lock().unwrap_or_else(PoisonError::into_inner);
        let is_clean = device.how == Denoising::Best && spp >= CLEAN_SPP;
        match device.run(is_clean, [(c"color", color), (c"albedo", albedo), (c"normal", normal)]) {
            Ok(picture) => Some(picture),
            Err(problem) => {
                tracing::warn!(problem, "the denoiser failed; the image stays noisy");
                None
            }
        }
    }
}

impl Device {
    /// A filter over one picture, the first, with guides that are clean or not.
    fn run(&mut self, is_clean: bool, images: [(&CStr, &Raster<[f32; 3]>); 3]) -> Result<Raster<[f32; 3]>, String> {
        let (width, height) = (images[0].1.width, images[0].1.height);
        if images.iter().any(|(_, image)| (image.width, image.height) != (width, height)) {
            return Err("images of different sizes".into());
        }
        let mut output = Raster::filled(width, height, [0.0f32; 3]);
        if output.data.is_empty() {
            return Ok(output);
        }
        let filter = self.filter(is_clean)?;
        let api = &self.api;
        // SAFETY: device and filter are alive; every image has width × height
        // pixels of three floats, packed, and outlives the filter, which only writes to `output`.
        unsafe {
            let set = |name: &CStr, data: *mut [f32; 3]| {
                let (width, height) = (width as usize, height as usize);
                let format = api::FORMAT_FLOAT3;
                (api.set_shared_image)(filter, name.as_ptr(), data.cast(), format, width, height, 0, 0, 0);
            };
            for (name, image) in images {
                set(name, image.data.as_ptr().cast_mut());
            }
            set(c"output", output.data.as_mut_ptr());
            (api.commit_filter)(filter);
            (api.execute_filter)(filter);
        }
        self.api.error(self.handle).map(|()| output)
    }

    fn filter(&mut self, is_clean: bool) -> Result<Handle, String> {
        if let Some(filter) = self.filters[usize::from(is_clean)] {
            return Ok(filter);
        }
        let api = &self.api;
        // SAFETY: the device is alive; names are those of the filter `RT`.
        let filter = unsafe { (api.new_filter)(self.handle, c"RT".as_ptr()) };
        if filter.is_null() {
            return Err(api.error(self.handle).err().unwrap_or_else(|| "no filter `RT`".into()));
        }
        let quality = if self.how == Denoising::Best { api::QUALITY_HIGH } else { api::QUALITY_FAST };
        // SAFETY: as above.
        unsafe {
            (api.set_filter_int)(filter, c"quality".as_ptr(), quality);
            (api.set_filter_bool)(filter, c"hdr".as_ptr(), true);
            (api.set_filter_bool)(filter, c"cleanAux".as_ptr(), is_clean);
        }
        self.filters[usize::from(is_clean)] = Some(filter);
        Ok(filter)
    }
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use trove_model::Seed;

    use super::*;

    /// The denoiser in `TROVE_OIDN`, which `make test` sets.
    fn installed(threads: usize, how: Denoising) -> Denoiser {
        let place = PathBuf::from(std::env::var_os("TROVE_OIDN").expect("TROVE_OIDN"));
        Denoiser::load(&[place], threads, how).unwrap()
    }

    #[test]
    fn a_missing_library_is_a_reason_and_not_a_crash() {
        let nowhere = [PathBuf::from("/nowhere")];
        let Err(problem) = Denoiser::load(&nowhere, 1, Denoising::Best) else { return };
        assert!(problem.to_string().contains("/nowhere"), "{problem}");
    }

    #[test]
    fn a_file_that_is_no_library_is_named_in_the_reason() {
        let files = [PathBuf::from(file!()), PathBuf::from("Cargo.toml")];
        let Err(problem) = Denoiser::load(&files, 1, Denoising::Best) else { return };
        assert!(problem.to_string().contains("Cargo.toml"), "{problem}");
    }

    #[test]
    fn only_the_library_itself_is_a_candidate() {
        for (name, is) in [
            ("libOpenImageDenoise.so.2.5.1", true),
            ("libOpenImageDenoise.2.dylib", true),
            ("OpenImageDenoise.dll", true),
            ("libOpenImageDenoise_core.so.2.5.1", false),
            ("libtbb.so.12", false),
        ] {
            assert_eq!(api::is_library(Path::new(name)), is, "{name}");
        }
    }

    #[test]
    #[ignore = "needs TROVE_OIDN"]
    fn noise_goes_edges_stay_and_threads_do_not_matter() {
        let mut random = Seed(5).random();
        let side = |x: u32| if x < 100 { 0.2 } else { 0.8 };
        let guide = Raster::from_fn(200, 120, |x, _| [side(x) as f32; 3]);
        let normal = Raster::filled(200, 120, [0.0, 0.0, 1.0f32]);
        let noisy = Raster::from_fn(200, 120, |x, _| [(side(x) * (1.0 + 0.5 * random.normal())).max(0.0) as f32; 3]);
        let error = |image: &Raster<[f32; 3]>| {
            let squares = (0..120).flat_map(|y| (0..200).map(move |x| (x, y)));
            squares.map(|(x, y)| (f64::from(image.at(x, y)[0]) - side(x)).powi(2)).sum::<f64>()
        };
        for (how, spp) in [(Denoising::Fast, 2.0), (Denoising::Best, 4.0), (Denoising::Best, 64.0)] {
            let (one, two) = (installed(1, how), installed(2, how));
            let clean = one.denoise(&noisy, &guide, &normal, spp).unwrap();
            assert!(error(&clean) < 0.02 * error(&noisy), "{how:?}, {spp}: {} of {}", error(&clean), error(&noisy));
            // Another filter of the same device in between changes nothing.
            one.denoise(&noisy, &guide, &normal, 68.0 - spp).unwrap();
            assert_eq!(clean, one.denoise(&noisy, &guide, &normal, spp).unwrap());
            assert_eq!(clean, two.denoise(&noisy, &guide, &normal, spp).unwrap());
        }
    }

    #[test]
    #[ignore = "needs TROVE_OIDN"]
    fn guides_of_another_size_are_refused() {
        let denoiser = installed(1, Denoising::Fast);
        let (small, large) = (Raster::filled(8, 8, [0.5; 3]), Raster::filled(9, 8, [0.5; 3]));
        assert!(denoiser.denoise(&small, &large, &small, 2.0).is_none());
        assert!(denoiser.denoise(&small, &small, &small, 2.0).is_some());
    }
}
