//! What holds of every place's surfaces, on a made-up street with a map around it.

use std::collections::BTreeSet;

use glam::DVec2;
use trove_model::{
    AssetLibrary, Bounds, Building, Class, DrivingSide, HeightField, Land, LandKind, LaneMap, Material, Polygon,
    Raster, Report, RoadKind, Role, Seed, StreetMap, Surface, SurfaceKind, Tags,
};

use super::decks::Lift;
use super::layout::layout;
use super::{Footing, RoadSurfaces, land};
use crate::geometry::plane;
use crate::ground::{Drape, Spans};
use crate::pieces::Piece;
use crate::place::Place;
use crate::testing::{drive, place};

/// Side streets across the recorded street, which runs along x from y = −4 to 12.
fn map() -> StreetMap {
    let road = |id: i64, kind: RoadKind, points: [[f64; 2]; 2]| crate::testing::road(id, kind, &points);
    let roads = vec![
        road(1, RoadKind::Residential, [[60.0, 4.0], [90.0, 180.0]]),
        road(2, RoadKind::Tertiary, [[-60.0, -170.0], [-60.0, 170.0]]),
        road(3, RoadKind::Footway, [[-150.0, 60.0], [150.0, 80.0]]),
        road(4, RoadKind::Secondary, [[-240.0, 3.0], [240.0, 5.0]]),
    ];
    StreetMap { roads, ..StreetMap::default() }
}

fn bounds() -> Bounds {
    Bounds::square(DVec2::new(20.0, 0.0), 360.0)
}

fn hilly() -> HeightField {
    let nodes = Raster::from_fn(182, 182, |x, y| (x as f32 * 0.05).sin() + 0.02 * y as f32);
    HeightField { origin: bounds().min - 1.0, cell_m: 2.0, nodes }
}

fn surfaces(place: &Place<'_>) -> RoadSurfaces {
    super::surfaces(place, &Spans::default(), None)
}

fn built() -> RoadSurfaces {
    surfaces(&place(
        &drive(),
        Some(&map()),
        bounds(),
        &hilly(),
        &AssetLibrary::default(),
        &Seed(7).into(),
        &Report::default(),
    ))
}

fn area_m2(area: &[Polygon]) -> f64 {
    area.iter().map(Polygon::area_m2).sum()
}

fn is_paint(piece: &Piece) -> bool {
    piece.materials[0].name.contains("marking")
}

fn is_apron(piece: &Piece) -> bool {
    piece.mesh.bounds().is_some_and(|(low, high)| (high - low).x > 1000.0)
}

#[test]
fn the_plane_is_covered_once() {
    let report = Report::default();
    let (drive, map, bounds) = (drive(), map(), bounds());
    let (flat, spans) = (HeightField::flat(bounds, 0.0), Spans::default());
    let lift = Lift { ground: &flat, spans: &spans };
    let layout = layout(&drive, Some(&map), DrivingSide::Left, bounds, &lift, &report);
    let covers = land::covers(layout.land.clone(), &layout.car_parks, Some(&map), bounds);
    let mut areas = vec![layout.carriageway, layout.kerb, layout.pavement, layout.tracks];
    areas.extend(covers.into_iter().map(|cover| cover.area));
    let whole_m2 = bounds.size_m().element_product();
    let covered_m2: f64 = areas.iter().map(|area| area_m2(area)).sum();
    assert!((covered_m2 - whole_m2).abs() < 1e-4 * whole_m2, "{covered_m2} of {whole_m2} m²");
    for (i, a) in areas.iter().enumerate() {
        for b in &areas[..i] {
            let common_m2 = area_m2(&plane::intersection(a, b));
            assert!(common_m2 < 0.05, "{common_m2} m² twice");
        }
    }
}

#[test]
fn surfaces_face_up_and_are_where_things_are_told_to_stand() {
    let (built, ground) = (built(), hilly());
    let drape = Drape::new(&ground);
    for piece in built.pieces.iter().filter(|p| !is_apron(p)) {
        assert_eq!(piece.mesh.defect(), None);
        for t in &piece.mesh.triangles {
            let [a, b, c] = t.map(|i| piece.mesh.positions[i as usize].as_dvec3());
            let (up, middle) = ((b - a).cross(c - a), (a + b + c) / 3.0);
            assert!(up.z > -1e-4, "{:?} faces down", piece.class);
            // Kerb stones' fronts are too steep to stand on.
            if up.z > 0.9 * up.length() {
                let told_m = drape.height_m(middle.truncate()) + built.elevation_m(middle.truncate());
                assert!((middle.z - told_m).abs() < 0.03, "{:?} at {middle}: {told_m}", piece.class);
            }
        }
    }
}

#[test]
fn the_recorded_street_keeps_its_area_and_the_map_adds_only_what_it_lacks() {
    let built = built();
    let recorded = [plane::rectangle(Bounds { min: DVec2::new(-160.0, -4.0), max: DVec2::new(200.0, 12.0) })];
    let kept = plane::intersection(&built.carriageway, &recorded);
    assert!((area_m2(&kept) - 360.0 * 16.0).abs() < 1.0, "{}", area_m2(&kept));
    assert_eq!(built.footing(DVec2::new(-60.0, 100.0)), Footing::Carriageway);
    assert_eq!(built.footing(DVec2::new(-60.0 + 5.0, 100.0)), Footing::Sidewalk);
    assert_eq!(built.footing(DVec2::new(20.0, 13.5)), Footing::Sidewalk);
    assert_eq!(built.footing(DVec2::new(20.0, 100.0)), Footing::Land);
    // Two side streets of 6.9 m and their rounded corners, no second street along the recorded one.
    let added = area_m2(&built.carriageway) - area_m2(&kept);
    assert!((3000.0..4200.0).contains(&added), "{added}");
}

