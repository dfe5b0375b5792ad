//! Measures that nobody can have, refused before they are built from.

use super::head::HairCut;
use super::outfit::Bottom;
use super::plan::{Layer, PersonPlan};
use crate::measure::{Wrong, wrong};

/// A share has to be from 0 to 1.
const SHARE: &str = "a number from 0 to 1";

impl PersonPlan {
    /// The key of a value that nobody can have, with what was expected and what it is.
    pub(crate) fn check(&self) -> Result<(), Wrong> {
        if !(self.commonness.is_finite() && self.commonness > 0.0) {
            return wrong("commonness", "a number above 0", &self.commonness);
        }
        if self.worn_in.iter().enumerate().any(|(i, worn_in)| self.worn_in[..i].contains(worn_in)) {
            return wrong("worn_in", "each weather once", &self.worn_in);
        }
        self.check_build()?;
        self.check_clothes()?;
        self.check_colors()?;
        if self.headgear.hides_hair() && self.hair_cut != HairCut::Covered {
            return wrong("hair_cut", "covered, where headgear is scarf or hood", &self.hair_cut);
        }
        let is_twice = self.acts.iter().enumerate().any(|(i, act)| self.acts[..i].contains(act));
        if self.acts.is_empty() || is_twice {
            return wrong("acts", "at least one act, none of them twice", &self.acts);
        }
        Ok(())
    }

    fn check_build(&self) -> Result<(), Wrong> {
        let build = &self.build;
        if !(3.0..=90.0).contains(&build.years) {
            return wrong("build.years", "years from 3 to 90", &build.years);
        }
        let shares = [
            ("build.male", build.male),
            ("build.muscle", build.muscle),
            ("build.weight", build.weight),
            ("build.height", build.height),
            ("build.proportions", build.proportions),
            ("beard", self.beard),
        ];
        for (key, share) in shares {
            if !(0.0..=1.0).contains(&share) {
                return wrong(key, SHARE, &share);
            }
        }
        let origins = &build.origins;
        let are_shares = origins.iter().all(|share| (0.0..=1.0).contains(share));
        if !(are_shares && (origins.iter().sum::<f32>() - 1.0).abs() < 0.01) {
            return wrong("build.origins", "three shares that come to 1", origins);
        }
        Ok(())
    }

    fn check_clothes(&self) -> Result<(), Wrong> {
        if !(1..=3).contains(&self.top.len()) {
            return wrong("top", "one to three garments", &self.top.len());
        }
        self.top.iter().try_for_each(Layer::check)?;
        if let Some(to_m) = self.tail_m.filter(|m| !(-0.68..=-0.05).contains(m)) {
            return wrong("tail_m", "metres from -0.68 to -0.05", &to_m);
        }
        match self.bottom.cut {
            Bottom::Trousers { to, .. } if !(0.3..=2.0).contains(&to) => {
                return wrong("bottom.cut.trousers.to", "a number from 0.3 to 2", &to);
            }
            Bottom::Trousers { hem_m, .. } if !(0.03..=0.2).contains(&hem_m) => {
                return wrong("bottom.cut.trousers.hem_m", "metres from 0.03 to 0.2", &hem_m);
            }
            Bottom::Skirt { hem_m } if !(-0.68..=-0.1).contains(&hem_m) => {
                return wrong("bottom.cut.skirt.hem_m", "metres from -0.68 to -0.1", &hem_m);
            }
            _ => {}
        }
        if !(-0.78..=-0.4).contains(&self.shoes.to_m) {
            return wrong("shoes.to_m", "metres from -0.78 to -0.4", &self.shoes.to_m);
        }
        Ok(())
    }

    fn check_colors(&self) -> Result<(), Wrong> {
        let own = [
            ("skin.colors", &self.skin.colors),
            ("hair.colors", &self.hair.colors),
            ("bottom.dye.colors", &self.bottom.dye.colors),
            ("shoes.colors", &self.shoes.colors),
        ];
        for (key, colors) in own.into_iter().chain(self.top.iter().map(|layer| ("top.dye.colors", &layer.dye.colors))) {
            if colors.is_empty() || colors.iter().flatten().any(|v| !(0.0..=1.0).contains(v)) {
                return wrong(key, "at least one colour, from 0 to 1", colors);
            }
        }
        Ok(())
    }
}

impl Layer {
    fn check(&self) -> Result<(), Wrong> {
        if !(0.0..=2.1).contains(&self.sleeve) {
            return wrong("top.sleeve", "a number from 0 to 2.1", &self.sleeve);
        }
        if !(-0.03..=0.15).contains(&self.neck_m) {
            return wrong("top.neck_m", "metres from -0.03 to 0.15", &self.neck_m);
        }
        if !(-0.1..=0.2).contains(&self.hem_m) {
            return wrong("top.hem_m", "metres from -0.1 to 0.2", &self.hem_m);
        }
        if !(0.0..=1.5).contains(&self.wide) {
            return wrong("top.wide", "a number from 0 to 1.5", &self.wide);
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::super::plan::{PersonKind, WornIn};
    use super::super::posture::Act;
    use super::*;
    use crate::Plans;

    fn dressed_for(worn_in: WornIn) -> impl Iterator<Item = &'static PersonPlan> {
        let suits = move |p: &&PersonPlan| p.worn_in.is_empty() || p.worn_in.contains(&worn_in);
        Plans::built_in().persons.iter().filter(suits)
    }

    #[test]
    fn there_are_people_of_every_kind_for_every_weather_and_an_adult_who_sits() {
        for worn_in in [WornIn::Warm, WornIn::Mild, WornIn::Wet, WornIn::Cold] {
            let count = |kind: PersonKind| dressed_for(worn_in).filter(|p| p.kind == kind).count();
            let counts =
                [PersonKind::Adult, PersonKind::Child, PersonKind::ConstructionWorker, PersonKind::PoliceOfficer]
                    .map(count);
            assert!(counts.iter().zip([8, 2, 2, 2]).all(|(count, least)| *count >= least), "{worn_in:?}: {counts:?}");
            let sits = |p: &PersonPlan| p.kind == PersonKind::Adult && p.acts.contains(&Act::Sitting);
            assert!(dressed_for(worn_in).any(sits), "{worn_in:?}");
        }
    }

    #[test]
    fn nobody_has_bare_arms_or_legs_in_rain_or_frost() {
        for person in dressed_for(WornIn::Wet).chain(dressed_for(WornIn::Cold)) {
            assert!(person.top.last().unwrap().sleeve > 1.9, "{}", person.id);
            let is_long = match person.bottom.cut {
                Bottom::Trousers { to, .. } => to > 1.8,
                Bottom::Skirt { hem_m } => hem_m < -0.6,
            };
            assert!(is_long, "{}", person.id);
        }
    }
}
