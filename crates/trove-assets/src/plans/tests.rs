//! What is read from files of plans, and what is refused.

use trove_model::{Asset, Kind, PlantForm};

use super::Plans;

const CAR: &str = "[[car]]\nid = \"kombi\"\nlike = \"car/estate\"\n";
const BUILDING: &str = "[[building]]\nid = \"shed\"\nlike = \"building/garage-row\"\n";
const CONE: &str = "[[cone]]\nid = \"red\"\nlike = \"cone/standard\"\n";
const FURNITURE: &str = "[[furniture]]\nid = \"post\"\nkind = \"bollard\"\n";
const PERSON: &str = "[[person]]\nid = \"nurse\"\nlike = \"adult/woman-tee\"\n";
const FACADE: &str = "[[facade]]\nid = \"clinker\"\nlike = \"facade/brick-row\"\n";
const TREE: &str = "[[tree]]\nid = \"hazel\"\nlike = \"tree/lime\"\n";
const SHRUB: &str = "[[shrub]]\nid = \"dogwood\"\nlike = \"bush/lilac\"\n";
const HEDGE: &str = "[[hedge]]\nid = \"beech\"\nlike = \"bush/hedge-hornbeam\"\n";
const BED: &str = "[[bed]]\nid = \"tulips\"\nlike = \"bush/bed-annuals\"\n";

#[test]
fn the_built_in_plans_are_sound() {
    let plans = Plans::built_in();
    assert!(plans.cars.len() >= 45 && plans.facades.len() >= 27, "{} {}", plans.cars.len(), plans.facades.len());
    let plants = &plans.plants;
    let counts = [plants.trees.len(), plants.shrubs.len(), plants.hedges.len(), plants.beds.len()];
    assert!(counts.iter().zip([12, 9, 3, 3]).all(|(count, least)| *count >= least), "{counts:?}");
    assert!(plans.persons().count() >= 29, "{}", plans.persons().count());
}

#[test]
fn a_car_takes_what_it_does_not_say_from_the_one_that_it_is_like() {
    let text = format!("{CAR}[car.profile]\nlength_m = 4.9\n{CAR}").replacen("kombi", "long", 1);
    let plans = Plans::parse(&text.replace("like = \"car/estate\"\n[[", "like = \"long\"\n[[")).unwrap();
    let estate = Plans::built_in().cars.iter().find(|car| car.id == "car/estate").unwrap();
    let long = &plans.cars[0];
    assert_eq!((long.profile.length_m, long.profile.width_m), (4.9, estate.profile.width_m));
    assert_eq!((long.axles_m, &long.plate.text), (estate.axles_m, &estate.plate.text));
}

#[test]
fn pieces_are_named_or_written_out_and_may_be_like_others() {
    let text = format!(
        "{CAR}paint = \"mine\"\nface = {{ like = \"family\", badge_m = -0.2 }}\n[paint.mine]\nlike = \"fleet\"\nflakes = 0.1\n"
    );
    let car = &Plans::parse(&text).unwrap().cars[0];
    assert_eq!((car.paint.flakes, car.paint.colors.len(), car.face.badge_m), (0.1, 25, -0.2));
    let text = format!("{CAR}paint = {{ colors = [[1, 0, 0.5]] }}\n");
    assert_eq!(Plans::parse(&text).unwrap().cars[0].paint.colors, [[1.0, 0.0, 0.5]]);
}

#[test]
fn what_stands_along_streets_is_built_with_the_measures_of_its_plan() {
    let text = format!(
        "{CONE}height_m = 0.9\n[[signal]]\nid = \"own\"\ntags = [\"own\"]\n{FURNITURE}parts = [{{ finish = \"stainless\", \
         shapes = [{{ post = {{ foot = [0, 0, 0], radius = 0.1, height = 1.2, around = 12 }} }}] }}]\n"
    );
    let assets = Plans::parse(&text).unwrap().library("mine", None).assets;
    let ids: Vec<&str> = assets.iter().map(|a| a.id.as_str()).collect();
    let signals = ["mine/own/left/green", "mine/own/left/red", "mine/own/right/green", "mine/own/right/red"];
    assert_eq!(ids, [signals.as_slice(), &["mine/post", "mine/red"]].concat());
    let [.., post, cone] = assets.as_slice() else { unreachable!() };
    assert!((cone.size_m.z - 0.9).abs() < 0.02 && (post.size_m - glam::dvec3(0.2, 0.2, 1.2)).length() < 0.01);
    assert!(assets[0].tags.iter().any(|tag| tag == "own") && assets[0].tags.iter().any(|tag| tag == "green"));
}

