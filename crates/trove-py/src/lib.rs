//! The Python module `trove._trove`: conversions only.

mod arrays;
mod attended;
mod error;
mod frames;
mod scene;

use std::ffi::OsString;
use std::path::PathBuf;

use pyo3::prelude::*;

/// Functions that `trove`, the Python package, is made of.
#[pymodule]
mod _trove {
    use super::*;

    #[pymodule_export]
    use super::arrays::{encode_png, label_colors};
    #[pymodule_export]
    use super::error::TroveError;
    #[pymodule_export]
    use super::frames::{PyStoredFrame, image_names, painted};
    #[pymodule_export]
    use super::scene::PyReadyScene;

    /// Runs the command line `args` (the program's name first) and returns its exit status; `site_packages` are the
    /// folders to look for Embree and Open Image Denoise in.
    #[pyfunction]
    fn main(py: Python<'_>, args: Vec<OsString>, site_packages: Vec<PathBuf>) -> i32 {
        py.detach(|| trove::main(args, &site_packages))
    }

    /// Runs the command line `args` and returns what it prints with `--json`; `null` of a command that prints by itself.
    /// `progress(done, total, doing)` is called on this thread.
    #[pyfunction]
    fn call(
        py: Python<'_>,
        args: Vec<OsString>,
        site_packages: Vec<PathBuf>,
        progress: Option<Py<PyAny>>,
    ) -> PyResult<String> {
        let run = move |watch: &_| trove::call(args, &site_packages, watch);
        attended::attended(py, progress.as_ref(), run)?.map_err(error::trove_error)
    }

    /// The table of a label set (`trove20`, `trove13`, `cityscapes`, `coco`, …): a line a class, fields apart by tabs, the
    /// first line names the columns; `None` for another name.
    #[pyfunction]
    fn label_table(label_set: &str) -> Option<&'static str> {
        trove::label_table(label_set)
    }

    #[pymodule_init]
    fn init(module: &Bound<'_, PyModule>) -> PyResult<()> {
        module.add("__version__", env!("CARGO_PKG_VERSION"))
    }
}
