"""How far a picture is from its reference.

Pictures are float32 arrays, height × width × 3, of linear Rec. 709 radiance, already multiplied by the exposure, so that
a grey card has about 0.18.
"""

import numpy as np

RELATIVE_EPSILON = 0.01  # added to the squared reference: black pixels would count without bound
TRIMMED_SHARE = 1e-3  # the worst pixels, left out of relMSE: single sparks would decide it

# Andersson et al. 2020, "FLIP: A Difference Evaluator for Alternating Images".
PIXELS_PER_DEGREE = 67.02  # a 0.7 m wide screen of 3,840 pixels seen from 0.7 m
CONTRAST = {  # (a, b) of the Gaussians of the contrast sensitivity functions: brightness, red–green, blue–yellow
    "A": [(1.0, 0.0047)],
    "RG": [(1.0, 0.0053)],
    "BY": [(34.1, 0.04), (13.5, 0.025)],
}
FEATURE_WIDTH_DEG = 0.082
COLOR_POWER, FEATURE_POWER = 0.7, 0.5
KNEE_AT, KNEE_TO = 0.4, 0.95

XYZ_FROM_RGB = np.array(
    [[0.4124564, 0.3575761, 0.1804375], [0.2126729, 0.7151522, 0.0721750], [0.0193339, 0.1191920, 0.9503041]]
)
RGB_FROM_XYZ = np.linalg.inv(XYZ_FROM_RGB)
WHITE = XYZ_FROM_RGB.sum(axis=1)


def rel_mse(picture, reference):
    """Mean of (x − r)² / (r² + 0.01) over pixels and channels, without the worst thousandth of the pixels."""
    error = ((picture - reference) ** 2 / (reference**2 + RELATIVE_EPSILON)).mean(axis=-1).ravel()
    kept = len(error) - int(len(error) * TRIMMED_SHARE)
    return float(np.partition(error, kept - 1)[:kept].mean(dtype=np.float64))


def tone_mapped(exposed):
    """Linear display values in [0, 1] by Narkowicz's fit of the ACES curve (2015)."""
    x = np.clip(0.6 * exposed, 0.0, None)
    return np.clip(x * (2.51 * x + 0.03) / (x * (2.43 * x + 0.59) + 0.14), 0.0, 1.0)


def flip(picture, reference):
    """Mean FLIP of two tone-mapped pictures: 0 the same, 1 as different as can be."""
    return float(flip_map(tone_mapped(picture), tone_mapped(reference)).mean(dtype=np.float64))


def flip_map(test, reference):
    """FLIP of every pixel of two pictures of linear display values in [0, 1]."""
    test, reference = opponent(test), opponent(reference)
    colors = [hunt_adjusted(filtered(image)) for image in (test, reference)]
    color = redistributed(hyab(*colors) ** COLOR_POWER)
    grey = [(image[..., 0] + 16.0) / 116.0 for image in (test, reference)]
    (edges_a, points_a), (edges_b, points_b) = (features(image) for image in grey)
    feature = np.maximum(np.abs(edges_a - edges_b), np.abs(points_a - points_b))
    feature = np.clip((feature / np.sqrt(2.0)) ** FEATURE_POWER, 0.0, 1.0)
    return color ** (1.0 - feature)


def opponent(rgb):
    """YCxCz of linear display values."""
    x, y, z = np.moveaxis(rgb @ XYZ_FROM_RGB.T / WHITE, -1, 0)
    return np.stack([116.0 * y - 16.0, 500.0 * (x - y), 200.0 * (y - z)], axis=-1)


def filtered(ycc):
    """What the eye resolves, as linear display values in [0, 1]."""
    planes = []
    for plane, gaussians in zip(np.moveaxis(ycc, -1, 0), CONTRAST.values(), strict=True):
        widest = max(b for _, b in gaussians)
        radius = int(np.ceil(3.0 * np.sqrt(widest / (2.0 * np.pi**2)) * PIXELS_PER_DEGREE))
        x = np.arange(-radius, radius + 1) / PIXELS_PER_DEGREE
        total, weight = 0.0, 0.0
        for a, b in gaussians:
            kernel = np.exp(-(np.pi**2) * x**2 / b)
            strength = a * np.sqrt(np.pi / b)
            total = total + strength * separable(plane, kernel, kernel)
            weight += strength * kernel.sum() ** 2
        planes.append(total / weight)
    y = (planes[0] + 16.0) / 116.0
    xyz = np.stack([y + planes[1] / 500.0, y, y - planes[2] / 200.0], axis=-1) * WHITE
    return np.clip(xyz @ RGB_FROM_XYZ.T, 0.0, 1.0)


def hunt_adjusted(rgb):
    """L*a*b* whose colourfulness grows with brightness (Hunt effect)."""
    t = rgb @ XYZ_FROM_RGB.T / WHITE
    delta = 6.0 / 29.0
    f = np.where(t > delta**3, np.cbrt(t), t / (3.0 * delta**2) + 4.0 / 29.0)
    lightness = 116.0 * f[..., 1] - 16.0
    a, b = 500.0 * (f[..., 0] - f[..., 1]), 200.0 * (f[..., 1] - f[..., 2])
    return np.stack([lightness, 0.01 * lightness * a, 0.01 * lightness * b], axis=-1)


def hyab(lab_a, lab_b):
    """Distance of colours that may be far apart."""
    difference = np.abs(lab_a - lab_b)
    return difference[..., 0] + np.hypot(difference[..., 1], difference[..., 2])


def redistributed(distance):
    """Colour distances, already raised to their power, brought to [0, 1]."""
    green, blue = (hunt_adjusted(np.array(c, dtype=np.float64)) for c in ([0, 1, 0], [0, 0, 1]))
    largest = hyab(green, blue) ** COLOR_POWER
    knee = KNEE_AT * largest
    above = KNEE_TO + (distance - knee) / (largest - knee) * (1.0 - KNEE_TO)
    return np.clip(np.where(distance < knee, KNEE_TO / knee * distance, above), 0.0, 1.0)


def features(grey):
    """Strength of edges and of points."""
    sigma = 0.5 * FEATURE_WIDTH_DEG * PIXELS_PER_DEGREE
    radius = int(np.ceil(3.0 * sigma))
    x = np.arange(-radius, radius + 1)
    gauss = np.exp(-(x**2) / (2.0 * sigma**2))
    found = []
    for kernel in (-x * gauss, (x**2 / sigma**2 - 1.0) * gauss):
        # Positive and negative weights each add up to one, over the kernel's two dimensions.
        scale = np.where(kernel > 0, kernel[kernel > 0].sum(), -kernel[kernel < 0].sum()) * gauss.sum()
        found.append(np.hypot(separable(grey, kernel / scale, gauss), separable(grey, gauss, kernel / scale)))
    return found


def separable(plane, along_x, along_y):
    """Correlation with the product of two kernels of odd length; the picture's edges go on outside it."""
    for axis, kernel in ((1, along_x), (0, along_y)):
        radius = len(kernel) // 2
        padding = [(0, 0), (0, 0)]
        padding[axis] = (radius, radius)
        padded = np.pad(plane, padding, mode="edge")
        length = plane.shape[axis]
        shifted = (np.take(padded, range(i, i + length), axis=axis) * k for i, k in enumerate(kernel))
        plane = sum(shifted)
    return plane
