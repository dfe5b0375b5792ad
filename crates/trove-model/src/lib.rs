//! The nouns of TRoVE and their mathematics.
//!
//! What goes in: numbers. What comes out: types with meaning. This crate must not know files, clocks, threads, the
//! environment, or any third-party type but glam's.
//!
//! Poses compose only where their frames meet, and a [`Lens`] takes points in the camera's frame to pixels:
//!
//! ```
//! use glam::{DMat3, DQuat, DVec2, DVec3};
//! use trove_model::{Camera, Distortion, Ego, Lens, Pose, World};
//!
//! // A vehicle that heads north, with a camera on its roof that looks forward.
//! let world_from_ego = Pose::<World, Ego>::from_yaw(std::f64::consts::FRAC_PI_2, DVec3::new(10.0, 20.0, 0.0));
//! let forward = DQuat::from_mat3(&DMat3::from_cols(-DVec3::Y, -DVec3::Z, DVec3::X));
//! let ego_from_camera = Pose::<Ego, Camera>::new(forward, DVec3::new(1.7, 0.0, 1.5));
//! let world_from_camera = world_from_ego * ego_from_camera; // the other way round it does not compile
//!
//! let lens = Lens {
//!     width_px: 1600,
//!     height_px: 900,
//!     fx_px: 1266.0,
//!     fy_px: 1266.0,
//!     cx_px: 800.0,
//!     cy_px: 450.0,
//!     distortion: Distortion::None,
//! };
//! let project = |point_world| lens.project(world_from_camera.inverse().point(point_world));
//! let ahead = project(DVec3::new(10.0, 50.0, 1.5)).expect("a point before the camera");
//! assert!(ahead.distance(DVec2::new(800.0, 450.0)) < 1e-9);
//! assert_eq!(project(DVec3::new(10.0, -50.0, 1.5)), None, "a point behind it");
//! ```

mod asset;
mod beam;
mod capture;
mod class;
mod class_map;
mod cuboid;
mod drive;
mod ego_motion;
mod facade;
#[cfg(feature = "serde")]
mod flat;
mod frames;
mod height_field;
mod human_body;
mod ies;
mod in_season;
mod keypoints;
mod kind;
mod lane_map;
mod lens;
mod lettering;
mod light;
mod locale;
mod looks;
mod luminaire;
mod luminance;
mod material;
mod mesh;
mod outdoors;
mod patches;
mod plant;
mod point_cloud;
mod polygon;
mod precipitation;
mod projection;
mod puff;
mod radar;
mod raster;
mod relief;
mod report;
mod road_plan;
mod role;
mod scanner;
mod scene;
mod seed;
mod sensor;
mod shot;
mod snow;
mod srgb;
mod state;
mod street_map;
mod surface_kind;
mod tags;
mod tone_curve;
mod trajectory;
mod variation;
mod voxels;

pub use asset::{Asset, AssetLibrary, Coarser, CoverKind, Extra, Figure, GroundCover, Posture, Slot, Surface};
pub use beam::Beam;
pub use capture::{
    Capture, CaptureStats, Color, ExtraLabel, ExtraLabels, GlassLabels, LabelSettings, Labels, Mask, ObjectLabel,
    Occlusion, PixelBox, SeenKeypoint,
};
pub use class::{CLASSES, Class, ClassRow, LABEL_TABLES, label_table};
pub use class_map::{ClassMap, ClassMapEntry, ClassMapFault, InstanceCoding, MappedClass};
pub use cuboid::Cuboid;
pub use drive::{
    Drive, DriveOrigin, EgoBody, Exposure, Keyframe, LidarClass, LidarSweep, ObjectBox, RigCamera, Sweep, Track,
};
pub use ego_motion::EgoMotion;
pub use facade::{Course, FacadeDesign, Filling, Fixtures, Interior, Opening};
pub use frames::{Body, Camera, Ego, Frame, Pose, SensorFrame, World};
pub use height_field::HeightField;
pub use human_body::{BodyJoint, HumanBody};
pub use ies::IesFault;
pub use keypoints::{KEYPOINTS, Keypoints};
pub use kind::Kind;
pub use lane_map::{Lane, LaneMap, LaneMark, MarkPattern};
pub use lens::{Distortion, Lens};
pub use lettering::Lettering;
pub use light::{Environment, EnvironmentMap, Fog, Light, Moon, PhysicalSky};
pub use locale::{
    BuildingCustoms, CarColors, CentreLine, Covering, CrossingStyle, Dash, DrivingSide, FacadeRule, FacadeUse,
    GiveWayLine, KerbCustoms, KerbLines, KerbParking, LampCustoms, LampRow, LidarBuildings, LinePattern, Locale,
    MarkingCustoms, MinorRoad, ModelShare, NamePlate, Paint, RoadSurfaceCustoms, RoofShare, SignCustoms, SignalCustoms,
    SignalSide, SpeedUnit, StreetCustoms, TrafficMix, WarrantedSign,
};
pub use looks::Looks;
pub use luminaire::Luminaire;
pub use luminance::luminance;
pub use material::{ColorSpace, Mapping, Material, Texture, Tiling};
pub use mesh::Mesh;
pub use outdoors::Outdoors;
pub use patches::{InPatches, Patches};
pub use plant::{Climate, Foliage, LeafType, Plant, PlantForm, Season};
pub use point_cloud::{LidarPoint, PointCloud};
pub use polygon::{Bounds, Polygon};
pub use precipitation::{Form, Precipitation};
pub use projection::{DatasetPlane, MapProjection};
pub use puff::Puff;
pub use radar::{Radar, RadarDetection, RadarDirection, RadarScan, RadarShot, RadarSurface, RadarSurfaces};
pub use raster::Raster;
pub use relief::Relief;
pub use report::{Entry, Measurement, Outcome, Report};
pub use road_plan::{LaneUsage, MapLayer, PaintedLine, PlannedLane, RoadPlan};
pub use role::Role;
pub use scanner::{LidarShot, RigLidar, Scanner, SweepPhase, ToldReturns};
pub use scene::{Instance, InstanceId, Origin, Placement, Provenance, Scene, SceneObject};
pub use seed::{Random, Seed, weighted_at};
pub use sensor::{Points, Return, Scan, Sensor, SensorRay};
pub use shot::{CameraBeside, ExposureRule, Film, LensDrops, SensorModel, Shot, Shutter, Viewpoint, WhiteBalance};
pub use snow::{Snow, SnowLeft};
pub use state::State;
pub use street_map::{
    BarrierStyle, Building, BuildingKind, CrossingMarking, Cycleway, Furniture, FurnitureDetail, FurnitureKind,
    LampMount, Land, LandKind, LineKind, MapLine, MappedPlant, MappedSign, Parking, ParkingOrientation, Road, RoadKind,
    RoadSurface, RoofMaterial, RoofShape, Sides, SidewalkSides, StreetMap, Turns, WallMaterial,
};
pub use surface_kind::SurfaceKind;
pub use tags::Tags;
pub use tone_curve::ToneCurve;
pub use trajectory::{Disorder, Trajectory};
pub use voxels::{GridForm, GridFrame, GridPlan, GridShot, Occupancy, VoxelGrid};
