use std::path::Path;
use std::sync::LazyLock;

use proptest::prelude::*;
use trove_model::{DrivingSide, LinePattern, Paint, SpeedUnit};

use super::*;

/// Towns within 20 km of a border or a strait: name, latitude and longitude in degrees, country, whether it drives on the
/// left.
#[rustfmt::skip]
const TOWNS: [(&str, f64, f64, &str, bool); 83] = [
    ("Dover",              51.127,    1.313, "GB", true),
    ("Folkestone",         51.081,    1.166, "GB", true),
    ("Calais",             50.951,    1.858, "FR", false),
    ("Boulogne-sur-Mer",   50.726,    1.614, "FR", false),
    ("Strasbourg",         48.573,    7.752, "FR", false),
    ("Kehl",               48.573,    7.815, "DE", false),
    ("Basel",              47.556,    7.590, "CH", false),
    ("Lörrach",            47.616,    7.661, "DE", false),
    ("Saint-Louis",        47.585,    7.560, "FR", false),
    ("Geneva",             46.204,    6.143, "CH", false),
    ("Annemasse",          46.194,    6.237, "FR", false),
    ("Aachen",             50.776,    6.084, "DE", false),
    ("Maastricht",         50.851,    5.691, "NL", false),
    ("Vaals",              50.771,    6.016, "NL", false),
    ("Liège-Visé",         50.736,    5.696, "BE", false),
    ("Salzburg",           47.800,   13.045, "AT", false),
    ("Freilassing",        47.842,   12.979, "DE", false),
    ("Vaduz",              47.141,    9.522, "LI", false),
    ("Buchs SG",           47.168,    9.478, "CH", false),
    ("Feldkirch",          47.238,    9.598, "AT", false),
    ("Monaco",             43.738,    7.424, "MC", false),
    ("Menton",             43.775,    7.500, "FR", false),
    ("Ventimiglia",        43.791,    7.608, "IT", false),
    ("Trieste",            45.650,   13.777, "IT", false),
    ("Koper",              45.548,   13.730, "SI", false),
    ("Gibraltar",          36.140,   -5.353, "GI", false),
    ("La Línea",           36.168,   -5.348, "ES", false),
    ("Copenhagen",         55.676,   12.568, "DK", false),
    ("Malmö",              55.605,   13.003, "SE", false),
    ("Narva",              59.377,   28.190, "EE", false),
    ("Ivangorod",          59.376,   28.223, "RU", false),
    ("Newry",              54.176,   -6.337, "GB", true),
    ("Dundalk",            54.004,   -6.405, "IE", true),
    ("Derry",              54.998,   -7.320, "GB", true),
    ("Letterkenny Bridgend", 55.040, -7.380, "IE", true),
    ("Saint Helier",       49.186,   -2.107, "JE", true),
    ("Nicosia",            35.165,   33.360, "CY", true),
    ("Detroit",            42.332,  -83.047, "US", false),
    ("Windsor",            42.300,  -83.016, "CA", false),
    ("Niagara Falls, NY",  43.095,  -79.040, "US", false),
    ("Niagara Falls, ON",  43.090,  -79.085, "CA", false),
    ("San Diego",          32.560, -117.050, "US", false),
    ("Tijuana",            32.520, -117.030, "MX", false),
    ("El Paso",            31.770, -106.490, "US", false),
    ("Ciudad Juárez",      31.720, -106.460, "MX", false),
    ("Charlotte Amalie",   18.342,  -64.931, "VI", true),
    ("Culebra",            18.303,  -65.301, "PR", false),
    ("Delhi",              28.614,   77.209, "IN", true),
    ("Lahore",             31.550,   74.343, "PK", true),
    ("Amritsar",           31.634,   74.872, "IN", true),
    ("Kabul",              34.528,   69.172, "AF", false),
    ("Torkham",            34.140,   71.070, "AF", false),
    ("Peshawar-Landi Kotal", 34.098, 71.143, "PK", true),
    ("Lhasa",              29.652,   91.172, "CN", false),
    ("Mae Sai",            20.425,   99.883, "TH", true),
    ("Tachileik",          20.455,   99.880, "MM", false),
    ("Vientiane",          17.966,  102.613, "LA", false),
    ("Nong Khai",          17.878,  102.741, "TH", true),
    ("Aranyaprathet",      13.690,  102.503, "TH", true),
    ("Poipet",             13.655,  102.567, "KH", false),
    ("Hanoi",              21.028,  105.854, "VN", false),
    ("Dongxing",           21.548,  107.970, "CN", false),
    ("Singapore Woodlands", 1.437,  103.786, "SG", true),
    ("Johor Bahru",         1.465,  103.757, "MY", true),
    ("Hong Kong",          22.300,  114.170, "HK", true),
    ("Sheung Shui",        22.502,  114.128, "HK", true),
    ("Shenzhen",           22.543,  114.060, "CN", false),
    ("Macao",              22.195,  113.545, "MO", true),
    ("Zhuhai",             22.270,  113.570, "CN", false),
    ("Seoul",              37.567,  126.978, "KR", false),
    ("Kaesong",            37.971,  126.555, "KP", false),
    ("Fukuoka-Tsushima",   34.205,  129.288, "JP", true),
    ("Vladivostok",        43.116,  131.883, "RU", false),
    ("Kigali",             -1.950,   30.059, "RW", false),
    ("Goma",               -1.679,   29.229, "CD", false),
    ("Gisenyi",            -1.702,   29.256, "RW", false),
    ("Kabale-Katuna",      -1.414,   30.013, "UG", true),
    ("Livingstone",       -17.850,   25.860, "ZM", true),
    ("Victoria Falls",    -17.932,   25.830, "ZW", true),
    ("Kazungula",         -17.797,   25.250, "BW", true),
    ("Oshikango",         -17.400,   15.880, "NA", true),
    ("Ondjiva-Santa Clara", -17.370, 15.870, "AO", false),
    ("Dili-Batugade",      -8.960,  124.960, "TL", true),
];

