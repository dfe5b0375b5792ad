//! Removes the noise that few samples leave, where a denoiser is installed.

use std::path::PathBuf;

use trove_model::Raster;

use crate::RenderError;

/// A denoiser.
pub(crate) struct Denoiser;

impl Denoiser {
    /// Loads the library; `search` are folders or files in which to look for it.
    pub(crate) fn load(search: &[PathBuf], _threads: usize) -> Result<Self, RenderError> {
        Err(RenderError::Library { library: "Open Image Denoise", problem: "not found".into(), looked: search.to_vec() })
    }

    /// Name and version, for people.
    pub(crate) fn name(&self) -> String {
        String::new()
    }

    /// The picture without noise; `albedo` and `normal` (World, unit or 0) are guides of the same size.
    pub(crate) fn denoise(
        &self,
        color: &Raster<[f32; 3]>,
        _albedo: &Raster<[f32; 3]>,
        _normal: &Raster<[f32; 3]>,
    ) -> Option<Raster<[f32; 3]>> {
        Some(color.clone())
    }
}
