"""What a converged press says that no real segment does: elements near collapse, laws without stiffness, wild fields.

det F is looked at where it is integrated and at all nodes, and each element also with straight edges between its
corners: a state that is in balance between the quadrature points may be turned inside out beside them.

A law has positive stiffness where the Hencky strain and the Kirchhoff stress grow together,
    d tau : d eps > 0 for every d eps (of an incompressible law, every isochoric one)
(Hill, Proc. R. Soc. A 314 (1970) 457), for an isotropic law in its principal axes a matrix of three by three.

Fields: 30 V/um is the largest direct voltage and 80 V/um the breakdown that the maker of PVDF film states (Measurement
Specialties, Piezo Film Sensors Technical Manual); from its coercive field, some 50 V/um, on the polarisation turns
(Furukawa, Phase Transitions 18 (1989) 143).
"""

from collections.abc import Iterable, Iterator

import numpy as np

from foundation.arrays import Bools, Floats, Ints
from mesh.jacobian import determinants
from mesh.types import TetMesh
from solve.fem.quadrature import tetrahedron
from solve.fem.shape_functions import quadratic
from solve.materials.laws import MediumLaw
from solve.materials.parameters import PiezoelectricFilm
from solve.model import Model
from solve.result import PressResult
from solve.tensors import from_voigt

CORNERS_AND_MIDDLES = np.array(
    [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1], [0.5, 0, 0], [0.5, 0.5, 0], [0, 0.5, 0], [0, 0, 0.5], [0.5, 0, 0.5],
     [0, 0.5, 0.5]]
)  # fmt: skip
CRUSHED_RUBBER_VOLUME, CRUSHED_FOAM_VOLUME = 0.1, 0.05
"""det F of a law that hardly changes its volume; and of a foam, which keeps its solid: cushions have 0.05 to 0.2 of it
(Gibson and Ashby, Cellular Solids, 1997, chapter 1).
"""
FIELDS_V_PER_UM = (
    (80.0, "the breakdown strength of PVDF, about 80 V/um: a real film is destroyed before"),
    (50.0, "the coercive field of PVDF, about 50 V/um: the polarisation of a real film turns before"),
    (30.0, "the largest direct voltage that makers of PVDF film allow, 30 V/um"),
)


def validity_warnings(model: Model, result: PressResult) -> list[str]:
    """Warnings, one sentence for each kind and layer, about states that no real segment reaches."""
    return [*_collapse_warnings(model, result), *_stability_warnings(model, result), *_field_warnings(model, result)]


