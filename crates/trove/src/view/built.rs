//! Scenes of a recipe, built again for their shapes.

use std::path::PathBuf;

use anyhow::{Context, Result, ensure};
use glam::DVec3;
use rayon::prelude::*;
use trove_build::Timeline;
use trove_format::{LanesFile, TrajectoryFile};
use trove_model::{AssetLibrary, Instance, Origin, Report, Scene, SceneObject, Shot};

use super::chunks::Chunks;
use super::pose::pose;
use super::scene::{SceneChunk, Thing, Things, centimetres};
use super::shapes::{Shapes, Stand, Stock};
use super::table::{Camera, SceneRow, Table};
use crate::contents::Contents;
use crate::library;
use crate::progress::Progress;
use crate::recipe::Recipe;
use crate::sources::Sources;
use crate::virtual_scene::VirtualScene;
use crate::watch::Watch;

/// What the scenes of a recipe are built from.
pub(super) struct Builder<'a> {
    sources: Sources<'a>,
    library: AssetLibrary,
    report: Report,
}

impl<'a> Builder<'a> {
    pub(super) fn open(recipe: &'a Recipe, search: &[PathBuf]) -> Result<Self> {
        let report = Report::default();
        let sources = Sources::open(recipe, &report)?;
        let library = library::gather(recipe, search, &mut Contents::open(), &report)?;
        Ok(Self { sources, library, report })
    }

    /// The shapes of a variation of a scene, with who is there at some moments.
    pub(super) fn shapes(&self, scene: &str, variation: u32, moments: &[u32]) -> Result<Shapes> {
        let (timeline, map) = self.sources.drive(scene, &self.report)?;
        let built =
            VirtualScene::build(&self.sources, (&timeline, map.as_ref()), &self.library, variation, &self.report)?;
        let mut shapes = None;
        for few in moments.chunks(rayon::current_num_threads()) {
            let scenes: Vec<Scene> = few.par_iter().map(|moment| built.at(*moment as usize)).collect();
            scenes.iter().for_each(|scene| add_shapes(&mut shapes, scene, &timeline));
        }
        Ok(shapes.unwrap_or_default())
    }

    /// The recipe's first scene with its cameras.
    pub(super) fn first_scene(
        &self,
        recipe: &Recipe,
        table: &mut Table,
        chunks: &mut Chunks,
        watch: &Watch,
    ) -> Result<()> {
        let scenes = self.sources.scenes()?;
        let (name, _) = scenes.first().context("the recipe has no scene")?;
        let (timeline, map) = self.sources.drive(name, &self.report)?;
        let built = VirtualScene::build(&self.sources, (&timeline, map.as_ref()), &self.library, 0, &self.report)?;
        let moments = timeline.moments();
        let keyframes = match &recipe.drive {
            Some(section) => section.keyframes.of(timeline.recorded.keyframes.len())?,
            None => (0..timeline.recorded.keyframes.len()).collect(),
        };
        let id = format!("{name}/v00");
        let mut row = SceneRow::new(id.clone(), name.clone(), name.clone());
        let mut chunk = SceneChunk::default();
        chunk.set_lanes(LanesFile::new(moments.drive, built.site.roads()));
        chunk.set_way(&TrajectoryFile::new(moments.drive, |moment| moments.keyframe(moment)));
        let chosen = moments.chosen(&keyframes);
        let progress = Progress::new(chosen.len(), watch);
        for few in chosen.chunks(rayon::current_num_threads()) {
            ensure!(!watch.stops(), "ended before every moment was built; nothing was written");
            let built: Vec<(Scene, Vec<Shot>)> =
                few.par_iter().map(|k| (built.at(*k), built.shots(*k, &self.report))).collect();
            for (k, (scene, shots)) in few.iter().zip(built) {
                let moment = row.moment(*k as u32);
                moment.ego = moments.drive.keyframes.get(*k).map(|keyframe| pose(&keyframe.world_from_ego.affine()));
                moment.frames.extend(shots.iter().map(|shot| Camera::of_shot(&format!("{id}/k{k:03}"), shot)));
                chunk.moments.push(Things::default());
                let objects = scene.instances.iter().filter_map(|one| Some(thing(one, one.object.as_ref()?)));
                objects.for_each(|thing| chunk.add(thing));
                add_shapes(&mut chunk.shapes, &scene, &timeline);
                progress.frame_done();
            }
        }
        progress.finish();
        table.scenes.push(row);
        chunks.add(&id, &chunk)
    }
}

/// Adds who is in a scene, and of the first one what stands in it.
fn add_shapes(shapes: &mut Option<Shapes>, scene: &Scene, timeline: &Timeline) {
    let stock = Stock { meshes: &scene.meshes, materials: &scene.materials };
    shapes.get_or_insert_with(|| Shapes::of(stock, &stands(scene), &way(timeline))).add_bodies(stock, &bodies(scene));
}

/// What stands still.
fn stands(scene: &Scene) -> Vec<Stand<'_>> {
    let is_still = |one: &&Instance| one.object.as_ref().is_none_or(|object| object.origin == Origin::Scenery);
    let still = scene.instances.iter().filter(is_still);
    still.map(|one| Stand { mesh: one.mesh, materials: &one.materials, place: one.world_from_mesh }).collect()
}

/// Who moves.
fn bodies(scene: &Scene) -> Vec<(u32, Stand<'_>)> {
    let body = |one: &'_ Instance| {
        let object = one.object.as_ref().filter(|object| object.origin != Origin::Scenery)?;
        let place = object.cuboid.world_from_body.inverse().affine() * one.world_from_mesh;
        Some((one.id.0, place))
    };
    let stand = |one| body(one).map(|(id, place)| (id, Stand { mesh: one.mesh, materials: &one.materials, place }));
    scene.instances.iter().filter_map(stand).collect()
}

fn thing(instance: &Instance, object: &SceneObject) -> Thing {
    Thing {
        id: instance.id.0,
        class_id: instance.class.id(),
        kind: object.kind.name(),
        origin: (&object.origin).into(),
        asset: object.asset.clone().unwrap_or_default(),
        pose: pose(&object.cuboid.world_from_body.affine()),
        size: object.cuboid.size_m.to_array().map(centimetres),
    }
}

/// Where the recording vehicle was.
fn way(timeline: &Timeline) -> Vec<DVec3> {
    timeline.recorded.keyframes.iter().map(|keyframe| keyframe.world_from_ego.affine().translation).collect()
}
