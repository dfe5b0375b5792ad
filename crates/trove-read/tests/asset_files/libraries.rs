//! `library.toml` written, completed, read and checked.

use serde_json::json;
use trove_model::{Kind, Outdoors, Report, Role, SurfaceKind};
use trove_read::asset_files;

use crate::files::{Folder, Glb, png};

#[test]
fn a_second_import_changes_nothing_and_edits_win() {
    let folder = Folder::new(&[("car.glb", &Glb::cuboid([1.8, 1.5, 4.5]).bytes()), ("LICENSE", b"CC0 1.0 Universal")]);
    let (_, report) = folder.read();
    let first = folder.toml();
    assert!(first.contains("kind = \"car\" # 0.9") && first.contains("licence = \"CC0-1.0\""), "{first} {report}");
    folder.read();
    assert_eq!(folder.toml(), first);
    let edited = first.replace("kind = \"car\"", "kind = \"truck\"").replace("front = ", "# front = ");
    folder.write("library.toml", edited.as_bytes());
    folder.write("new/bench.glb", &Glb::cuboid([1.7, 0.8, 0.6]).bytes());
    let (library, report) = folder.read();
    let library = library.expect(&report);
    let kinds: Vec<Kind> = library.assets.iter().map(|a| a.kind).collect();
    assert_eq!(kinds, [Kind::Bench, Kind::Truck], "{report}");
    let second = folder.toml();
    assert!(second.contains("kind = \"truck\"") && second.contains("new/bench.glb"), "{second}");
    assert_eq!(second.matches("\nfront = ").count(), 2, "{second}");
    assert!(library.assets[1].licence.starts_with("CC0-1.0"));
}

#[test]
fn sets_of_textures_become_surfaces_and_skies_are_listed() {
    let grey = |v: u8| png(16, 16, move |_, _| [v, v, v, 255]);
    let sky = image::Rgb32FImage::from_pixel(64, 32, image::Rgb([0.5, 0.6, 0.9]));
    let mut hdr = std::io::Cursor::new(Vec::new());
    sky.write_to(&mut hdr, image::ImageFormat::Hdr).unwrap();
    let folder = Folder::new(&[
        ("bricks/Bricks008_1K-JPG_Color.png", &png(16, 16, |_, _| [180, 60, 40, 255])),
        ("bricks/Bricks008_1K-JPG_NormalDX.png", &png(16, 16, |_, _| [128, 200, 255, 255])),
        ("bricks/Bricks008_1K-JPG_Roughness.png", &grey(200)),
        ("bricks/Bricks008_1K-JPG_AmbientOcclusion.png", &grey(250)),
        ("bricks/Bricks008_1K-JPG_Displacement.png", &grey(128)),
        ("glass_diff_2k.png", &grey(9)),
        ("glass_rough_2k.png", &grey(9)),
        ("sky.hdr", &hdr.into_inner()),
    ]);
    let (library, report) = folder.read();
    let library = library.expect(&report);
    assert_eq!(library.surfaces.len(), 1, "{}", folder.toml());
    let surface = &library.surfaces[0];
    assert_eq!((surface.id.as_str(), surface.kind), ("mine/bricks008", SurfaceKind::Wall));
    assert_eq!((surface.size_m, surface.cells), ([2.0, 2.0], [1, 1]));
    let material = &surface.material;
    assert_eq!(material.normal_map.as_ref().unwrap().rgba[0], [128, 55, 255, 255]);
    assert_eq!(material.orm_map.as_ref().unwrap().rgba[0], [250, 200, 255, 255]);
    assert_eq!((material.roughness, material.metalness), (1.0, 0.0));
    assert!(material.height_map.is_some() && material.height_m > 0.0);
    assert_eq!(surface.tags.iter().collect::<Vec<_>>(), ["brick"]);
    assert!(folder.toml().contains("[[environment]]\nfile = \"sky.hdr\""), "{}", folder.toml());
}

#[test]
fn tags_come_from_the_name_of_a_file_and_never_from_its_folder() {
    let block = Glb::cuboid([12.0, 9.0, 10.0]).bytes();
    let folder = Folder::new(&[
        ("houses/office_tower.glb", &block),
        ("houses/skyscraper.glb", &block),
        ("houses/town_hall.glb", &block),
        ("library.toml", b"[[asset]]\nfile = \"houses/town_hall.glb\"\nkind = \"building\"\ntags = [\"civic\"]\n"),
    ]);
    let (library, report) = folder.read();
    let library = library.expect(&report);
    let tags: Vec<Vec<&str>> = library.assets.iter().map(|a| a.tags.iter().collect()).collect();
    assert_eq!(tags, [vec!["building", "office"], vec!["building", "office"], vec!["building", "civic"]], "{report}");
    let written = folder.toml();
    assert!(written.contains("tags = [\"office\"] # 0.75: words in its name"), "{written}");
    assert_eq!(library.tagged(Kind::Building, &["house"]).count(), 0);
}

