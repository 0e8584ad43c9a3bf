"""What every mesh must be: conforming, positive, filling the exact shape, with the right facets."""

from math import asin, pi

import numpy as np
import pytest
from mesh_samples import SAMPLES, corner_faces, facet_area, segment_of

from mesh.quality import measure_quality
from mesh.types import TetMesh

Sample = tuple[str, TetMesh]
ROUND = sorted(name for name, (effector, *_) in SAMPLES.items() if effector in ("cylinder", "dome"))
SLICES = sorted(name for name, (_, section, _) in SAMPLES.items() if section == "plane-strain")
DOME_RADIUS = (0.8**2 + 0.5**2) / (2 * 0.5)


def contact_area(name: str, thickness: float) -> float:
    """Skin of the effector plus bare top of medium 1, by hand."""
    is_slice = "plane-strain" in name
    foot = 2.5 * thickness
    shape = name.split()[0]
    if is_slice:
        extra = {"layer": 0.0, "block": 2 * 0.8, "dome": 2 * DOME_RADIUS * asin(0.8 / DOME_RADIUS) - 1.6}
        return foot + extra[shape] * thickness
    extra = {
        "none": 0.0,
        "layer": 0.0,
        "block": 2 * (1.2 + 1.0) * 0.8,
        "cylinder": pi * 1.5 * 0.8,
        "dome": 2 * pi * DOME_RADIUS * 0.5 - pi * 0.8**2,
    }
    return foot + extra[shape]


@pytest.mark.press
def test_every_face_belongs_to_two_tetrahedra_or_to_the_outside(sample: Sample) -> None:
    _, tet_mesh = sample
    _, count = np.unique(corner_faces(tet_mesh.tets), axis=0, return_counts=True)
    assert count.max() == 2
    facets = tet_mesh.facets
    outer = sum(len(f) for n, f in facets.items() if not n.startswith("film-"))
    if "plane-strain" in sample[0]:
        outer += 2 * len(tet_mesh.tets) // 3  # two y faces for every prism of three tetrahedra
    assert (count == 1).sum() == outer


def test_each_part_has_its_closed_form_volume(sample: Sample) -> None:
    name, tet_mesh = sample
    quality = measure_quality(tet_mesh, segment_of(name))
    for part, error in quality.region_volume_error.items():
        tolerance = 2e-4 if part == "effector" and ("dome" in name or "cylinder" in name) else 1e-10
        assert abs(error) < tolerance, (part, error)


def test_volumes_of_the_flat_parts_by_hand(sample: Sample) -> None:
    _, tet_mesh = sample
    corner = tet_mesh.points_mm[tet_mesh.tets[:, :4]]
    volume = np.linalg.det(corner[:, 1:] - corner[:, :1]) / 6
    assert volume.min() > 0
    for part, height in (("medium2", 1.5), ("film", 0.028), ("medium1", 0.5)):
        meshed = volume[tet_mesh.region_tets(part)].sum()
        assert meshed == pytest.approx(2.5 * tet_mesh.thickness_mm * height, rel=1e-9)


def test_nothing_is_inverted(sample: Sample) -> None:
    name, tet_mesh = sample
    quality = measure_quality(tet_mesh, segment_of(name))
    assert quality.inverted == 0
    assert quality.min_scaled_jacobian > 0


def test_named_facets_have_the_areas_of_the_shape(sample: Sample) -> None:
    name, tet_mesh = sample
    thickness, points, facets = tet_mesh.thickness_mm, tet_mesh.points_mm, tet_mesh.facets
    for flat in ("base", "film-bottom", "film-top"):
        assert facet_area(points, facets[flat]) == pytest.approx(2.5 * thickness, rel=1e-9)
    perimeter = 2 * thickness + (0.0 if "plane-strain" in name else 2 * 2.5)
    heights = {"medium2": 1.5, "film": 0.028, "medium1": 0.5}
    if name.startswith("layer"):
        heights["effector"] = 1.0
    assert {n for n in facets if n.startswith("side-")} == {f"side-{part}" for part in heights}
    for part, height in heights.items():
        assert facet_area(points, facets[f"side-{part}"]) == pytest.approx(perimeter * height, rel=1e-9)
    # Chords lie inside an arc, so flat triangles fall short by (edge / radius)^2 / 24 or so.
    tolerance = 2e-2 if name.split()[0] in ("cylinder", "dome") else 1e-9
    assert facet_area(points, facets["contact"]) == pytest.approx(contact_area(name, thickness), rel=tolerance)


