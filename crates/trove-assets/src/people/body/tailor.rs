//! One person: shaped, dressed at rest, then posed.

use glam::{Vec2, Vec3, vec3};
use rayon::prelude::*;
use trove_model::{Asset, Figure, Keypoints, Kind, Material, Mesh, Posture, Seed, Slot};

use super::carried::Held;
use super::fabric::Fabrics;
use super::head::Face;
use super::outfit::{Bottom, Cutter, Top, WAIST_M, bare};
use super::plan::{Bag, Dye, Fabric, Headgear, Layer, PersonKind, PersonPlan};
use super::posture::Act;
use super::stance::Arm;
use super::stock::Stock;
use super::wearer::{Cut, Piece, Wearer, normals};

/// A person dressed, with the slots of what they wear.
struct Dressed<'a> {
    wearer: Wearer<'a>,
    pieces: Vec<Piece>,
    slots: Vec<Slot>,
    held: Option<(Held, [u16; 3])>,
    /// Slots of a phone, and of a box to carry.
    phone: u16,
    parcel: u16,
}

/// A person's assets, one a posture.
pub(super) fn assets(stock: &Stock<'_>, person: &PersonPlan) -> Vec<Asset> {
    let dressed = Dressed::new(stock, person);
    let acts: Vec<Act> = person.acts.iter().copied().chain(Act::cycles()).collect();
    let licence = format!("{}; shaped, dressed and posed by TRoVE", stock.body.licence);
    let assets = acts.par_iter().map(|&act| {
        let (mesh, posture, keypoints) = dressed.posed(act);
        let mut used = vec![false; dressed.slots.len()];
        mesh.slots.iter().for_each(|&s| used[usize::from(s)] = true);
        let number = |s: u16| used[..usize::from(s)].iter().filter(|u| **u).count() as u16;
        let slots = dressed.slots.iter().zip(&used).filter(|(_, used)| **used).map(|(slot, _)| slot.clone()).collect();
        let mesh = Mesh { slots: mesh.slots.iter().map(|&s| number(s)).collect(), ..mesh };
        let kind: Kind = person.kind.into();
        let asset = Asset {
            commonness: person.commonness,
            worn_in: person.worn_in.iter().copied().map(Into::into).collect(),
            figure: Some(Figure { person: person.id.clone(), posture }),
            keypoints: Some(keypoints),
            ..Asset::new(&format!("{}-{}", person.id, act.name()), kind, kind.class(), mesh, slots, &licence)
        };
        asset.tagged(&person.tags)
    });
    assets.collect()
}

