//! One individual of an asset: its paints, its wear, what it carries.

use std::sync::Arc;

use glam::Vec3;

use crate::{Asset, CarColors, Extra, Material, Mesh, Seed, Slot};

/// How worn individuals are: what their materials' dirt is multiplied by. Few values, so that materials are shared.
const WEAR: [f32; 5] = [0.3, 0.6, 1.0, 1.0, 1.7];

impl Asset {
    /// The materials of an individual, one a slot: paints are drawn, the same for slots that have the same ones, and
    /// with them how worn it is. `colors` are those of cars where it stands; without them every paint is as common.
    pub fn materials(&self, seed: Seed, colors: Option<&CarColors>) -> Vec<Material> {
        let wear = seed.child("wear").random().pick(&WEAR).copied().unwrap_or(1.0);
        let mut drawn: Vec<(&[Vec3], Vec3)> = Vec::new();
        let mut materials = Vec::with_capacity(self.slots.len());
        for (i, slot) in self.slots.iter().enumerate() {
            let known = drawn.iter().find(|(paints, _)| *paints == slot.paints).map(|(_, paint)| *paint);
            let paint = known.or_else(|| paint(slot, colors, seed.child("paint").nth(i as u64)));
            let mut material = slot.material.clone();
            material.dirt = (material.dirt * wear).min(1.0);
            if let Some(paint) = paint {
                drawn.push((&slot.paints, paint));
                material.base_color = paint;
            }
            materials.push(material);
        }
        materials
    }

    /// Which of its extras an individual has, in their order; `driven`: it moves by itself or is ridden.
    pub fn drawn_extras(&self, driven: bool, seed: Seed) -> Vec<usize> {
        let is_first = |i: &usize| self.extras[..*i].iter().all(|e| e.group != self.extras[*i].group);
        let mut drawn: Vec<usize> = (0..self.extras.len())
            .filter(is_first)
            .filter_map(|first| {
                let group = &self.extras[first].group;
                let can_be = |e: &Extra| e.group == *group && (driven || !e.when_driven);
                let share = |e: &Extra| if can_be(e) { f64::from(e.share) } else { 0.0 };
                let none = 1.0 - self.extras.iter().map(share).sum::<f64>();
                let weights = self.extras.iter().map(share).chain([none]);
                let drawn = seed.child("extra").child(group).random().weighted(weights)?;
                (drawn < self.extras.len()).then_some(drawn)
            })
            .collect();
        drawn.sort_unstable();
        drawn
    }

    /// The mesh with some of its extras; without any it is the shared one.
    pub fn with_extras(&self, extras: &[usize]) -> Arc<Mesh> {
        if extras.is_empty() {
            return self.mesh.clone();
        }
        let mut mesh = Mesh::clone(&self.mesh);
        for extra in extras {
            mesh.append(&self.extras[*extra].mesh, 0);
        }
        Arc::new(mesh)
    }
}

fn paint(slot: &Slot, colors: Option<&CarColors>, seed: Seed) -> Option<Vec3> {
    let mut random = seed.random();
    let by_color = colors.filter(|_| slot.by_region).and_then(|colors| random.weighted(colors.weights(&slot.paints)));
    by_color.map_or_else(|| random.pick(&slot.paints).copied(), |i| slot.paints.get(i).copied())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Class, Kind, Slot};

    fn triangle() -> Mesh {
        Mesh { positions: vec![Vec3::ZERO, Vec3::X, Vec3::Y], triangles: vec![[0, 1, 2]], ..Mesh::default() }
    }

    fn car() -> Asset {
        let paints: Vec<Vec3> = (0..50).map(|i| Vec3::splat(i as f32 / 50.0)).collect();
        let body = Material { dirt: 0.4, ..Material::plain("body", Vec3::ONE, 0.3) };
        let slots = vec![
            Slot::new(body, paints.clone()),
            Slot::new(Material::plain("bumper", Vec3::ONE, 0.5), paints),
            Slot::new(Material::plain("tyre", Vec3::ZERO, 0.9), Vec::new()),
        ];
        let extra = |group: &str, share: f32, when_driven: bool| Extra {
            group: group.into(),
            share,
            when_driven,
            mesh: Arc::new(triangle()),
        };
        let extras = vec![extra("driver", 1.0, true), extra("roof", 0.25, false), extra("roof", 0.5, false)];
        Asset { extras, ..Asset::new("car/a", Kind::Car, Class::Car, triangle(), slots, "test") }
    }

    #[test]
    fn slots_with_the_same_paints_are_painted_alike_and_what_has_none_keeps_its_colour() {
        let car = car();
        let painted = car.materials(Seed(1), None);
        assert_eq!(painted[0].base_color, painted[1].base_color);
        assert_eq!(painted[2].base_color, Vec3::ZERO);
        assert_eq!(car.materials(Seed(1), None), painted);
        assert!((2..20).any(|s| car.materials(Seed(s), None)[0].base_color != painted[0].base_color));
    }

    #[test]
    fn individuals_are_worn_differently() {
        let dirt: Vec<f32> = (0..40).map(|s| car().materials(Seed(s), None)[0].dirt).collect();
        assert!(dirt.iter().any(|d| *d < 0.2) && dirt.iter().any(|d| *d > 0.6), "{dirt:?}");
    }

    #[test]
    fn a_driver_is_there_while_driving_and_of_a_group_there_is_at_most_one() {
        let car = car();
        let mut roofs = [0; 3];
        for s in 0..400 {
            assert!(car.drawn_extras(true, Seed(s)).contains(&0));
            let parked = car.drawn_extras(false, Seed(s));
            assert!(parked.len() <= 1 && !parked.contains(&0));
            roofs[parked.first().copied().unwrap_or(0)] += 1;
        }
        assert!(
            (60..140).contains(&roofs[0]) && (60..140).contains(&roofs[1]) && (160..240).contains(&roofs[2]),
            "{roofs:?}"
        );
    }

    #[test]
    fn extras_join_the_mesh() {
        let car = car();
        assert!(Arc::ptr_eq(&car.with_extras(&[]), &car.mesh));
        let mesh = car.with_extras(&[0, 2]);
        assert_eq!((mesh.defect(), mesh.triangles.len()), (None, 3));
    }
}