static LOCALES: LazyLock<Locales> = LazyLock::new(Locales::built_in);

fn at(lat_deg: f64, lon_deg: f64) -> Locale {
    LOCALES.at(lat_deg, lon_deg, &Report::default())
}

#[test]
fn towns_near_borders_lie_in_their_own_country_and_drive_on_its_side() {
    let (locales, report) = (&*LOCALES, Report::default());
    for (town, lat_deg, lon_deg, country, left) in TOWNS {
        let locale = locales.at(lat_deg, lon_deg, &report);
        assert_eq!((locale.country.as_deref(), locale.driving_side.is_left()), (Some(country), left), "{town}");
    }
    assert!(report.entries().is_empty(), "{:?}", report.entries());
}

#[test]
fn every_country_drives_on_its_own_side() {
    // Countries and territories with left-hand traffic.
    let left = "AC AG AI AU BB BD BM BN BS BT BW CC CK CX CY DM FJ FK GB GD GG GS GY HK ID IE IM IN JE JM JP KE KI KN KY LC \
        LK LS MO MS MT MU MV MW MY MZ NA NF NP NR NU NZ PG PK PN SB SC SG SH SR SZ TA TC TH TK TL TO TT TV TZ UG VC VG VI \
        WS ZA ZM ZW";
    let left: Vec<&str> = left.split_whitespace().collect();
    let locales = &*LOCALES;
    for code in locales.codes() {
        let side = locales.country(code).unwrap().driving_side;
        assert_eq!(side, if left.contains(&code) { DrivingSide::Left } else { DrivingSide::Right }, "{code}");
    }
    assert!(left.iter().all(|code| locales.country(code).is_some()));
}

#[test]
fn every_country_with_borders_has_a_row() {
    let locales = &*LOCALES;
    let countries: Vec<&str> = borders::codes().into_iter().filter(|code| code.len() == 2).collect();
    assert!(countries.len() > 230, "{}", countries.len());
    let missing: Vec<&str> = countries.into_iter().filter(|code| locales.country(code).is_none()).collect();
    assert!(missing.is_empty(), "{missing:?}");
}

