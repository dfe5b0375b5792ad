//! Holds `docs/schema` to the types.

use std::fs;
use std::path::Path;

use schemars::JsonSchema;
use schemars::generate::SchemaSettings;

use crate::{
    Curated, FrameLine, FrameTable, GridTable, JournalLine, LanesFile, Manifest, MaskTable, PlainDrive, RadarTable,
    RunIdentity, RunReport, SiteFile, SweepTable, TrajectoryFile,
};

/// The schema of a file as it is written: as a name and a text.
fn schema<T: JsonSchema>(file: &str) -> (&str, String) {
    of::<T>(file, SchemaSettings::draft2020_12().for_serialize())
}

/// The schema of a file as it may be written by others, with what has a default left out.
fn schema_for_others<T: JsonSchema>(file: &str) -> (&str, String) {
    of::<T>(file, SchemaSettings::draft2020_12().for_deserialize())
}

fn of<T: JsonSchema>(file: &str, settings: SchemaSettings) -> (&str, String) {
    let mut schema = settings.into_generator().into_root_schema_for::<T>();
    schema.insert("title".into(), file.into());
    (file.split('.').next().unwrap(), serde_json::to_string_pretty(&schema).unwrap() + "\n")
}

#[test]
fn the_schemas_are_those_of_the_types() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/schema");
    let schemas = [
        schema::<Manifest>(Manifest::NAME),
        schema::<RunReport>(RunReport::NAME),
        schema::<SiteFile>(SiteFile::NAME),
        schema::<FrameTable>(FrameTable::NAME),
        schema::<MaskTable>(MaskTable::NAME),
        schema::<SweepTable>(SweepTable::NAME),
        schema::<GridTable>(GridTable::NAME),
        schema::<LanesFile>(LanesFile::NAME),
        schema::<TrajectoryFile>(TrajectoryFile::NAME),
        schema::<RadarTable>(RadarTable::NAME),
        schema::<Curated>(Curated::NAME),
        schema::<RunIdentity>(RunIdentity::NAME),
        schema::<JournalLine>(FrameLine::JOURNAL),
        schema_for_others::<PlainDrive>(PlainDrive::NAME),
    ];
    for (name, expected) in &schemas {
        let path = folder.join(format!("{name}.schema.json"));
        if std::env::var_os("TROVE_WRITE_SCHEMAS").is_some() {
            fs::write(&path, expected).unwrap();
        }
        let found = fs::read_to_string(&path).unwrap_or_default();
        let remedy = "TROVE_WRITE_SCHEMAS=1 cargo test -p trove-format schemas writes it anew";
        assert!(found == *expected, "{}: expected the schema of the types; {remedy}", path.display());
    }
    assert_eq!(fs::read_dir(&folder).unwrap().count(), schemas.len(), "a schema of a file that is not written");
}
