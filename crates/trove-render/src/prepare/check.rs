//! Everything in a scene that could make rendering fail is refused here, once.

use std::sync::Arc;

use trove_model::{Environment, Light, Material, Mesh, Placement, Scene};

use crate::RenderError;

/// Checks all indices and numbers.
pub(crate) fn check(scene: &Scene) -> Result<(), RenderError> {
    if !scene.keyframes_apart_s.iter().all(|&s| s > 0.0) {
        let found = format!("{:?}", scene.keyframes_apart_s);
        return refuse("keyframes_apart_s".into(), "more than 0 seconds", found);
    }
    for (i, mesh) in scene.meshes.iter().enumerate() {
        if let Some(defect) = mesh.defect() {
            return refuse(format!("mesh {i}"), "a sound mesh", defect);
        }
        if mesh.triangles.len() >= u32::MAX as usize || mesh.positions.len() >= u32::MAX as usize {
            return refuse(format!("mesh {i}"), "fewer than 2³² triangles", mesh.triangles.len().to_string());
        }
    }
    for (i, material) in scene.materials.iter().enumerate() {
        let place = || format!("material {i} ({})", material.name);
        if !is_finite(material) {
            return refuse(place(), "finite numbers", format!("{material:?}").chars().take(200).collect());
        }
        for texture in material.textures() {
            let texels = texture.width as usize * texture.height as usize;
            if texels == 0 || texture.rgba.len() != texels {
                let found = format!("{}×{} with {} texels", texture.width, texture.height, texture.rgba.len());
                return refuse(format!("{}, texture {}", place(), texture.name), "width × height texels", found);
            }
        }
    }
    for (i, instance) in scene.instances.iter().chain(scene.others.iter().flatten()).enumerate() {
        let place = || format!("instance {i} (id {}, {:?})", instance.id.0, instance.class);
        let Some(mesh) = scene.meshes.get(instance.mesh) else {
            let found = format!("index {} of {}", instance.mesh, scene.meshes.len());
            return refuse(place(), "an existing mesh", found);
        };
        if instance.materials.len() < mesh.slot_count() {
            let found = format!("{} for {} slots", instance.materials.len(), mesh.slot_count());
            return refuse(place(), "a material for every slot", found);
        }
        if let Some(m) = instance.materials.iter().find(|&&m| m >= scene.materials.len()) {
            return refuse(place(), "existing materials", format!("index {m} of {}", scene.materials.len()));
        }
        for Placement { mesh: index, world_from_mesh } in
            [Some(instance.now()), instance.previous, instance.next].into_iter().flatten()
        {
            if !world_from_mesh.is_finite() {
                return refuse(place(), "finite placements", format!("{world_from_mesh:?}"));
            }
            let same = |other: &Arc<Mesh>| other.triangles == mesh.triangles && other.slots == mesh.slots;
            if index != instance.mesh && !scene.meshes.get(index).is_some_and(same) {
                let found = format!("mesh {index} beside mesh {}", instance.mesh);
                return refuse(place(), "one set of triangles and slots at neighbouring keyframes", found);
            }
        }
        let volume = instance.world_from_mesh.matrix3.determinant();
        if volume.abs() < 1e-12 {
            return refuse(place(), "an invertible placement", format!("determinant {volume:e}"));
        }
    }
    check_light(&scene.light)
}

/// Takes the material apart whole: a new field does not compile until it is looked at.
fn is_finite(material: &Material) -> bool {
    let Material {
        name: _,
        base_color,
        // Textures are bytes.
        base_color_map: _,
        alpha_cutoff,
        roughness,
        metalness,
        orm_map: _,
        normal_map: _,
        height_map: _,
        height_m,
        ior,
        coat,
        flakes,
        sheen,
        subsurface,
        transmission,
        translucency,
        retroreflection,
        emission,
        emission_map: _,
        // Checked as it was made.
        beam: _,
        dirt,
        wetness,
        uv_scale,
        mapping: _,
        tiling: _,
        role: _,
    } = material;
    let layers = [coat, flakes, sheen, subsurface, transmission, translucency, retroreflection, dirt, wetness];
    let numbers = [alpha_cutoff, roughness, metalness, ior, height_m].into_iter().chain(layers);
    numbers.into_iter().all(|n| n.is_finite()) && base_color.is_finite() && emission.is_finite() && uv_scale.is_finite()
}

fn check_light(light: &Light) -> Result<(), RenderError> {
    if let Some(fog) = &light.fog {
        let is_sound = |n: f64| n > 0.0 && n.is_finite();
        if !(is_sound(fog.visibility_m) && is_sound(fog.height_m) && fog.ground_z_m.is_finite()) {
            return refuse("fog".into(), "visibility and height of more than 0 m over a ground", format!("{fog:?}"));
        }
    }
    if let Some(falling) = light.falling.filter(|falling| !(falling.rate_mm_h > 0.0 && falling.rate_mm_h.is_finite())) {
        return refuse("precipitation".into(), "more than 0 mm an hour", format!("{falling:?}"));
    }
    if let Some(snow) = light.snow.as_ref().filter(|snow| !(0.0..=1.0).contains(&snow.cover)) {
        return refuse("snow".into(), "a cover of 0 to 1", format!("{}", snow.cover));
    }
    match &light.environment {
        Environment::Sky(sky) => {
            let numbers = [sky.turbidity, sky.ground_albedo, sky.cloud_cover];
            if !sky.to_sun.is_finite() || sky.to_sun.length() < 1e-6 || !numbers.iter().all(|n| n.is_finite()) {
                return refuse("sky".into(), "finite numbers and a direction to the sun", format!("{sky:?}"));
            }
        }
        Environment::Map(map) => {
            let place = || format!("environment map {}", map.name);
            let texels = map.width as usize * map.height as usize;
            if texels == 0 || map.rgb.len() != texels {
                let found = format!("{}×{} with {} texels", map.width, map.height, map.rgb.len());
                return refuse(place(), "width × height texels", found);
            }
            if !map.rgb.iter().flatten().all(|c| c.is_finite() && *c >= 0.0) {
                return refuse(place(), "finite radiance", "NaN, infinity or a negative number".into());
            }
        }
    }
    Ok(())
}

fn refuse(place: String, expected: &'static str, found: String) -> Result<(), RenderError> {
    Err(RenderError::Scene { place, expected, found })
}