impl<'a> Dressed<'a> {
    fn new(stock: &Stock<'a>, person: &PersonPlan) -> Self {
        let seed = Seed(5).child(&person.id);
        let body = stock.body;
        let wearer = Wearer::new(body, person.build.shape(body, seed.child("face")), seed.child("cloth"));
        let mut slots: Vec<Slot> = Vec::new();
        let mut slot = |material: Material, paints: &[Vec3]| {
            let base_color = paints.first().copied().unwrap_or(material.base_color);
            slots.push(Slot::new(Material { base_color, ..material }, paints.to_vec()));
            slots.len() as u16 - 1
        };
        let mut pieces = Vec::new();
        let cutter = &stock.cutter;

        // Skin where nothing covers it.
        let skin = slot(face_of(person).material(), &paints(&person.skin));
        let feet = |p: Vec3| if cutter.along_arm(p) > 0.0 { -1.0 } else { Cutter::in_shoes(person.shoes.to_m, p) };
        let covered = |p: Vec3| {
            let tops = person.top.iter().map(|l| {
                let under = cutter.under_top(&l.cut(), p);
                if l.has_lapels { under.min(-Cutter::lapels(p)) } else { under }
            });
            tops.fold(cutter.under_bottom(&person.bottom.cut, p).max(feet(p)), f32::max)
        };
        pieces.push(wearer.skin(&bare(body, &stock.skin, covered), skin));
        let iris = if person.build.origins[2] > 0.8 && seed.0.is_multiple_of(2) {
            vec3(0.12, 0.16, 0.2)
        } else {
            vec3(0.05, 0.028, 0.015)
        };
        let eye = slot(Material { coat: 0.8, ..Material::plain("eye", Vec3::ONE, 0.25) }, &[]);
        pieces.extend(wearer.eyes(iris, eye));
        let hair = slot(stock.fabrics.hair.clone(), &paints(&person.hair));
        pieces.extend(wearer.hair(person.hair_cut, &stock.skin, hair));

        // Clothes, from the innermost.
        let bottom = slot(cloth(&stock.fabrics, person.bottom.fabric), &paints(&person.bottom.dye));
        let trousers = pieces.len();
        pieces.push(bottom_piece(stock, &wearer, person, bottom));
        let shoes = slot(
            Material { coat: 0.2, ..Material::plain("shoes", Vec3::splat(0.1), 0.5) },
            &vectors(&person.shoes.colors),
        );
        pieces.push(shoes_piece(stock, &wearer, person.shoes.to_m, shoes));
        let leather = slot(
            Material::plain("leather", Vec3::splat(0.02), 0.5),
            &[vec3(0.014, 0.013, 0.013), vec3(0.05, 0.025, 0.014), vec3(0.16, 0.075, 0.03)],
        );
        let is_dress = matches!(person.bottom.cut, Bottom::Skirt { .. })
            && person.bottom.dye.colors == person.top[0].dye.colors
            && person.top.len() == 1;
        let mut outermost = bottom;
        let mut tops = Vec::new();
        let count = person.top.len();
        for (i, layer) in person.top.iter().enumerate() {
            let is_outer = i + 1 == count;
            outermost = if is_dress { bottom } else { slot(cloth(&stock.fabrics, layer.fabric), &paints(&layer.dye)) };
            tops.push(pieces.len());
            pieces.extend(layer_pieces(stock, &wearer, layer, is_outer, outermost));
        }
        let (innermost, outer) = (tops[0], tops[count - 1]);
        if let Some(to_m) = person.tail_m {
            let cut = Cut { ease_m: 0.022, sleeve_m: [0.0; 3], leg_m: [0.0; 3], drape: 0.0, folds_m: 0.003 };
            let pattern = stock.skirt.cut(body, |p| (WAIST_M - 0.004 - p.z).min(p.z - to_m));
            pieces.push(flared(wearer.cloth(&pattern, &cut, outermost), 0.018));
        }
        let is_tucked = person.top.iter().all(|l| l.hem_m > 0.05);
        let has_belt = is_tucked && matches!(person.bottom.cut, Bottom::Trousers { .. });
        if has_belt || person.tail_m.is_some() {
            let (ease_m, slot) = if person.tail_m.is_some() { (0.04, outermost) } else { (0.021, leather) };
            pieces.push(band(stock, &wearer, [WAIST_M - 0.025, WAIST_M + 0.012], ease_m, slot));
        }
        if person.has_tie {
            let tie = slot(
                Material { sheen: 0.5, ..Material::plain("tie", NAVY, 0.5) },
                &[NAVY, vec3(0.2, 0.012, 0.02), vec3(0.03, 0.03, 0.035)],
            );
            let path = [vec3(0.085, 0.0, 0.545), vec3(0.13, 0.0, 0.48), vec3(0.16, 0.0, 0.38), vec3(0.17, 0.0, 0.26)];
            let knot = wearer.strap(&path, &[&pieces[innermost]], 0.06, tie);
            pieces.push(knot);
        }
        if person.is_hi_vis {
            let vest = slot(
                cloth(&stock.fabrics, Fabric::Woven),
                &[vec3(0.85, 0.24, 0.015), vec3(0.6, 0.8, 0.03), vec3(0.6, 0.8, 0.03)],
            );
            let silver = slot(Material::plain("reflective band", Vec3::splat(0.78), 0.35), &[]);
            pieces.extend(vest_pieces(stock, &wearer, vest, silver));
        }
        match person.headgear {
            Headgear::None => {}
            Headgear::Cap => {
                let cap = slot(stock.fabrics.woven.clone(), &[NAVY, vec3(0.4, 0.36, 0.3), vec3(0.05, 0.05, 0.05)]);
                pieces.push(wearer.cap(cap));
            }
            Headgear::Helmet => {
                let shell = Material { coat: 0.6, ..Material::plain("helmet", vec3(0.8, 0.55, 0.02), 0.4) };
                let helmet = slot(
                    shell,
                    &[vec3(0.8, 0.55, 0.02), vec3(0.76, 0.76, 0.74), vec3(0.75, 0.22, 0.01), vec3(0.03, 0.1, 0.35)],
                );
                pieces.push(wearer.helmet(helmet));
            }
            Headgear::PoliceCap => {
                let badge = slot(Material { metalness: 1.0, ..Material::plain("badge", Vec3::splat(0.6), 0.3) }, &[]);
                pieces.extend(wearer.police_cap(outermost, badge));
            }
            Headgear::Scarf => {
                let scarf = slot(stock.fabrics.woven.clone(), &SCARVES);
                pieces.push(wearer.headscarf(&stock.skin, 0.016, scarf));
                let cape = Top { sleeve: 0.03, neck_m: -0.04, hem_m: 0.45, wide: 1.0 };
                let cut = Cut { ease_m: 0.03, sleeve_m: [0.0; 3], leg_m: [0.0; 3], drape: 0.4, folds_m: 0.009 };
                let pattern = stock.tights.cut(body, |p| cutter.under_top(&cape, p));
                pieces.push(wearer.cloth(&pattern, &cut, scarf));
            }
            Headgear::Beanie => {
                let beanie = slot(cloth(&stock.fabrics, Fabric::Knit), &BEANIES);
                pieces.push(wearer.beanie(beanie));
            }
            Headgear::Hood => pieces.push(wearer.headscarf(&stock.skin, 0.034, outermost)),
        }
        let bag_colours = [
            vec3(0.016, 0.016, 0.018),
            vec3(0.02, 0.035, 0.09),
            vec3(0.25, 0.03, 0.03),
            vec3(0.07, 0.09, 0.055),
            vec3(0.14, 0.14, 0.15),
        ];
        let dark = slot(Material::plain("dark", Vec3::splat(0.014), 0.45), &[]);
        let steel = slot(Material { metalness: 1.0, ..Material::plain("steel", Vec3::splat(0.5), 0.3) }, &[]);
        let parcel = slot(Material::plain("cardboard", vec3(0.42, 0.27, 0.15), 0.85), &[]);
        let mut held = None;
        match person.bag {
            Bag::None => {}
            Bag::Backpack => {
                let bag =
                    slot(Material { sheen: 0.2, ..Material::plain("backpack", bag_colours[0], 0.75) }, &bag_colours);
                let bag = wearer.backpack(&[&pieces[outer]], bag, dark);
                pieces.extend(bag);
            }
            Bag::Satchel => {
                let bag = wearer.satchel(&[&pieces[outer], &pieces[trousers]], leather);
                pieces.extend(bag);
            }
            Bag::Shopping => {
                let paper = slot(
                    Material::plain("shopping bag", vec3(0.7, 0.68, 0.62), 0.7),
                    &[vec3(0.7, 0.68, 0.62), vec3(0.4, 0.26, 0.15), vec3(0.1, 0.3, 0.14)],
                );
                held = Some((Held::Shopping, [paper, steel, dark]));
            }
            Bag::Briefcase => held = Some((Held::Briefcase, [leather, steel, dark])),
            Bag::Umbrella => {
                let silk = Material { translucency: 0.25, ..Material::plain("umbrella", bag_colours[0], 0.6) };
                held = Some((Held::Umbrella, [slot(silk, &bag_colours), steel, dark]));
            }
        }
        Self { wearer, pieces, slots, held, phone: dark, parcel }
    }

