//! Who there is: bodies, faces, hair and clothes.

use glam::{Vec3, vec3};
use trove_model::Kind;

use super::build::Build;
use super::head::HairCut;
use super::outfit::{Bottom, Top};
use super::posture::Act;

/// Cloth, as [`super::fabric::Fabrics`] has it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Fabric {
    Woven,
    Denim,
    Knit,
    Striped,
    Checked,
    Printed,
    /// Waterproof.
    Coated,
}

/// A garment for the trunk.
#[derive(Clone, Copy, Debug)]
pub(super) struct Layer {
    pub(super) top: Top,
    pub(super) fabric: Fabric,
    pub(super) colours: &'static [Vec3],
    /// Open over the chest.
    pub(super) has_lapels: bool,
    /// With a collar that stands up.
    pub(super) has_collar: bool,
}

/// What is worn on the head.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Headgear {
    None,
    Cap,
    Helmet,
    PoliceCap,
    Scarf,
    Hood,
}

/// What is carried on the body.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Bag {
    None,
    Backpack,
    Satchel,
    Shopping,
    Briefcase,
    Umbrella,
}

/// Someone.
#[derive(Clone, Debug)]
pub(super) struct Person {
    pub(super) id: &'static str,
    pub(super) kind: Kind,
    pub(super) build: Build,
    pub(super) skins: &'static [Vec3],
    pub(super) hair: HairCut,
    pub(super) hairs: &'static [Vec3],
    /// 0 shaven, 1 a full beard.
    pub(super) beard: f32,
    /// From the innermost.
    pub(super) layers: Vec<Layer>,
    /// How far down the outermost goes on as a coat.
    pub(super) tail_m: Option<f32>,
    pub(super) bottom: Bottom,
    pub(super) bottom_fabric: Fabric,
    pub(super) bottoms: &'static [Vec3],
    /// How high the shoes reach in the body's own shape, and their colours.
    pub(super) shoes_to_m: f32,
    pub(super) shoes: &'static [Vec3],
    pub(super) has_tie: bool,
    pub(super) is_hi_vis: bool,
    pub(super) headgear: Headgear,
    pub(super) bag: Bag,
    pub(super) acts: &'static [Act],
    pub(super) commonness: f32,
}

const LIGHT: &[Vec3] = &[vec3(0.62, 0.41, 0.32), vec3(0.58, 0.38, 0.29), vec3(0.55, 0.35, 0.25), vec3(0.5, 0.3, 0.2)];
const EAST: &[Vec3] = &[vec3(0.6, 0.41, 0.29), vec3(0.55, 0.36, 0.25), vec3(0.5, 0.32, 0.21), vec3(0.42, 0.25, 0.16)];
const BROWN: &[Vec3] = &[vec3(0.4, 0.23, 0.145), vec3(0.33, 0.18, 0.11), vec3(0.27, 0.145, 0.085)];
const DARK: &[Vec3] = &[vec3(0.2, 0.105, 0.065), vec3(0.14, 0.073, 0.046), vec3(0.095, 0.05, 0.034)];

const BLACK_HAIR: &[Vec3] = &[vec3(0.014, 0.012, 0.011), vec3(0.02, 0.016, 0.013)];
const ANY_HAIR: &[Vec3] = &[
    vec3(0.02, 0.015, 0.012),
    vec3(0.045, 0.026, 0.016),
    vec3(0.085, 0.046, 0.024),
    vec3(0.06, 0.034, 0.02),
    vec3(0.26, 0.17, 0.08),
];
const GREY_HAIR: &[Vec3] = &[vec3(0.4, 0.4, 0.4), vec3(0.55, 0.55, 0.54), vec3(0.22, 0.21, 0.2)];

const SHIRTS: &[Vec3] = &[
    vec3(0.72, 0.72, 0.7),
    vec3(0.02, 0.02, 0.022),
    vec3(0.1, 0.1, 0.105),
    vec3(0.28, 0.28, 0.29),
    vec3(0.018, 0.03, 0.075),
    vec3(0.05, 0.1, 0.22),
    vec3(0.26, 0.37, 0.52),
    vec3(0.36, 0.03, 0.03),
    vec3(0.07, 0.11, 0.06),
    vec3(0.45, 0.36, 0.23),
    vec3(0.5, 0.4, 0.06),
];
const BRIGHT: &[Vec3] = &[
    vec3(0.7, 0.68, 0.64),
    vec3(0.5, 0.25, 0.28),
    vec3(0.35, 0.08, 0.12),
    vec3(0.2, 0.34, 0.42),
    vec3(0.05, 0.05, 0.055),
    vec3(0.52, 0.42, 0.3),
    vec3(0.1, 0.17, 0.14),
];
const SUITS: &[Vec3] =
    &[vec3(0.018, 0.02, 0.026), vec3(0.02, 0.028, 0.055), vec3(0.06, 0.062, 0.066), vec3(0.11, 0.105, 0.1)];
