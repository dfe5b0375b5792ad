//! The labels of a picture while they are made: several threads fill a band of rows each.

use std::slice::ChunksMut;

use trove_model::{Class, ExtraLabel, ExtraLabels, Labels, Occlusion, Raster, Role, Shot};

use super::pixel::Shown;

/// Everything that pixels tell.
pub(super) struct Layers {
    pub shown: Shown,
    /// Without objects and coverage.
    pub labels: Labels,
}

/// Rows of it that follow each other, the first pixel of the upper one first. Of two layers, the first is of the previous
/// keyframe.
pub(super) struct Band<'a> {
    pub shown: &'a mut [u32],
    pub exact_range_m: &'a mut [f64],
    pub class: &'a mut [Class],
    pub instance: &'a mut [u32],
    pub depth_m: &'a mut [f32],
    pub normal: &'a mut [[f32; 3]],
    pub flow: [&'a mut [[f32; 2]]; 2],
    pub occlusion: [&'a mut [Occlusion]; 2],
    pub extra: ExtraBand<'a>,
}

/// The same of what was asked for.
pub(super) struct ExtraBand<'a> {
    pub range_m: Option<&'a mut [f32]>,
    pub normal_world: Option<&'a mut [[f32; 3]]>,
    pub albedo: Option<&'a mut [[f32; 3]]>,
    pub roughness: Option<&'a mut [f32]>,
    pub scene_flow: [Option<&'a mut [[f32; 3]]>; 2],
    pub object_coordinates: Option<&'a mut [[f32; 3]]>,
    pub part: Option<&'a mut [Option<Role>]>,
}

impl Layers {
    /// With room for what a shot asks for; every pixel is to be filled in.
    pub(super) fn new(shot: &Shot) -> Self {
        // Zeros cost nothing before they are written over.
        let (width, height) = (shot.lens.width_px, shot.lens.height_px);
        let pixels = width as usize * height as usize;
        let numbers = || Raster::filled(width, height, 0.0);
        let vectors = || Raster::filled(width, height, [0.0; 3]);
        let flow = || Raster::filled(width, height, [0.0; 2]);
        let occlusion = || Raster::filled(width, height, Occlusion::Undefined);
        let wants = |label: ExtraLabel| shot.labels.extra.contains(&label);
        let extra = ExtraLabels {
            range_m: wants(ExtraLabel::Range).then(numbers),
            normal_world: wants(ExtraLabel::NormalWorld).then(vectors),
            albedo: wants(ExtraLabel::Albedo).then(vectors),
            roughness: wants(ExtraLabel::Roughness).then(numbers),
            scene_flow_forward: wants(ExtraLabel::SceneFlowForward).then(vectors),
            scene_flow_backward: wants(ExtraLabel::SceneFlowBackward).then(vectors),
            object_coordinates: wants(ExtraLabel::ObjectCoordinates).then(vectors),
            coverage: None,
            part: wants(ExtraLabel::Part).then(|| Raster::filled(width, height, None)),
        };
        let labels = Labels {
            class: Raster::filled(width, height, Class::Void),
            instance: Raster::filled(width, height, 0),
            depth_m: numbers(),
            normal: vectors(),
            flow_forward: flow(),
            flow_backward: flow(),
            occluded_forward: occlusion(),
            occluded_backward: occlusion(),
            extra,
            objects: Vec::new(),
        };
        Self { shown: Shown { width, instance: vec![0; pixels], range_m: vec![0.0; pixels] }, labels }
    }

    /// All bands of so many rows, from the top; the last one may have fewer.
    pub(super) fn bands(&mut self, rows: u32) -> Vec<Band<'_>> {
        let pixels = (self.shown.width.max(1) * rows) as usize;
        let labels = &mut self.labels;
        let extra = &mut labels.extra;
        let mut shown = self.shown.instance.chunks_mut(pixels);
        let mut exact_range_m = self.shown.range_m.chunks_mut(pixels);
        let (mut class, mut instance) = (labels.class.data.chunks_mut(pixels), labels.instance.data.chunks_mut(pixels));
        let (mut depth_m, mut normal) = (labels.depth_m.data.chunks_mut(pixels), labels.normal.data.chunks_mut(pixels));
        let mut flow = [labels.flow_backward.data.chunks_mut(pixels), labels.flow_forward.data.chunks_mut(pixels)];
        let mut occlusion =
            [labels.occluded_backward.data.chunks_mut(pixels), labels.occluded_forward.data.chunks_mut(pixels)];
        let mut range_m = chunks(&mut extra.range_m, pixels);
        let mut normal_world = chunks(&mut extra.normal_world, pixels);
        let mut albedo = chunks(&mut extra.albedo, pixels);
        let mut roughness = chunks(&mut extra.roughness, pixels);
        let mut before = chunks(&mut extra.scene_flow_backward, pixels);
        let mut after = chunks(&mut extra.scene_flow_forward, pixels);
        let mut object_coordinates = chunks(&mut extra.object_coordinates, pixels);
        let mut part = chunks(&mut extra.part, pixels);
        let mut band = || {
            Some(Band {
                shown: shown.next()?,
                exact_range_m: exact_range_m.next()?,
                class: class.next()?,
                instance: instance.next()?,
                depth_m: depth_m.next()?,
                normal: normal.next()?,
                flow: [flow[0].next()?, flow[1].next()?],
                occlusion: [occlusion[0].next()?, occlusion[1].next()?],
                extra: ExtraBand {
                    range_m: next(&mut range_m),
                    normal_world: next(&mut normal_world),
                    albedo: next(&mut albedo),
                    roughness: next(&mut roughness),
                    scene_flow: [next(&mut before), next(&mut after)],
                    object_coordinates: next(&mut object_coordinates),
                    part: next(&mut part),
                },
            })
        };
        std::iter::from_fn(&mut band).collect()
    }
}

fn chunks<T>(layer: &mut Option<Raster<T>>, pixels: usize) -> Option<ChunksMut<'_, T>> {
    layer.as_mut().map(|raster| raster.data.chunks_mut(pixels))
}

fn next<'a, T>(bands: &mut Option<ChunksMut<'a, T>>) -> Option<&'a mut [T]> {
    bands.as_mut().and_then(Iterator::next)
}

/// Fills a pixel in where its layer was asked for.
pub(super) fn put<T>(layer: &mut Option<&mut [T]>, i: usize, value: impl FnOnce() -> T) {
    if let Some(layer) = layer {
        layer[i] = value();
    }
}