    /// The mesh in a posture: it stands on z = 0, x and y from the middle of its bounds, or from below the hips where
    /// it goes.
    fn posed(&self, act: Act) -> (Mesh, Posture, Keypoints<Vec3>) {
        let skeleton = &self.wearer.skeleton;
        let mut stance = act.stance(skeleton);
        let is_going = matches!(act, Act::Walk(_) | Act::Run(_));
        let has_hands_free = is_going || matches!(act, Act::Easy | Act::Leaning);
        let held = match act {
            Act::Carrying => Some((Held::Box, [self.parcel; 3])),
            Act::Run(_) => None,
            _ => self.held.filter(|_| has_hands_free),
        };
        match held {
            Some((Held::Umbrella, _)) => {
                stance.arms[1] = Arm::reaching(vec3(0.5, -0.12, -0.32), vec3(-0.4, 0.6, -1.0)).gripping();
            }
            Some((Held::Shopping | Held::Briefcase, _)) => {
                stance.arms[1] = Arm { wrist: stance.arms[1].wrist * vec3(0.5, 1.2, 1.0), curl: 0.8, ..stance.arms[1] };
            }
            _ => {}
        }
        let posed = stance.pose(skeleton);
        let mut mesh = Mesh::default();
        let add = |mesh: &mut Mesh, positions: Vec<Vec3>, piece: &Piece| {
            let base = mesh.positions.len() as u32;
            mesh.normals.extend(normals(&positions, &piece.triangles));
            mesh.positions.extend(positions);
            mesh.uvs.extend(&piece.uvs);
            mesh.tints.extend(&piece.tints);
            mesh.triangles.extend(piece.triangles.iter().map(|t| t.map(|i| i + base)));
            mesh.slots.extend(std::iter::repeat_n(piece.slot, piece.triangles.len()));
        };
        for piece in &self.pieces {
            add(&mut mesh, posed.skin(&piece.positions, &piece.weights), piece);
        }
        if matches!(act, Act::LookingAtPhone | Act::Phoning) {
            let phone = self.wearer.phone(self.phone);
            add(&mut mesh, posed.skin(&phone.positions, &phone.weights), &phone);
        }
        for (shape, slot) in held.map(|(held, slots)| self.wearer.held(held, &posed, slots)).into_iter().flatten() {
            let piece = Piece::stiff(shape, 0, slot);
            add(&mut mesh, piece.positions.clone(), &piece);
        }
        let origin = stand(&mut mesh, is_going);
        (mesh, act.posture(skeleton), self.wearer.keypoints(&posed).map(|p| p - origin))
    }
}

