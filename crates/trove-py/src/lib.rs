//! The Python module `trove._trove`: conversions only.

use std::ffi::OsString;
use std::path::PathBuf;

use pyo3::prelude::*;

/// Functions that `trove`, the Python package, is made of.
#[pymodule]
mod _trove {
    use super::*;

    /// Runs the command line `args` (the program's name first) and returns its exit status; `site_packages` are the
    /// folders to look for Embree and Open Image Denoise in.
    #[pyfunction]
    fn main(py: Python<'_>, args: Vec<OsString>, site_packages: Vec<PathBuf>) -> i32 {
        py.detach(|| trove::main(args, &site_packages))
    }

    /// The table of a label set (`trove20`, `trove13`, `cityscapes`, `camvid`): a line a class, fields apart by tabs, the
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
