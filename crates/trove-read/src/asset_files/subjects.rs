//! What models show: words in their names, and how large such things are.

use trove_model::{Class, Kind};

use super::words::{match_of, words};

/// Something that models show.
#[derive(Debug)]
pub(super) struct Subject {
    /// What it can stand for; `None`: nothing that is placed.
    pub(super) kind: Option<Kind>,
    /// What its pixels are, where not as its kind's.
    pub(super) class: Option<Class>,
    /// Phrases in names, parted by `|`.
    phrases: &'static str,
    /// Typical length, width and height, metres.
    shapes: &'static [[f32; 3]],
    /// How far each of them may well be off, as a natural logarithm.
    pub(super) spread: [f32; 3],
    /// How far all of it may be off before the file's unit is doubted, as a natural logarithm.
    pub(super) tolerance: f32,
}

const fn row(
    kind: Option<Kind>,
    class: Option<Class>,
    phrases: &'static str,
    shapes: &'static [[f32; 3]],
    spread: [f32; 3],
    tolerance: f32,
) -> Subject {
    Subject { kind, class, phrases, shapes, spread, tolerance }
}

const CAR: [f32; 3] = [0.14, 0.1, 0.12];
const LONG: [f32; 3] = [0.25, 0.15, 0.2];
const WIDE: [f32; 3] = [0.5, 0.5, 0.4];
const PERSON: [f32; 3] = [0.5, 0.4, 0.08];
const POLE: [f32; 3] = [0.8, 0.8, 0.25];
/// Standing, walking, with the arms spread.
const PEOPLE: &[[f32; 3]] = &[[0.35, 0.5, 1.75], [0.75, 0.5, 1.75], [0.35, 1.7, 1.75]];
/// Words of what people do, and their shapes then.
const POSES: [(&str, &[[f32; 3]]); 4] = [
    ("sitting cheering|sitting waving|sit cheering|sit waving", &[[0.7, 0.55, 1.6]]),
    ("sit|sits|sitting|seated", &[[0.7, 0.5, 1.35]]),
    ("picking|bending|crouching|kneeling|crouch|kneel|bend", &[[1.0, 0.5, 1.08]]),
    ("waving|cheering|raising|wave", &[[0.4, 0.6, 2.1]]),
];

