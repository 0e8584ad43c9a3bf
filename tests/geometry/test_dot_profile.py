"""A measured dot: what its file may hold, and the solid that is made of it."""

from math import pi

import numpy as np
import pytest

from foundation.errors import InputError
from geometry.assembly import dot_solid
from geometry.dot_at_rest import resolve_dot
from geometry.parameters import Dot
from tests.cases import for_each

BAD = {
    "a unit is missing": ("radius,height_mm\n0,1\n", "no column radius_mm or radius_um"),
    "few rows": ("radius_mm,height_mm\n0,1\n", "has 1 rows, needs at least 4"),
    "rises": ("radius_mm,height_mm\n0,0.5\n0.1,0.4\n0.2,0.45\n0.3,0\n", "row 4: the height rises to 0.45 mm"),
    "no number": ("radius_mm,height_mm\n0,0.5\n0.1,nan\n0.2,0.3\n0.3,0\n", "row 3: '0.1,nan' has no finite number"),
    "no tip": ("radius_mm,height_mm\n0.1,0.5\n0.2,0.4\n0.3,0.3\n0.4,0\n", "begins at a radius of 0.1 mm"),
    "back": ("radius_mm,height_mm\n0,0.5\n0.2,0.4\n0.1,0.3\n0.4,0\n", "row 4: a radius of 0.1 mm is not above"),
    "flat": ("radius_mm,height_mm\n0,1\n1,1\n2,1\n3,1\n", "one height everywhere"),
}


@for_each("case", list(BAD))
def test_what_is_no_profile_is_refused(case, tmp_path, segment):
    text, sentence = BAD[case]
    (tmp_path / "dot.csv").write_text(text)
    with pytest.raises(InputError, match=sentence):
        resolve_dot(Dot(shape="profile", profile_csv=str(tmp_path / "dot.csv")), segment)


def test_the_solid_of_a_paraboloid_has_its_volume(tmp_path, segment):
    """Half of the cylinder around it; heights in um over any level."""
    radius = np.linspace(0.0, 0.8, 21)
    rows = [f"{1e3 * r:.17g},{500.0 * (1.0 - (r / 0.8) ** 2) + 37.0:.17g}" for r in radius]
    (tmp_path / "dot.csv").write_text("\n".join(["radius_um,height_um", *rows]))
    measured = resolve_dot(Dot(shape="profile", profile_csv=str(tmp_path / "dot.csv")), segment)
    plate = resolve_dot(Dot(shape="plate"), segment)
    assert measured.height_mm == pytest.approx(0.5)
    assert measured.radius_mm == pytest.approx(0.64)  # r^2 / 2 h
    low = dot_solid(measured, segment)
    assert pytest.approx(measured.origin_mm[2], abs=1e-6) == low.bounding_box().min.Z
    added = low.volume - dot_solid(plate, segment).volume
    assert added == pytest.approx(0.5 * pi * 0.64 * 0.5, rel=1e-4)
