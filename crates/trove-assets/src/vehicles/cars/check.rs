//! Measures that no car can have, refused before they are built from.

use super::plan::{Bars, CarExtra, CarPlan};
use crate::measure::{Wrong, wrong};
use crate::vehicles::wheel::Rim;

/// Whether a point of an outline is on a car.
fn is_near(&(share, height_m): &(f32, f32)) -> bool {
    (-2.0..=2.0).contains(&share) && (-3.0..=3.0).contains(&height_m)
}

impl CarPlan {
    /// The key of a value that no car can have, with what was expected and what it is.
    pub(crate) fn check(&self) -> Result<(), Wrong> {
        let p = &self.profile;
        if !(2.0..=9.0).contains(&p.length_m) {
            return wrong("profile.length_m", "metres from 2 to 9", &p.length_m);
        }
        if !(1.0..=3.0).contains(&p.width_m) {
            return wrong("profile.width_m", "metres from 1 to 3", &p.width_m);
        }
        let along = [0.0, p.cowl.0, p.header.0, p.peak.0, p.rear_header.0, p.deck.0, p.length_m];
        if !along.is_sorted_by(|a, b| a < b) {
            let expected = "cowl, header, peak, rear_header and deck one behind the other, within length_m";
            return wrong("profile", expected, &along);
        }
        let heights = [p.clearance_m, p.nose_m, p.tail_m, p.cowl.1, p.header.1, p.peak.1, p.rear_header.1, p.deck.1];
        if heights.into_iter().chain(p.belt_m).any(|z| !(0.05..=4.0).contains(&z)) {
            return wrong("profile", "heights from 0.05 to 4 metres", &heights);
        }
        if !(0.2..=1.0).contains(&p.roof_share) {
            return wrong("profile.roof_share", "a share from 0.2 to 1", &p.roof_share);
        }
        if p.round_m.iter().any(|m| !(0.05..=p.length_m / 3.0).contains(m)) {
            return wrong("profile.round_m", "metres from 0.05 to a third of the length", &p.round_m);
        }
        if p.square.iter().any(|n| !(1.0..=12.0).contains(n)) {
            return wrong("profile.square", "numbers from 1 to 12", &p.square);
        }
        let small = [p.shoulder_m, p.flare_m, p.hollow_m].into_iter().chain(p.rake_m).chain(p.screen_bow_m);
        if let Some(found) = small.into_iter().find(|m| !(0.0..=1.0).contains(m)) {
            let expected = "shoulder_m, flare_m, hollow_m, rake_m and screen_bow_m from 0 to 1";
            return wrong("profile", expected, &found);
        }
        if ![0.0, self.axles_m[0], self.axles_m[1], p.length_m].is_sorted_by(|a, b| a < b) {
            return wrong("axles_m", "two axles one behind the other, within profile.length_m", &self.axles_m);
        }
        if !(0.15..=0.8).contains(&self.wheel_radius_m) {
            return wrong("wheel_radius_m", "metres from 0.15 to 0.8", &self.wheel_radius_m);
        }
        if let Rim::Spokes(count) | Rim::Pairs(count) | Rim::Cover(count) = self.rim
            && !(1..=40).contains(&count)
        {
            return wrong("rim", "a number from 1 to 40", &self.rim);
        }
        if self.seats_m.is_empty() || self.seats_m.iter().any(|s| !(0.0..=p.length_m).contains(s)) {
            return wrong("seats_m", "at least one row of seats, within profile.length_m", &self.seats_m);
        }
        if self.pillars_m.iter().chain(&self.glass_end_m).any(|s| !(0.0..=p.length_m).contains(s)) {
            let found = (&self.pillars_m, self.glass_end_m);
            return wrong("pillars_m", "pillars and glass_end_m within profile.length_m", &found);
        }
        if self.blind_from_m.is_nan() || self.dark_from_m.is_nan() {
            return wrong("blind_from_m", "metres, or no key", &self.blind_from_m);
        }
        self.check_ends()?;
        if self.paint.colors.is_empty() {
            return wrong("paint.colors", "at least one colour", &self.paint.colors);
        }
        let plate = &self.plate;
        if plate.size_m.iter().any(|m| !(0.05..=1.0).contains(m)) {
            return wrong("plate.size_m", "metres from 0.05 to 1", &plate.size_m);
        }
        let colors = self.paint.colors.iter().chain([&plate.ink, &plate.ground]).chain(&plate.field);
        if let Some(color) = colors.into_iter().find(|c| c.iter().any(|v| !(0.0..=1.0).contains(v))) {
            return wrong("paint", "colours from 0 to 1", color);
        }
        if !(self.commonness.is_finite() && self.commonness > 0.0) {
            return wrong("commonness", "a number above 0", &self.commonness);
        }
        self.check_extras()
    }

    /// Lamps and openings of both ends.
    fn check_ends(&self) -> Result<(), Wrong> {
        let (face, back) = (&self.face, &self.back);
        let needs_grille = face.bars != Bars::Closed;
        let outlines = [
            ("face.lamp", &face.lamp, true),
            ("face.strip", &face.strip, false),
            ("face.grille", &face.grille, needs_grille),
            ("face.intake", &face.intake, false),
            ("face.vent", &face.vent, false),
            ("back.lamp", &back.lamp, true),
            ("back.strip", &back.strip, false),
            ("back.white", &back.white, false),
        ];
        for (key, outline, is_needed) in outlines {
            let is_there = outline.len() > 2 || (outline.is_empty() && !is_needed);
            if !is_there || outline.len() > 40 || !outline.iter().all(is_near) {
                return wrong(key, "from 3 to 40 points (share of half the width, metres)", outline);
            }
        }
        if !face.bulbs.iter().all(is_near) {
            return wrong("face.bulbs", "points (share of half the width, metres)", &face.bulbs);
        }
        if let Bars::Across(count) | Bars::Upright(count) = face.bars
            && !(1..=40).contains(&count)
        {
            return wrong("face.bars", "a number from 1 to 40", &face.bars);
        }
        let heights = [face.badge_m, face.plate_m, back.plate_m, back.lid_m, back.black_m];
        if heights.iter().any(|m| !(-2.0..=2.0).contains(m)) {
            return wrong("face", "badge_m, plate_m, lid_m and black_m from -2 to 2", &heights);
        }
        if !(0.005..=0.2).contains(&face.bulb_m) {
            return wrong("face.bulb_m", "metres from 0.005 to 0.2", &face.bulb_m);
        }
        Ok(())
    }

    fn check_extras(&self) -> Result<(), Wrong> {
        let is_blind = self.blind_from_m < self.profile.length_m;
        for extra in &self.extras {
            let expected = match extra {
                CarExtra::LoadDoors | CarExtra::LoadName(_) if !is_blind => {
                    "no load_doors or load_name, or blind_from_m within profile.length_m"
                }
                CarExtra::LightBar(bar) if !(0.3..=2.5).contains(&bar.width_m) => "lights from 0.3 to 2.5 metres wide",
                CarExtra::Checks(checks) if !(0.05..=1.0).contains(&checks.row_m) => "rows of 0.05 to 1 metres",
                _ => continue,
            };
            return Err(("extras", expected, format!("{extra:?}")));
        }
        Ok(())
    }
}