/// Moves a mesh to where an asset's origin has to be; answers what was there before.
fn stand(mesh: &mut Mesh, is_going: bool) -> Vec3 {
    let (low, high) = mesh.bounds().unwrap_or_default();
    let middle = if is_going { Vec2::ZERO } else { (low + high).truncate() / 2.0 };
    let origin = middle.extend(low.z);
    mesh.positions.iter_mut().for_each(|p| *p -= origin);
    origin
}

const NAVY: Vec3 = vec3(0.015, 0.02, 0.06);
const BEANIES: [Vec3; 5] = [
    vec3(0.03, 0.03, 0.034),
    vec3(0.02, 0.035, 0.09),
    vec3(0.3, 0.03, 0.035),
    vec3(0.45, 0.42, 0.37),
    vec3(0.16, 0.16, 0.165),
];
const SCARVES: [Vec3; 4] =
    [vec3(0.025, 0.025, 0.03), vec3(0.5, 0.42, 0.36), vec3(0.2, 0.1, 0.13), vec3(0.1, 0.17, 0.22)];

fn vectors(colors: &[[f32; 3]]) -> Vec<Vec3> {
    colors.iter().copied().map(Vec3::from_array).collect()
}

fn paints(dye: &Dye) -> Vec<Vec3> {
    vectors(&dye.colors)
}

fn face_of(person: &PersonPlan) -> Face<'_> {
    let is_woman = person.build.male < 0.5;
    Face {
        name: &person.id,
        brows: if is_woman { 0.75 } else { 1.15 },
        lips: if is_woman { vec3(0.82, 0.42, 0.42) } else { vec3(0.86, 0.6, 0.58) },
        beard: if person.kind == PersonKind::Child { 0.0 } else { person.beard },
        wrinkles: ((person.build.years - 25.0) / 50.0).clamp(0.0, 1.0),
        hair: person.hair_cut,
    }
}

fn cloth(fabrics: &Fabrics, fabric: Fabric) -> Material {
    match fabric {
        Fabric::Woven => fabrics.woven.clone(),
        Fabric::Denim => fabrics.denim.clone(),
        Fabric::Knit => fabrics.knit.clone(),
        Fabric::Striped => fabrics.striped.clone(),
        Fabric::Checked => fabrics.checked.clone(),
        Fabric::Printed => fabrics.printed.clone(),
        Fabric::Coated => {
            Material { name: "coated".into(), sheen: 0.0, coat: 0.25, roughness: 0.5, ..fabrics.woven.clone() }
        }
    }
}