#[rustfmt::skip]
static SUBJECTS: [Subject; 57] = [
    row(Some(Kind::Car), None, "car|auto|sedan|saloon|hatchback|coupe|compact|estate|station wagon|wagon|vehicle|prius|tesla|golf|civic|corolla|camry|hybrid|limousine|limo|voiture|berline|coche|carro|macchina|automobil|pkw|kombi|limousine|schrägheck|stufenheck|汽车|轿车|小车", &[[4.5, 1.85, 1.47]], CAR, 0.3),
    row(Some(Kind::Car), None, "taxi|cab|cabbie|uber|出租车", &[[4.6, 1.85, 1.55]], CAR, 0.3),
    row(Some(Kind::Car), None, "sports car|sport car|race car|racing car|racer|supercar|roadster|convertible|muscle car|cabriolet|sportwagen|rennwagen|跑车", &[[4.5, 1.95, 1.25]], CAR, 0.3),
    row(Some(Kind::Car), None, "kei car|micro car|mini car|city car|smart car|kleinwagen", &[[3.5, 1.6, 1.5]], CAR, 0.3),
    row(Some(Kind::Car), Some(Class::Jeep), "suv|jeep|offroad|off road|off roader|crossover|hummer|land rover|geländewagen|越野车", &[[4.75, 1.95, 1.8]], CAR, 0.3),
    row(Some(Kind::Car), Some(Class::Jeep), "pickup|pick up truck|pickup truck|pritsche|皮卡", &[[5.5, 2.0, 1.85]], CAR, 0.3),
    row(Some(Kind::Car), Some(Class::Van), "van|minivan|mini van|mpv|camper|delivery van|transporter|sprinter|minibus|mini bus|lieferwagen|fourgon|furgoneta|furgone|camionnette|面包车", &[[5.4, 2.05, 2.3]], LONG, 0.35),
    row(Some(Kind::PoliceCar), None, "police car|police|cop|cop car|sheriff|patrol car|polizei|polizeiauto|policia|polizia|警车", &[[4.7, 1.9, 1.6]], CAR, 0.35),
    row(Some(Kind::PoliceCar), Some(Class::Jeep), "cop suv|police suv|sheriff suv|police jeep", &[[4.8, 1.98, 1.9]], CAR, 0.35),
    row(Some(Kind::Ambulance), None, "ambulance|krankenwagen|rettungswagen|ambulancia|ambulanza|救护车", &[[6.2, 2.3, 2.65]], LONG, 0.35),
    row(Some(Kind::Truck), None, "truck|lorry|lkw|lastwagen|camion|camión|box truck|tipper|dump truck|dumper|flatbed|tanker|semi|kipper|garbage truck|müllwagen|tow truck|卡车|货车", &[[7.5, 2.5, 3.1], [14.0, 2.55, 3.8]], LONG, 0.5),
    row(Some(Kind::Truck), None, "fire truck|firetruck|fire engine|feuerwehr|pompiers|bomberos|消防车", &[[9.5, 2.6, 3.2]], LONG, 0.5),
    row(Some(Kind::Trailer), None, "trailer|semi trailer|anhänger|remorque|remolque|caravan|挂车", &[[9.0, 2.5, 3.4]], [0.5, 0.2, 0.35], 0.6),
    row(Some(Kind::ConstructionVehicle), None, "excavator|bulldozer|digger|backhoe|wheel loader|loader|forklift|crane|roller|steamroller|grader|concrete mixer|cement mixer|mixer truck|tractor|bagger|radlader|pelleteuse|excavadora|挖掘机", &[[7.0, 2.6, 3.2]], [0.4, 0.25, 0.3], 0.6),
    row(Some(Kind::Bus), None, "bus|coach|city bus|school bus|schoolbus|double decker|autobus|autobús|omnibus|reisebus|公交车|巴士", &[[11.0, 2.6, 3.3]], LONG, 0.4),
    row(Some(Kind::ArticulatedBus), None, "articulated bus|bendy bus|gelenkbus", &[[18.0, 2.55, 3.2]], LONG, 0.3),
    row(Some(Kind::Bicycle), None, "bicycle|bike|cycle|fahrrad|velo|vélo|bicicleta|bicicletta|mountain bike|自行车", &[[1.75, 0.6, 1.05]], [0.12, 0.35, 0.15], 0.25),
    row(Some(Kind::BicycleWithRider), None, "cyclist|bicyclist|bike rider|radfahrer|cycliste|ciclista", &[[1.75, 0.6, 1.75]], [0.12, 0.35, 0.15], 0.25),
    row(Some(Kind::Motorcycle), None, "motorcycle|motorbike|motor bike|scooter|moped|vespa|chopper|motorrad|roller vespa|moto|motocicleta|摩托车", &[[2.1, 0.8, 1.2]], [0.15, 0.3, 0.2], 0.3),
    row(Some(Kind::MotorcycleWithRider), None, "motorcyclist|biker|motorcycle rider|motorradfahrer", &[[2.1, 0.8, 1.6]], [0.15, 0.3, 0.2], 0.3),
    row(Some(Kind::Adult), None, "person|people|human|man|woman|male|female|adult|pedestrian|character|businessman|businesswoman|guy|lady|mensch|mann|frau|fußgänger|personne|homme|femme|piéton|persona|hombre|mujer|peatón|uomo|donna|行人|人", PEOPLE, PERSON, 0.16),
    row(Some(Kind::Child), None, "child|kid|boy|girl|toddler|kind|junge|mädchen|enfant|niño|niña|bambino|儿童", &[[0.3, 0.4, 1.25]], [0.5, 0.4, 0.15], 0.3),
    row(Some(Kind::ConstructionWorker), None, "construction worker|worker|builder|bauarbeiter|ouvrier|obrero|工人", PEOPLE, PERSON, 0.16),
    row(Some(Kind::PoliceOfficer), None, "police officer|policeman|policewoman|police man|polizist|policier|警察", PEOPLE, PERSON, 0.16),
    row(Some(Kind::PersonalMobility), None, "skateboarder|segway|e scooter rider|hoverboard", &[[0.9, 0.6, 1.85]], WIDE, 0.3),
    row(Some(Kind::Stroller), None, "stroller|pram|baby carriage|kinderwagen|poussette", &[[1.2, 0.6, 1.1]], WIDE, 0.4),
    row(Some(Kind::Wheelchair), None, "wheelchair|rollstuhl|fauteuil roulant", &[[1.1, 0.65, 1.2]], WIDE, 0.3),
    row(Some(Kind::Animal), None, "dog|cat|bird|pigeon|horse|cow|deer|animal|hund|katze|chien|chat|perro|gato|狗|猫", &[[0.8, 0.3, 0.6]], WIDE, 1.0),
    row(Some(Kind::Barrier), None, "barrier|jersey barrier|barricade|road block|roadblock|concrete barrier|absperrung|barrière|barrera|护栏", &[[0.6, 2.2, 1.0], [0.6, 4.0, 1.0]], [0.4, 0.4, 0.3], 0.5),
    row(Some(Kind::TrafficCone), None, "cone|traffic cone|construction cone|pylon|leitkegel|cône|cono|锥", &[[0.4, 0.4, 0.75]], [0.25, 0.25, 0.2], 0.42),
    row(Some(Kind::TrafficCone), None, "barrel|construction barrel|traffic drum|drum|leitbake|delineator", &[[0.65, 0.65, 1.15]], [0.3, 0.3, 0.25], 0.5),
    row(Some(Kind::PushablePullable), None, "cart|trolley|shopping cart|suitcase|wheelie bin|hand truck|wheelbarrow|koffer|einkaufswagen|chariot|carrito|手推车", &[[0.8, 0.55, 0.95]], WIDE, 0.6),
    row(Some(Kind::Debris), None, "debris|trash bag|garbage bag|cardboard box|box|crate|bag|pallet|tire|tyre|branch|schutt|müllsack|kiste", &[[0.6, 0.5, 0.4]], WIDE, 0.8),
    row(Some(Kind::BicycleRack), None, "bicycle rack|bike rack|fahrradständer", &[[0.6, 2.0, 0.9]], WIDE, 0.6),
    row(Some(Kind::Building), None, "building|apartment|apartments|skyscraper|office|office building|shop|store|tower|factory|warehouse|hotel|school|church|gebäude|hochhaus|bâtiment|immeuble|edificio|大楼|建筑", &[[14.0, 13.0, 13.0]], [0.5, 0.5, 0.5], 0.75),
    row(Some(Kind::Building), None, "house|cottage|villa|home|garage|shed|post office|haus|maison|casa|hütte|房子", &[[11.0, 8.5, 7.0]], [0.3, 0.3, 0.3], 0.6),
    row(Some(Kind::Building), None, "gas station|petrol station|filling station|tankstelle|gasolinera|加油站", &[[28.0, 20.0, 8.0]], [0.5, 0.5, 0.4], 0.8),
    row(Some(Kind::Tree), None, "tree|oak|pine|birch|maple|palm|fir|spruce|willow|lime tree|linden|poplar|baum|arbre|árbol|albero|树", &[[5.5, 5.5, 8.0]], [0.5, 0.5, 0.4], 1.15),
    row(Some(Kind::Bush), None, "bush|shrub|hedge|busch|strauch|hecke|buisson|arbusto|灌木", &[[1.3, 1.3, 1.2]], [0.5, 0.5, 0.4], 1.0),
    row(Some(Kind::TrafficSign), None, "sign|traffic sign|road sign|stop sign|street sign|speed limit|speed limit sign|signpost|schild|verkehrsschild|panneau|señal|cartello|路牌|标志", &[[0.08, 0.65, 2.4]], [0.8, 0.3, 0.2], 0.33),
    row(Some(Kind::TrafficSignal), None, "traffic light|traffic signal|stop light|stoplight|signal light|semaphore|ampel|verkehrsampel|feu tricolore|semáforo|semaforo|红绿灯|信号灯", &[[0.35, 0.35, 3.5], [0.35, 4.0, 5.8], [0.3, 0.3, 0.9]], [0.5, 0.4, 0.25], 0.45),
    row(Some(Kind::StreetLamp), None, "street lamp|street light|streetlight|lamp post|light post|lantern|lamp|laterne|straßenlaterne|lampadaire|réverbère|farola|lampione|路灯", &[[1.2, 0.3, 6.0], [0.5, 0.5, 4.5]], POLE, 0.8),
    row(Some(Kind::UtilityPole), None, "telephone pole|utility pole|power pole|electric pole|pylon tower|strommast|telefonmast|poteau|poste|电线杆", &[[0.3, 2.2, 9.5]], POLE, 0.45),
    row(Some(Kind::Bollard), None, "bollard|poller|borne|bolardo|路桩", &[[0.2, 0.2, 0.9]], [0.6, 0.6, 0.25], 0.5),
    row(Some(Kind::Hydrant), None, "hydrant|fire hydrant|bouche incendie|hidrante|消防栓", &[[0.4, 0.4, 0.85]], [0.3, 0.3, 0.25], 0.45),
    row(Some(Kind::Bin), None, "bin|trash can|garbage can|trashcan|waste|litter bin|dumpster|mülleimer|mülltonne|poubelle|basura|垃圾桶", &[[0.55, 0.55, 0.95], [1.1, 1.8, 1.3]], [0.35, 0.35, 0.3], 0.6),
    row(Some(Kind::Bench), None, "bench|bank|parkbank|banc|banco|panchina|长椅", &[[0.6, 1.7, 0.85]], [0.3, 0.3, 0.25], 0.45),
    row(Some(Kind::Shelter), None, "bus stop|bus shelter|shelter|bushaltestelle|haltestelle|abribus|parada|公交站", &[[1.6, 3.6, 2.6]], [0.4, 0.4, 0.25], 0.5),
    row(Some(Kind::StreetFurniture), None, "mailbox|mail box|postbox|post box|letter box|parking meter|phone booth|telephone booth|kiosk|planter|vending machine|newspaper|table|chair|utility box|briefkasten|boîte aux lettres|buzón|邮箱", &[[0.6, 0.6, 1.3]], [0.6, 0.6, 0.35], 0.7),
    row(Some(Kind::Fence), None, "fence|zaun|clôture|valla|recinto|栅栏", &[[2.4, 0.08, 1.4]], WIDE, 0.7),
    row(Some(Kind::Wall), None, "wall|mauer|mur|muro|围墙", &[[3.0, 0.3, 1.8]], WIDE, 0.8),
    row(Some(Kind::GuardRail), None, "guard rail|guardrail|crash barrier|leitplanke|glissière|quitamiedos", &[[4.0, 0.35, 0.8]], WIDE, 0.5),
    row(None, None, "rock|stone|boulder|cliff|fels|stein|rocher|石头", &[[1.6, 1.6, 1.1]], WIDE, 1.6),
    row(None, None, "grass|flower|plant|fern|mushroom|gras|blume|herbe|hierba|草", &[[0.3, 0.3, 0.35]], WIDE, 1.2),
    row(None, None, "train|tram|tramway|locomotive|metro|subway|zug|straßenbahn|火车", &[[20.0, 2.9, 3.7]], [0.4, 0.15, 0.15], 0.35),
    row(None, None, "plane|airplane|aircraft|helicopter|boat|ship|flugzeug|schiff|avion|bateau", &[[15.0, 12.0, 4.0]], [0.8, 0.8, 0.6], 1.2),
    row(None, Some(Class::Road), "road|street way|street curve|street deadend|street empty|street straight|crossroad|intersection|road piece|sidewalk|pavement|bridge|tunnel|straße|路", &[[12.0, 12.0, 0.6]], [0.5, 0.5, 1.2], 0.6),
];