#[test]
fn road_and_sidewalk_differ_by_the_kerb_and_the_paint_lies_on_the_road() {
    let (built, ground) = (built(), hilly());
    let heights = |class: Class, paint: bool| -> Vec<f64> {
        let pieces = built.pieces.iter().filter(|p| p.class == class && is_paint(p) == paint);
        let above = |p: &glam::Vec3| f64::from(p.z) - ground.height_m(p.as_dvec3().truncate());
        pieces.flat_map(|p| p.mesh.positions.iter().map(above)).collect()
    };
    assert!(heights(Class::Road, false).iter().all(|h| h.abs() < 0.02));
    let paint = heights(Class::Road, true);
    assert!(!paint.is_empty() && paint.iter().all(|h| (h - 0.004).abs() < 0.02));
    assert!(heights(Class::Sidewalk, false).iter().all(|h| (-0.03..built.kerb_m + 0.02).contains(h)));
}

/// What parts pieces of a class are by their materials, where sidewalks are paved with what has the tags.
fn roles(map: &StreetMap, class: Class, tags: &[&str]) -> BTreeSet<Option<Role>> {
    let (drive, ground) = (drive(), hilly());
    let surface = |kind: SurfaceKind| Surface {
        id: kind.name().into(),
        kind,
        tags: Tags::new(tags),
        material: Material::default(),
        size_m: [1.0; 2],
        cells: [1; 2],
        design: None,
    };
    let surfaces_of = [SurfaceKind::Paving, SurfaceKind::Kerb].map(surface).to_vec();
    let library = AssetLibrary { surfaces: surfaces_of, ..AssetLibrary::default() };
    let built = surfaces(&place(&drive, Some(map), bounds(), &ground, &library, &Seed(7).into(), &Report::default()));
    let of_class = built.pieces.into_iter().filter(|piece| piece.class == class);
    of_class.map(|piece| piece.materials[0].role).collect()
}

#[test]
fn kerbs_are_told_from_sidewalks_but_along_trodden_earth() {
    assert_eq!(roles(&map(), Class::Sidewalk, &["slabs"]), [None, Some(Role::Kerb)].into());
    assert_eq!(roles(&map(), Class::Sidewalk, &["earth"]), [Some(Role::Unpaved)].into());
}

#[test]
fn what_is_laid_on_the_ground_is_told_from_what_grows() {
    let polygon = || {
        let corners = [[0.0, 30.0], [10.0, 30.0], [10.0, 40.0], [0.0, 40.0]].map(DVec2::from_array);
        Polygon::simple(corners.to_vec())
    };
    let with = |kind: LandKind, tag: &str| {
        let land = vec![Land { id: 1, kind, polygon: polygon() }];
        roles(&StreetMap { land, ..map() }, Class::Ground, &[tag])
    };
    assert_eq!(with(LandKind::Parking, "slabs"), [None, Some(Role::CarPark)].into());
    assert_eq!(with(LandKind::Paved, "slabs"), [None, Some(Role::Paved)].into());
    assert_eq!(with(LandKind::Paved, "earth"), [None, Some(Role::Unpaved)].into());
    for kind in [LandKind::Park, LandKind::Sand, LandKind::Farmland, LandKind::Water] {
        assert_eq!(with(kind, "slabs"), [None].into(), "{kind:?}");
    }
    // Around a house.
    let buildings = vec![Building::new(1, polygon(), None)];
    let yard = roles(&StreetMap { buildings, ..map() }, Class::Ground, &["slabs"]);
    assert_eq!(yard, [None, Some(Role::Paved)].into());
}

#[test]
fn a_drive_without_any_map_has_a_road_under_it() {
    let drive = trove_model::Drive { lane_map: None, ..drive() };
    let flat = HeightField::flat(bounds(), 0.0);
    let built =
        surfaces(&place(&drive, None, bounds(), &flat, &AssetLibrary::default(), &Seed(7).into(), &Report::default()));
    for keyframe in &drive.keyframes {
        assert_eq!(built.footing(keyframe.world_from_ego.translation.truncate()), Footing::Carriageway);
    }
}

#[test]
fn a_patchy_recording_is_closed_where_vehicles_drove() {
    let mut drive = drive();
    let piece = |from: f64, to: f64| {
        let corners = [[from, -4.0], [to, -4.0], [to, 12.0], [from, 12.0]];
        Polygon::simple(corners.map(DVec2::from_array).to_vec())
    };
    let drivable = vec![piece(-100.0, 5.0), piece(25.0, 200.0)];
    drive.lane_map = Some(LaneMap { drivable, ..LaneMap::default() });
    let flat = HeightField::flat(bounds(), 0.0);
    let report = Report::default();
    let built = surfaces(&place(&drive, None, bounds(), &flat, &AssetLibrary::default(), &Seed(7).into(), &report));
    assert_eq!(built.footing(DVec2::new(15.0, 0.0)), Footing::Carriageway);
    assert!(report.entries().iter().any(|e| e.what.contains("gaps")));
}