#[test]
fn checks_find_what_is_wrong() {
    let mut inside_out = Glb::cuboid([1.8, 1.5, 4.5]);
    inside_out.json["meshes"][0]["primitives"][0]["mode"] = json!(4);
    let flipped: Vec<u32> = {
        let quads = [[0, 4, 6, 2], [1, 3, 7, 5], [0, 1, 5, 4], [2, 6, 7, 3], [0, 2, 3, 1], [4, 5, 7, 6]];
        quads.iter().flat_map(|q| [q[0], q[2], q[1], q[0], q[3], q[2]]).collect()
    };
    let flipped = inside_out.indices(&flipped);
    inside_out.json["meshes"][0]["primitives"][0]["indices"] = json!(flipped);
    let mut lost = Glb::cuboid([1.8, 1.5, 4.5]);
    let texture = lost.picture(json!({"uri": "paint.png"}));
    let lost = lost.material(json!({"pbrMetallicRoughness": {"baseColorTexture": {"index": texture}}}));
    let library = "[[asset]]\nfile = \"a_car.glb\"\nkind = \"car\"\nunit_m = 100.0\n\
        [[asset]]\nfile = \"b_car.glb\"\nlicence = \"MIT\"\n[[asset]]\nfile = \"c_car.glb\"\nlicence = \"MIT\"\n\
        [[asset]]\nfile = \"gone.glb\"\nlicence = \"MIT\"\n\
        [[asset]]\nfile = \"fence.glb\"\nlicence = \"MIT\"\ntags = [\"nice\"]\n";
    let folder = Folder::new(&[
        ("a_car.glb", &Glb::cuboid([1.8, 1.5, 4.5]).bytes()),
        ("fence.glb", &Glb::cuboid([0.08, 1.4, 2.4]).bytes()),
        ("b_car.glb", &inside_out.bytes()),
        ("c_car.glb", &lost.bytes()),
        ("library.toml", library.as_bytes()),
    ]);
    let findings = asset_files::check(&folder.path);
    for (file, what) in [
        ("a_car.glb", "no licence"),
        ("a_car.glb", "450.00 × 180.00 × 150.00 m"),
        ("b_car.glb", "face inwards"),
        ("c_car.glb", "paint.png"),
        ("gone.glb", "readable file"),
        ("fence.glb", "tags = [\"nice\"]"),
    ] {
        assert!(findings.iter().any(|f| f.file == file && f.what.contains(what)), "{file} {what}: {findings:#?}");
    }
    assert_eq!(findings.len(), 6, "{findings:#?}");
    assert!(asset_files::check(folder.path.parent().unwrap())[0].severe);
}

#[test]
fn the_same_stem_in_two_folders_makes_two_ids() {
    let car = Glb::cuboid([1.8, 1.5, 4.5]).bytes();
    let (library, report) = Folder::new(&[("a/car.glb", &car), ("b/car.glb", &car)]).read();
    let ids: Vec<String> = library.expect(&report).assets.into_iter().map(|a| a.id).collect();
    assert_eq!(ids, ["mine/a-car.glb", "mine/b-car.glb"]);
}

#[test]
fn a_library_without_its_file_says_how_to_make_one() {
    let folder = Folder::new(&[]);
    let error = asset_files::read_library(&folder.path, &Report::default()).unwrap_err().to_string();
    assert!(error.contains("trove assets import"), "{error}");
}

#[test]
fn materials_have_the_roles_that_the_file_gives_them() {
    let folder = Folder::new(&[("lantern.glb", &Glb::cuboid([0.4, 4.0, 0.4]).bytes())]);
    folder.read();
    let toml = folder.toml();
    let (library, report) = folder.read();
    let name = library.expect(&report).assets[0].slots[0].material.name.clone();
    let with =
        |roles: &str| toml.replace("file = \"lantern.glb\"", &format!("file = \"lantern.glb\"\nroles = {roles}"));
    folder.write("library.toml", with(&format!("{{ {name:?} = \"street_lamp\" }}")).as_bytes());
    let (library, report) = folder.read();
    assert_eq!(library.expect(&report).assets[0].slots[0].material.role, Some(Role::StreetLamp));
    for (roles, part) in [
        (format!("{{ {name:?} = \"lamp\" }}"), "street_lamp, wall_lamp"),
        ("{ lense = \"street_lamp\" }".into(), "lense"),
    ] {
        folder.write("library.toml", with(&roles).as_bytes());
        let (_, report) = folder.read();
        assert!(report.contains(part), "{report}");
    }
}

