"""Layout of an array: where its segments lie, and where each layer has material. Lengths in mm.

The origin is the middle of the array's base. Columns follow x and rows follow y, as the dots of a Braille cell do
(geometry.braille_standards): segment r1c1 is under dot 1 of the first cell, r2c1 under dot 2, r1c2 under dot 4.
"""

from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise

import numpy as np

from foundation.arrays import Bools, Floats
from foundation.errors import InputError
from geometry.array.parameters import Array, Groove
from geometry.braille_standards import QuantityName
from geometry.dot_size import dot_standard
from geometry.parameters import Dot, Effector, Electrode, LayerName, Segment
from geometry.stack import layers

AXIS_NAMES = ("x", "y")
PATCH_PER_RADIUS = 1.3
Rectangle = tuple[float, float, float, float]
"""Least and largest x, least and largest y in mm."""


@dataclass(frozen=True)
class SegmentPlace:
    """The place of one segment: its row and column, counted from 1, and its centre in mm."""

    row: int
    column: int
    x_mm: float
    y_mm: float

    @property
    def label(self) -> str:
        """Name of the segment in files and results, such as segment-r1c2."""
        return f"segment-r{self.row}c{self.column}"


@dataclass(frozen=True)
class ArrayLayout:
    """An array whose pitches are resolved. segment : one of its segments, as the configuration states it."""

    array: Array
    segment: Segment
    pitch_mm: float
    cell_pitch_mm: float

    @property
    def size_mm(self) -> tuple[float, float]:
        """Size of one segment in x and y, in mm."""
        return self.segment.length_mm, self.segment.width_mm

    @property
    def is_slice(self) -> bool:
        """Whether it is a row of plane-strain slices."""
        return self.segment.section == "plane-strain"

    @property
    def gap_mm(self) -> tuple[float, float]:
        """Smallest gap between neighbouring segments in x and y, in mm; infinite without neighbours."""
        nearest = np.diff(self.centres(0)).min(initial=np.inf), np.diff(self.centres(1)).min(initial=np.inf)
        return float(nearest[0] - self.size_mm[0]), float(nearest[1] - self.size_mm[1])

    def centres(self, axis: int) -> Floats:
        """Middles (n,) of the columns (axis 0) or of the rows (axis 1) in mm, rising and mirrored about 0."""
        array = self.array
        if axis == 1:
            return _centred_positions(self.pitch_mm * np.arange(array.rows, dtype=np.float64))
        cells = self.cell_pitch_mm * np.arange(array.cells, dtype=np.float64)
        return _centred_positions((cells[:, None] + self.pitch_mm * np.arange(array.columns)).ravel())

    @cached_property
    def places(self) -> tuple[SegmentPlace, ...]:
        """Places of all segments, row by row."""
        return tuple(
            SegmentPlace(row, column, float(x), float(y))
            for row, y in enumerate(self.centres(1), start=1)
            for column, x in enumerate(self.centres(0), start=1)
        )

    @property
    def middles(self) -> Floats:
        """Middles (n, 2) of all segments in mm, in the order of places."""
        return np.array([(place.x_mm, place.y_mm) for place in self.places])

    @property
    def half_mm(self) -> tuple[float, float]:
        """Half the size of the whole array in x and y, in mm."""
        return tuple(float(self.centres(axis)[-1]) + self.size_mm[axis] / 2 for axis in (0, 1))  # type: ignore[return-value]

    def edges(self, axis: int) -> list[tuple[float, float]]:
        """Lower and upper edge in mm of each column (axis 0) or row (axis 1) of segments."""
        half = self.size_mm[axis] / 2
        return [(float(middle) - half, float(middle) + half) for middle in self.centres(axis)]

    def seams(self, axis: int) -> list[float]:
        """Coordinates in mm midway between neighbouring columns (axis 0) or rows (axis 1)."""
        return [float(a + b) / 2 for a, b in pairwise(self.centres(axis))]

    def ends_at_walls(self, layer: str) -> bool:
        """Whether a layer ends at the edges of each segment: an island, or one that the grid holds."""
        return layer not in self.array.shared or layer in self.array.grid_layers

    def is_cut(self, layer: str) -> bool:
        """Whether a layer has a solid on each segment; a film that runs through passes a grid as one sheet."""
        return self.ends_at_walls(layer) and not (layer == "film" and layer in self.array.shared)

    def foot_mm(self, layer: str) -> tuple[float, float]:
        """Size in x and y, in mm, of a layer on one segment: the segment's, or that of a narrower effector."""
        effector = self.segment.effector
        if layer != "effector" or effector is None or effector.shape == "layer":
            return self.size_mm
        length, width = effector.length_mm or effector.diameter_mm, effector.width_mm or effector.diameter_mm
        return length or self.size_mm[0], width or self.size_mm[1]

    @property
    def foot_radius_mm(self) -> float | None:
        """Radius in mm of effectors that are cylinders or domes; None for others."""
        effector = self.segment.effector
        return None if effector is None or effector.diameter_mm is None else effector.diameter_mm / 2

    @property
    def patch_mm(self) -> float:
        """Half side in mm of the square around a round effector within which its mesh is round."""
        return min(PATCH_PER_RADIUS * (self.foot_radius_mm or 0.0), *(size / 2 for size in self.size_mm))

    def grooves(self, layer: str) -> list[Groove]:
        """Grooves that are cut into one layer."""
        return [groove for groove in self.array.grooves if groove.layer == layer]

    def lines(self, axis: int) -> Floats:
        """Coordinates (n,) in mm at which some layer begins or ends, rising, the middle and the rim included."""
        half = self.half_mm[axis]
        at = {-half, 0.0, half}
        for layer in layers(self.segment):
            if self.ends_at_walls(layer.name) and not (layer.name == "effector" and self.foot_radius_mm is not None):
                foot = self.foot_mm(layer.name)[axis] / 2
                at |= {float(c) + side * foot for c in self.centres(axis) for side in (-1, 1)}
            for groove in self.grooves(layer.name):
                at |= {seam + side * groove.width_mm / 2 for seam in self.seams(axis) for side in (-1, 1)}
        rounded = np.unique(np.round(list(at), 9))
        return np.asarray(rounded[np.abs(rounded) <= half + 1e-9])

    def holds(self, layer: str, xy_mm: Floats, z_mm: float) -> Bools:
        """Whether a layer has material at points (n, 2) and a height, both in mm; the height is one of the layer."""
        if self.ends_at_walls(layer):
            foot = self.foot_mm(layer)
            return self._within(xy_mm[:, 0], 0, foot[0] / 2) & self._within(xy_mm[:, 1], 1, foot[1] / 2)
        present: Bools = np.ones(len(xy_mm), dtype=bool)
        top = next(one.top_mm for one in layers(self.segment) if one.name == layer)
        for groove in self.grooves(layer):
            if z_mm > top - groove.depth_mm:
                for axis in (0, 1):
                    for seam in self.seams(axis):
                        present &= np.abs(xy_mm[:, axis] - seam) > groove.width_mm / 2
        return present

    def _within(self, along: Floats, axis: int, half: float) -> Bools:
        return np.asarray((np.abs(along[:, None] - self.centres(axis)) < half).any(axis=1))

    def rectangles(self, layer: str) -> list[Rectangle]:
        """Rectangles that a layer which ends at walls covers, one for each segment in the order of places."""
        half_x, half_y = (size / 2 for size in self.foot_mm(layer))
        return [(p.x_mm - half_x, p.x_mm + half_x, p.y_mm - half_y, p.y_mm + half_y) for p in self.places]

    @cached_property
    def whole(self) -> Segment:
        """The array as one wide segment with an electrode on each of its own, as the solver takes it.

        Its layers are those of the array but for what is missing in gaps and grooves, which the mesh knows.
        """
        segment, (half_x, half_y) = self.segment, self.half_mm
        margin = self.array.electrode_margin_mm
        size = (segment.length_mm - 2 * margin, segment.width_mm - 2 * margin)
        electrodes = [Electrode(name=p.label, center_mm=(p.x_mm, p.y_mm), size_mm=size) for p in self.places]
        effector = segment.effector and Effector(
            shape="layer", height_mm=segment.effector.height_mm, material=segment.effector.material
        )
        return segment.model_copy(
            update={
                "length_mm": 2 * half_x,
                "width_mm": 2 * half_y,
                "film": segment.film.model_copy(update={"electrodes": tuple(electrodes)}),
                "effector": effector,
                "boundary": "clamped" if self.array.grid_layers else segment.boundary,
                "held_layers": self.held_layers,
            }
        )

    @property
    def held_layers(self) -> tuple[LayerName, ...]:
        """Names of the layers of which some sides are held, by the grid or at the rim."""
        rim = self.segment.held_layers if self.segment.boundary != "free" else ()
        return tuple(dict.fromkeys((*self.array.grid_layers, *rim)))


