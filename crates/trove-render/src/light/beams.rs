//! Into which directions lamps shine, made ready.

use std::sync::Arc;

use trove_model::Beam;
use trove_trace::light::{self, BeamTable};

/// What [`light::Beams`] looks up.
#[derive(Default)]
pub(crate) struct Beams {
    known: Vec<Arc<Beam>>,
    tables: Vec<BeamTable>,
    numbers: Vec<f32>,
}

impl Beams {
    /// The index of a beam, which is listed if it is new.
    pub(crate) fn index(&mut self, beam: &Arc<Beam>) -> u32 {
        let known = self.known.iter().position(|other| Arc::ptr_eq(other, beam));
        known.unwrap_or_else(|| self.list(beam)) as u32
    }

    fn list(&mut self, beam: &Arc<Beam>) -> usize {
        let [azimuths, elevations, shares] = beam.table();
        let first = self.numbers.len() as u32;
        self.tables.push(BeamTable { first, azimuths: azimuths.len() as u32, elevations: elevations.len() as u32 });
        [azimuths, elevations, shares].into_iter().for_each(|part| self.numbers.extend_from_slice(part));
        self.known.push(beam.clone());
        self.known.len() - 1
    }

    /// To be looked up.
    pub(crate) fn view(&self) -> light::Beams<'_> {
        light::Beams { tables: &self.tables, numbers: &self.numbers }
    }
}
