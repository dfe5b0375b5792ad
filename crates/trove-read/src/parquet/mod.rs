//! Parquet files: columns of numbers and texts, and of lists of them, by name and type.
//!
//! <https://parquet.apache.org/docs/file-format>. The `parquet` crate (60.1) panics on one or two of a thousand files of
//! which a byte was changed, also inside its decoders, and takes 41 s to build; the part of the format that pyarrow writes
//! for flat tables and lists stands here: pages of both versions, plain and by dictionary, packed with Snappy, gzip,
//! Zstandard or not at all.

mod codec;
mod fault;
mod metadata;
mod pages;
mod runs;
mod table;
mod thrift;
mod values;

pub(crate) use table::{Rows, Table};
pub(crate) use values::{Physical, Sink};