def test_facets_point_out_of_the_solid_and_up_on_the_film(sample: Sample) -> None:
    _, tet_mesh = sample
    corners = tet_mesh.tets[:, :4]
    others = [[1, 2, 3], [0, 2, 3], [0, 1, 3], [0, 1, 2]]
    opposite = {tuple(sorted(tet[o])): tet[k] for tet in corners for k, o in enumerate(others)}
    for name, facets in tet_mesh.facets.items():
        a, b, c = np.moveaxis(tet_mesh.points_mm[facets[:, :3]], 1, 0)
        normal = np.cross(b - a, c - a)
        if name.startswith("film-"):
            assert (normal[:, 2] > 0).all(), name
            continue
        inside = tet_mesh.points_mm[[opposite[tuple(sorted(facet))] for facet in facets[:, :3]]]
        assert (np.einsum("ij,ij->i", normal, a - inside) > 0).all(), name


def test_mid_side_nodes_follow_their_edges_in_vtk_order(sample: Sample) -> None:
    name, tet_mesh = sample
    points, tets = tet_mesh.points_mm, tet_mesh.tets
    for node, (i, j) in zip(range(4, 10), [(0, 1), (1, 2), (0, 2), (0, 3), (1, 3), (2, 3)], strict=True):
        middle = points[tets[:, [i, j]]].mean(axis=1)
        length = np.linalg.norm(points[tets[:, i]] - points[tets[:, j]], axis=1)
        off = np.linalg.norm(points[tets[:, node]] - middle, axis=1)
        flat = name.split()[0] not in ("cylinder", "dome") or "cylinder plane" in name
        assert (off <= (1e-12 if flat else 0.2) * length + 1e-15).all()
    for facets in tet_mesh.facets.values():
        for node, (i, j) in zip((3, 4, 5), [(0, 1), (1, 2), (2, 0)], strict=True):
            middle = points[facets[:, [i, j]]].mean(axis=1)
            assert np.linalg.norm(points[facets[:, node]] - middle, axis=1).max() < 0.05


def test_the_film_is_two_exact_layers(sample: Sample) -> None:
    _, tet_mesh = sample
    corners = np.unique(tet_mesh.tets[tet_mesh.region_tets("film"), :4])
    heights = np.unique(np.round(tet_mesh.points_mm[corners, 2], 12))
    np.testing.assert_allclose(heights, [1.5, 1.514, 1.528], rtol=0, atol=1e-12)


@pytest.mark.parametrize("sample", ROUND, indirect=True)
def test_round_skin_is_exact_but_for_the_counted_straight_edges(sample: Sample) -> None:
    name, tet_mesh = sample
    shape = name.split()[0]
    skin = np.unique(tet_mesh.facets["contact"])
    x, y, z = tet_mesh.points_mm[skin].T
    across = np.abs(x) if "plane-strain" in name else np.hypot(x, y)
    above = z > 2.028 + 1e-9
    if shape == "cylinder":
        side = above & (z < 2.828 - 1e-9)
        off = np.abs(across[side] - 0.75) > 1e-9
    else:
        radius = np.hypot(across, z - (2.528 - DOME_RADIUS))
        off = np.abs(radius[above] - DOME_RADIUS) > 1e-9
    corners = np.isin(skin, tet_mesh.tets[:, :4])[side if shape == "cylinder" else above]
    straight = measure_quality(tet_mesh, segment_of(name)).straight_edges
    assert off.sum() <= straight
    assert not off[corners].any()
    assert len(off) > 50
    assert straight <= 0.02 * len(off)


def test_twins_are_the_nodes_of_equal_x_and_z(sample: Sample) -> None:
    name, tet_mesh = sample
    points, twin = tet_mesh.points_mm, tet_mesh.twin
    if "solid" in name:
        np.testing.assert_array_equal(twin, np.arange(len(points)))
        return
    np.testing.assert_array_equal(twin[twin], twin)
    np.testing.assert_allclose(points[twin][:, [0, 2]], points[:, [0, 2]], rtol=0, atol=1e-9)
    count = np.bincount(twin)
    # A corner of the section stands for its two ends and the middle between; a mid-side also for a diagonal.
    assert set(count[count > 0]) == {3}


@pytest.mark.parametrize("sample", SLICES, indirect=True)
def test_a_slice_mesh_is_a_quadratic_triangle_mesh_of_its_section(sample: Sample) -> None:
    _, tet_mesh = sample
    six = [len(np.unique(t)) for t in tet_mesh.twin[tet_mesh.tets]]
    assert set(six) == {6}  # three corners and three mid-sides remain of each tetrahedron's ten nodes
