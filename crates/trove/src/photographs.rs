//! The recorded photographs of a scene beside renders of their views: what they tell of how it looks.

use std::collections::BTreeMap;
use std::path::PathBuf;

use anyhow::Result;
use trove_judge::looks::{Pair, distances, looks};
use trove_judge::thumbnail;
use trove_model::{Capture, Drive, Film, Outcome, Raster, Report, Shot, Viewpoint};
use trove_render::Renderer;

use crate::sources::Sources;
use crate::virtual_scene::VirtualScene;

/// Photographs are compared at this width, pixels.
const WIDTH_PX: u32 = 240;
/// With so many samples a pixel.
const SPP: u32 = 8;
/// Those of at most so many keyframes, spread over the drive.
const KEYFRAMES: usize = 4;
/// What was found is rendered and looked at again: highlights and reflections answer less than in proportion.
const ROUNDS: usize = 2;

/// A photograph with the shot that repeats it.
struct Photograph {
    camera: String,
    picture: Raster<[u8; 3]>,
    shot: Shot,
}

/// Exposes the scene's cameras, gives their film contrast and colours its vehicles, people, buildings and surfaces as its
/// recorded photographs have them.
pub(crate) fn match_photographs(
    built: &mut VirtualScene<'_>,
    sources: &Sources,
    renderer: &Renderer,
    report: &Report,
) -> Result<()> {
    let keyframes = keyframes(built, sources, report);
    if keyframes.is_empty() {
        report.note(Outcome::Warned, "no recorded photographs that could be matched", &built.moments.drive.id);
        return Ok(());
    }
    for round in 0..=ROUNDS {
        let mut rendered: Vec<(&Photograph, Film, Capture)> = Vec::new();
        for (moment, photographs) in &keyframes {
            let prepared = renderer.prepare(&built.at(*moment))?;
            let exposed = built.shots(*moment, &Report::default());
            for photograph in photographs {
                let Some(now) = exposed.iter().find(|s| s.view == photograph.shot.view) else { continue };
                let shot = Shot { film: now.film, ..photograph.shot.clone() };
                let capture = renderer.render(&prepared, &shot, true, &|_| false);
                rendered.extend(capture.map(|capture| (photograph, shot.film, capture)));
            }
        }
        let pairs: Vec<Pair> =
            rendered.iter().filter_map(|(photograph, film, capture)| pair(photograph, film, capture)).collect();
        let distances: Vec<f64> = distances(&pairs).into_values().collect();
        let mean = distances.iter().sum::<f64>() / distances.len().max(1) as f64;
        if round == 0 {
            report.measure("photographs.matched", pairs.len() as f64);
            report.measure("photographs.distance_before", mean);
        }
        if round == ROUNDS {
            report.measure("photographs.distance", mean);
            if let Some(pair) = pairs.first() {
                report.measure("photographs.contrast", pair.contrast);
            }
        } else {
            built.look_like(&looks(&pairs));
        }
    }
    Ok(())
}

/// The moments with photographs that are looked at.
fn keyframes(built: &VirtualScene<'_>, sources: &Sources, report: &Report) -> Vec<(usize, Vec<Photograph>)> {
    let drive = built.moments.drive;
    let files = sources.photographs(drive);
    let is_there = |file: &Option<String>| file.as_ref().is_some_and(|file| files.contains_key(file));
    let has_some = |&m: &usize| drive.keyframes[m].exposures.iter().any(|e| is_there(&e.file));
    let all: Vec<usize> = (0..drive.keyframes.len()).filter(has_some).collect();
    let step = all.len().div_ceil(KEYFRAMES).max(1);
    let taken = |moment: usize| {
        let shots = built.shots(moment, &Report::default()).into_iter();
        let photographs = shots.filter_map(|shot| photograph(drive, &files, moment, shot, report)).collect();
        (moment, photographs)
    };
    all.into_iter().step_by(step).map(taken).filter(|(_, photographs): &(_, Vec<_>)| !photographs.is_empty()).collect()
}

/// The photograph that a shot repeats.
fn photograph(
    drive: &Drive,
    files: &BTreeMap<String, PathBuf>,
    moment: usize,
    shot: Shot,
    report: &Report,
) -> Option<Photograph> {
    let Viewpoint::Recording { camera } = shot.viewpoint else { return None };
    let exposure = drive.keyframes[moment].exposures.iter().find(|e| e.camera == camera)?;
    let path = files.get(exposure.file.as_ref()?)?;
    let lens = exposure.lens.scaled(f64::from(WIDTH_PX) / f64::from(exposure.lens.width_px));
    let picture = match thumbnail(path, WIDTH_PX) {
        Ok(picture) if (picture.width, picture.height) == (lens.width_px, lens.height_px) => picture,
        Ok(_) => {
            let (width, height) = (exposure.lens.width_px, exposure.lens.height_px);
            let example = format!("{}: expected the shape of {width} × {height}", path.display());
            report.note(Outcome::Dropped, "photograph that has not the shape of its camera's pictures", example);
            return None;
        }
        Err(error) => {
            report.note(Outcome::Dropped, "photograph that cannot be read", error);
            return None;
        }
    };
    let world_from_camera = exposure.world_from_camera();
    let shot = Shot { lens, world_from_camera, spp: SPP, noise: 0.0, drops: None, ..shot };
    Some(Photograph { camera: drive.rig.get(camera)?.name.clone(), picture, shot })
}

fn pair<'a>(photograph: &'a Photograph, film: &Film, capture: &'a Capture) -> Option<Pair<'a>> {
    let render = &capture.color.as_ref()?.srgb;
    let (camera, contrast) = (&photograph.camera, film.contrast);
    Some(Pair { camera, photograph: &photograph.picture, render, contrast, labels: &capture.labels })
}
