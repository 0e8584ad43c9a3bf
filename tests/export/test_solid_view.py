"""The studio's 3D view: every part is closed, its tetrahedra fill it, and arrays travel as they are."""

import json
import struct

import numpy as np
import pytest
from build123d import Box, Cylinder, Pos

from export.solid_view import parts_view, press_view
from geometry.dot import DotShape
from mesh.types import TetMesh
from softdot.studio.frames import packed
from solve.result import PressResult


@pytest.fixture(scope="module")
def view(segment: TetMesh, press: PressResult, dot: DotShape) -> dict:
    return press_view(segment, press, dot)


def enclosed_mm3(view: dict, part: int) -> float:
    """Volume inside the triangles of a part, positive where they face outwards (divergence theorem)."""
    triangles = view["triangles"][view["region"][view["triangles"][:, 0]] == part]
    a, b, c = view["points"][triangles].transpose(1, 0, 2).astype(float)
    return float(np.einsum("ij,ij->", a, np.cross(b, c)) / 6)


def filled_mm3(view: dict, part: int) -> float:
    """Volume of the tetrahedra of a part."""
    tets = view["tets"][view["region"][view["tets"][:, 0]] == part]
    a, b, c, d = view["points"][tets].transpose(1, 0, 2).astype(float)
    return float(np.abs(np.einsum("ij,ij->i", np.cross(b - a, c - a), d - a)).sum() / 6)


def test_each_part_is_closed_and_filled(view: dict) -> None:
    for part, name in enumerate(view["names"]):
        assert enclosed_mm3(view, part) == pytest.approx(filled_mm3(view, part), rel=1e-5), name
    edges = np.sort(view["triangles"][:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2), axis=1)
    _, count = np.unique(edges, axis=0, return_counts=True)
    assert set(count) == {2}


def test_fields_and_displacements_are_those_of_the_press(view: dict, segment: TetMesh, press: PressResult) -> None:
    moved = view["displacement"] * view["displacementUnit"]
    largest = 1e3 * np.abs(press.steps[-1].fields.displacement_m).max()
    assert np.abs(moved[-1]).max() == pytest.approx(largest, rel=1e-4)
    assert not moved[0].any()
    assert set(view["tops"]) == {"stress", "strain", "charge", "pressure"}
    film = view["region"] == segment.region_names.index("film")
    assert not view["strain"][:, ~film].any()
    assert (view["charge"][0] == 128).all()  # none at rest: the middle of its colours


def test_parts_at_rest_are_closed_and_face_outwards(dot: DotShape) -> None:
    solids = {"medium2": Box(2.5, 2.5, 2.0), "effector": Pos(0.0, 0.0, 1.5) * Cylinder(0.8, 1.0)}
    found = parts_view(solids, dot)
    for part, solid in enumerate(solids.values()):
        assert enclosed_mm3(found, part) == pytest.approx(solid.volume, rel=1e-2)
    a, b, c = found["dotPoints"].reshape(-1, 3, 3).transpose(1, 0, 2).astype(float)
    assert np.einsum("ij,ij->", a, np.cross(b, c)) > 0


def test_a_frame_holds_its_arrays_where_its_head_says(view: dict) -> None:
    frame = packed({"tell": "view", "view": view})
    assert isinstance(frame, bytes)
    (length,) = struct.unpack("<I", frame[:4])
    head = json.loads(frame[4 : 4 + length])
    for name in ("points", "displacement", "region", "triangles", "stress"):
        told = head["view"][name]
        at = 4 + length + told["at"]
        assert at % 8 == 0
        found = np.frombuffer(frame, np.dtype(told["array"]).newbyteorder("<"), told["count"], at)
        np.testing.assert_array_equal(found, view[name].ravel())
    assert packed({"tell": "said", "text": "é"}) == json.dumps({"tell": "said", "text": "é"})
