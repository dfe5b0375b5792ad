//! A frame's labels in the numbers of a class map.

use std::collections::BTreeMap;

use trove_format::{FrameFile, ObjectRow};
use trove_model::{ClassMap, Raster};

use crate::{StoredFrame, WriteError};

/// What each pixel shows, in a class map's numbers.
pub(crate) struct MappedLabels {
    /// The class's number.
    pub ids: Raster<u8>,
    /// The id of the object that the pixel shows; 0: none.
    pub instance: Raster<u16>,
}

/// For each number whether its class is made of things; `None` for what does not count.
pub(crate) fn things(map: &ClassMap) -> [Option<bool>; 256] {
    let mut things = [None; 256];
    map.counted().for_each(|class| things[usize::from(class.id)] = Some(class.thing));
    things
}

/// Pixels of one class, and of one object where there is one.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct Segment {
    /// The class's number.
    pub id: u8,
    /// The object; 0 for all that is not countable.
    pub object: u16,
}

/// How large a segment is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Extent {
    /// Pixels.
    pub area: u32,
    /// First column, first row, last column, last row.
    pub bounds: [u32; 4],
}

impl Extent {
    /// That of both.
    pub(crate) fn and(&self, other: &Self) -> Self {
        let ([l, t, r, b], [left, top, right, bottom]) = (self.bounds, other.bounds);
        Self { area: self.area + other.area, bounds: [l.min(left), t.min(top), r.max(right), b.max(bottom)] }
    }

    /// First column, first row, width and height, as COCO writes boxes.
    pub(crate) fn xywh(&self) -> [u32; 4] {
        let [x0, y0, x1, y1] = self.bounds;
        [x0, y0, x1 + 1 - x0, y1 + 1 - y0]
    }
}

impl StoredFrame {
    /// What each pixel shows, in a class map's numbers: by its class, by its object's kind where there is `instance.png`,
    /// and by the part that it shows of it where there is `part.png`.
    ///
    /// # Errors
    /// As for [`StoredFrame::rgb`].
    pub fn labels(&self, map: &ClassMap) -> Result<Raster<u8>, WriteError> {
        let objects = if self.has(FrameFile::Instance) { Some(self.instance()?) } else { None };
        self.mapped(map, objects.as_ref())
    }

    fn mapped(&self, map: &ClassMap, objects: Option<&Raster<u16>>) -> Result<Raster<u8>, WriteError> {
        let class = self.class()?;
        let object = |i: usize| objects.map_or(0, |objects| objects.data[i]);
        let parts = if map.knows_parts() && self.has(FrameFile::Part) { Some(self.part()?.data) } else { None };
        let last = objects.and_then(|objects| objects.data.iter().max()).copied().unwrap_or(0);
        let mut kinds = vec![None; usize::from(last) + 1];
        for ObjectRow { id, kind, .. } in &self.table.objects {
            if let Some(place) = kinds.get_mut(*id as usize) {
                *place = Some(*kind);
            }
        }
        let id = |i: usize| {
            let part = parts.as_ref().and_then(|parts| parts[i]);
            map.part_id(class.data[i], kinds[usize::from(object(i))], part)
        };
        Ok(Raster { data: (0..class.data.len()).map(id).collect(), ..class.map(|_| 0) })
    }
}

impl MappedLabels {
    /// Of a frame that has objects.
    pub(crate) fn read(frame: &StoredFrame, map: &ClassMap) -> Result<Self, WriteError> {
        let instance = frame.instance()?;
        Ok(Self { ids: frame.mapped(map, Some(&instance))?, instance })
    }

    /// The segments of the picture, without what is not labelled or does not count.
    pub(crate) fn segments(&self, map: &ClassMap) -> Vec<(Segment, Extent)> {
        let things = things(map);
        let mut found: BTreeMap<Segment, Extent> = BTreeMap::new();
        let (width, height) = (self.ids.width, self.ids.height);
        for y in 0..height {
            let row = (y * width) as usize..((y + 1) * width) as usize;
            let (ids, objects) = (&self.ids.data[row.clone()], &self.instance.data[row]);
            let mut x = 0;
            // Runs of one segment are long: one look into the table each.
            while x < width as usize {
                let (id, object, first) = (ids[x], objects[x], x);
                while x < width as usize && (ids[x], objects[x]) == (id, object) {
                    x += 1;
                }
                let Some(thing) = things[usize::from(id)] else { continue };
                let segment = Segment { id, object: if thing { object } else { 0 } };
                let (x0, x1) = (first as u32, x as u32 - 1);
                let extent = found.entry(segment).or_insert(Extent { area: 0, bounds: [x0, y, x1, y] });
                extent.area += (x - first) as u32;
                let [left, top, right, bottom] = extent.bounds;
                extent.bounds = [left.min(x0), top, right.max(x1), bottom.max(y)];
            }
        }
        found.into_iter().collect()
    }
}
