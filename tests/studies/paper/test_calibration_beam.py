"""The beam as a displacement sensor against its own curvature, integrated twice."""

import numpy as np
import pytest
from scipy.integrate import cumulative_trapezoid

from softdot.studies.paper.calibration.beam import BENDING_STIFFNESS_N_MM2, dot_depth_mm, tip_stiffness_N_per_mm
from tests.cases import for_each

LENGTH_MM, FORCE_N, READ_MM = 80.0, 0.7, 0.9


@for_each("force_N", [0.0, 0.5, 5.0])
def test_pushed_over_the_dot_the_gauge_reads_the_depth_whatever_the_sensor_does(force_N):
    assert dot_depth_mm(READ_MM, lambda _depth: force_N, LENGTH_MM, 0.0) == pytest.approx(READ_MM, rel=1e-9)


@for_each("offset_mm", [5.0, 2.0, -3.0])
def test_the_deflection_is_the_curvature_integrated_twice(offset_mm):
    """With the depth that the sensor's force bends back, the moment at the clamp is what the gauge reads."""
    depth = dot_depth_mm(READ_MM, lambda _depth: FORCE_N, LENGTH_MM, offset_mm)
    moment = READ_MM * 3 * BENDING_STIFFNESS_N_MM2 / LENGTH_MM**2
    push = (moment + FORCE_N * LENGTH_MM) / (LENGTH_MM - offset_mm)
    x = np.linspace(0.0, LENGTH_MM, 20001)
    bending = push * np.maximum(LENGTH_MM - offset_mm - x, 0.0) - FORCE_N * (LENGTH_MM - x)
    slope = cumulative_trapezoid(bending / BENDING_STIFFNESS_N_MM2, x, initial=0.0)
    assert depth == pytest.approx(np.trapezoid(slope, x), rel=1e-6)


def test_a_hand_nearer_to_the_clamp_presses_less_deep_than_the_gauge_reads():
    depths = [dot_depth_mm(READ_MM, lambda depth: FORCE_N * depth, LENGTH_MM, a) for a in (-2.0, 0.0, 2.0)]
    assert depths[0] > depths[1] > depths[2]


def test_stiffness_of_the_acrylic_bar():
    """3 E I / L^3 with E 2.8 GPa, 9 x 2 mm, 100 mm: 0.05 N/mm."""
    assert tip_stiffness_N_per_mm(100.0) == pytest.approx(0.0504, rel=1e-3)
