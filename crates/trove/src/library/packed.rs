//! How the values of an asset library are written as bytes: numbers little-endian, lists after their length.

use std::collections::HashMap;
use std::sync::Arc;

use glam::{DVec3, Vec2, Vec3};
use trove_model::{
    Asset, AssetLibrary, Class, Climate, Coarser, ColorSpace, Course, CoverKind, Extra, FacadeDesign, Figure, Filling,
    Fixtures, Foliage, GroundCover, Interior, Kind, LeafType, Mapping, Material, Mesh, Opening, Plant, PlantForm,
    Posture, Season, Slot, Surface, SurfaceKind, Tags, Texture, Tiling,
};

/// Bytes in the making; meshes and textures, which are shared, lie apart and are referred to by number.
#[derive(Default)]
pub(super) struct Packer {
    pub bytes: Vec<u8>,
    pub meshes: Vec<Arc<Mesh>>,
    pub textures: Vec<Arc<Texture>>,
    // Only ever looked up.
    known: HashMap<usize, u32>,
}

/// Bytes that are being read.
pub(super) struct Unpacker<'a> {
    pub bytes: &'a [u8],
    pub meshes: &'a [Arc<Mesh>],
    pub textures: &'a [Arc<Texture>],
}

/// What can be written and read again.
pub(super) trait Packed: Sized {
    /// Least number of bytes that a value takes, so that damaged lengths are noticed before memory is asked for.
    const LEAST: usize = 1;

    fn pack(&self, out: &mut Packer);

    /// `None` where the bytes are no such value.
    fn unpack(from: &mut Unpacker) -> Option<Self>;
}

impl Unpacker<'_> {
    fn take<const N: usize>(&mut self) -> Option<[u8; N]> {
        let (taken, left) = self.bytes.split_first_chunk::<N>()?;
        self.bytes = left;
        Some(*taken)
    }
}

macro_rules! numbers {
    ($($number:ty),*) => {$(
        impl Packed for $number {
            const LEAST: usize = size_of::<$number>();

            fn pack(&self, out: &mut Packer) {
                out.bytes.extend_from_slice(&self.to_le_bytes());
            }

            fn unpack(from: &mut Unpacker) -> Option<Self> {
                from.take().map(Self::from_le_bytes)
            }
        }
    )*};
}
numbers!(u8, u16, u32, u64, f32, f64);

/// Structs as their fields in this order.
macro_rules! fields {
    ($($name:ident { $($field:ident),* $(,)? })*) => {$(
        impl Packed for $name {
            fn pack(&self, out: &mut Packer) {
                $(self.$field.pack(out);)*
            }

            fn unpack(from: &mut Unpacker) -> Option<Self> {
                Some(Self { $($field: Packed::unpack(from)?),* })
            }
        }
    )*};
}

/// Choices as their number.
macro_rules! choices {
    ($($name:ident { $($choice:ident),* $(,)? })*) => {$(
        impl Packed for $name {
            fn pack(&self, out: &mut Packer) {
                enum Number { $($choice),* }
                let number = match self { $(Self::$choice => Number::$choice as u8),* };
                out.bytes.push(number);
            }

            fn unpack(from: &mut Unpacker) -> Option<Self> {
                let all = [$(Self::$choice),*];
                all.get(usize::from(u8::unpack(from)?)).copied()
            }
        }
    )*};
}

fields! {
    AssetLibrary { assets, surfaces, covers }
    Asset { id, kind, class, tags, size_m, mesh, slots, extras, coarser, commonness, figure, plant, licence }
    Plant { species, form, leaves, genera, habitat, seasons }
    Foliage { season, slot, paints, alpha_cutoff }
    Slot { material, paints }
    Extra { group, share, when_driven, mesh }
    Coarser { from_m, mesh }
    Figure { person, posture }
    Surface { id, kind, tags, material, size_m, cells, design }
    GroundCover { id, kind, side_m, mesh, slots }
    Material {
        name, base_color, base_color_map, alpha_cutoff, roughness, metalness, orm_map, normal_map, height_map, height_m,
        ior, coat, flakes, sheen, subsurface, transmission, translucency, emission, dirt, wetness, uv_scale, mapping,
        tiling,
    }
    Mesh { positions, normals, uvs, tints, triangles, slots }
    FacadeDesign {
        wall, wall_tint, bays, stagger, frame, frame_m, bar_m, recess_m, glass, interior, trim, sill_m, lintel_m,
        surround_m, courses, pier_m, cornice_m, shutters, arcade_m, paints, fixtures,
    }
    Opening { filling, low_m, size_m, panes }
    Course { between_m, out_m, color }
    Fixtures {
        balconies, glass_balconies, conditioners, cages, laundry, awnings, signs, blades, oriels, lamps, fire_escapes,
        scaffold,
    }
}