const WHITES: &[Vec3] = &[vec3(0.74, 0.74, 0.73), vec3(0.55, 0.63, 0.74), vec3(0.7, 0.66, 0.66)];
const JEANS: &[Vec3] =
    &[vec3(0.022, 0.034, 0.07), vec3(0.035, 0.06, 0.12), vec3(0.09, 0.14, 0.23), vec3(0.02, 0.02, 0.024)];
const CHINOS: &[Vec3] =
    &[vec3(0.3, 0.22, 0.14), vec3(0.05, 0.05, 0.052), vec3(0.09, 0.09, 0.07), vec3(0.03, 0.035, 0.05)];
const NAVY: &[Vec3] = &[vec3(0.012, 0.018, 0.045)];
const WORK: &[Vec3] = &[vec3(0.03, 0.04, 0.075), vec3(0.06, 0.065, 0.07), vec3(0.14, 0.12, 0.09)];
const RAIN: &[Vec3] = &[vec3(0.6, 0.42, 0.03), vec3(0.03, 0.06, 0.14), vec3(0.09, 0.14, 0.08), vec3(0.4, 0.05, 0.04)];
const COATS: &[Vec3] =
    &[vec3(0.02, 0.02, 0.023), vec3(0.28, 0.2, 0.12), vec3(0.09, 0.09, 0.095), vec3(0.05, 0.06, 0.09)];
pub(super) const SCARVES: &[Vec3] =
    &[vec3(0.025, 0.025, 0.03), vec3(0.5, 0.42, 0.36), vec3(0.2, 0.1, 0.13), vec3(0.1, 0.17, 0.22)];
const LEATHER: &[Vec3] = &[vec3(0.012, 0.011, 0.011), vec3(0.06, 0.03, 0.017)];
const SNEAKERS: &[Vec3] =
    &[vec3(0.7, 0.7, 0.68), vec3(0.03, 0.03, 0.033), vec3(0.2, 0.21, 0.23), vec3(0.06, 0.09, 0.2)];
const BOOTS: &[Vec3] = &[vec3(0.09, 0.05, 0.025), vec3(0.016, 0.015, 0.014)];

const TEE: Top = Top { sleeve: 0.62, neck_m: 0.015, hem_m: -0.005, wide: 0.5 };
const SHIRT: Top = Top { sleeve: 1.95, neck_m: 0.0, hem_m: 0.1, wide: 0.5 };
const SWEATER: Top = Top { sleeve: 2.0, neck_m: 0.01, hem_m: 0.0, wide: 0.8 };
const JACKET: Top = Top { sleeve: 1.98, neck_m: 0.0, hem_m: -0.008, wide: 0.8 };
const BLOUSE: Top = Top { sleeve: 1.5, neck_m: 0.05, hem_m: 0.085, wide: 0.5 };
const SLEEVELESS: Top = Top { sleeve: 0.14, neck_m: 0.045, hem_m: 0.09, wide: 0.25 };
const TO_WAIST: Top = Top { sleeve: 2.02, neck_m: 0.0, hem_m: 0.085, wide: 0.9 };

const STRAIGHT: Bottom = Bottom::Trousers { to: 1.95, hem_m: 0.078 };
const SLIM: Bottom = Bottom::Trousers { to: 1.9, hem_m: 0.056 };
const WIDE: Bottom = Bottom::Trousers { to: 1.96, hem_m: 0.095 };
const SHORTS: Bottom = Bottom::Trousers { to: 0.92, hem_m: 0.098 };
const SHOE_M: f32 = -0.73;
const BOOT_M: f32 = -0.64;

const fn layer(top: Top, fabric: Fabric, colours: &'static [Vec3]) -> Layer {
    Layer { top, fabric, colours, has_lapels: false, has_collar: false }
}

const fn collared(top: Top, fabric: Fabric, colours: &'static [Vec3]) -> Layer {
    Layer { has_collar: true, ..layer(top, fabric, colours) }
}

fn build(male: f32, years: f32, height: f32, weight: f32, muscle: f32, origins: [f32; 3]) -> Build {
    Build { male, years, muscle, weight, height, proportions: 0.7, origins }
}

