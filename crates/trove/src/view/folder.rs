//! The frames of a finished folder.

use std::path::Path;

use anyhow::{Result, ensure};
use rayon::prelude::*;
use serde::Serialize;
use trove_format::{FrameRow, FrameTable, LanesFile, Manifest, TrajectoryFile};
use trove_write::StoredFrame;

use super::chunks::Chunks;
use super::pictures::Pictures;
use super::pose::pose_of_parts;
use super::scene::{SceneChunk, Seen, Things};
use super::shapes::Shapes;
use super::table::{Camera, SceneRow, Table};
use crate::progress::Progress;
use crate::watch::Watch;

/// What the page loads of a frame.
#[derive(Serialize)]
struct FrameChunk {
    images: Pictures,
    objects: Vec<Seen>,
}

/// Adds the frames of a folder and their scenes, so many of them with the shapes that are made of a scene's name, variation
/// and moments.
pub(super) fn add(
    folder: &Path,
    manifest: &Manifest,
    (wanted, mut shapes): (usize, impl FnMut(&str, u32, &[u32]) -> Option<Shapes>),
    (table, chunks): (&mut Table, &mut Chunks),
    watch: &Watch,
) -> Result<()> {
    let progress = Progress::new(manifest.frames.len(), watch);
    let same_scene = |a: &FrameRow, b: &FrameRow| (&a.scene, a.variation) == (&b.scene, b.variation);
    for (number, rows) in manifest.frames.chunk_by(same_scene).enumerate() {
        let [first, ..] = rows else { continue };
        let id = format!("{}/v{:02}", first.scene, first.variation);
        let mut row =
            SceneRow::new(id.clone(), first.scene.clone(), format!("{} v{:02}", first.scene, first.variation));
        let mut chunk = SceneChunk::default();
        let of_scene = folder.join(&id);
        chunk.set_lanes(LanesFile::read(&of_scene)?);
        let way = TrajectoryFile::read(&of_scene)?;
        chunk.set_way(&way);
        // A handful at a time, so that memory does not grow with the run.
        for rows in rows.chunks(4 * rayon::current_num_threads()) {
            ensure!(!watch.stops(), "ended before every frame was read; the page was not written");
            let read = |row: &FrameRow| -> Result<(FrameTable, Pictures)> {
                let frame = StoredFrame::open(&folder.join(&row.path))?;
                let pictures = Pictures::of(&frame)?;
                progress.frame_done();
                Ok((frame.table, pictures))
            };
            let made: Vec<_> = rows.par_iter().map(read).collect::<Result<_>>()?;
            for (frame, (seen, images)) in rows.iter().zip(made) {
                add_frame(frame, &seen, (&mut row, &mut chunk));
                table.add_layers(images.layers());
                let objects = seen.objects.iter().filter(|row| row.visible_px > 0).map(Seen::of).collect();
                chunks.add(&frame.path, &FrameChunk { images, objects })?;
            }
        }
        for moment in &mut row.moments {
            let at = way.moments.iter().find(|at| at.keyframe == moment.keyframe);
            moment.ego =
                at.map(|at| pose_of_parts(at.pose.world_from_ego_rotation_wxyz, at.pose.world_from_ego_translation_m));
        }
        if number < wanted {
            progress.say(&format!("building {}", row.name));
            let moments: Vec<u32> = row.moments.iter().map(|moment| moment.keyframe).collect();
            chunk.shapes = shapes(&first.scene, first.variation, &moments);
        }
        chunks.add(&id, &chunk)?;
        table.scenes.push(row);
    }
    progress.finish();
    Ok(())
}

fn add_frame(frame: &FrameRow, seen: &FrameTable, (row, chunk): (&mut SceneRow, &mut SceneChunk)) {
    let moment = row.moment(frame.keyframe);
    moment.frames.push(Camera::of_frame(&frame.path, seen));
    chunk.moments.resize_with(row.moments.len(), Things::default);
    for object in &seen.objects {
        chunk.add(object.into());
    }
}