fn bottom_piece(stock: &Stock<'_>, wearer: &Wearer<'_>, person: &PersonPlan, slot: u16) -> Piece {
    let under = |p: Vec3| stock.cutter.under_bottom(&person.bottom.cut, p);
    match person.bottom.cut {
        Bottom::Trousers { hem_m, .. } => {
            let thigh = 0.085 + 0.3 * (hem_m - 0.06);
            let knee = hem_m.max(0.064) * 0.9 + 0.008;
            let cut =
                Cut { ease_m: 0.008, sleeve_m: [0.0; 3], leg_m: [thigh, knee, hem_m], drape: 0.25, folds_m: 0.006 };
            let piece = wearer.cloth(&stock.tights.cut(stock.body, under), &cut, slot);
            if person.bottom.fabric == Fabric::Denim {
                // Worn pale over the thighs and knees.
                piece.tinted(|p| {
                    Vec3::splat(
                        1.0 + 0.5 * (-((p.z + 0.2) / 0.16).powi(2)).exp() * ((p.x - 0.02) * 12.0).clamp(0.0, 1.0),
                    )
                })
            } else {
                piece
            }
        }
        Bottom::Skirt { .. } => {
            let cut = Cut { ease_m: 0.019, sleeve_m: [0.0; 3], leg_m: [0.0; 3], drape: 0.0, folds_m: 0.003 };
            flared(wearer.cloth(&stock.skirt.cut(stock.body, under), &cut, slot), 0.02)
        }
    }
}

/// Pleats that open towards the hem.
fn flared(piece: Piece, depth_m: f32) -> Piece {
    piece.moved(|p, spot| {
        let out = vec3(spot.x - 0.02, spot.y, 0.0).normalize_or(Vec3::X);
        let down = ((0.05 - spot.z) / 0.4).clamp(0.0, 1.0);
        p + out * depth_m * down * (9.0 * out.y.atan2(out.x) + 3.0 * spot.z).sin()
    })
}

fn shoes_piece(stock: &Stock<'_>, wearer: &Wearer<'_>, to_m: f32, slot: u16) -> Piece {
    let is_boot = to_m > -0.7;
    let ankle = if is_boot { 0.052 } else { 0.0 };
    let cut = Cut { ease_m: 0.007, sleeve_m: [0.0; 3], leg_m: [0.0, 0.0, ankle], drape: 0.0, folds_m: 0.0015 };
    let pattern = stock.tights.cut(stock.body, |p| Cutter::in_shoes(to_m, p));
    let floor = wearer.skeleton.floor_m;
    let sole = 0.02 * wearer.scale;
    let own_floor = stock.body.positions.iter().map(|p| p.z).fold(f32::INFINITY, f32::min);
    wearer
        .cloth(&pattern, &cut, slot)
        .moved(|p, _| {
            // A flat sole that stands out a little.
            let down = ((floor + 0.03 * wearer.scale - p.z) / (0.02 * wearer.scale)).clamp(0.0, 1.0);
            vec3(p.x, p.y, p.z + (floor - sole - p.z) * down)
        })
        .tinted(|p| if p.z < own_floor + 0.012 { Vec3::splat(0.5) } else { Vec3::ONE })
}

/// A band around the trunk between two heights.
fn band(stock: &Stock<'_>, wearer: &Wearer<'_>, [low, high]: [f32; 2], ease_m: f32, slot: u16) -> Piece {
    let pattern = stock
        .tights
        .cut(stock.body, |p| if stock.cutter.along_arm(p) > 0.0 { -1.0 } else { (p.z - low).min(high - p.z) });
    let cut = Cut { ease_m, sleeve_m: [0.0; 3], leg_m: [0.0; 3], drape: 0.25, folds_m: 0.0 };
    wearer.cloth(&pattern, &cut, slot)
}

