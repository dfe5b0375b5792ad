//! The pipeline (recipe, run, resume, manifest) and the command line: the only crate that knows more than one stage.
