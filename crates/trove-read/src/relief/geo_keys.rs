//! Where the samples of a GeoTIFF lie on the earth (OGC GeoTIFF 1.1).

use glam::DVec2;

use super::sheet::Grid;

/// Keys.
const MODEL_TYPE: u16 = 1024;
const RASTER_TYPE: u16 = 1025;
const GEODETIC_CRS: u16 = 2048;
const ANGULAR_UNITS: u16 = 2054;
const PROJECTED_CRS: u16 = 3072;
const VERTICAL_UNITS: u16 = 4099;
/// Values.
const GEOGRAPHIC: u16 = 2;
const PIXEL_IS_POINT: u16 = 2;
const DEGREE: u16 = 9102;
/// Coordinate systems within metres of WGS84: itself in two and three dimensions, ETRS89, NAD83; and user-defined.
const NEAR_WGS84: [u16; 5] = [4326, 4979, 4258, 4269, 32767];

/// The numbers of the tags that say so.
pub(super) struct GeoTags {
    /// Columns and rows of the picture.
    pub size: [u32; 2],
    /// `ModelPixelScale`, empty where there is none.
    pub pixel_scale: Vec<f64>,
    /// `ModelTiepoint`, likewise.
    pub tiepoint: Vec<f64>,
    /// `ModelTransformation`, likewise.
    pub transformation: Vec<f64>,
    /// `GeoKeyDirectory`, likewise.
    pub keys: Vec<u16>,
}

/// What the tags say.
pub(super) struct Georeference {
    pub grid: Grid,
    /// Metres that a unit of height is.
    pub height_unit_m: f64,
    /// The code of a coordinate system that may lie hundreds of metres from WGS84.
    pub foreign_crs: Option<u16>,
}

/// What was expected, what was found, and what to do.
pub(super) struct Fault(pub &'static str, pub String, pub &'static str);

const REPROJECT: &str = "convert it: gdalwarp -t_srs EPSG:4326 IN.tif OUT.tif";
const REFERENCE: &str = "take the file with its georeference, or convert it: gdal_translate -a_srs EPSG:4326 -a_ullr WEST NORTH EAST SOUTH IN.tif OUT.tif";

impl GeoTags {
    /// # Errors
    /// Coordinates that are not geographic, a grid that is turned, or numbers that make no sense.
    pub(super) fn georeference(&self) -> Result<Georeference, Fault> {
        let key = |key: u16| self.keys.get(4..)?.chunks_exact(4).find(|k| k[0] == key && k[1] == 0).map(|k| k[3]);
        match (key(MODEL_TYPE), key(PROJECTED_CRS), key(GEODETIC_CRS)) {
            (Some(GEOGRAPHIC), ..) | (None, None, Some(_)) => {}
            (None, None, None) => {
                return Err(Fault("geographic coordinates", "no coordinate system".into(), REFERENCE));
            }
            (_, Some(code), _) => {
                let found = format!("projected ones (EPSG:{code})");
                return Err(Fault("geographic coordinates (degrees)", found, REPROJECT));
            }
            (..) => return Err(Fault("geographic coordinates (degrees)", "other ones".into(), REPROJECT)),
        }
        if let Some(unit) = key(ANGULAR_UNITS).filter(|unit| *unit != DEGREE) {
            return Err(Fault("coordinates in degrees (unit 9102)", format!("unit {unit}"), REPROJECT));
        }
        // International feet and the surveyors' of the United States.
        let height_unit_m = match key(VERTICAL_UNITS) {
            Some(9002) => 0.3048,
            Some(9003) => 1200.0 / 3937.0,
            _ => 1.0,
        };
        let (corner_deg, step_deg) = self.placement()?;
        let plausible = step_deg.is_finite()
            && step_deg.cmpgt(DVec2::splat(1e-8)).all()
            && step_deg.cmplt(DVec2::splat(10.0)).all()
            && corner_deg.is_finite()
            && corner_deg.x.abs() <= 720.0
            && corner_deg.y.abs() <= 91.0;
        if !plausible {
            let found = format!("corner {corner_deg}, step {step_deg}");
            return Err(Fault("a grid of degrees on the earth", found, REFERENCE));
        }
        // Tie points lie on the corner of a pixel where its value is the area's.
        let into_pixel = if key(RASTER_TYPE) == Some(PIXEL_IS_POINT) { 0.0 } else { 0.5 };
        let north_west_deg = corner_deg + DVec2::new(into_pixel, -into_pixel) * step_deg;
        let grid = Grid { north_west_deg, step_deg, size: self.size };
        let foreign_crs = key(GEODETIC_CRS).filter(|code| !NEAR_WGS84.contains(code));
        Ok(Georeference { grid, height_unit_m, foreign_crs })
    }

