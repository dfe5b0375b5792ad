//! Class maps: the classes of a dataset's label pictures, and where our 20 belong among them.
//!
//! Those that come with the program are tables beside [`Class`](crate::Class); a user's is a file (docs/judge.md). Both
//! become a [`ClassMap`] by [`ClassMap::new`].

mod built_in;
mod map;
#[cfg(test)]
mod tests;

pub use map::{ClassMap, ClassMapEntry, ClassMapFault, InstanceCoding, MappedClass};
