//! The UTM grid, by other means than the reader's.

use glam::DVec2;

/// Easting and northing on the UTM grid by Krüger's series to the third order, which is good to a millimetre; the reader
/// uses a library.
pub(crate) fn utm(zone: u32, lat_deg: f64, lon_deg: f64) -> DVec2 {
    let (radius_m, flattening, k0) = (6_378_137.0, 1.0 / 298.257_223_563, 0.9996);
    let n: f64 = flattening / (2.0 - flattening);
    let rectifying_m = radius_m / (1.0 + n) * (1.0 + n * n / 4.0 + n.powi(4) / 64.0);
    let alpha = [
        n / 2.0 - 2.0 / 3.0 * n * n + 5.0 / 16.0 * n.powi(3),
        13.0 / 48.0 * n * n - 3.0 / 5.0 * n.powi(3),
        61.0 / 240.0 * n.powi(3),
    ];
    let (phi, lambda) = (lat_deg.to_radians(), (lon_deg - (6.0 * f64::from(zone) - 183.0)).to_radians());
    let e = 2.0 * n.sqrt() / (1.0 + n);
    let t = (phi.sin().atanh() - e * (e * phi.sin()).atanh()).sinh();
    let (xi, eta) = ((t / lambda.cos()).atan(), (lambda.sin() / t.hypot(1.0)).atanh());
    let term = |j: usize| 2.0 * (j as f64 + 1.0);
    let east: f64 = (0..3).map(|j| alpha[j] * (term(j) * xi).cos() * (term(j) * eta).sinh()).sum();
    let north: f64 = (0..3).map(|j| alpha[j] * (term(j) * xi).sin() * (term(j) * eta).cosh()).sum();
    DVec2::new(500_000.0 + k0 * rectifying_m * (eta + east), k0 * rectifying_m * (xi + north))
}

/// Origin of Pittsburgh's frame on the grid of zone 17, metres.
pub(crate) const PITTSBURGH_UTM_M: DVec2 = DVec2::new(583_710.007, 4_477_259.999_9);
