use std::collections::BTreeMap;

use glam::Vec3;
use trove_model::Texture;

use super::*;

/// The built-in facades, none of which takes anything from another.
fn facades_of_the_library() -> Vec<FacadePlan> {
    #[derive(serde::Deserialize)]
    struct Facades {
        facade: Vec<FacadePlan>,
    }
    toml::from_str::<Facades>(include_str!("../../plans/facades.toml")).unwrap().facade
}

/// Mean difference of two columns (or rows, by `transposed`) of a picture.
fn difference(texture: &Texture, a: u32, b: u32, transposed: bool) -> f64 {
    let along = if transposed { texture.width } else { texture.height };
    let at = |i: u32, k: u32| {
        let (x, y) = if transposed { (k, i) } else { (i, k) };
        texture.rgba[(y * texture.width + x) as usize]
    };
    let apart = |k: u32| (0..4).map(|c| f64::from(at(a, k)[c].abs_diff(at(b, k)[c]))).sum::<f64>();
    (0..along).map(apart).sum::<f64>() / f64::from(along)
}

fn mean_albedo(surface: &Surface) -> Vec3 {
    let texture = surface.material.base_color_map.as_ref().unwrap();
    let linear = |c: u8| (f32::from(c) / 255.0).powf(2.2);
    let there: Vec<_> = texture.rgba.iter().filter(|t| t[3] > 127).collect();
    there.iter().map(|t| vec3(linear(t[0]), linear(t[1]), linear(t[2]))).sum::<Vec3>() / there.len() as f32
}

#[test]
fn every_surface_is_there_tiles_and_is_as_bright_as_the_real_thing() {
    let surfaces = surfaces(&facades_of_the_library(), 1);
    let mut count: BTreeMap<SurfaceKind, usize> = BTreeMap::new();
    let mut wrong = Vec::new();
    for surface in &surfaces {
        *count.entry(surface.kind).or_default() += 1;
        let range = match surface.kind {
            SurfaceKind::Asphalt => 0.04..0.18,
            SurfaceKind::Thing => 0.015..0.97,
            SurfaceKind::MarkingWhite => 0.45..0.75,
            SurfaceKind::MarkingYellow => 0.15..0.45,
            SurfaceKind::Paving | SurfaceKind::Kerb | SurfaceKind::Concrete => 0.12..0.4,
            SurfaceKind::RoadCover => 0.04..0.16,
            SurfaceKind::FlatRoof => 0.05..0.5,
            SurfaceKind::RoofTiles => 0.05..0.4,
            SurfaceKind::Grass => 0.04..0.14,
            SurfaceKind::Water => 0.01..0.03,
            SurfaceKind::FacadeGroundFloor | SurfaceKind::Facade => 0.04..0.5,
            SurfaceKind::Wall | SurfaceKind::RoomBack => 0.1..0.45,
            _ => 0.05..0.3,
        };
        let albedo = mean_albedo(surface);
        if !range.contains(&albedo.y) {
            wrong.push(format!("{}: {albedo}", surface.id));
        }
        if surface.kind == SurfaceKind::Grass {
            // Worn grass is as red as green.
            assert!(albedo.y > 0.85 * albedo.x && albedo.x > albedo.z, "{}: {albedo}", surface.id);
        }
        // Heights are the normals' relief, too coarse for its joints.
        for texture in surface.material.textures().filter(|t| !t.name.ends_with(".height")) {
            for transposed in [false, true] {
                let n = if transposed { texture.height } else { texture.width };
                let inside = (1..n).map(|i| difference(texture, i - 1, i, transposed)).fold(0.0, f64::max);
                let around = difference(texture, n - 1, 0, transposed);
                if around > inside * 1.2 + 0.5 {
                    wrong.push(format!("{} has a seam: {around} for {inside}", texture.name));
                }
            }
        }
        let scale = surface.material.uv_scale;
        assert!((scale * glam::Vec2::from_array(surface.size_m) - 1.0).length() < 1e-5);
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
    let least = |kind| match kind {
        SurfaceKind::Facade => 10,
        SurfaceKind::FacadeGroundFloor => 7,
        SurfaceKind::Asphalt => 2,
        SurfaceKind::Thing => 35,
        SurfaceKind::Paving | SurfaceKind::RoadCover => 3,
        SurfaceKind::Grass | SurfaceKind::Kerb | SurfaceKind::FlatRoof | SurfaceKind::RoofTiles => 2,
        _ => 1,
    };
    assert_eq!(count.len(), 19);
    assert!(count.iter().all(|(&kind, &n)| n >= least(kind)), "{count:?}");
    let bytes: usize = surfaces.iter().flat_map(|s| s.material.textures()).map(|t| t.rgba.len() * 4).sum();
    assert!(bytes < 256 << 20, "{} MB of textures", bytes >> 20);
}

#[test]
fn a_surface_is_the_same_every_time() {
    let recipe =
        plain("grass/lawn", SurfaceKind::Grass, &[], |d| ground::grass(vec3(0.1, 0.1, 0.0), Vec3::ONE, 0.2, 1, d));
    assert_eq!(surface(&recipe, 1).material, surface(&recipe, 1).material);
}

#[test]
fn the_documentation_lists_the_tags_of_surfaces() {
    use SurfaceKind::*;
    let recipes: Vec<super::Recipe> = super::ground_recipes().into_iter().chain(super::building_recipes()).collect();
    let asked = [Asphalt, RoadCover, Paving, Kerb, Concrete, FlatRoof, RoofTiles, Facade, FacadeGroundFloor, Wall];
    let facades = super::facades(&crate::Plans::built_in().facades);
    let row = |kind: SurfaceKind| {
        let painted = recipes.iter().filter(|r| r.1 == kind).flat_map(|r| r.2.iter().copied());
        let planned = facades.iter().filter(|s| s.kind == kind).flat_map(|s| s.tags.iter());
        crate::tests::tag_row(&format!("{kind:?}"), "", painted.chain(planned))
    };
    crate::tests::assert_documented(&asked.map(row));
}
