"""Mirror planes of a press: a half or a quarter of it then stands for the whole.

A press is its own image in the plane x = 0 or y = 0 where everything that the solver is told is: the film's constants
in the axes of the segment, electrodes, delaminated patches, the dot at rest and its path. The layers are centred and
isotropic. On the plane the displacement normal to it is zero, and so is the traction along it, which is the natural
condition of the weak form.
"""

from collections.abc import Sequence

import numpy as np

from foundation.arrays import Floats, Ints
from geometry.dot import DotShape
from geometry.electrode_outlines import electrode_outlines
from geometry.polygons import Point
from mesh.options import MeshOptions
from mesh.types import Planes
from solve.materials.film import FilmLaw, film_law
from solve.materials.parameters import PiezoelectricFilm
from solve.model import Model
from solve.physics import Delamination
from solve.readout.channel_parts import capacitances_F, conductances_uS
from solve.tensors import strain_rotation

Outlines = Sequence[Sequence[Point]]

SAME_PLACE_MM, SAME_CONSTANT = 1e-9, 1e-9
"""How far an image may be off: in mm; of the largest constant, for angles whose cosine is rounded."""


def planes_of(model: Model, dot: DotShape) -> Planes:
    """Axes of the mirror planes that a press of this dot has; a slice varies over x alone."""
    axes = (0,) if model.segment.section == "plane-strain" else (0, 1)
    return tuple(axis for axis in axes if _press_is_mirrored(model, dot, axis))


def meshed_planes(model: Model, dot: DotShape, options: MeshOptions) -> Planes:
    """Axes of the mirror planes at which the mesh is to end: none for the user's own mesh, which is of the whole."""
    return planes_of(model, dot) if options.symmetry == "auto" and options.file is None else ()


def _press_is_mirrored(model: Model, dot: DotShape, axis: int) -> bool:
    """Whether everything that the solver is told is its own image in the plane normal to an axis."""
    film = model.materials["film"]
    assert isinstance(film, PiezoelectricFilm)
    return (
        law_is_mirrored(film_law(film, model.segment.film.draw_angle_deg), axis)
        and electrode_images(electrode_outlines(model.segment), axis) is not None
        and _inputs_are_mirrored(model, axis)
        and _patches_are_mirrored(model.physics.delaminations, axis, model.segment.section == "plane-strain")
        and all(term.mirrored for term in model.physics.terms)
        and dot_is_mirrored(dot, axis)
        and all(point[axis] == 0.0 for point in model.press.path_xy_mm)
    )


def law_is_mirrored(law: FilmLaw, axis: int) -> bool:
    """Whether the constants of a film are those of its image in the plane normal to an axis."""
    sign = np.ones(3)
    sign[axis] = -1.0
    turn = np.diag(strain_rotation(np.diag(sign)))  # of strains; stresses turn by the same signs
    off = law.stiffness - turn[:, None] * law.stiffness * turn
    off_coupling = law.coupling - turn * law.coupling
    return bool(
        np.abs(off).max() <= SAME_CONSTANT * np.abs(law.stiffness).max()
        and np.abs(off_coupling).max() <= SAME_CONSTANT * np.abs(law.coupling).max()
    )


def electrode_images(outlines: Outlines, axis: int) -> Ints | None:
    """The electrode (e,) that is the image of each of the outlines; None where one has none."""
    corners = [np.asarray(outline) for outline in outlines]
    middles = np.array([each.mean(axis=0) for each in corners])
    sign = np.where(np.arange(2) == axis, -1.0, 1.0)
    found = []
    for own, middle in zip(corners, middles, strict=True):
        near = np.flatnonzero(np.abs(middles - sign * middle).max(axis=1) <= SAME_PLACE_MM)
        image = sign * own[::-1]
        found.append(next((number for number in near if _is_same_outline(corners[number], image)), None))
    return None if None in found else np.array(found, dtype=np.int64)


def _is_same_outline(one: Floats, other: Floats) -> bool:
    """Whether corners (n, 2) in order are those of another outline, whichever comes first."""
    if len(one) != len(other):
        return False
    first = int(np.abs(other - one[0]).max(axis=1).argmin())
    return bool(np.abs(np.roll(other, -first, axis=0) - one).max() <= SAME_PLACE_MM)


def _inputs_are_mirrored(model: Model, axis: int) -> bool:
    """Whether amplifiers of electrodes that act back on the film are their own images."""
    image = electrode_images(electrode_outlines(model.segment), axis)
    if not model.separate_channels or image is None:
        return image is not None
    leaks = conductances_uS(model.physics.channels, len(image))
    between = capacitances_F(model.physics.channels, len(image))
    off = np.abs(leaks[image] - leaks).max(), np.abs(between[image][:, image] - between).max()
    return bool(off[0] <= SAME_CONSTANT * leaks.max() and off[1] <= SAME_CONSTANT * np.abs(between).max())


def _patches_are_mirrored(patches: tuple[Delamination, ...], axis: int, is_slice: bool) -> bool:
    """Whether the image of each patch is one of them; in a slice they are strips, which y does not tell apart."""

    def place(patch: Delamination, sign: float) -> tuple[str, float, float, float, bool]:
        center = [*patch.center_mm]
        center[axis] *= sign
        across = 0.0 if is_slice else round(center[1], 9)
        return patch.bond, round(center[0], 9), across, patch.diameter_mm, patch.outside

    return {place(patch, -1.0) for patch in patches} == {place(patch, 1.0) for patch in patches}


def dot_is_mirrored(dot: DotShape, axis: int) -> bool:
    """Whether a dot at rest is its own image in the plane normal to an axis: its plate is not turned out of the plane,
    and each ball has its image among the balls.
    """
    sign = np.ones(3)
    sign[axis] = -1.0
    turned = sign[:, None] * dot.rotation * sign
    if np.abs(turned - dot.rotation).max() > SAME_CONSTANT:
        return False
    if dot.kind == "plate" or (dot.kind == "ridge" and axis == 1):
        return True
    tips = dot.origin_mm + dot.tips_mm @ dot.rotation.T
    apart = np.abs((sign * tips)[:, None] - tips[None]).max(axis=2)
    return bool((apart.min(axis=1) <= SAME_PLACE_MM).all())


def electrode_orbits(outlines: Outlines, planes: Planes) -> Ints:
    """Number (e,), from 0, of the group that each of the electrodes shares with its images."""
    first = np.arange(len(outlines))
    for axis in planes:
        image = electrode_images(outlines, axis)
        assert image is not None, "the mesh is cut at a plane that the electrodes do not have"
        first = np.minimum(first, first[image])
    return np.unique(first, return_inverse=True)[1].ravel()


def electrode_image_sum(outlines: Outlines, planes: Planes) -> Floats:
    """Matrix (e, e) from what each electrode collects of the meshed part to what it collects of the whole."""
    total = np.eye(len(outlines))
    for axis in planes:
        image = electrode_images(outlines, axis)
        assert image is not None, "the mesh is cut at a plane that the electrodes do not have"
        total = total + total[:, image]
    return total
