//! OpenStreetMap extracts (`.osm`, `.osm.pbf`) → `StreetMap`.