#[test]
fn towns_are_painted_as_their_countries_do() {
    let solid = |locale: &Locale| locale.markings.centre.narrow == LinePattern::Solid;
    for (town, lat_deg, lon_deg, dash_m, centre, crossing) in [
        ("Boston", 42.35, -71.05, 3.05, Paint::Yellow, Paint::White),
        ("Windsor", 42.300, -83.016, 3.05, Paint::Yellow, Paint::White),
        ("Lima", -12.05, -77.04, 3.0, Paint::Yellow, Paint::White),
        ("Singapore", 1.29, 103.78, 2.0, Paint::White, Paint::White),
        ("Folkestone", 51.081, 1.166, 2.0, Paint::White, Paint::White),
        ("Belfast", 54.597, -5.930, 2.0, Paint::White, Paint::White),
        ("Neukölln", 52.47, 13.44, 3.0, Paint::White, Paint::White),
        ("Basel", 47.556, 7.590, 3.0, Paint::White, Paint::Yellow),
        ("Taipei", 25.05, 121.52, 4.0, Paint::Yellow, Paint::White),
        ("Tsushima", 34.205, 129.288, 5.0, Paint::White, Paint::White),
        ("Busan", 35.18, 129.08, 3.0, Paint::Yellow, Paint::White),
        ("Cairo", 30.04, 31.24, 3.0, Paint::White, Paint::White),
    ] {
        let markings = at(lat_deg, lon_deg).markings;
        assert_eq!(
            (markings.lane.dash_m, markings.centre.paint, markings.crossing_paint),
            (dash_m, centre, crossing),
            "{town}"
        );
    }
    // France's lines between lanes are broken by gaps of ten metres, and solid between directions of wide roads.
    for (town, lat_deg, lon_deg) in
        [("Boulogne", 50.726, 1.614), ("Strasbourg", 48.573, 7.752), ("Monaco", 43.738, 7.424)]
    {
        let markings = at(lat_deg, lon_deg).markings;
        assert_eq!((markings.lane.gap_m, markings.centre.wide), (10.0, LinePattern::Solid), "{town}");
    }
    assert!(solid(&at(37.567, 126.978)), "Seoul");
}

#[test]
fn limits_are_written_in_the_country_s_unit() {
    for (town, lat_deg, lon_deg, unit, limit_kmh, written) in [
        ("Boston", 42.35, -71.05, SpeedUnit::Mph, 40.23, 25.0),
        ("Detroit", 42.332, -83.047, SpeedUnit::Mph, 56.33, 35.0),
        ("Windsor", 42.300, -83.016, SpeedUnit::Kmh, 50.0, 50.0),
        ("Toronto", 43.65, -79.38, SpeedUnit::Kmh, 40.0, 40.0),
        ("Tijuana", 32.520, -117.030, SpeedUnit::Kmh, 40.0, 40.0),
        ("Dover", 51.127, 1.313, SpeedUnit::Mph, 48.28, 30.0),
        ("Belfast", 54.597, -5.930, SpeedUnit::Mph, 32.19, 20.0),
        ("Newry", 54.176, -6.337, SpeedUnit::Mph, 48.28, 30.0),
        ("Dundalk", 54.004, -6.405, SpeedUnit::Kmh, 50.0, 50.0),
        ("Gibraltar", 36.140, -5.353, SpeedUnit::Kmh, 50.0, 50.0),
        ("Calais", 50.951, 1.858, SpeedUnit::Kmh, 30.0, 30.0),
        ("Taipei", 25.05, 121.52, SpeedUnit::Kmh, 50.0, 50.0),
        ("Singapore", 1.3, 103.79, SpeedUnit::Kmh, 70.0, 70.0),
    ] {
        let found = at(lat_deg, lon_deg).signs.speed_unit;
        assert_eq!((found, found.written(limit_kmh)), (unit, written), "{town}");
    }
}

#[test]
fn kerbs_and_traffic_are_those_of_the_country() {
    for (town, lat_deg, lon_deg, kerb_m, motorcycling) in [
        ("Boston", 42.35, -71.05, 0.15, 0.02),
        ("Singapore", 1.29, 103.78, 0.12, 0.18),
        ("Seoul", 37.567, 126.978, 0.15, 0.14),
        ("Vladivostok", 43.116, 131.883, 0.12, 0.02),
        ("Monaco", 43.738, 7.424, 0.12, 0.11),
    ] {
        let locale = at(lat_deg, lon_deg);
        assert_eq!((locale.kerb.height_m, locale.traffic.motorcycling), (kerb_m, motorcycling), "{town}");
    }
}

#[test]
fn at_sea_the_nearest_country_counts_and_is_reported() {
    let (locales, report) = (&*LOCALES, Report::default());
    let locale = locales.at(36.5, -9.6, &report);
    assert_eq!(locale.country.as_deref(), Some("PT"));
    assert_eq!(report.entries().len(), 1);
    let ocean = locales.at(-48.9, -123.4, &report);
    assert_eq!((ocean.country, ocean.driving_side), (None, DrivingSide::Right));
    assert_eq!(report.entries().len(), 2);
}