#[test]
fn a_building_of_a_plan_wears_surfaces_of_both_libraries() {
    let text = format!(
        "{FACADE}{BUILDING}tags = [\"shed\"]\nparts = []\nfinishes = {{ front = {{ surface = \"clinker\" }} }}\n\
         masses = [{{ size_m = [11.6, 6], levels = [{{ storey_m = 3.1, count = 2, walls = [\"front\", \"wall/brick\"] }}] }}]\n"
    );
    let library = Plans::parse(&text).unwrap().library("mine", None);
    let [shed] = library.assets.as_slice() else { unreachable!() };
    let names: Vec<&str> = shed.slots.iter().map(|slot| &*slot.material.name).collect();
    assert_eq!((&*shed.id, names), ("mine/shed", vec!["clinker as front", "wall/brick"]));
    assert!(shed.tags.has("shed") && shed.slots.iter().all(|slot| slot.material.base_color_map.is_some()));
}

#[test]
fn plants_of_a_plan_are_grown_with_their_own_names_and_what_they_are_like() {
    let text = format!("{TREE}height_m = 9.0\ntags = [\"nuts\"]\ncommonness = 0.5\n{SHRUB}{HEDGE}{BED}");
    let library = Plans::parse(&text).unwrap().library("mine", None);
    let ids: Vec<&str> = library.assets.iter().map(|asset| &*asset.id).collect();
    let trees = ["mine/hazel-1", "mine/hazel-2", "mine/hazel-young"];
    let beds = ["mine/tulips-1", "mine/tulips-2"];
    assert_eq!(
        ids,
        [&["mine/beech-1", "mine/beech-2", "mine/dogwood-1", "mine/dogwood-2"], &trees[..], &beds].concat()
    );
    let (hedge, tree, bed) = (&library.assets[0], &library.assets[4], &library.assets[7]);
    let known = |asset: &Asset| asset.plant.clone().unwrap();
    assert_eq!((hedge.kind, known(hedge).form, known(bed).form), (Kind::Bush, PlantForm::Hedge, PlantForm::Bed));
    assert_eq!((tree.kind, tree.commonness, known(tree).species.as_deref()), (Kind::Tree, 0.5, Some("hazel")));
    assert!(tree.tags.has_all(&["hazel", "nuts"]) && known(tree).is_called("tilia") && tree.size_m.z < 10.0);
}

#[test]
fn the_largest_and_the_smallest_plants_that_are_allowed_can_be_grown() {
    let tree = |measures: &str| format!("{TREE}{}", measures.replace(", ", "\n"));
    let shrub = |measures: &str| format!("{SHRUB}{}", measures.replace("; ", "\n"));
    for text in [
        tree("height_m = 60.0, radius_m = 20.0, lobes = 200, points = 8000, cards = 10000, flat = 5.0, leader = 1.0"),
        tree("height_m = 1.0, radius_m = 0.2, lobes = 2, points = 10, cards = 1, clear = 0.02, leader = 0.0"),
        tree("height_m = 60.0, radius_m = 0.2, points = 8000, cards = 10000, trunk_m = 0.03, lift = -1.0"),
        shrub("half_m = [10, 10, 10]; clumps = 100; clump = 1.0; cards = 10000"),
        shrub("half_m = [0.05, 0.05, 0.05]; clumps = 1; clump = 0.05; cards = 1"),
    ] {
        for asset in Plans::parse(&text).unwrap().library("mine", None).assets {
            assert_eq!(asset.mesh.defect(), None, "{} of {text}", asset.id);
        }
    }
}

#[test]
fn a_person_differs_from_a_built_in_one_in_single_measures_and_wears_a_list_of_garments() {
    let text = format!(
        "{PERSON}build = {{ years = 50 }}\ntop = [\"shirt\", {{ like = \"suit\", dye = \"mine\" }}]\n\
         [dye.mine]\ncolors = [[0.1, 0.2, 0.3]]\n"
    );
    let plans = Plans::parse(&text).unwrap();
    assert_eq!(plans.persons().collect::<Vec<_>>(), ["nurse"]);
    // Their parts are private to the builder of people.
    let found = format!("{:?}", plans.persons[0]);
    for part in [
        "years: 50.0, muscle: 0.5, weight: 0.45",
        "hair_cut: Long",
        "has_collar: true",
        "colors: [[0.1, 0.2, 0.3]] }, has_lapels: true",
    ] {
        assert!(found.contains(part), "{part}: {found}");
    }
}