choices! {
    Climate { Tropical, Subtropical, Mediterranean, Arid, Temperate, Cold }
    Season { Spring, Summer, Autumn, Winter }
    PlantForm { Free, Hedge, Bed }
    LeafType { Broad, Needle, Frond }
    ColorSpace { Srgb, Linear }
    Mapping { Uv, Triplanar }
    Tiling { Repeat, Stochastic }
    Filling { Window, Door, GlassDoor, Roller }
    Interior { Home, Office, Shop, Bare }
    CoverKind { GrassNear, GrassMiddle, GrassFar, Weeds, Flowers, Leaves, TreePit }
    SurfaceKind {
        Asphalt, MarkingWhite, MarkingYellow, RoadCover, Paving, Kerb, Concrete, Grass, Soil, Gravel, Water, FlatRoof,
        RoofTiles, Facade, FacadeGroundFloor, Wall, ShopSign, RoomBack, Thing,
    }
}

impl<A: Packed, B: Packed> Packed for (A, B) {
    const LEAST: usize = A::LEAST + B::LEAST;

    fn pack(&self, out: &mut Packer) {
        self.0.pack(out);
        self.1.pack(out);
    }

    fn unpack(from: &mut Unpacker) -> Option<Self> {
        Some((A::unpack(from)?, B::unpack(from)?))
    }
}

impl Packed for bool {
    fn pack(&self, out: &mut Packer) {
        out.bytes.push(u8::from(*self));
    }

    fn unpack(from: &mut Unpacker) -> Option<Self> {
        Some(u8::unpack(from)? == 1)
    }
}

impl Packed for usize {
    fn pack(&self, out: &mut Packer) {
        (*self as u64).pack(out);
    }

    fn unpack(from: &mut Unpacker) -> Option<Self> {
        u64::unpack(from)?.try_into().ok()
    }
}

impl Packed for Kind {
    fn pack(&self, out: &mut Packer) {
        let number = Self::ALL.iter().position(|k| k == self).unwrap_or(Self::ALL.len());
        out.bytes.push(number as u8);
    }

    fn unpack(from: &mut Unpacker) -> Option<Self> {
        Self::ALL.get(usize::from(u8::unpack(from)?)).copied()
    }
}

impl Packed for Class {
    fn pack(&self, out: &mut Packer) {
        out.bytes.push(self.id());
    }

    fn unpack(from: &mut Unpacker) -> Option<Self> {
        Self::from_id(u8::unpack(from)?)
    }
}

impl Packed for Posture {
    fn pack(&self, out: &mut Packer) {
        let (number, phase, stride_m) = match *self {
            Self::Standing => (0u8, 0.0, 0.0),
            Self::Walking { phase, stride_m } => (1, phase, stride_m),
            Self::Running { phase, stride_m } => (2, phase, stride_m),
            Self::Sitting => (3, 0.0, 0.0),
        };
        number.pack(out);
        [phase, stride_m].pack(out);
    }

    fn unpack(from: &mut Unpacker) -> Option<Self> {
        let number = u8::unpack(from)?;
        let [phase, stride_m] = Packed::unpack(from)?;
        Some(match number {
            0 => Self::Standing,
            1 => Self::Walking { phase, stride_m },
            2 => Self::Running { phase, stride_m },
            3 => Self::Sitting,
            _ => return None,
        })
    }
}

impl<T: Packed, const N: usize> Packed for [T; N] {
    const LEAST: usize = N * T::LEAST;

    fn pack(&self, out: &mut Packer) {
        self.iter().for_each(|value| value.pack(out));
    }

    fn unpack(from: &mut Unpacker) -> Option<Self> {
        let mut values = Vec::with_capacity(N);
        for _ in 0..N {
            values.push(T::unpack(from)?);
        }
        values.try_into().ok()
    }
}

macro_rules! vectors {
    ($($name:ident of $count:literal $number:ty),*) => {$(
        impl Packed for $name {
            const LEAST: usize = $count * size_of::<$number>();

            fn pack(&self, out: &mut Packer) {
                self.to_array().pack(out);
            }

            fn unpack(from: &mut Unpacker) -> Option<Self> {
                let numbers: [$number; $count] = Packed::unpack(from)?;
                Some(Self::from_array(numbers))
            }
        }
    )*};
}
vectors!(Vec2 of 2 f32, Vec3 of 3 f32, DVec3 of 3 f64);

