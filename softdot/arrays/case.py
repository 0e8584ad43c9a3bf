"""An array of one configuration and its presses: what is solved, on which mesh, and which presses are images of others.

Every press of an array is a press of one wide segment (geometry.array) on a mesh with its gaps and grooves
(mesh.array), by the solver of one segment.
"""

from dataclasses import replace
from functools import cached_property

import numpy as np

from foundation.arrays import Floats
from foundation.errors import InputError
from geometry.array.checks import check_array
from geometry.array.layout import ArrayLayout, SegmentPlace, array_layout
from geometry.braille_cells import COLUMN_AND_ROW, dot_offset_mm, raised_dots
from geometry.checks import check_press_depth, check_pushed_dot, check_segment, press_warnings
from geometry.dot import DotShape
from geometry.dot_at_rest import resolve_dot
from geometry.dot_size import dot_standard
from geometry.parameters import Dot, Segment
from mesh.array.mesh import array_mesh
from mesh.array.sizing import expected_elements
from mesh.types import Planes, TetMesh
from softdot.checks import Cost, cost_of, design_warnings, refuse_held_rim, refuse_many_elements
from softdot.config.model import model_of
from softdot.config.schema import Config
from solve.materials.film import FilmLaw, film_law
from solve.materials.parameters import PiezoelectricFilm
from solve.model import Model
from solve.symmetry import meshed_planes, mirrored_dot, mirrored_law


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
        """InputError for a pitch that the standard does not state."""
        return array_layout(self.array, self.config.segment, self.config.dot)

    @cached_property
    def built(self) -> list[str]:
        """What a user should know about what is built. InputError for what cannot be built or pressed at all."""
        warnings = [*check_segment(self.config.segment), *check_array(self.layout)]
        self._refuse_what_is_one_segments()
        if self.config.press.indentation_mm is not None:
            check_press_depth(self.config.segment, self.config.press.indentation_mm)
        if self.config.dot.cell is not None:
            self.under_dots()
        return warnings

    @cached_property
    def checked(self) -> list[str]:
        """What a user should know about this design. InputError for what cannot be built or solved."""
        warnings, depth = [*self.built], self.config.press.indentation_mm
        for press in self.presses:
            if depth is None:
                check_pushed_dot(press.config.dot, self.layout.whole)
            else:
                warnings += press_warnings(press.dot, self.layout.whole, depth)
                refuse_held_rim(self.layout.whole, press.dot, depth)
        refuse_many_elements(max(self._elements), self.config.mesh, False)
        return list(dict.fromkeys([*warnings, *design_warnings(self.presses[0].model)]))

    @cached_property
    def presses(self) -> "list[ArrayPress]":
        """All that are solved of the array: a dot over one segment each, and the cell where there is one."""
        alone = [self.press_over(self.layout.places[number]) for number in self.solved]
        return [*alone, self.press_by_cell()] if self.config.dot.cell is not None else alone

    @property
    def _elements(self) -> list[float]:
        """Rough number of elements of each press that is solved. InputError for a dot that overlaps the array."""
        return [expected_elements(self.layout, press.dot, self.config.mesh, press.planes) for press in self.presses]

    @property
    def cost(self) -> Cost:
        """Of all presses of the array, whose meshes are of about the size of the largest. InputError."""
        return cost_of(max(self._elements), self.config, len(self._elements))

    def _refuse_what_is_one_segments(self) -> None:
        """Keys of the configuration that an array does not take."""
        config = self.config
        if config.dot.shape != "cap":
            raise InputError(f"dot.shape = '{config.dot.shape}': an array is pressed by round dots, 'cap'")
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
        """InputError for what a kernel, a table over depth without time, does not hold."""
        dot, force = self.config.dot, self.config.press.force_N
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

    def press_over(self, place: SegmentPlace) -> "ArrayPress":
        """One dot alone over one segment. InputError."""
        x, y = self.config.dot.offset_mm
        return ArrayPress(self, self.config.dot.lone(offset_mm=(place.x_mm + x, place.y_mm + y)))

    def press_by_cell(self) -> "ArrayPress":
        """All dots of dot.cell on one plate, dot 1 over segment r1c1, the others at the pitch of the standard.

        InputError without a cell, or where the standard states no pitch.
        """
        dot, first = self.config.dot, self.layout.places[0]
        if dot.cell is None:
            raise InputError("dot.cell is missing: a cell is needed that presses the array")
        standard = dot_standard(dot)
        pitch = self.layout.pitch_mm if standard is None else standard.nominal_mm("dot_pitch_mm")
        x, y = np.add(dot.offset_mm, dot_offset_mm(dot.cell_dot, pitch))
        return ArrayPress(self, dot.model_copy(update={"offset_mm": (first.x_mm + float(x), first.y_mm + float(y))}))

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
        """Of the film in the axes of the array. InputError."""
        film = self.press_over(self.layout.places[0]).model.materials["film"]
        assert isinstance(film, PiezoelectricFilm)
        return film_law(film, self.config.segment.film.draw_angle_deg)

    @property
    def capacitance_pF(self) -> Floats:
        """eps A / t of each segment's electrode, (n,). InputError."""
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
        if press.model.physics.crosstalk:
            return ()
        place = self.layout.places[0]
        at_origin = replace(press.dot, origin_mm=press.dot.origin_mm - [place.x_mm, place.y_mm, 0.0])
        return tuple(axis for axis in (0, 1) if mirrored_law(self._film_law, axis) and mirrored_dot(at_origin, axis))

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
    def solved(self) -> list[int]:
        """Numbers of the segments whose presses are solved: the first of those that are images of each other."""
        return [number for number in range(len(self.layout.places)) if min(self.images(number)) == number]

    def lone(self, segment: Segment) -> "ArrayCase":
        """One segment alone, on a mesh of the same kind: side conditions are the segment's. It has one channel."""
        alone = self.array.model_copy(
            update={"columns": 1, "rows": 1, "cells": 1, "shared": (), "grooves": (), "grid_layers": ()}
        )
        kept = tuple(one for one in self.config.mechanisms if not one.component.startswith("channel-"))
        update = {"array": alone, "segment": segment, "dot": self.config.dot.lone(), "mechanisms": kept}
        return ArrayCase(self.config.model_copy(update=update))