#[test]
fn a_mistake_is_named_with_its_entry_and_key_and_what_was_expected() {
    for (text, parts) in [
        (format!("{CAR}rimm = 3\n"), &["car \"kombi\": rimm", "did you mean `rim`?"][..]),
        (format!("{CAR}[car.profile]\nlenght_m = 3\n"), &["profile.lenght_m", "did you mean `length_m`?"]),
        (format!("{CAR}wheel_radius_m = \"big\"\n"), &["car \"kombi\": wheel_radius_m", "expected f32", "\"big\""]),
        (format!("{CAR}rim = {{ spoke = 5 }}\n"), &["car \"kombi\": rim", "`spoke`", "did you mean `spokes`?"]),
        (format!("{CAR}class = \"jep\"\n"), &["class", "did you mean `jeep`?"]),
        (format!("{CAR}face = \"famly\"\n"), &["car \"kombi\": face", "did you mean `family`?"]),
        (format!("{CAR}seats_m = []\n"), &["seats_m", "at least one row"]),
        (format!("{CAR}[car.profile]\nlength_m = nan\n"), &["profile.length_m", "metres from 2 to 9", "NaN"]),
        (format!("{CAR}extras = [\"load_doors\"]\n"), &["extras", "blind_from_m"]),
        (CAR.replace("car/estate", "car/estat"), &["car \"kombi\": like", "did you mean `car/estate`?"]),
        (CAR.replace("like = \"car/estate\"", "like = \"kombi\""), &["like", "does not come from this one"]),
        (CAR.replace("like = \"car/estate\"", ""), &["car \"kombi\": ", "expected a value, found none"]),
        (CAR.replace("id = \"kombi\"", ""), &["car number 1: id", "found none"]),
        (format!("{CAR}{CAR}"), &["car number 2: id", "\"kombi\" twice"]),
        (format!("{FACADE}worn = 2.0\n"), &["facade \"clinker\": worn", "from 0 to 1", "2.0"]),
        (format!("{FACADE}cells = [0, 4]\n"), &["cells", "from 1 to 16"]),
        (format!("{FACADE}fixtures = {{ balcony = 1 }}\n"), &["fixtures.balcony", "did you mean `balconies`?"]),
        (format!("{FACADE}bays = [[{{ low_m = [9, 0], size_m = [1, 1] }}]]\n"), &["bays", "inside their bay"]),
        (format!("{BUILDING}storeys = 3\n"), &["building \"shed\": storeys", "a known key"]),
        (format!("{BUILDING}repeat = {{ x = [2, -2] }}\n"), &["building \"shed\": repeat", "from below upwards"]),
        (format!("{BUILDING}module_m = [nan, 0]\n"), &["building \"shed\": module_m", "metres from 0 to 100", "NaN"]),
        (format!("{BUILDING}masses = [{{ size_m = [9, 9], levles = [] }}]\n"), &["levles", "did you mean `levels`?"]),
        (
            format!("{BUILDING}masses = [{{ size_m = [9, 9], levels = [{{ storey_m = 3, walls = [\"brik\"] }}] }}]\n"),
            &["building \"shed\": finish", "one of its finishes", "brik"],
        ),
        (
            format!("{BUILDING}parts = [{{ finish = \"dark\", mass = 1, shape = {{ pipe = {{ height = 3 }} }} }}]\n"),
            &["building \"shed\": parts.mass", "the number of a mass"],
        ),
        (
            format!("{BUILDING}parts = [{{ finish = \"dark\", up = 3, shape = {{ pipe = {{ height = 3 }} }} }}]\n"),
            &["building \"shed\": parts", "a list of metres or"],
        ),
        (format!("{CONE}height_m = 9.0\n"), &["cone \"red\": height_m", "from 0.2 to 3", "9.0"]),
        (format!("{CONE}bands = [[0.5, 0.2]]\n"), &["bands", "from a lower to a higher share"]),
        (format!("{FURNITURE}parts = []\n"), &["furniture \"post\": parts", "1 to 400 shapes"]),
        (
            format!(
                "{FURNITURE}parts = [{{ finish = \"painted\", shapes = [{{ bar = {{ at = [0, 0, 1], size = [1, 1, 1] }} }}] }}]\n"
            ),
            &["parts.colors", "a colour for this finish"],
        ),
        (
            format!(
                "{FURNITURE}parts = [{{ finish = \"rusty\", shapes = [{{ tube = {{ path = [[0, 0, 0], [0, 0, nan]], radius = 0.1, around = 8 }} }}] }}]\n"
            ),
            &["parts.shapes", "within 20 metres", "NaN"],
        ),
        (FURNITURE.replace("bollard", "bolard"), &["furniture \"post\": kind", "did you mean `bollard`?"]),
        ("[[signal]]\nid = \"s\"\narm_m = 99\n".into(), &["signal \"s\": arm_m", "from 1 to 20"]),
        (
            "[[wall]]\nid = \"w\"\nfinish = \"brick\"\nheight_m = 1\nthick_m = -1\n".into(),
            &["wall \"w\": thick_m", "-1.0"],
        ),
        (format!("{TREE}hight_m = 9.0\n"), &["tree \"hazel\": hight_m", "did you mean `height_m`?"]),
        (format!("{TREE}height_m = 900.0\n"), &["tree \"hazel\": height_m", "metres from 1 to 60", "900.0"]),
        (format!("{TREE}hang = nan\n"), &["tree \"hazel\": hang", "from -5 to 5", "NaN"]),
        (format!("{TREE}lobes = 1\n"), &["lobes", "from 2 to 200"]),
        (format!("{TREE}points = 1000000\n"), &["points", "from 10 to 8000"]),
        (format!("{TREE}cards = 0\n"), &["cards", "from 1 to 10000"]),
        (format!("{TREE}clear = 0.2\nleader = -0.9\n"), &["leader", "above the ground"]),
        (format!("{TREE}crown = [[0.5, 1], [0.2, 1]]\n"), &["crown", "from below upwards"]),
        (format!("{TREE}genera = [\"Corylus avellana\"]\n"), &["genera", "lower case", "Corylus"]),
        (format!("{TREE}habitat = [[\"polar\", 1.0]]\n"), &["habitat", "one of tropical", "`polar`"]),
        (format!("{TREE}habitat = [[\"cold\", 1], [\"cold\", 0]]\n"), &["habitat", "each climate once"]),
        (format!("{TREE}bark = {{ furrowed = 0.0 }}\n"), &["bark", "furrows 0.005 to 0.5"]),
        (format!("{TREE}year = {{ turns = [] }}\n"), &["year", "1 to 20 colours"]),
        (format!("{TREE}year = {{ keeps = [0, 2, 0] }}\n"), &["year", "colours from 0 to 1"]),
        (format!("{TREE}sprig = \"neddles\"\n"), &["sprig", "did you mean `needles`?"]),
        (TREE.replace("tree/lime", "tree/line"), &["tree \"hazel\": like", "did you mean `tree/lime`?"]),
        (format!("{SHRUB}clumps = 0\n"), &["shrub \"dogwood\": clumps", "from 1 to 100"]),
        (format!("{SHRUB}half_m = [1, 1, inf]\n"), &["half_m", "0.05 to 10 metres", "inf"]),
        (format!("{HEDGE}flowers = [[1, 0, 0]]\n"), &["hedge \"beech\": flowers", "only a bed"]),
        (format!("{BED}commonness = 0\n"), &["bed \"tulips\": commonness", "above 0"]),
        (format!("{PERSON}hat = \"cap\"\n"), &["person \"nurse\": hat", "did you mean"]),
        (format!("{PERSON}bag = \"bagpack\"\n"), &["person \"nurse\": bag", "did you mean `backpack`?"]),
        (format!("{PERSON}worn_in = [\"frost\"]\n"), &["person \"nurse\": worn_in", "one of warm, mild, wet, cold"]),
        (format!("{PERSON}worn_in = [\"wet\", \"wet\"]\n"), &["person \"nurse\": worn_in", "each weather once"]),
        (format!("{PERSON}acts = [\"walk\"]\n"), &["acts", "one of easy, leaning"]),
        (format!("{PERSON}acts = [\"easy\", \"easy\"]\n"), &["acts", "none of them twice"]),
        (format!("{PERSON}top = [\"te\"]\n"), &["person \"nurse\": top", "did you mean `tee`?"]),
        (format!("{PERSON}top = []\n"), &["person \"nurse\": top", "one to three garments"]),
        (format!("{PERSON}top = [{{ like = \"tee\", sleeve = 9 }}]\n"), &["top.sleeve", "from 0 to 2.1", "9.0"]),
        (
            format!("{PERSON}top = [{{ like = \"tee\", dye = {{ colors = [] }} }}]\n"),
            &["top.dye.colors", "at least one"],
        ),
        (format!("{PERSON}build = {{ years = nan }}\n"), &["build.years", "years from 3 to 90", "NaN"]),
        (format!("{PERSON}build = {{ year = 9 }}\n"), &["person \"nurse\": build", "did you mean `years`?"]),
        (format!("{PERSON}build = {{ origins = [1, 1, 0] }}\n"), &["build.origins", "come to 1"]),
        (format!("{PERSON}bottom = {{ like = \"skirt\", cut = {{ skirt = {{ hem_m = -2 }} }} }}\n"), &["skirt.hem_m"]),
        (format!("{PERSON}tail_m = -inf\n"), &["tail_m", "from -0.68 to -0.05"]),
        (format!("{PERSON}headgear = \"scarf\"\n"), &["hair_cut", "covered, where headgear is scarf"]),
        (PERSON.replace("woman-tee", "woman-te"), &["person \"nurse\": like", "did you mean `adult/woman-tee`?"]),
        ("[[cra]]\nid = 3\n".into(), &["`cra`", "did you mean `car`?"]),
        ("[[car]\n".into(), &["line 1", "TOML"]),
    ] {
        let message = Plans::parse(&text).unwrap_err().to_string();
        for part in parts {
            assert!(message.contains(part), "{text}\n{message}");
        }
    }
}