impl<T: Packed> Packed for Vec<T> {
    const LEAST: usize = 8;

    fn pack(&self, out: &mut Packer) {
        self.len().pack(out);
        out.bytes.reserve(self.len() * T::LEAST);
        self.iter().for_each(|value| value.pack(out));
    }

    fn unpack(from: &mut Unpacker) -> Option<Self> {
        let length = usize::unpack(from)?;
        if length.checked_mul(T::LEAST)? > from.bytes.len() {
            return None;
        }
        let mut values = Self::with_capacity(length);
        for _ in 0..length {
            values.push(T::unpack(from)?);
        }
        Some(values)
    }
}

impl Packed for String {
    const LEAST: usize = 8;

    fn pack(&self, out: &mut Packer) {
        self.len().pack(out);
        out.bytes.extend_from_slice(self.as_bytes());
    }

    fn unpack(from: &mut Unpacker) -> Option<Self> {
        let length = usize::unpack(from)?;
        let (text, left) = from.bytes.split_at_checked(length)?;
        from.bytes = left;
        Self::from_utf8(text.to_vec()).ok()
    }
}

impl Packed for Tags {
    const LEAST: usize = 8;

    fn pack(&self, out: &mut Packer) {
        self.iter().map(str::to_owned).collect::<Vec<String>>().pack(out);
    }

    fn unpack(from: &mut Unpacker) -> Option<Self> {
        Vec::<String>::unpack(from).map(Self::new)
    }
}

impl<T: Packed> Packed for Option<T> {
    fn pack(&self, out: &mut Packer) {
        self.is_some().pack(out);
        self.iter().for_each(|value| value.pack(out));
    }

    fn unpack(from: &mut Unpacker) -> Option<Self> {
        Some(if bool::unpack(from)? { Some(T::unpack(from)?) } else { None })
    }
}

impl Packed for Arc<FacadeDesign> {
    fn pack(&self, out: &mut Packer) {
        FacadeDesign::pack(self, out);
    }

    fn unpack(from: &mut Unpacker) -> Option<Self> {
        FacadeDesign::unpack(from).map(Self::new)
    }
}

/// What is shared is written once and stays shared.
macro_rules! shared {
    ($($name:ident in $list:ident),*) => {$(
        impl Packed for Arc<$name> {
            const LEAST: usize = 4;

            fn pack(&self, out: &mut Packer) {
                let list = &mut out.$list;
                let number = *out.known.entry(Arc::as_ptr(self).addr()).or_insert_with(|| {
                    list.push(self.clone());
                    list.len() as u32 - 1
                });
                number.pack(out);
            }

            fn unpack(from: &mut Unpacker) -> Option<Self> {
                from.$list.get(u32::unpack(from)? as usize).cloned()
            }
        }
    )*};
}
shared!(Mesh in meshes, Texture in textures);

/// Channels lie apart, each as its difference to the one before: greys and full alpha, of which there is much, then
/// are zeros.
impl Packed for Texture {
    fn pack(&self, out: &mut Packer) {
        self.name.pack(out);
        self.color_space.pack(out);
        [self.width, self.height].pack(out);
        out.bytes.extend(self.rgba.iter().map(|t| t[0]));
        for channel in 1..3 {
            out.bytes.extend(self.rgba.iter().map(|t| t[channel].wrapping_sub(t[channel - 1])));
        }
        out.bytes.extend(self.rgba.iter().map(|t| 255 - t[3]));
    }

    fn unpack(from: &mut Unpacker) -> Option<Self> {
        let (name, color_space) = (Packed::unpack(from)?, Packed::unpack(from)?);
        let [width, height]: [u32; 2] = Packed::unpack(from)?;
        let texels = usize::try_from(u64::from(width) * u64::from(height)).ok()?;
        let (channels, left) = from.bytes.split_at_checked(texels.checked_mul(4)?)?;
        from.bytes = left;
        let (r, rest) = channels.split_at(texels);
        let (g, rest) = rest.split_at(texels);
        let (b, a) = rest.split_at(texels);
        let texel = |(((r, g), b), a): (((&u8, &u8), &u8), &u8)| {
            let g = r.wrapping_add(*g);
            [*r, g, g.wrapping_add(*b), 255 - a]
        };
        let rgba = r.iter().zip(g).zip(b).zip(a).map(texel).collect();
        Some(Self { name, width, height, rgba, color_space })
    }
}