    /// Longitude and latitude of the picture's north-west corner, and a pixel's size.
    fn placement(&self) -> Result<(DVec2, DVec2), Fault> {
        match (&self.pixel_scale[..], &self.tiepoint[..], &self.transformation[..]) {
            ([sx, sy, ..], [i, j, _, x, y, _, ..], _) => Ok((DVec2::new(x - i * sx, y + j * sy), DVec2::new(*sx, *sy))),
            (_, _, [a, b, _, x, d, e, _, y, ..]) if *b == 0.0 && *d == 0.0 => {
                Ok((DVec2::new(*x, *y), DVec2::new(*a, -e)))
            }
            (_, _, [_, _, _, _, ..]) => {
                Err(Fault("a grid along parallels and meridians", "one that is turned".into(), REPROJECT))
            }
            _ => {
                let found = "neither a pixel scale with a tie point nor a transformation".into();
                Err(Fault("a georeference", found, REFERENCE))
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn tags(keys: &[[u16; 2]]) -> GeoTags {
        let directory = [[1, 1, 0, keys.len() as u16]].into_iter().chain(keys.iter().map(|&[key, v]| [key, 0, 1, v]));
        GeoTags {
            size: [10, 10],
            pixel_scale: vec![0.1, 0.2, 0.0],
            tiepoint: vec![0.0, 0.0, 0.0, 7.0, 44.0, 0.0],
            transformation: Vec::new(),
            keys: directory.flatten().collect(),
        }
    }

    #[test]
    fn samples_lie_in_the_middle_of_areas_and_on_points() {
        let area = tags(&[[1024, 2], [1025, 1]]).georeference().ok().unwrap();
        assert!(area.grid.north_west_deg.distance(DVec2::new(7.05, 43.9)) < 1e-12);
        let point = tags(&[[1024, 2], [1025, 2], [4099, 9002]]).georeference().ok().unwrap();
        assert_eq!((point.grid.north_west_deg, point.height_unit_m), (DVec2::new(7.0, 44.0), 0.3048));
        let transformed = GeoTags {
            pixel_scale: Vec::new(),
            transformation: vec![0.1, 0.0, 0.0, 7.0, 0.0, -0.2, 0.0, 44.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0],
            ..tags(&[[2048, 4326]])
        };
        assert!(
            transformed.georeference().ok().unwrap().grid.north_west_deg.distance(area.grid.north_west_deg) < 1e-12
        );
    }

    #[test]
    fn other_coordinates_are_told_with_a_remedy() {
        let turned = GeoTags {
            pixel_scale: Vec::new(),
            transformation: vec![0.1, 0.01, 0.0, 7.0, 0.0, -0.2, 0.0, 44.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0],
            ..tags(&[[1024, 2]])
        };
        let wild = GeoTags { pixel_scale: vec![f64::NAN, 0.1, 0.0], ..tags(&[[1024, 2]]) };
        let mirrored = GeoTags { pixel_scale: vec![0.1, -0.1, 0.0], ..tags(&[[1024, 2]]) };
        let bare = GeoTags { pixel_scale: Vec::new(), ..tags(&[[1024, 2]]) };
        for (tags, found, remedy) in [
            (tags(&[[1024, 1], [3072, 32632]]), "EPSG:32632", "gdalwarp"),
            (tags(&[[1024, 3]]), "other ones", "gdalwarp"),
            (tags(&[]), "no coordinate system", "gdal_translate"),
            (tags(&[[1024, 2], [2054, 9101]]), "unit 9101", "gdalwarp"),
            (turned, "turned", "gdalwarp"),
            (wild, "NaN", "gdal_translate"),
            (mirrored, "-0.1", "gdal_translate"),
            (bare, "neither", "gdal_translate"),
        ] {
            let Err(fault) = tags.georeference() else { panic!("{found}") };
            assert!(fault.1.contains(found) && fault.2.contains(remedy), "{} {}", fault.1, fault.2);
        }
    }
}
