"""Filters of order two against scipy.signal's prototypes, which are made from poles."""

import numpy as np
import pytest
from scipy.optimize import least_squares
from scipy.signal import bessel, butter, cheby1, freqs, lsim

from solve.readout.filters import Filter
from tests.cases import for_each

CORNER_HZ = 12.0
ANGULAR = 2.0 * np.pi * CORNER_HZ
RIPPLE_DB = 1.0


def chebyshev():
    """Its quality and its transfer function, with half the power left at the corner instead of the ripple's end."""
    poles = np.roots(cheby1(2, RIPPLE_DB, 1.0, analog=True)[1])
    quality = float(abs(poles[0]) / (-2.0 * poles[0].real))
    level = 10.0 ** (RIPPLE_DB / 10.0)
    corner = np.cosh(np.arccosh(np.sqrt((2.0 * level - 1.0) / (level - 1.0))) / 2.0)
    numerator, denominator = cheby1(2, RIPPLE_DB, ANGULAR / corner, analog=True)
    return quality, (numerator * 10.0 ** (RIPPLE_DB / 20.0), denominator)


@for_each(
    ("quality", "prototype"),
    [
        (np.sqrt(1.0 / 3.0), bessel(2, ANGULAR, analog=True, norm="mag")),
        (np.sqrt(0.5), butter(2, ANGULAR, analog=True)),
        (0.5, ([ANGULAR**2 / (np.sqrt(2.0) - 1.0)], np.poly(2 * [-ANGULAR / np.sqrt(np.sqrt(2.0) - 1.0)]))),
        chebyshev(),
    ],
    ids=["Bessel", "Butterworth", "two RC stages", "Chebyshev"],
)
def test_quality_is_the_shape_at_the_same_corner(quality, prototype):
    time = np.linspace(0.0, 1.0, 4001)
    given = np.sin(40.0 * time) ** 2
    expected = lsim(prototype, given, time)[1]
    found = Filter(CORNER_HZ, 2, quality=float(quality)).apply(time, given)
    np.testing.assert_allclose(found, expected, atol=1e-9)


@for_each(("order", "quality"), [(5, None), (2, None), (2, 2.0), (2, 0.05)])
def test_half_the_power_is_left_at_the_corner(order, quality):
    own = Filter(CORNER_HZ, order, quality=quality)
    _, response = freqs(*own.transfer(), worN=[ANGULAR])
    assert abs(response[0]) ** 2 == pytest.approx(0.5, rel=1e-9)


def test_dead_time_shifts_what_leaves_the_filter():
    time = np.linspace(0.0, 1.0, 4001)
    given = np.sin(40.0 * time) ** 2
    plain = Filter(CORNER_HZ, 2).apply(time, given)
    late = Filter(CORNER_HZ, 2, delay_s=0.05).apply(time, given)
    np.testing.assert_allclose(late[200:], plain[:-200], atol=1e-9)
    assert not late[:200].any()


@for_each("prototype", [bessel, butter], ids=["Bessel", "Butterworth"])
def test_order_two_and_dead_time_come_close_to_order_four(prototype):
    """A trapezoid through scipy's filter: the shape is missed by three times less than without dead time."""
    time = np.linspace(0.0, 2.0, 4001)
    given = np.clip((time - 0.1) / 0.12, 0.0, 1.0) - np.clip((time - 0.8) / 0.12, 0.0, 1.0)
    true = lsim(prototype(4, ANGULAR, analog=True), given, time)[1]

    def missed(shares):
        def left(values):
            corner_Hz, quality, delay_s = *values[:2], values[2] if shares == 3 else 0.0
            return Filter(corner_Hz, 2, quality=quality, delay_s=delay_s).apply(time, given) - true

        found = least_squares(left, [CORNER_HZ, 0.6, 0.005][:shares], bounds=(1e-4, [100.0, 2.0, 0.1][:shares]))
        return np.sqrt(np.mean(found.fun**2) / np.mean(true**2))

    assert 3.0 * missed(3) < missed(2)
    assert missed(3) < 0.005


def test_a_resonant_filter_enlarges_more_than_butterworths_and_stages_never():
    sharp, flat, stages = (Filter(CORNER_HZ, 2, quality=q).largest_gain() for q in (2.0, None, 0.3))
    assert sharp > flat > 1.0
    assert stages == pytest.approx(1.0, abs=1e-3)
