"""The measures' known values."""

import metrics
import numpy as np
import pytest


def plain(rgb):
    """A picture of one colour."""
    return np.full((24, 32, 3), rgb, dtype=np.float64)


def noise(seed):
    """A picture of random display values."""
    return np.random.default_rng(seed).random((24, 32, 3))


def test_a_picture_does_not_differ_from_itself():
    assert metrics.rel_mse(noise(0), noise(0)) == 0
    assert metrics.flip_map(noise(0), noise(0)).max() == 0


def test_flip_is_symmetric():
    a, b = noise(1), noise(2)
    assert np.allclose(metrics.flip_map(a, b), metrics.flip_map(b, a))


@pytest.mark.parametrize(
    ("a", "b", "expected"),
    [
        # By hand from the paper's equations: |ΔL| = 100 gives 100^0.7 = 25.1 of 41.2 …
        ([0, 0, 0], [1, 1, 1], 0.967),
        # … and green to blue is the largest distance there is.
        ([0, 1, 0], [0, 0, 1], 1.0),
    ],
)
def test_flip_of_plain_colours(a, b, expected):
    found = metrics.flip_map(plain(a), plain(b))
    assert found.mean() == pytest.approx(expected, abs=2e-3) and np.ptp(found) < 1e-9


def test_an_edge_that_moved_counts_more_than_its_colours_alone():
    def step(column):
        picture = plain([0.2, 0.2, 0.2])
        picture[:, column:] = 0.5
        return picture

    moved = metrics.flip_map(step(16), step(17))
    faded = metrics.flip_map(plain([0.2] * 3), plain([0.21] * 3))
    assert moved[:, 14:19].mean() > 3 * faded.mean() and moved[:, :4].max() < 0.01


def test_flip_sees_through_fine_noise_of_the_same_mean():
    grey, rng = plain([0.5] * 3), np.random.default_rng(3)
    offset = 0.1 * rng.choice([-1.0, 1.0], size=grey.shape[:2])[..., None]
    assert metrics.flip_map(grey + offset, grey).mean() < metrics.flip_map(grey + 0.1, grey).mean()


def test_rel_mse_leaves_out_sparks_and_is_relative():
    reference = np.full((40, 50, 3), 10.0)
    picture = reference * 1.1
    picture[3, 3] = 1e6
    assert metrics.rel_mse(picture, reference) == pytest.approx(0.01, rel=1e-3)