def _solved_part(result: PressResult) -> slice:
    """Slice of the elements that were solved; their mirror images follow them and have the same values."""
    return slice(len(result.tet_mesh.tets) // 2 ** len(result.planes))


def _layer_elements(result: PressResult, layer: str) -> Ints:
    """Numbers of the elements of a layer in the part that was solved."""
    tet_mesh = result.tet_mesh
    return np.flatnonzero(tet_mesh.region[_solved_part(result)] == tet_mesh.region_names.index(layer))


def smallest_volumes(nodes_mm: Floats, displacements_m: Iterable[Floats]) -> tuple[Floats, Floats]:
    """The smallest det F (m,) over all displacements (m, 10, 3) of elements with nodes (m, 10, 3): where it is
    integrated, and elsewhere, which is at the nodes and of straight edges.
    """
    inside, at_nodes = tetrahedron()[0], CORNERS_AND_MIDDLES
    rest = _determinants(nodes_mm, inside), _determinants(nodes_mm, at_nodes), _corner_volumes(nodes_mm)
    smallest = np.full((2, len(nodes_mm)), np.inf)
    for displacement_m in displacements_m:
        moved = nodes_mm + 1e3 * displacement_m
        beside = (_determinants(moved, at_nodes) / rest[1]).min(axis=1), _corner_volumes(moved) / rest[2]
        now = (_determinants(moved, inside) / rest[0]).min(axis=1), np.minimum(*beside)
        smallest = np.minimum(smallest, now)
    return smallest[0], smallest[1]


def _determinants(nodes: Floats, points: Floats) -> Floats:
    """Determinants (m, q) of the Jacobian of elements with nodes (m, 10, 3) at reference points (q, 3)."""
    return determinants(np.einsum("qna,mni->mqia", quadratic(points)[1], nodes, optimize=True))


def _corner_volumes(nodes: Floats) -> Floats:
    """Six times the volume (m,) of the tetrahedra that the corners of elements span with straight edges."""
    return determinants(nodes[:, 1:4] - nodes[:, :1])


def _collapse_warnings(model: Model, result: PressResult) -> Iterator[str]:
    """A sentence for each layer with an element that is turned inside out or crushed."""
    tet_mesh, part = result.tet_mesh, _solved_part(result)
    tets = tet_mesh.tets[part]
    moved = (step.fields.displacement_m[tets] for step in result.steps)
    inside, elsewhere = smallest_volumes(tet_mesh.points_mm[tets], moved)
    layers = [(layer, material) for layer, material in model.materials.items() if layer in tet_mesh.region_names]
    advice = "what is computed near it is not to be trusted; press less deep or mesh finer"
    for layer, material in layers:
        tets = _layer_elements(result, layer)
        soft = not isinstance(material, PiezoelectricFilm) and material.law.compressible
        limit = CRUSHED_FOAM_VOLUME if soft else CRUSHED_RUBBER_VOLUME
        turned, crushed = int(tets[np.argmin(elsewhere[tets])]), int(tets[np.argmin(inside[tets])])
        if elsewhere[turned] <= 0.0:
            yield f"an element of {layer} is turned inside out at a corner{_place_words(tet_mesh, turned)}: {advice}"
        elif inside[crushed] <= limit:
            volume = f"{100.0 * inside[crushed]:.2g} % of its volume"
            yield f"an element of {layer} is crushed to {volume}{_place_words(tet_mesh, crushed)}: {advice}"


def _place_words(tet_mesh: TetMesh, element: int) -> str:
    """The middle of an element as a message states it."""
    x, y, z = tet_mesh.points_mm[tet_mesh.tets[element, :4]].mean(axis=0)
    return f" at x = {x:.2f}, y = {y:.2f}, z = {z:.2f} mm"


def _stability_warnings(model: Model, result: PressResult) -> Iterator[str]:
    """A sentence for each layer whose law has no positive stiffness at the strains of the press."""
    tet_mesh = result.tet_mesh
    for layer, material in model.materials.items():
        if isinstance(material, PiezoelectricFilm) or layer not in tet_mesh.region_names:
            continue
        tets = _layer_elements(result, layer)
        for step in result.steps:
            strain = from_voigt(step.fields.green_lagrange_strain[tets])
            squared: Floats = np.asarray(2.0 * np.linalg.eigvalsh(strain) + 1.0, dtype=np.float64)
            stiff = has_positive_stiffness(material.law, squared)
            if not stiff.all():
                stretch = float(np.sqrt(squared[~stiff]).max())
                count = 2 ** len(result.planes) * int((~stiff).sum())
                yield (
                    f"the law of {layer} ({material.model}) has no positive stiffness at the strain of "
                    f"{count} elements (stretches up to {stretch:.3g}) at an indentation of "
                    f"{1e3 * step.indentation_m:.3g} mm: beyond it the law means nothing"
                )
                break


def has_positive_stiffness(law: MediumLaw, squared_stretches: Floats) -> Bools:
    """Whether a law has positive stiffness (n,) at squares (n, 3) of the principal stretches."""
    stress, tangent = law.stress(squared_stretches[:, :, None] * np.eye(3))
    square = squared_stretches
    slope = square[:, :, None] * tangent[:, :3, :3] * square[:, None, :]
    slope[:, range(3), range(3)] += 2.0 * square * stress[:, :3]
    if not law.compressible:
        isochoric = np.linalg.svd(np.ones((1, 3)))[2][1:]
        slope = isochoric @ slope @ isochoric.T
    return positive_definite(0.5 * (slope + slope.swapaxes(1, 2)))


def positive_definite(matrices: Floats) -> Bools:
    """Whether symmetric matrices (n, d, d) are positive definite (n,), d at most 3: by leading minors (Sylvester)."""
    size = matrices.shape[-1]
    minors = [matrices[:, 0, 0], matrices[:, 0, 0] * matrices[:, 1, 1] - matrices[:, 0, 1] ** 2]
    if size == 3:
        minors.append(determinants(matrices))
    return np.asarray(np.all([minor > 0.0 for minor in minors], axis=0))


def _field_warnings(model: Model, result: PressResult) -> Iterator[str]:
    """One sentence where the open-circuit voltage is beyond a limit of PVDF film."""
    voltage = max(float(np.abs(step.open_circuit_voltage_V).max()) for step in result.steps)
    field = voltage / model.segment.film.thickness_um
    for limit, said in FIELDS_V_PER_UM:
        if field > limit:
            yield f"the open-circuit voltage of {voltage:.3g} V is {field:.3g} V/um across the film, beyond {said}"
            return