#[test]
fn clothes_are_worn_in_the_weather_that_the_file_says() {
    let folder = Folder::new(&[("man.glb", &Glb::cuboid([0.4, 1.8, 0.4]).bytes())]);
    folder.read();
    let toml = folder.toml();
    let with = |words: &str| toml.replace("file = \"man.glb\"", &format!("file = \"man.glb\"\nworn_in = {words}"));
    let worn_in = |words: &str| {
        folder.write("library.toml", with(words).as_bytes());
        let (library, report) = folder.read();
        library.expect(&report).assets[0].worn_in.clone()
    };
    assert_eq!(worn_in("[\"wet\", \"cold\"]"), [Outdoors::Wet, Outdoors::Cold]);
    assert_eq!(worn_in("[]"), []);
    folder.write("library.toml", with("[\"frost\"]").as_bytes());
    let (_, report) = folder.read();
    assert!(report.contains("worn_in") && report.contains("warm, mild, wet, cold"), "{report}");
}

#[test]
fn lamps_shine_by_the_table_lumens_and_colour_that_the_file_gives_them() {
    // 100 candelas into all directions below.
    let table = b"IESNA:LM-63-2002\nTILT=NONE\n1 -1 1 2 1 1 2 0 0 0\n1 1 50\n0 90\n0\n100 100\n";
    let damaged = b"IESNA:LM-63-2002\nTILT=NONE\n1 -1 1 2 1 2 2 0 0 0\n1 1 50\n0 90\n0\n100 100\n";
    let lamp = Glb::cuboid([0.4, 4.0, 0.4]).bytes();
    let folder = Folder::new(&[("lantern.glb", &lamp), ("mine.ies", table), ("damaged.ies", damaged)]);
    folder.read();
    let toml = folder.toml();
    let shining = |light: &str| {
        let with = format!("file = \"lantern.glb\"\nlight = {light}");
        folder.write("library.toml", toml.replace("file = \"lantern.glb\"", &with).as_bytes());
        let (library, report) = folder.read();
        library.map(|library| library.assets[0].luminaire.clone().unwrap()).ok_or(report)
    };
    let by_table = shining("{ table = \"mine.ies\" }").unwrap();
    assert!((by_table.lumens / (200.0 * std::f32::consts::PI) - 1.0).abs() < 0.01, "{}", by_table.lumens);
    assert_eq!(by_table.intensity.share(glam::Vec3::new(0.6, 0.0, -0.8)), 100.0);
    let given = shining("{ table = \"mine.ies\", lumens = 4000, kelvin = 2200 }").unwrap();
    assert_eq!((given.lumens, given.kelvin), (4000.0, 2200.0));
    assert_eq!(shining("{ kelvin = 4000 }").unwrap().intensity, trove_model::Luminaire::default().intensity);
    for (light, parts) in [
        ("{ table = \"damaged.ies\" }", ["damaged.ies", "photometric type C"]),
        ("{ table = \"none.ies\" }", ["none.ies", "read"]),
        ("{ kelvin = 200 }", ["light.kelvin", "1667"]),
        ("{ lumen = 200 }", ["library.toml", "lumens"]),
    ] {
        let error = shining(light).expect_err(light);
        assert!(parts.iter().all(|part| error.contains(part)), "{light}: {error}");
    }
}

#[test]
fn a_building_repeats_the_bays_and_stands_in_the_countries_that_the_file_names() {
    // 12 m wide, 9 m high, 8 m deep; its front looks towards +z of the file.
    let folder = Folder::new(&[("house.glb", &Glb::cuboid([12.0, 9.0, 8.0]).bytes())]);
    folder.read();
    let toml = folder.toml();
    let toml = toml.lines().filter(|l| !["kind", "front"].iter().any(|key| l.starts_with(key))).collect::<Vec<_>>();
    let named = "file = \"house.glb\"\nkind = \"building\"\nfront = \"+z\"\n";
    let with = |more: &str| toml.join("\n").replace("file = \"house.glb\"", &format!("{named}{more}"));
    folder.write("library.toml", with("repeats = { x = [-2.0, 1.0], z = [3, 6] }\ncountries = [\"GB\"]").as_bytes());
    let (library, report) = folder.read();
    let house = &library.expect(&report).assets[0];
    assert!((house.size_m - glam::DVec3::new(12.0, 8.0, 9.0)).length() < 1e-3, "{}", house.size_m);
    assert_eq!(house.repeats, [Some([-2.0, 1.0]), None, Some([3.0, 6.0])]);
    assert_eq!(house.countries, ["GB"]);
    for (wrong, part) in [
        ("repeats = { x = [-2.0, 7.0] }", "between -6.00 and 6.00 m"),
        ("repeats = { z = [3.0, 3.0] }", "repeats.z"),
        ("countries = [\"Germany\"]", "ISO 3166-1"),
    ] {
        folder.write("library.toml", with(wrong).as_bytes());
        let (_, report) = folder.read();
        assert!(report.contains(part), "{report}");
    }
    let car = with("repeats = { x = [-2.0, 1.0] }").replace("\"building\"", "\"truck\"");
    folder.write("library.toml", car.as_bytes());
    assert!(folder.read().1.contains("what is no building"));
}
