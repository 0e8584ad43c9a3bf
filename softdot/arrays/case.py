"""An array of one configuration and its presses: over which segments, and which presses are images of others.

Every press of an array is a press of one wide segment (geometry.array) on a mesh with its gaps and grooves
(mesh.array), as softdot.prepared_press has it.
"""

from dataclasses import replace
from functools import cached_property

import numpy as np

from foundation.arrays import Floats
from foundation.errors import InputError
from geometry.array.checks import check_array
from geometry.array.layout import ArrayLayout, SegmentPlace, array_layout
from geometry.braille_cells import COLUMN_AND_ROW, dot_offset_mm, raised_dots
from geometry.checks import check_press_depth, check_segment
from geometry.dot_size import dot_standard
from geometry.parameters import Dot, Segment
from mesh.types import Planes
from softdot.checks import Cost, cost_of
from softdot.config.schema import Config
from softdot.prepared_press import PreparedPress
from solve.materials.film import FilmLaw, film_law
from solve.materials.parameters import PiezoelectricFilm
from solve.symmetry import dot_is_mirrored, law_is_mirrored


class ArrayCase:
    """An array and one rigid dot, or a cell of dots, that presses it.

    config : as stated, with its table [array]. Nothing is solved here.
    """

    def __init__(self, config: Config) -> None:
        """InputError where the configuration states no array."""
        if config.array is None:
            raise InputError("array is missing: softdot array needs a table [array]")
        self.array, self.config = config.array, config

    @cached_property
    def layout(self) -> ArrayLayout:
        """Layout of the segments. InputError for a pitch that the standard does not state."""
        return array_layout(self.array, self.config.segment, self.config.dot)

    @cached_property
    def design_warnings(self) -> list[str]:
        """Warnings about the array as it is built. InputError for one that cannot be built or pressed at all."""
        warnings = [*check_segment(self.config.segment), *check_array(self.layout)]
        self._refuse_keys_of_one_segment()
        if self.config.press.indentation_mm is not None:
            check_press_depth(self.config.segment, self.config.press.indentation_mm)
        if self.config.dot.cell is not None:
            self.under_dots()
        return warnings

    @property
    def warnings(self) -> list[str]:
        """Warnings about the array and all its presses. InputError for one that cannot be solved."""
        return list(
            dict.fromkeys([*self.design_warnings, *(text for press in self.presses for text in press.warnings)])
        )

    @cached_property
    def presses(self) -> list[PreparedPress]:
        """Presses that are solved: a dot over one segment each, and the cell where there is one."""
        alone = [self.press_over(self.layout.places[number]) for number in self.solved_numbers]
        return [*alone, self.press_by_cell()] if self.config.dot.cell is not None else alone

    @property
    def cost(self) -> Cost:
        """Cost of all presses of the array, whose meshes are of about the size of the largest. InputError."""
        return cost_of(max(press.elements for press in self.presses), self.config, len(self.presses))

    def _refuse_keys_of_one_segment(self) -> None:
        """InputError for keys that an array does not take."""
        config = self.config
        if config.dot.shape != "cap" and not self.layout.is_slice:
            raise InputError(f"dot.shape = '{config.dot.shape}': an array is pressed by round dots, 'cap'")
        if config.dot.shape != "ridge" and self.layout.is_slice:
            raise InputError(f"dot.shape = '{config.dot.shape}': a row of slices is pressed by a 'ridge'")
        if config.press.path_xy_mm:
            raise InputError("press.path_xy_mm: softdot array presses each segment in turn; leave the slide out")
        if config.mesh.file is not None:
            raise InputError(f"mesh.file = '{config.mesh.file}': an array is meshed by softdot; leave the file out")
        if config.mesh.accuracy_percent is not None:
            raise InputError(
                f"mesh.accuracy_percent = {config.mesh.accuracy_percent:g}: an array takes element sizes; give "
                "mesh.element_size_mm and mesh.contact_element_size_mm"
            )

    def refuse_kernel(self) -> None:
        """InputError for an array of which a kernel, a table over depth without time, cannot be made."""
        dot, force = self.config.dot, self.config.press.force_N
        if self.layout.is_slice:
            raise InputError(
                "segment.section = 'plane-strain': a kernel is of dots anywhere in x and y; it needs 'solid'"
            )
        if self.config.press.indentation_mm is None:
            raise InputError(
                f"press.force_N = {force}: a kernel is a table over depth; give press.indentation_mm instead"
            )
        if dot.tilt_deg != (0.0, 0.0):
            raise InputError(f"dot.tilt_deg = {list(dot.tilt_deg)}: a kernel is of an upright dot; must be [0, 0]")
        if dot.gap_mm:
            raise InputError(f"dot.gap_mm = {dot.gap_mm:g}: depths of a kernel begin at the touch; must be 0")
        if self.presses[0].model.follows_time:
            raise InputError(
                "mechanisms: a kernel is a table over depth without time; leave out those that remember, slip or move, "
                "and the coupling of the read-out"
            )

    def press_over(self, place: SegmentPlace) -> PreparedPress:
        """Press by one dot alone over one segment. InputError."""
        x, y = self.config.dot.offset_mm
        return self._press(self.config.dot.lone(offset_mm=(place.x_mm + x, place.y_mm + y)))

    def press_by_cell(self) -> PreparedPress:
        """Press by all dots of dot.cell on one plate, dot 1 over segment r1c1, the others at the pitch of the standard.

        InputError without a cell, or where the standard states no pitch.
        """
        dot, first = self.config.dot, self.layout.places[0]
        if dot.cell is None:
            raise InputError("dot.cell is missing: a cell is needed that presses the array")
        standard = dot_standard(dot)
        pitch = self.layout.pitch_mm if standard is None else standard.nominal_mm("dot_pitch_mm")
        x, y = np.add(dot.offset_mm, dot_offset_mm(dot.cell_dot, pitch))
        return self._press(dot.model_copy(update={"offset_mm": (first.x_mm + float(x), first.y_mm + float(y))}))

    def _press(self, dot: Dot) -> PreparedPress:
        return PreparedPress(self.config.model_copy(update={"dot": dot}))

    def under_dots(self) -> dict[int, int]:
        """Number of the segment under each raised dot of dot.cell, dot 1 over segment r1c1. InputError for a dot that
        has none.
        """
        found = {}
        for dot in raised_dots(self.config.dot.cell or ""):
            number = self.under_dot(dot)
            if number is None:
                columns, rows = len(self.layout.centres(0)), len(self.layout.centres(1))
                raise InputError(
                    f"dot.cell = '{self.config.dot.cell}': dot {dot} has no segment under it, "
                    f"array.rows = {rows} and {columns} in each"
                )
            found[dot] = number
        return found

    def under_dot(self, dot: int) -> int | None:
        """Number of the segment under a dot of the first cell, dot 1 over r1c1; None where there is none."""
        columns, rows = len(self.layout.centres(0)), len(self.layout.centres(1))
        column, row = COLUMN_AND_ROW[dot]
        return row * columns + column if column < columns and row < rows else None

    @cached_property
    def _film_law(self) -> FilmLaw:
        """Law of the film in the axes of the array. InputError."""
        film = self.press_over(self.layout.places[0]).model.materials["film"]
        assert isinstance(film, PiezoelectricFilm)
        return film_law(film, self.config.segment.film.draw_angle_deg)

    @property
    def capacitance_pF(self) -> Floats:
        """Capacitance eps A / t of each segment's electrode, (n,). InputError."""
        length, width = (1e-3 * (size - 2.0 * self.array.electrode_margin_mm) for size in self.layout.size_mm)
        thickness = 1e-6 * self.config.segment.film.thickness_um
        one = 1e12 * self._film_law.permittivity * length * width / thickness
        return np.full(len(self.layout.places), one)

    @cached_property
    def mirrors(self) -> Planes:
        """Axes along which a press of a segment has that of the mirrored segment as its image; none where channels of
        the amplifiers differ.
        """
        press = self.press_over(self.layout.places[0])
        if press.model.physics.channels:
            return ()
        place = self.layout.places[0]
        at_origin = replace(press.dot, origin_mm=press.dot.origin_mm - [place.x_mm, place.y_mm, 0.0])
        return tuple(
            axis for axis in (0, 1) if law_is_mirrored(self._film_law, axis) and dot_is_mirrored(at_origin, axis)
        )

    def images(self, number: int) -> list[int]:
        """Numbers of the segments whose presses are images of that of one, itself first."""
        rows, columns = len(self.layout.centres(1)), len(self.layout.centres(0))
        row, column = divmod(number, columns)
        found = [(row, column)]
        if 0 in self.mirrors:
            found += [(r, columns - 1 - c) for r, c in found]
        if 1 in self.mirrors:
            found += [(rows - 1 - r, c) for r, c in found]
        return list(dict.fromkeys(r * columns + c for r, c in found))

    @property
    def solved_numbers(self) -> list[int]:
        """Numbers of the segments whose presses are solved: the first of those that are images of each other."""
        return [number for number in range(len(self.layout.places)) if min(self.images(number)) == number]

    def lone(self, segment: Segment) -> "ArrayCase":
        """The case of one segment alone, on a mesh of the same kind: side conditions are the segment's. It has one
        channel.
        """
        alone = self.array.model_copy(
            update={"columns": 1, "rows": 1, "cells": 1, "shared": (), "grooves": (), "grid_layers": ()}
        )
        kept = tuple(one for one in self.config.mechanisms if not one.component.startswith("channel-"))
        update = {"array": alone, "segment": segment, "dot": self.config.dot.lone(), "mechanisms": kept}
        return ArrayCase(self.config.model_copy(update=update))