/// A subject and the shapes that it may have here.
#[derive(Clone, Copy, Debug)]
pub(super) struct Expected {
    pub(super) subject: &'static Subject,
    pub(super) shapes: &'static [[f32; 3]],
}

impl Expected {
    /// People's shapes depend on what their file's name says they do.
    pub(super) fn of(subject: &'static Subject, file: &str) -> Self {
        let words = words(file);
        let said = |doing: &str| doing.split('|').any(|d| match_of(&words, d) > 0);
        let pose = POSES.iter().find(|(doing, _)| subject.shapes == PEOPLE && said(doing));
        Self { subject, shapes: pose.map_or(subject.shapes, |p| p.1) }
    }
}

/// A subject that a name speaks of.
#[derive(Clone, Copy, Debug)]
pub(super) struct Named {
    pub(super) subject: &'static Subject,
    /// 0 to 1.
    pub(super) confidence: f32,
    /// The phrase and where it was found.
    pub(super) phrase: &'static str,
    pub(super) in_folder: bool,
}

/// The subject of the longest phrase in a file's name, or else in its folders' names.
pub(super) fn named(relative: &str) -> Option<Named> {
    let (folders, file) = relative.rsplit_once('/').unwrap_or(("", relative));
    let stem = file.rsplit_once('.').map_or(file, |(stem, _)| stem);
    let best = |name: &str| {
        let words = words(name);
        let phrases = SUBJECTS.iter().flat_map(|s| s.phrases.split('|').map(move |p| (s, p)));
        let scored = phrases.map(|(s, p)| (match_of(&words, p), s, p)).filter(|(score, ..)| *score > 0);
        // Of equal ones the first counts, so that the table's order decides.
        scored.reduce(|a, b| if b.0 > a.0 { b } else { a })
    };
    let found = |(score, subject, phrase): (usize, &'static Subject, &'static str), in_folder: bool| {
        let whole = score > phrase.chars().filter(|c| *c != ' ').count();
        let confidence = if in_folder { 0.5 } else { 0.75 } + if whole { 0.2 } else { 0.0 };
        Named { subject, confidence, phrase, in_folder }
    };
    best(stem).map(|b| found(b, false)).or_else(|| best(folders).map(|b| found(b, true)))
}