fn layer_pieces(stock: &Stock<'_>, wearer: &Wearer<'_>, layer: &Layer, is_outer: bool, slot: u16) -> Vec<Piece> {
    let (body, cutter, top) = (stock.body, &stock.cutter, &layer.cut());
    let loose = top.wide;
    let ease_m = if is_outer { 0.009 + 0.008 * loose + if layer.has_lapels { 0.006 } else { 0.0 } } else { 0.005 };
    let sleeve = if top.sleeve < 1.0 {
        [0.058 + 0.03 * loose, 0.07 + 0.022 * loose, 0.06]
    } else {
        [0.055 + 0.024 * loose, 0.046 + 0.02 * loose, 0.034 + 0.014 * loose]
    };
    let cut = Cut {
        ease_m,
        sleeve_m: sleeve,
        leg_m: [0.0; 3],
        drape: if top.hem_m < 0.05 { 0.35 + 0.6 * loose } else { 0.0 },
        folds_m: 0.004 + 0.003 * loose,
    };
    let pattern = stock.tights.cut(body, |p| cutter.under_top(top, p));
    // The opening's point lies in the middle of the chest.
    let pattern = if layer.has_lapels || !is_outer { pattern.scored(body, |p| p.y) } else { pattern };
    let pattern = if layer.has_lapels { pattern.cut(body, |p| -Cutter::lapels(p)) } else { pattern };
    // Of what is worn below only the chest is seen.
    let pattern = if is_outer { pattern } else { pattern.cut(body, |p| (Cutter::lapels(p) + 0.04).max(p.z - 0.53)) };
    let mut pieces = vec![wearer.cloth(&pattern, &cut, slot)];
    if layer.has_collar {
        let from = |p: Vec3| p.z - (0.567 - 0.28 * p.x);
        let high = Top { neck_m: -0.022, sleeve: 2.0, ..*top };
        // Its points part over the throat.
        let parted = |p: Vec3| if p.x > 0.03 { p.y.abs() - 0.004 - 0.6 * from(p).max(0.0) } else { 1.0 };
        let collar = stock.tights.cut(body, |p| from(p).min(cutter.under_top(&high, p)).min(parted(p)));
        let stand =
            Cut { ease_m: ease_m + 0.004 + if is_outer { 0.003 } else { 0.006 }, folds_m: 0.0, drape: 0.0, ..cut };
        pieces.push(wearer.cloth(&collar, &stand, slot).tinted(|_| Vec3::splat(0.94)));
    }
    if layer.has_lapels {
        let lapel = stock.tights.cut(body, |p| {
            let l = Cutter::lapels(p);
            let wide = 0.012 + 0.16 * (p.z - 0.27).max(0.0);
            (-l).min(l + wide).min(cutter.under_top(top, p))
        });
        let lie = Cut { ease_m: ease_m + 0.006, folds_m: 0.0, ..cut };
        pieces.push(wearer.cloth(&lapel, &lie, slot).tinted(|_| Vec3::splat(1.15)));
    }
    pieces
}

fn vest_pieces(stock: &Stock<'_>, wearer: &Wearer<'_>, slot: u16, silver: u16) -> Vec<Piece> {
    let (body, cutter) = (stock.body, &stock.cutter);
    let vest = Top { sleeve: 0.1, neck_m: 0.1, hem_m: 0.015, wide: 1.0 };
    let pattern = stock.tights.cut(body, |p| cutter.under_top(&vest, p));
    let cut = Cut { ease_m: 0.026, sleeve_m: [0.0; 3], leg_m: [0.0; 3], drape: 0.95, folds_m: 0.0025 };
    // Two bands around, one over each shoulder.
    let around = |p: Vec3| (0.025 - (p.z - 0.095).abs()).max(0.025 - (p.z - 0.205).abs());
    let over = |p: Vec3| (p.z - 0.2).min(0.025 - (p.y.abs() - 0.1).abs());
    let lines = [0.07, 0.12, 0.18, 0.23, 0.2].iter().fold(pattern, |p, &z| p.scored(body, |q| q.z - z));
    let pattern = [0.075, 0.125].iter().fold(lines, |p, &y| p.scored(body, |q| q.y.abs() - y));
    let whole = wearer.cloth(&pattern, &cut, slot);
    whole.divide(silver, |p| around(p).max(over(p)) > 0.0).into()
}
