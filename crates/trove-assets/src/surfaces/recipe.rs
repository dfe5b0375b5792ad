//! How a surface is made from an id, a kind, tags and a painter.

use trove_model::{Material, Surface, SurfaceKind, Tags, Tiling};

use super::canvas::Canvas;
use super::road::Wear;

/// How a surface is painted.
pub(super) enum Paint {
    /// At a multiple of the ordinary resolution.
    Plain(Box<dyn Fn(u32) -> Canvas + Send + Sync>),
    /// Whole cells, so many across and up.
    Cells([u32; 2], fn(u32) -> Canvas, u32),
}

/// An id, a kind, tags, and how it is painted.
pub(super) type Recipe = (&'static str, SurfaceKind, &'static [&'static str], Paint);

pub(super) fn plain(
    id: &'static str,
    kind: SurfaceKind,
    tags: &'static [&'static str],
    paint: impl Fn(u32) -> Canvas + Send + Sync + 'static,
) -> Recipe {
    (id, kind, tags, Paint::Plain(Box::new(paint)))
}

pub(super) fn surface((id, kind, tags, paint): &Recipe, detail: u32) -> Surface {
    let (canvas, cells) = match paint {
        Paint::Plain(paint) => (paint(detail), [1, 1]),
        Paint::Cells(cells, paint, seed) => (paint(*seed), *cells),
    };
    let mut material = canvas.material(id, 2);
    // What has no joints, windows or patches that would be cut.
    if [
        "asphalt/new",
        "asphalt/worn",
        "paving/asphalt-walk",
        "paving/mosaic",
        "concrete/",
        "grass/",
        "soil/",
        "gravel/",
        "flat-roof/gravel",
    ]
    .iter()
    .any(|name| id.starts_with(name))
    {
        material.tiling = Tiling::Stochastic;
    }
    if matches!(kind, SurfaceKind::MarkingWhite | SurfaceKind::MarkingYellow) {
        material.alpha_cutoff = 0.5;
        // Glass beads: at a grazing angle a hundredth of what sheeting gives back (150 of 15,000 mcd·lx⁻¹·m⁻²).
        material.retroreflection = 0.01;
    }
    if *kind == SurfaceKind::Water {
        material.ior = 1.33;
    }
    match *id {
        "asphalt/wet" => material.wetness = 0.7,
        "glass/pane" => material.transmission = 0.92,
        "sheeting/reflective" => material.retroreflection = 0.5,
        "paint/lacquer" => material.coat = 1.0,
        _ => {}
    }
    Surface { tags: Tags::new(*tags), ..finished(id, *kind, &canvas, material, cells) }
}

pub(super) fn finished(id: &str, kind: SurfaceKind, canvas: &Canvas, material: Material, cells: [u32; 2]) -> Surface {
    let material = Material { dirt: dirt(kind), ..material };
    Surface {
        id: id.into(),
        kind,
        tags: Tags::default(),
        material,
        size_m: canvas.size_m.to_array(),
        cells,
        design: None,
    }
}

/// How much of what weather and wheels bring stays on a surface.
pub(super) fn dirt(kind: SurfaceKind) -> f32 {
    match kind {
        SurfaceKind::Asphalt | SurfaceKind::MarkingWhite | SurfaceKind::MarkingYellow | SurfaceKind::RoadCover => 0.7,
        SurfaceKind::Paving | SurfaceKind::Kerb | SurfaceKind::Concrete | SurfaceKind::FlatRoof => 0.6,
        SurfaceKind::Facade | SurfaceKind::FacadeGroundFloor => 0.5,
        SurfaceKind::Grass | SurfaceKind::Soil | SurfaceKind::Gravel | SurfaceKind::RoofTiles => 0.4,
        SurfaceKind::Wall | SurfaceKind::ShopSign | SurfaceKind::Thing => 0.3,
        SurfaceKind::Water | SurfaceKind::RoomBack => 0.0,
    }
}

// Asphalt reflects 4 % when it is new, 12 % on average after five years, and hardly ever more than 16 % (Pomerantz,
// Akbari et al. 2000).
pub(super) const WORN: Wear =
    Wear { binder: 0.105, stone: 0.17, stone_m: 0.014, worn: 0.6, cracks: 0.2, size_m: 6.0, seed: 2 };
pub(super) const NEW: Wear = Wear { binder: 0.055, stone: 0.11, worn: 0.2, cracks: 0.0, seed: 1, ..WORN };