class ArrayPress:
    """One press of an array: where the dots stand, and what the solver is told."""

    def __init__(self, case: ArrayCase, dot: Dot) -> None:
        self.case = case
        self.config = case.config.model_copy(update={"array": None, "segment": case.layout.whole, "dot": dot})

    @cached_property
    def model(self) -> Model:
        """InputError for a mechanism that changes what an array is made of."""
        model = model_of(self.config)
        changed = model.segment != self.config.segment or model.dot != self.config.dot
        if changed or model.physics.bonds or model.physics.delaminations:
            names = ", ".join(f"'{one.name}'" for one in self.config.mechanisms)
            raise InputError(
                f"mechanisms: {names}: one of them changes the segment, the dot or a bond, which an array does not "
                "take; leave it out"
            )
        return replace(model, physics=replace(model.physics, separate_channels=True))

    @cached_property
    def dot(self) -> DotShape:
        """At rest. InputError for a dot that overlaps the array."""
        return resolve_dot(self.config.dot, self.config.segment)

    @property
    def planes(self) -> Planes:
        """Mirror planes at which the mesh ends."""
        return meshed_planes(self.model, self.dot, self.config.mesh)

    @cached_property
    def mesh(self) -> TetMesh:
        """Of the part that is solved; fine under these dots. MeshingError."""
        touching = self.dot.origin_mm - [0.0, 0.0, self.config.dot.gap_mm]  # a gap is not another mesh
        return array_mesh(self.case.layout, replace(self.dot, origin_mm=touching), self.config.mesh, self.planes)
