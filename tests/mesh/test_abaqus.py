"""One mesh in the ways in which the format may write it is read as the same mesh."""

import re
from pathlib import Path

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from foundation.errors import InputError
from mesh.files.user_mesh import read_file
from tests.cases import for_each

POINTS = np.array([(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1), (1, 1, 1), (-1, 0, 0)], dtype=float)
TETS = np.array([(0, 1, 2, 3), (1, 4, 2, 3), (0, 2, 5, 3)])
FILM, MEDIUM = [0, 1], [2]
ON_DISK = settings(max_examples=60, suppress_health_check=[HealthCheck.function_scoped_fixture], deadline=None)


@st.composite
def files(draw: st.DrawFn) -> dict[str, str]:
    """Name -> text of the files of one mesh."""
    first = draw(st.integers(1, 40))
    numbers = draw(st.sampled_from([[1, 2, 3], [7, 8, 9], [2, 4, 6]]))
    nodes = [f"{first + n}, {x}, {y:.3e}, {z:.2f}" for n, (x, y, z) in enumerate(POINTS)]
    cut = draw(st.integers(0, len(nodes)))
    cells = [f"{number}, {', '.join(str(first + node) for node in tet)}" for number, tet in zip(numbers, TETS)]  # noqa: B905
    if draw(st.booleans()):
        cells = [re.sub(r"^(\d+, \d+,)", r"\1\n  ", row) for row in cells]
    quoted = '"{}"' if draw(st.booleans()) else "{}"
    case = draw(st.sampled_from([str.upper, str.lower, str.title]))
    film, medium = quoted.format(case("film")), quoted.format(case("medium1"))
    span = f"{numbers[0]}, {numbers[1]}, {numbers[1] - numbers[0]}"
    set_of_film = draw(
        st.sampled_from(
            [
                f"*ELSET, ELSET={film}\n{numbers[0]}, {numbers[1]},\n",
                f"*Elset,elset={film},\n generate\n{span}\n",
                f"*ELSET, ELSET={film}, GENERATE\n{numbers[0]}, {numbers[0]}\n{numbers[1]}, {numbers[1]}, 1\n",
                f"*ELSET, ELSET=one\n{numbers[0]}\n*ELSET, ELSET=two\none, {numbers[1]}\n*ELSET, ELSET={film}\ntwo\n",
                f"*ELSET, ELSET={film}\n{numbers[0]}\n*NSET, NSET=x\n1\n*ELSET, ELSET={film}\n{numbers[1]}\n",
            ]
        )
    )
    tetrahedra = draw(st.sampled_from(["C3D4", "C3D4H"]))
    body = "\n".join(
        [
            *("*NODE", *nodes[:cut], "** a remark", "*node, nset=rest", *nodes[cut:]),
            *(f"*ELEMENT, TYPE={tetrahedra}", *cells[:2], "", f"*ELEMENT, ELSET={medium}, type=C3D4", cells[2]),
            set_of_film,
        ]
    )
    if draw(st.booleans()):
        return {"mine.inp": "*HEADING\nof nothing\n*INCLUDE, INPUT=below.inp\n", "below.inp": body}
    if not draw(st.booleans()):
        return {"mine.inp": body + "*STEP\n*STATIC\n1., 1.\n*END STEP\n"}
    placed = draw(st.sampled_from(["", "0, 0, 0\n", "0., 0., 0.\n0,0,0, 0,0,1, 360.\n"]))
    outer = draw(
        st.sampled_from(
            [
                "",
                f"*ELSET, ELSET={film}\nI-1.{numbers[0]}, i-1.{numbers[1]}\n",
                f"*ELSET, ELSET={film}, INSTANCE=I-1, GENERATE\n{span}\n",
            ]
        )
    )
    part = body.replace(set_of_film, "") if outer else body
    assembly = f"*ASSEMBLY, NAME=A\n*INSTANCE, NAME=I-1, PART=P\n{placed}*END INSTANCE\n{outer}*END ASSEMBLY\n"
    return {"mine.inp": f"*PART, NAME=p\n{part}\n*END PART\n{assembly}"}


@ON_DISK
@given(of=files())
def test_however_it_is_written(of: dict[str, str], tmp_path: Path) -> None:
    for name, text in of.items():
        (tmp_path / name).write_text(text, "utf-8")
    read = read_file(str(tmp_path / "mine.inp"))
    assert np.allclose(read.points_mm[read.tets], POINTS[TETS])
    assert np.flatnonzero(read.regions["film"]).tolist() == FILM
    assert np.flatnonzero(read.regions["medium1"]).tolist() == MEDIUM


ONE = "*NODE\n1,0,0,0\n2,1,0,0\n3,0,1,0\n4,0,0,1\n*ELEMENT, TYPE=C3D4, ELSET=film\n1, 1, 2, 3, 4\n"


