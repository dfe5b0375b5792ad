//! nuScenes (v1.0) tables, LiDAR and map expansion → `Drive`.