const AFRICAN: [f32; 3] = [1.0, 0.0, 0.0];
const ASIAN: [f32; 3] = [0.0, 1.0, 0.0];
const EUROPEAN: [f32; 3] = [0.0, 0.0, 1.0];
const MIXED: [f32; 3] = [0.35, 0.2, 0.45];
const SOUTH_ASIAN: [f32; 3] = [0.2, 0.3, 0.5];

/// Everyone.
pub(super) fn persons() -> Vec<Person> {
    use Act::*;
    use Fabric::*;
    let plain = Person {
        id: "",
        kind: Kind::Adult,
        build: build(1.0, 30.0, 0.5, 0.5, 0.55, EUROPEAN),
        skins: LIGHT,
        hair: HairCut::Short,
        hairs: ANY_HAIR,
        beard: 0.1,
        layers: vec![layer(TEE, Woven, SHIRTS)],
        tail_m: None,
        bottom: STRAIGHT,
        bottom_fabric: Denim,
        bottoms: JEANS,
        shoes_to_m: SHOE_M,
        shoes: SNEAKERS,
        has_tie: false,
        is_hi_vis: false,
        headgear: Headgear::None,
        bag: Bag::None,
        acts: &[Easy],
        commonness: 1.0,
    };
    let lady = Person {
        build: build(0.0, 30.0, 0.5, 0.45, 0.5, EUROPEAN),
        hair: HairCut::Long,
        beard: 0.0,
        bottom: SLIM,
        ..plain.clone()
    };
    let suit = Layer { has_lapels: true, ..layer(JACKET, Woven, SUITS) };
    let shirt = collared(SHIRT, Woven, WHITES);
    let worker = Person {
        kind: Kind::ConstructionWorker,
        layers: vec![layer(SWEATER, Woven, WORK)],
        bottom_fabric: Woven,
        bottoms: WORK,
        shoes_to_m: BOOT_M,
        shoes: BOOTS,
        is_hi_vis: true,
        headgear: Headgear::Helmet,
        ..plain.clone()
    };
    let police = Person {
        kind: Kind::PoliceOfficer,
        layers: vec![collared(Top { sleeve: 1.95, ..SHIRT }, Woven, NAVY)],
        bottom_fabric: Woven,
        bottoms: NAVY,
        shoes: LEATHER,
        headgear: Headgear::PoliceCap,
        ..plain.clone()
    };
    let child = |male: f32, years: f32, origins| Person {
        kind: Kind::Child,
        build: build(male, years, 0.5, 0.45, 0.5, origins),
        beard: 0.0,
        ..plain.clone()
    };
    vec![
        Person { id: "adult/man-tee", acts: &[Easy, Pockets], ..plain.clone() },
        Person {
            id: "adult/man-business",
            build: build(1.0, 42.0, 0.6, 0.5, 0.5, EUROPEAN),
            layers: vec![shirt, suit],
            has_tie: true,
            bottom_fabric: Woven,
            bottoms: SUITS,
            shoes: LEATHER,
            bag: Bag::Briefcase,
            acts: &[Leaning, Phoning],
            ..plain.clone()
        },
        Person {
            id: "adult/man-business-2",
            build: build(1.0, 35.0, 0.45, 0.45, 0.5, ASIAN),
            skins: EAST,
            hairs: BLACK_HAIR,
            beard: 0.0,
            layers: vec![shirt, suit],
            bottom_fabric: Woven,
            bottoms: SUITS,
            shoes: LEATHER,
            acts: &[Clasped, LookingAtPhone],
            ..plain.clone()
        },
        Person {
            id: "adult/man-shirt",
            build: build(1.0, 38.0, 0.45, 0.75, 0.5, SOUTH_ASIAN),
            skins: BROWN,
            hairs: BLACK_HAIR,
            beard: 0.8,
            layers: vec![collared(Top { hem_m: 0.0, ..SHIRT }, Checked, SHIRTS)],
            bottom_fabric: Woven,
            bottoms: CHINOS,
            shoes: LEATHER,
            acts: &[HandsBehind, Pointing],
            ..plain.clone()
        },
        Person {
            id: "adult/man-hoodie",
            build: build(1.0, 22.0, 0.65, 0.4, 0.55, AFRICAN),
            skins: DARK,
            hair: HairCut::Cropped,
            hairs: BLACK_HAIR,
            layers: vec![layer(Top { wide: 1.0, ..SWEATER }, Knit, SHIRTS)],
            bag: Bag::Backpack,
            acts: &[Pockets, LookingAtPhone],
            ..plain.clone()
        },
        Person {
            id: "adult/man-shorts",
            build: build(1.0, 28.0, 0.5, 0.55, 0.65, MIXED),
            skins: BROWN,
            beard: 0.4,
            layers: vec![layer(TEE, Striped, SHIRTS)],
            bottom: SHORTS,
            bottom_fabric: Woven,
            bottoms: CHINOS,
            acts: &[Akimbo, Waving],
            ..plain.clone()
        },
        Person {
            id: "adult/man-coat",
            build: build(1.0, 50.0, 0.55, 0.6, 0.45, EUROPEAN),
            beard: 0.6,
            layers: vec![shirt, Layer { has_lapels: true, ..layer(TO_WAIST, Knit, COATS) }],
            tail_m: Some(-0.27),
            bottom_fabric: Woven,
            bottoms: SUITS,
            shoes: LEATHER,
            acts: &[HandsBehind, Clasped],
            ..plain.clone()
        },
        Person {
            id: "adult/man-old",
            build: build(1.0, 76.0, 0.4, 0.55, 0.35, EUROPEAN),
            hair: HairCut::Receding,
            hairs: GREY_HAIR,
            layers: vec![collared(JACKET, Woven, CHINOS)],
            bottom_fabric: Woven,
            bottoms: CHINOS,
            shoes: LEATHER,
            headgear: Headgear::Cap,
            bag: Bag::Shopping,
            acts: &[Leaning, Sitting],
            ..plain.clone()
        },
        Person {
            id: "adult/man-stout",
            build: build(1.0, 48.0, 0.5, 0.95, 0.45, MIXED),
            skins: BROWN,
            hair: HairCut::Receding,
            beard: 0.9,
            layers: vec![layer(Top { wide: 0.9, ..TEE }, Woven, SHIRTS)],
            acts: &[ArmsCrossed, Carrying],
            ..plain.clone()
        },
        Person {
            id: "adult/man-young",
            build: build(1.0, 19.0, 0.45, 0.35, 0.5, ASIAN),
            skins: EAST,
            hairs: BLACK_HAIR,
            beard: 0.0,
            layers: vec![layer(Top { wide: 1.0, hem_m: -0.02, ..TEE }, Woven, SHIRTS)],
            bottom: SLIM,
            bag: Bag::Backpack,
            acts: &[LookingAtPhone, Sitting],
            ..plain.clone()
        },
        Person {
            id: "adult/woman-tee",
            layers: vec![layer(TEE, Woven, BRIGHT)],
            bag: Bag::Satchel,
            acts: &[Easy, Phoning],
            ..lady.clone()
        },
        Person {
            id: "adult/woman-business",
            build: build(0.0, 36.0, 0.55, 0.45, 0.5, EUROPEAN),
            hair: HairCut::Bun,
            layers: vec![layer(BLOUSE, Woven, WHITES), suit],
            bottom_fabric: Woven,
            bottoms: SUITS,
            shoes: LEATHER,
            bag: Bag::Satchel,
            acts: &[Clasped, LookingAtPhone],
            ..lady.clone()
        },
        Person {
            id: "adult/woman-skirt",
            build: build(0.0, 29.0, 0.45, 0.4, 0.45, ASIAN),
            skins: EAST,
            hairs: BLACK_HAIR,
            hair: HairCut::Bob,
            layers: vec![layer(BLOUSE, Woven, BRIGHT)],
            bottom: Bottom::Skirt { hem_m: -0.36 },
            bottom_fabric: Woven,
            bottoms: CHINOS,
            shoes: LEATHER,
            acts: &[Leaning, Waving],
            ..lady.clone()
        },
        Person {
            id: "adult/woman-dress",
            build: build(0.0, 26.0, 0.5, 0.5, 0.5, MIXED),
            skins: BROWN,
            layers: vec![layer(SLEEVELESS, Printed, BRIGHT)],
            bottom: Bottom::Skirt { hem_m: -0.4 },
            bottom_fabric: Printed,
            bottoms: BRIGHT,
            acts: &[Easy, Bending],
            ..lady.clone()
        },
        Person {
            id: "adult/woman-sweater",
            build: build(0.0, 45.0, 0.45, 0.7, 0.45, EUROPEAN),
            hair: HairCut::Bob,
            layers: vec![layer(SWEATER, Knit, BRIGHT)],
            bag: Bag::Shopping,
            acts: &[ArmsCrossed, Pointing],
            ..lady.clone()
        },
        Person {
            id: "adult/woman-headscarf",
            build: build(0.0, 33.0, 0.45, 0.55, 0.45, SOUTH_ASIAN),
            skins: BROWN,
            hair: HairCut::Covered,
            layers: vec![layer(TO_WAIST, Woven, COATS)],
            bottom: Bottom::Skirt { hem_m: -0.66 },
            bottom_fabric: Woven,
            bottoms: COATS,
            headgear: Headgear::Scarf,
            acts: &[Clasped, Phoning],
            ..lady.clone()
        },
        Person {
            id: "adult/woman-raincoat",
            build: build(0.0, 31.0, 0.55, 0.45, 0.5, EUROPEAN),
            hair: HairCut::Covered,
            layers: vec![layer(TO_WAIST, Coated, RAIN)],
            tail_m: Some(-0.22),
            shoes_to_m: BOOT_M,
            shoes: BOOTS,
            headgear: Headgear::Hood,
            acts: &[Pockets],
            commonness: 0.5,
            ..lady.clone()
        },
        Person {
            id: "adult/woman-umbrella",
            build: build(0.0, 40.0, 0.5, 0.5, 0.45, ASIAN),
            skins: EAST,
            hairs: BLACK_HAIR,
            hair: HairCut::Tail,
            layers: vec![collared(JACKET, Coated, COATS)],
            bag: Bag::Umbrella,
            acts: &[Easy],
            commonness: 0.05,
            ..lady.clone()
        },
        Person {
            id: "adult/woman-old",
            build: build(0.0, 74.0, 0.4, 0.6, 0.35, EUROPEAN),
            hair: HairCut::Short,
            hairs: GREY_HAIR,
            layers: vec![collared(JACKET, Woven, BRIGHT)],
            bottom: WIDE,
            bottom_fabric: Woven,
            bottoms: CHINOS,
            shoes: LEATHER,
            bag: Bag::Satchel,
            acts: &[Leaning, Sitting],
            ..lady.clone()
        },
        Person {
            id: "adult/woman-runner",
            build: build(0.0, 27.0, 0.55, 0.35, 0.65, AFRICAN),
            skins: DARK,
            hair: HairCut::Afro,
            hairs: BLACK_HAIR,
            layers: vec![layer(Top { sleeve: 0.4, wide: 0.2, ..TEE }, Woven, BRIGHT)],
            bottom_fabric: Woven,
            bottoms: SUITS,
            acts: &[Akimbo, Bending],
            ..lady.clone()
        },
        Person {
            id: "child/boy",
            bottom: SHORTS,
            bottom_fabric: Woven,
            bottoms: CHINOS,
            acts: &[Easy, Waving],
            ..child(1.0, 8.0, EUROPEAN)
        },
        Person {
            id: "child/girl",
            hair: HairCut::Tail,
            layers: vec![layer(Top { sleeve: 0.5, hem_m: 0.09, ..TEE }, Printed, BRIGHT)],
            bottom: Bottom::Skirt { hem_m: -0.3 },
            bottom_fabric: Printed,
            bottoms: BRIGHT,
            acts: &[Leaning, Bending],
            ..child(0.0, 7.0, EUROPEAN)
        },
        Person {
            id: "child/boy-school",
            skins: EAST,
            hairs: BLACK_HAIR,
            layers: vec![layer(SWEATER, Knit, SHIRTS)],
            bag: Bag::Backpack,
            acts: &[Pockets, Pointing],
            ..child(1.0, 11.0, ASIAN)
        },
        Person {
            id: "child/girl-school",
            skins: DARK,
            hairs: BLACK_HAIR,
            hair: HairCut::Bun,
            layers: vec![layer(TEE, Striped, BRIGHT)],
            bottom: SLIM,
            bag: Bag::Backpack,
            acts: &[Easy, LookingAtPhone],
            ..child(0.0, 12.0, AFRICAN)
        },
        Person { id: "worker/man", acts: &[Akimbo, Pointing, Carrying], ..worker.clone() },
        Person {
            id: "worker/man-2",
            build: build(1.0, 44.0, 0.45, 0.7, 0.6, SOUTH_ASIAN),
            skins: BROWN,
            hairs: BLACK_HAIR,
            beard: 0.7,
            acts: &[Leaning, Bending],
            ..worker.clone()
        },
        Person {
            id: "worker/woman",
            build: build(0.0, 33.0, 0.5, 0.5, 0.6, MIXED),
            hair: HairCut::Tail,
            beard: 0.0,
            acts: &[Easy, ArmsCrossed],
            ..worker
        },
        Person {
            id: "police/man",
            build: build(1.0, 36.0, 0.65, 0.55, 0.65, EUROPEAN),
            acts: &[Akimbo, Pointing],
            ..police.clone()
        },
        Person {
            id: "police/woman",
            build: build(0.0, 32.0, 0.55, 0.5, 0.6, MIXED),
            skins: BROWN,
            hair: HairCut::Bun,
            beard: 0.0,
            acts: &[HandsBehind, Phoning],
            ..police
        },
    ]
}
