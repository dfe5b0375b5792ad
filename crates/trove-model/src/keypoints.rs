//! Points of a person's face and joints.

/// Names of the points in COCO's order (Lin et al. 2014); left and right are the person's own.
pub const KEYPOINTS: [&str; 17] = [
    "nose",
    "left_eye",
    "right_eye",
    "left_ear",
    "right_ear",
    "left_shoulder",
    "right_shoulder",
    "left_elbow",
    "right_elbow",
    "left_wrist",
    "right_wrist",
    "left_hip",
    "right_hip",
    "left_knee",
    "right_knee",
    "left_ankle",
    "right_ankle",
];

/// Something of each point, in the order of [`KEYPOINTS`].
pub type Keypoints<T> = [T; KEYPOINTS.len()];
