//! Lists of numbers, written and read as bytes: a library has hundreds of millions, and one by one they take longer than
//! all else that is read.

use std::fmt;
use std::marker::PhantomData;

use glam::{Vec2, Vec3};
use serde::de::{Error, Visitor};
use serde::{Deserializer, Serializer};

/// What takes `N` bytes, each of its numbers the lowest byte first.
pub(crate) trait Flat<const N: usize>: Copy {
    fn to_bytes(self) -> [u8; N];
    fn from_bytes(bytes: [u8; N]) -> Self;
}

impl Flat<4> for [u8; 4] {
    fn to_bytes(self) -> [u8; 4] {
        self
    }

    fn from_bytes(bytes: [u8; 4]) -> Self {
        bytes
    }
}

impl Flat<2> for u16 {
    fn to_bytes(self) -> [u8; 2] {
        self.to_le_bytes()
    }

    fn from_bytes(bytes: [u8; 2]) -> Self {
        Self::from_le_bytes(bytes)
    }
}

impl Flat<12> for [u32; 3] {
    fn to_bytes(self) -> [u8; 12] {
        let mut bytes = [0; 12];
        bytes.as_chunks_mut().0.copy_from_slice(&self.map(u32::to_le_bytes));
        bytes
    }

    fn from_bytes(bytes: [u8; 12]) -> Self {
        let (numbers, _) = bytes.as_chunks();
        [numbers[0], numbers[1], numbers[2]].map(u32::from_le_bytes)
    }
}

impl Flat<12> for Vec3 {
    fn to_bytes(self) -> [u8; 12] {
        self.to_array().map(f32::to_bits).to_bytes()
    }

    fn from_bytes(bytes: [u8; 12]) -> Self {
        <[u32; 3]>::from_bytes(bytes).map(f32::from_bits).into()
    }
}

impl Flat<8> for Vec2 {
    fn to_bytes(self) -> [u8; 8] {
        let [x, y] = self.to_array().map(f32::to_bits);
        (u64::from(y) << 32 | u64::from(x)).to_le_bytes()
    }

    fn from_bytes(bytes: [u8; 8]) -> Self {
        let both = u64::from_le_bytes(bytes);
        Self::new(f32::from_bits(both as u32), f32::from_bits((both >> 32) as u32))
    }
}

pub(crate) fn serialize<S: Serializer, T: Flat<N>, const N: usize>(list: &[T], to: S) -> Result<S::Ok, S::Error> {
    let bytes: Vec<[u8; N]> = list.iter().map(|value| value.to_bytes()).collect();
    to.serialize_bytes(bytes.as_flattened())
}

pub(crate) fn deserialize<'de, D: Deserializer<'de>, T: Flat<N>, const N: usize>(from: D) -> Result<Vec<T>, D::Error> {
    from.deserialize_bytes(Bytes(PhantomData))
}

struct Bytes<T, const N: usize>(PhantomData<T>);

impl<T: Flat<N>, const N: usize> Visitor<'_> for Bytes<T, N> {
    type Value = Vec<T>;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "a multiple of {N} bytes")
    }

    fn visit_bytes<E: Error>(self, bytes: &[u8]) -> Result<Vec<T>, E> {
        match bytes.as_chunks() {
            (values, []) => Ok(values.iter().map(|value| T::from_bytes(*value)).collect()),
            _ => Err(E::invalid_length(bytes.len(), &self)),
        }
    }
}
