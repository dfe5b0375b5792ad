//! Materials that lost their colours on the way: they get them back from their names.

use glam::{Vec3, vec3};
use trove_model::{Material, Outcome};

use super::model::Model;
use super::words::words;

/// What a word in a material's name says of it: colour (linear), roughness, metalness, transmission.
struct Look(&'static str, Vec3, f32, f32, f32);

const LOOKS: [Look; 40] = [
    Look("windows window windshield windscreen glass fenster verre vidrio", vec3(0.03, 0.035, 0.04), 0.05, 0.0, 0.5),
    Look("headlight headlights lights whitelights scheinwerfer", vec3(0.85, 0.85, 0.8), 0.15, 0.0, 0.0),
    Look("taillight taillights brakelight redlights", vec3(0.45, 0.01, 0.01), 0.2, 0.0, 0.0),
    Look("bluelights", vec3(0.01, 0.03, 0.5), 0.2, 0.0, 0.0),
    Look("tire tires tyre tyres rubber reifen wheel wheels", vec3(0.02, 0.02, 0.02), 0.85, 0.0, 0.0),
    Look("chrome", vec3(0.6, 0.6, 0.6), 0.1, 1.0, 0.0),
    Look("metal steel iron", vec3(0.45, 0.45, 0.45), 0.35, 1.0, 0.0),
    Look("bumper handle details", vec3(0.06, 0.06, 0.065), 0.5, 0.0, 0.0),
    Look("skin haut peau", vec3(0.5, 0.28, 0.19), 0.55, 0.0, 0.0),
    Look("hair", vec3(0.05, 0.03, 0.02), 0.6, 0.0, 0.0),
    Look("shirt", vec3(0.16, 0.26, 0.42), 0.9, 0.0, 0.0),
    Look("pants trousers jeans", vec3(0.03, 0.05, 0.11), 0.9, 0.0, 0.0),
    Look("shoes shoe", vec3(0.03, 0.022, 0.018), 0.6, 0.0, 0.0),
    Look("leaves leaf foliage", vec3(0.06, 0.13, 0.03), 0.7, 0.0, 0.0),
    Look("bark trunk wood", vec3(0.1, 0.06, 0.035), 0.85, 0.0, 0.0),
    Look("asphalt", vec3(0.06, 0.06, 0.062), 0.9, 0.0, 0.0),
    Look("pole mast", vec3(0.3, 0.31, 0.32), 0.5, 0.6, 0.0),
    Look("black schwarz noir negro", vec3(0.015, 0.015, 0.016), 0.4, 0.0, 0.0),
    Look("darkgrey darkgray", vec3(0.07, 0.07, 0.07), 0.5, 0.0, 0.0),
    Look("lightgrey lightgray silver", vec3(0.45, 0.45, 0.46), 0.4, 0.0, 0.0),
    Look("grey gray grau gris", vec3(0.2, 0.2, 0.2), 0.5, 0.0, 0.0),
    Look("white weiss weiß blanc blanco", vec3(0.75, 0.75, 0.74), 0.4, 0.0, 0.0),
    Look("darkred", vec3(0.18, 0.01, 0.01), 0.4, 0.0, 0.0),
    Look("red rot rouge rojo", vec3(0.5, 0.02, 0.02), 0.4, 0.0, 0.0),
    Look("darkorange", vec3(0.45, 0.12, 0.01), 0.4, 0.0, 0.0),
    Look("orange", vec3(0.7, 0.18, 0.01), 0.45, 0.0, 0.0),
    Look("yellow gelb jaune amarillo", vec3(0.75, 0.5, 0.02), 0.4, 0.0, 0.0),
    Look("darkgreen", vec3(0.01, 0.07, 0.02), 0.45, 0.0, 0.0),
    Look("lightgreen", vec3(0.3, 0.55, 0.2), 0.45, 0.0, 0.0),
    Look("green grün vert verde", vec3(0.02, 0.22, 0.05), 0.45, 0.0, 0.0),
    Look("lightblue", vec3(0.2, 0.42, 0.65), 0.4, 0.0, 0.0),
    Look("darkblue", vec3(0.01, 0.02, 0.12), 0.4, 0.0, 0.0),
    Look("blue blau bleu azul", vec3(0.02, 0.08, 0.4), 0.4, 0.0, 0.0),
    Look("purple violet", vec3(0.14, 0.03, 0.25), 0.4, 0.0, 0.0),
    Look("pink", vec3(0.65, 0.2, 0.3), 0.45, 0.0, 0.0),
    Look("brown braun marron", vec3(0.15, 0.07, 0.03), 0.6, 0.0, 0.0),
    Look("beige sand cream", vec3(0.55, 0.45, 0.3), 0.6, 0.0, 0.0),
    Look("gold", vec3(1.0, 0.77, 0.34), 0.25, 1.0, 0.0),
    Look("brick", vec3(0.25, 0.08, 0.05), 0.85, 0.0, 0.0),
    Look("concrete", vec3(0.35, 0.34, 0.32), 0.9, 0.0, 0.0),
];

/// Two repairs of what converters do to materials: where several have one and the same colour and no picture, names
/// give them colours; where all are wholly metal and no map says so, none is.
pub(super) fn restore(model: &mut Model) {
    let plain = |m: &Material| m.base_color_map.is_none() && m.emission == Vec3::ZERO;
    let [first, others @ ..] = model.materials.as_slice() else { return };
    let all_metal = model.materials.iter().all(|m| m.metalness > 0.99 && m.orm_map.is_none());
    let alike = !others.is_empty()
        && model.materials.iter().all(plain)
        && others.iter().all(|m| m.base_color == first.base_color && m.roughness == first.roughness)
        && model.mesh.tints.iter().all(|t| *t == Vec3::ONE);
    let names: Vec<String> = model.materials.iter().map(|m| m.name.clone()).collect();
    if all_metal {
        model.materials.iter_mut().for_each(|m| m.metalness = 0.0);
        let what = "a model with only bare metal materials is treated as painted";
        model.notice(Outcome::Substituted, what, names.join(", "));
    }
    if !alike {
        return;
    }
    for (material, name) in model.materials.iter_mut().zip(&names) {
        let Some(Look(_, color, roughness, metalness, transmission)) = look_of(name) else { continue };
        material.base_color = *color;
        (material.roughness, material.metalness, material.transmission) = (*roughness, *metalness, *transmission);
    }
    model.notice(
        Outcome::Guessed,
        "colours of a model whose materials all share one, from their names",
        names.join(", "),
    );
}

/// The first row with a word of the name, or with two of its words joined (`Dark Grey`).
fn look_of(name: &str) -> Option<&'static Look> {
    let mut words = words(name);
    words.extend(words.windows(2).map(|w| w.concat()).collect::<Vec<_>>());
    LOOKS.iter().find(|look| look.0.split(' ').any(|w| words.iter().any(|n| n == w)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_give_back_lost_colours_and_leave_others_alone() {
        let material =
            |name: &str, color: f32| Material { metalness: 1.0, ..Material::plain(name, Vec3::splat(color), 0.7) };
        let mut model =
            Model { materials: vec![material("DarkGrey.001", 1.0), material("Windows", 1.0)], ..Model::default() };
        restore(&mut model);
        assert!(model.materials[0].base_color.x < 0.1 && model.materials[1].transmission > 0.0);
        assert!(model.materials.iter().all(|m| m.metalness == 0.0) && model.notices.len() == 2);
        let mut model = Model { materials: vec![material("Red", 0.2), material("Blue", 1.0)], ..Model::default() };
        restore(&mut model);
        assert_eq!(model.materials[0].base_color, Vec3::splat(0.2));
    }
}
