//! Which of the library's surfaces a place is made of.

use glam::Vec3;
use trove_model::{AssetLibrary, Material, Outcome, Random, Report, Surface, SurfaceKind, Tags};

/// No tag is asked for.
pub(crate) const ANY: &[&str] = &[];

/// The library's surfaces, with plain colours where it lacks a kind.
pub(crate) struct Palette<'a> {
    pub library: &'a AssetLibrary,
    pub report: &'a Report,
}

impl Palette<'_> {
    /// One of a kind's surfaces with one of the tags; one of all of the kind where none has one.
    pub(crate) fn fitting(&self, kind: SurfaceKind, tags: &[impl AsRef<str>], random: &mut Random) -> Surface {
        let (fits, others): (Vec<&Surface>, Vec<&Surface>) =
            self.library.surfaces_of(kind).partition(|s| s.tags.has_any(tags));
        match random.pick(if fits.is_empty() { &others } else { &fits }) {
            Some(surface) => (*surface).clone(),
            None => {
                let what = "surface whose kind the asset library lacks, replaced by a plain colour";
                self.report.note(Outcome::Substituted, what, format_args!("{kind:?}"));
                plain(kind)
            }
        }
    }
}

/// A plain colour in place of a texture; facades get bays of 3.5 m and storeys of 3.2 m.
fn plain(kind: SurfaceKind) -> Surface {
    let (name, rgb) = match kind {
        SurfaceKind::Asphalt => ("plain asphalt", [0.08, 0.08, 0.08]),
        SurfaceKind::MarkingWhite => ("plain white marking", [0.7, 0.7, 0.7]),
        SurfaceKind::MarkingYellow => ("plain yellow marking", [0.65, 0.4, 0.05]),
        SurfaceKind::RoadCover => ("plain road cover", [0.1, 0.1, 0.1]),
        SurfaceKind::Paving => ("plain paving", [0.35, 0.34, 0.32]),
        SurfaceKind::Kerb => ("plain kerb", [0.42, 0.41, 0.39]),
        SurfaceKind::Concrete => ("plain concrete", [0.38, 0.37, 0.35]),
        SurfaceKind::Grass => ("plain grass", [0.06, 0.11, 0.03]),
        SurfaceKind::Soil => ("plain soil", [0.14, 0.1, 0.06]),
        SurfaceKind::Gravel => ("plain gravel", [0.3, 0.28, 0.25]),
        SurfaceKind::Water => ("plain water", [0.02, 0.04, 0.05]),
        SurfaceKind::FlatRoof => ("plain flat roof", [0.25, 0.25, 0.25]),
        SurfaceKind::RoofTiles => ("plain roof tiles", [0.3, 0.12, 0.08]),
        SurfaceKind::Facade => ("plain facade", [0.45, 0.4, 0.35]),
        SurfaceKind::FacadeGroundFloor => ("plain ground floor", [0.3, 0.28, 0.26]),
        SurfaceKind::Wall => ("plain wall", [0.4, 0.38, 0.35]),
        SurfaceKind::ShopSign => ("plain sign", [0.3, 0.05, 0.05]),
        SurfaceKind::RoomBack => ("plain room", [0.3, 0.28, 0.25]),
        SurfaceKind::Thing => ("plain thing", [0.3, 0.3, 0.3]),
    };
    let roughness = if kind == SurfaceKind::Water { 0.1 } else { 0.85 };
    let size_m = match kind {
        SurfaceKind::Facade => [3.5, 3.2],
        SurfaceKind::FacadeGroundFloor => [5.0, 4.0],
        _ => [1.0, 1.0],
    };
    Surface {
        id: name.replace(' ', "-"),
        kind,
        tags: Tags::default(),
        material: Material::plain(name, Vec3::from_array(rgb), roughness),
        size_m,
        cells: [1, 1],
        design: None,
    }
}

/// A texture's colour moved to a tagged one: its hue wins, half of the texture's own lightness stays.
pub(crate) fn tinted(base: Vec3, color: Vec3) -> Vec3 {
    let hue = color / color.max_element().max(0.05);
    (base * hue * (0.5 + color.max_element())).clamp(Vec3::splat(0.05), Vec3::splat(1.5))
}
