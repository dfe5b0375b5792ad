//! Equirectangular images (`.hdr`, `.exr`) → `EnvironmentMap`.