/// The subject to measure a kind by that the user has named.
pub(super) fn of_kind(kind: Kind, class: Option<Class>) -> Option<&'static Subject> {
    let of = |class: Option<Class>| SUBJECTS.iter().find(|s| s.kind == Some(kind) && s.class == class);
    of(class.filter(|c| *c != kind.class())).or_else(|| of(None))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_of_many_packs_and_languages_say_what_they_show() {
        for (name, kind) in [
            ("pack/realistic_SUV.glb", Some(Kind::Car)),
            ("realistic_Cop_SUV.glb", Some(Kind::PoliceCar)),
            ("gazebo/bus_stop__head.glb", Some(Kind::Shelter)),
            ("gazebo/fire_truck.glb", Some(Kind::Truck)),
            ("gazebo/fire_hydrant.glb", Some(Kind::Hydrant)),
            ("person_Female_PickingUp.glb", Some(Kind::Adult)),
            ("quaternius-street/Streetlight_Double.glb", Some(Kind::StreetLamp)),
            ("stop_light_post.glb", Some(Kind::TrafficSignal)),
            ("SM_Prop_StopSign_01.fbx", Some(Kind::TrafficSign)),
            ("Feuerwehr.obj", Some(Kind::Truck)),
            ("小汽车.glb", Some(Kind::Car)),
            ("vehicles/model_17.obj", Some(Kind::Car)),
            ("jersey_barrier.glb", Some(Kind::Barrier)),
            ("post_office.glb", Some(Kind::Building)),
            ("postbox.glb", Some(Kind::StreetFurniture)),
        ] {
            assert_eq!(named(name).expect(name).subject.kind, kind, "{name}");
        }
        assert!(named("thing_42.glb").is_none());
        assert_eq!(named("Street_3Way.glb").expect("a road").subject.kind, None);
        assert_eq!(named("SUV.glb").expect("a jeep").subject.class, Some(Class::Jeep));
    }
}
