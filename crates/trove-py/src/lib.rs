//! The Python module `trove._trove`: conversions only.

use std::path::PathBuf;

use pyo3::prelude::*;

/// Functions that `trove`, the Python package, is made of.
#[pymodule]
mod _trove {
    use super::*;

    /// Runs the command line `args` (the program's name first) and returns its exit status; `site_packages` are the
    /// folders to look for Embree and Open Image Denoise in.
    #[pyfunction]
    fn main(py: Python<'_>, args: Vec<String>, site_packages: Vec<PathBuf>) -> i32 {
        py.detach(|| trove::main(args.into_iter().map(Into::into), &site_packages))
    }

    #[pymodule_init]
    fn init(module: &Bound<'_, PyModule>) -> PyResult<()> {
        module.add("__version__", env!("CARGO_PKG_VERSION"))
    }
}