def test_instances_stand_where_they_are_moved_and_turned(tmp_path: Path) -> None:
    assembly = "*INSTANCE, NAME={}, PART=P\n{}\n*END INSTANCE\n"
    text = f"*PART, NAME=P\n{ONE}*END PART\n" + assembly.format("a", "1, 2, 3") + assembly.format(
        "b", "0, 0, 0\n0, 0, 0, 0, 0, 2, 90"
    )  # fmt: skip
    (tmp_path / "two.inp").write_text(text, "utf-8")
    read = read_file(str(tmp_path / "two.inp"))
    moved, turned = read.points_mm[read.tets]
    assert np.allclose(moved, [(1, 2, 3), (2, 2, 3), (1, 3, 3), (1, 2, 4)])
    assert np.allclose(turned, [(0, 0, 0), (0, 1, 0), (-1, 0, 0), (0, 0, 1)])
    assert read.regions["film"].tolist() == [True, True]


@for_each(
    "name", ["NGEN", "NFILL", "NCOPY", "NMAP", "ELGEN", "ELCOPY", "SYSTEM", "Submodel", "IMPORT", "PARAMETER",
             "SYMMETRIC  MODEL GENERATION"],
)  # fmt: skip
def test_what_makes_nodes_or_elements_in_another_way_is_refused(name: str, tmp_path: Path) -> None:
    (tmp_path / "a.inp").write_text(f"{ONE}*{name}\n1, 4\n", "utf-8")
    with pytest.raises(InputError, match=r": line 8 of 'a.inp': \*[A-Z ]+: is not read; write all nodes"):
        read_file(str(tmp_path / "a.inp"))


FLAT = {2: "T3D2 T2D2 B31 B31H", 3: "T3D3 T2D3 B32 B32H S3 S3R S3RS CPS3 CPE3 M3D3 R3D3 SFM3D3",
        6: "CPS6 CPE6 M3D6 SFM3D6 STRI65"}  # fmt: skip
"""Nodes of elements without a volume (Abaqus 2016, Analysis User's Guide, volume IV)."""


@for_each(("nodes", "kind"), [(nodes, kind) for nodes, kinds in FLAT.items() for kind in kinds.split()])
def test_elements_without_a_volume_are_passed_over_or_name_a_surface(nodes: int, kind: str, tmp_path: Path) -> None:
    corners = ", ".join(str(number) for number in [1, 2, 3, 4, 1, 2][:nodes])
    rest = f"*ELEMENT, TYPE={kind}, ELSET=contact\n7, {corners}\n"
    (tmp_path / "a.inp").write_text(ONE + rest, "utf-8")
    read = read_file(str(tmp_path / "a.inp"))
    assert len(read.tets) == 1
    assert [surface.tolist() for surface in read.surfaces.values()] == ([[[0, 1, 2]]] if kind[0] not in "TB" else [])


def test_rows_of_other_files_with_remarks(tmp_path: Path) -> None:
    nodes = "** of nodes\n1, 0, 0, 0\n\n2, 1\n3, 0, 1\n** the last\n4, 0, 0, 1.D0\n"
    (tmp_path / "nodes.txt").write_text(nodes, "utf-8")
    body = "*ELEMENT, TYPE=C3D4, ELSET=film\n** of one\n1, 1, 2, 3, 4\n"
    (tmp_path / "a.inp").write_text(f'*NODE, INPUT="nodes.txt"\n{body}', "utf-8")
    read = read_file(str(tmp_path / "a.inp"))
    assert read.points_mm.tolist() == [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]]


@pytest.mark.parametrize(
    ("text", "said"),
    [
        (ONE + "*NGEN\n1, 4\n", r"line 8 of 'a.inp': \*NGEN: is not read; write all nodes and elements out"),
        (ONE.replace("*NODE", "*NODE, SYSTEM=C"), "cylindrical and spherical coordinates are not read"),
        (ONE + "*NODE\n1, 0, 0, 5\n", "node 1 is defined twice"),
        (ONE + "*ELSET, ELSET=x\ny\n", "holds 'y', which is neither a number nor a set that was defined before it"),
        (ONE + "*ELSET, ELSET=x\n9\n", "set 'X' holds element 9, which is not there"),
        (ONE + "*ELSET, ELSET=x, GENERATE\n1, 10, 4\n", "must be the first number, the last, and the step"),
        (ONE + "*ELEMENT, TYPE=COH3D6\n", "TYPE = COH3D6 is not read"),
        (ONE + "*INCLUDE, INPUT=a.inp\n", "'a.inp' is included in a circle"),
        (ONE + "*INCLUDE, INPUT=b.inp\n", "'b.inp': there is no such file"),
        (ONE.replace("3, 4\n", "3\n"), r"must be 5 numbers"),
        (ONE.replace("1,0,0,0", "1,0,x,0"), "'x' must be a number"),
    ],
)
def test_what_is_not_read_is_refused_with_its_line(text: str, said: str, tmp_path: Path) -> None:
    (tmp_path / "a.inp").write_text(text, "utf-8")
    with pytest.raises(InputError, match=f"^mesh.file = .*{said}"):
        read_file(str(tmp_path / "a.inp"))
