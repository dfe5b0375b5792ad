//! On which side of the road a country drives.

/// Rectangles (south, west, north, east, degrees) that hold the countries with left-hand traffic and few others.
#[rustfmt::skip]
const LEFT: [[f64; 4]; 14] = [
    [49.8, -10.8, 60.9, 1.8],      // British Isles
    [5.5, 60.9, 36.0, 92.5],       // Pakistan, India, Sri Lanka, Nepal, Bhutan, Bangladesh
    [5.6, 97.3, 20.4, 102.1],      // Thailand
    [-11.1, 94.9, 6.7, 141.1],     // Malaysia, Singapore, Indonesia, Brunei, Timor
    [24.0, 122.9, 45.7, 146.0],    // Japan
    [22.1, 113.5, 22.6, 114.5],    // Hong Kong and Macao
    [-44.0, 112.9, -9.9, 154.0],   // Australia
    [-47.5, 166.0, -34.0, 179.0],  // New Zealand
    [-35.0, 11.7, -8.0, 41.0],     // southern Africa
    [-11.8, 29.3, 5.1, 41.9],      // Tanzania, Kenya, Uganda
    [34.5, 32.2, 35.8, 34.7],      // Cyprus
    [35.7, 14.1, 36.1, 14.6],      // Malta
    [17.7, -78.4, 18.6, -76.1],    // Jamaica
    [1.1, -61.5, 8.6, -53.9],      // Guyana, Suriname
];
/// Countries with right-hand traffic within those rectangles.
#[rustfmt::skip]
const RIGHT: [[f64; 4]; 6] = [
    [29.4, 60.9, 38.5, 66.3],      // Afghanistan
    [49.8, 1.1, 51.2, 1.8],        // the Channel's French coast
    [-18.1, 11.7, -8.0, 21.9],     // Angola
    [-11.0, 11.7, 5.1, 29.3],      // Congo
    [34.4, 122.9, 43.0, 129.6],    // Korea
    [42.0, 122.9, 45.7, 139.0],    // Manchuria, Primorye
];

/// Whether traffic keeps left at a place; right where the rectangles do not say.
pub fn drives_on_left(lat_deg: f64, lon_deg: f64) -> bool {
    let within = |boxes: &[[f64; 4]]| {
        let holds = |b: &[f64; 4]| lat_deg >= b[0] && lat_deg <= b[2] && lon_deg >= b[1] && lon_deg <= b[3];
        boxes.iter().any(holds)
    };
    within(&LEFT) && !within(&RIGHT)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cities_drive_on_their_own_side() {
        for (city, lat_deg, lon_deg, left) in [
            ("Singapore", 1.29, 103.78, true),
            ("Boston", 42.35, -71.05, false),
            ("London", 51.5, -0.1, true),
            ("Calais", 50.95, 1.85, false),
            ("Tokyo", 35.68, 139.69, true),
            ("Seoul", 37.57, 126.98, false),
            ("Taipei", 25.03, 121.56, false),
            ("Pittsburgh", 40.44, -80.0, false),
            ("Kinshasa", -4.3, 15.3, false),
            ("Nairobi", -1.29, 36.82, true),
            ("Sydney", -33.87, 151.2, true),
            ("Helsinki", 60.17, 24.94, false),
        ] {
            assert_eq!(drives_on_left(lat_deg, lon_deg), left, "{city}");
        }
    }
}
