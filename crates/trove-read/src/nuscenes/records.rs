//! The tables' records, as far as they are used.

use serde::Deserialize;

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
        timestamp: i64,
        #[serde(default)]
        width: i64,
        #[serde(default)]
        height: i64,
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
    #[serde(default)]
    visibility_token: String,
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
