//! The tables' records, as far as they are used.

use std::fmt;

use serde::de::{self, Visitor};
use serde::{Deserialize, Deserializer};

/// A record that is found by its token.
pub(super) trait Record: for<'de> Deserialize<'de> {
    /// The table's file name without its ending.
    const TABLE: &'static str;
    /// Its own token.
    fn token(&self) -> &str;
}

macro_rules! record {
    ($table:literal, $(#[$doc:meta])* $name:ident { $($(#[$attr:meta])* $field:ident: $type:ty),* $(,)? }) => {
        $(#[$doc])*
        #[derive(Clone, Debug, Deserialize)]
        pub(super) struct $name {
            pub(super) token: String,
            $($(#[$attr])* pub(super) $field: $type,)*
        }

        impl Record for $name {
            const TABLE: &'static str = $table;
            fn token(&self) -> &str {
                &self.token
            }
        }
    };
}

/// A time that some relatives write with a fraction.
pub(super) fn microseconds<'de, D: Deserializer<'de>>(deserializer: D) -> Result<i64, D::Error> {
    struct Microseconds;
    impl Visitor<'_> for Microseconds {
        type Value = i64;

        fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
            f.write_str("microseconds since 1970")
        }

        fn visit_i64<E: de::Error>(self, time_us: i64) -> Result<i64, E> {
            Ok(time_us)
        }

        fn visit_u64<E: de::Error>(self, time_us: u64) -> Result<i64, E> {
            i64::try_from(time_us).map_err(E::custom)
        }

        fn visit_f64<E: de::Error>(self, time_us: f64) -> Result<i64, E> {
            Ok(time_us.round() as i64)
        }
    }
    deserializer.deserialize_any(Microseconds)
}

record!(
    "scene",
    SceneRecord {
        name: String,
        log_token: String,
        first_sample_token: String,
        #[serde(default)]
        nbr_samples: i64,
        #[serde(default)]
        description: String,
    }
);

record!("log",
    /// The `trove_` keys are ours: a made-up place says where on earth it lies and under which licence it is.
    LogRecord {
    #[serde(default)]
    location: String,
    #[serde(default)]
    date_captured: String,
    trove_origin_lat_deg: Option<f64>,
    trove_origin_lon_deg: Option<f64>,
    trove_licence: Option<String>,
});

record!(
    "sample",
    SampleRecord {
        #[serde(deserialize_with = "microseconds")]
        timestamp: i64,
        scene_token: String,
        #[serde(default)]
        next: String,
    }
);

record!(
    "sample_data",
    SampleDataRecord {
        sample_token: String,
        ego_pose_token: String,
        calibrated_sensor_token: String,
        #[serde(deserialize_with = "microseconds")]
        timestamp: i64,
        is_key_frame: bool,
        width: Option<i64>,
        height: Option<i64>,
        #[serde(default)]
        filename: String,
    }
);

record!("ego_pose", EgoPoseRecord { translation: [f64; 3], rotation: [f64; 4] });

record!("calibrated_sensor", CalibratedSensorRecord {
    sensor_token: String,
    translation: [f64; 3],
    rotation: [f64; 4],
    #[serde(default)]
    camera_intrinsic: Vec<Vec<f64>>,
});

record!("sensor", SensorRecord { channel: String, modality: String });

record!("sample_annotation", AnnotationRecord {
    sample_token: String,
    instance_token: String,
    visibility_token: Option<String>,
    #[serde(default)]
    attribute_tokens: Vec<String>,
    translation: [f64; 3],
    size: [f64; 3],
    rotation: [f64; 4],
    #[serde(default)]
    prev: String,
    #[serde(default)]
    next: String,
    num_lidar_pts: Option<i64>,
});

record!("instance", InstanceRecord { category_token: String });

record!("category", CategoryRecord {
    name: String,
    /// Its number in the lidarseg files, where those came with the dataset.
    index: Option<u8>,
});

record!("attribute", AttributeRecord { name: String });

record!("visibility", VisibilityRecord { level: String });

record!("lidarseg", LidarsegRecord { sample_data_token: String, filename: String });