proptest! {
    #[test]
    fn any_position_has_customs(lat_deg in prop::num::f64::ANY, lon_deg in prop::num::f64::ANY) {
        let locale = at(lat_deg, lon_deg);
        prop_assert!(locale.kerb.height_m > 0.0);
    }

    #[test]
    fn any_position_on_earth_has_customs(lat_deg in -90.0..=90.0_f64, lon_deg in -540.0..=540.0_f64) {
        let (here, around) = (at(lat_deg, lon_deg), at(lat_deg, lon_deg + 360.0));
        prop_assert!(here.traffic.walking > 0.0);
        prop_assert_eq!(here.driving_side, around.driving_side);
    }
}

fn extended(text: &str) -> Result<Locales, String> {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("locales.toml");
    std::fs::write(&path, text).unwrap();
    Locales::with_file(&path).map_err(|error| error.to_string())
}

#[test]
fn a_user_s_rows_stand_over_the_built_in_ones() {
    let text = "[SE]\nkerb.height_m = 0.2\n\
        [nordic]\nlike = \"northern-europe\"\ncountries = [\"DK\", \"NO\"]\nsigns.style = \"nordic\"\n\
        [DK]\nmarkings.crossing_paint = \"yellow\"\n[US-HI]\nlike = \"US\"\nkerb.height_m = 0.1\n";
    let (built_in, locales) = (&*LOCALES, extended(text).unwrap());
    let (before, sweden) = (built_in.country("SE").unwrap(), locales.country("SE").unwrap());
    assert_eq!(sweden.kerb.height_m, 0.2);
    assert_eq!((&sweden.markings, &sweden.buildings), (&before.markings, &before.buildings));
    let denmark = locales.country("DK").unwrap();
    assert_eq!((denmark.signs.style.as_str(), denmark.markings.crossing_paint), ("nordic", Paint::Yellow));
    // Listed by the user, Norway is as its new group is.
    assert_eq!(locales.country("NO").unwrap().markings.centre.paint, Paint::White);
    let at = |lat_deg, lon_deg| locales.at(lat_deg, lon_deg, &Report::default());
    assert_eq!((at(21.31, -157.86).kerb.height_m, at(34.05, -118.24).kerb.height_m), (0.1, 0.15));
    assert_eq!(at(21.31, -157.86).country.as_deref(), Some("US-HI"));
    for code in ["FR", "GB", "SG"] {
        assert_eq!(locales.country(code), built_in.country(code), "{code}");
    }
}

#[test]
fn mistakes_in_a_user_s_table_are_named() {
    for (text, place, what) in [
        ("[SE]\nkerb.hight_m = 0.2\n", "[SE]", "did you mean \"height_m\"?"),
        ("[SE]\nkerbs.height_m = 0.2\n", "[SE]", "did you mean \"kerb\"?"),
        ("[SE]\ncountry = \"SE\"\n", "[SE]", "the row's name is the code"),
        ("[SE]\nmarkings.crossing_paint = \"yelow\"\n", "[SE]", "did you mean \"yellow\"?"),
        ("[UK]\nlike = \"GB\"\n", "[UK]", "an ISO 3166 code"),
        ("[SE]\nlike = \"northern-europa\"\n", "[SE] like", "did you mean \"northern-europe\"?"),
        ("[SE]\nmarkings.like = \"britan\"\n", "[SE]", "did you mean \"britain\"?"),
        ("[SE]\nlike = \"NO\"\n[NO]\nlike = \"SE\"\n", "like", "not like itself"),
        ("[north]\nlike = \"vienna\"\ncountries = [\"se\"]\n", "[north] countries", "\"se\""),
        (
            "[a]\nlike = \"vienna\"\ncountries = [\"SE\"]\n[b]\nlike = \"vienna\"\ncountries = [\"SE\"]\n",
            "countries",
            "SE",
        ),
        ("[SE]\nkerb.height_m = \"high\"\n", "[SE]", "expected"),
        ("[SE]\nkerb.height_m = -0.1\n", "[SE] kerb height_m", "a number from 0 to 1000"),
        ("[SE]\nstreet.small_spacing_m = [5.0, nan]\n", "[SE] street small_spacing_m", "a number from 0 to 1000"),
        ("[SE]\nsurfaces.sidewalk = []\n", "[SE] surfaces sidewalk", "at least one"),
        ("[SE]\nlamps.main.models = []\n", "[SE] lamps main models", "at least one"),
        ("[SE\n", "line 1", "a table of locales"),
        ("SE = 1\n", "SE", "a row"),
    ] {
        let message = extended(text).unwrap_err();
        assert!(message.contains("locales.toml") && message.contains(place) && message.contains(what), "{message}");
    }
    let missing = Locales::with_file(Path::new("no/such.toml")).unwrap_err().to_string();
    assert!(missing.contains("no/such.toml"), "{missing}");
}
