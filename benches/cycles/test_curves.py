"""Ratios of made-up curves."""

import curves
import pytest

# Error falls with the square root of time.
FAST = [(t, t**-0.5) for t in (1, 4, 16)]
SLOW = [(3 * t, t**-0.5) for t in (2, 8, 32)]


def test_a_renderer_three_times_as_slow_has_a_ratio_of_three():
    assert curves.ratio(FAST, [SLOW]) == pytest.approx((3, 3, 3))


def test_the_best_of_the_others_counts():
    slower = [(2 * t, e) for t, e in SLOW]
    assert curves.ratio(FAST, [slower, SLOW]) == pytest.approx((3, 3, 3))


def test_an_error_that_is_never_reached_has_no_time():
    assert curves.time_at(FAST, 0.01) is None


def test_a_curve_that_lies_below_the_other_is_compared_at_the_lowest_error_of_that():
    assert curves.ratio([(1, 0.01), (2, 0.005)], [FAST]) == pytest.approx((16, 16, 16))


def test_a_curve_that_is_better_from_the_start_is_counted_from_its_first_point():
    assert curves.time_at(FAST, 5.0) == 1