def _centred_positions(positions: Floats) -> Floats:
    """Rising positions (n,), shifted so that they are mirrored about 0 to the last digit."""
    middle = positions - positions.mean()
    return np.asarray((middle - middle[::-1]) / 2, dtype=np.float64)


def array_layout(array: Array, segment: Segment, dot: Dot) -> ArrayLayout:
    """The layout of an array with its pitches resolved. InputError where the standard states none."""
    pitch = array.pitch_mm or _standard_pitch_mm("dot_pitch_mm", "array.pitch_mm", dot)
    cell_pitch = array.cell_pitch_mm
    if cell_pitch is None:
        cell_pitch = _standard_pitch_mm("cell_pitch_mm", "array.cell_pitch_mm", dot) if array.cells > 1 else 0.0
    return ArrayLayout(array, segment, pitch, cell_pitch)


def _standard_pitch_mm(quantity: QuantityName, field: str, dot: Dot) -> float:
    """A pitch in mm of the dot's standard, or of the default standard where the dot states no sizes. InputError."""
    chosen = dot_standard(dot)
    if chosen is None:
        raise InputError(f"{field} is missing: the dot has sizes of its own and no dot.standard with a pitch")
    try:
        return chosen.nominal_mm(quantity)
    except InputError as error:
        raise InputError(f"{field} is missing: {error}") from None
