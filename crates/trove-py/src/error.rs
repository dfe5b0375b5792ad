//! What went wrong, as Python raises it.

use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

pyo3::create_exception!(trove, TroveError, PyValueError, "What went wrong, in the words of the command line.");

/// An error of ours as Python raises it.
pub(crate) fn trove_error(error: impl ToString) -> PyErr {
    TroveError::new_err(error.to_string())
}
