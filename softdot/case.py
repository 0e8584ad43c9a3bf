"""A case: one configuration, and all that follows from it, from the parts to the files of a run and of a kit.

case = Case.load("mine.toml")
case.press().plot()
"""

from collections.abc import Sequence
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any

from foundation.errors import InputError
from geometry.stack import layers
from softdot.config.default_design import with_default_design
from softdot.config.loading import config_from, load_config
from softdot.config.model import refuse_array
from softdot.config.schema import Config
from softdot.prepared_press import PreparedPress
from solve.model import Model

if TYPE_CHECKING:
    from softdot.arrays.case import ArrayCase
    from softdot.checks import Cost
    from softdot.differentiation import Derivative


class Case(PreparedPress):
    """One press of one configuration; of an array one over each of its segments, and one by a cell of dots.

    config : as stated, with all defaults. Everything else is derived from it, each made when it is first asked for and
    then kept; what cannot be built or solved is refused by an InputError with one sentence where it is first needed.

    >>> case = Case(
    ...     segment={"section": "plane-strain", "medium1": {"thickness_mm": 0.4}},
    ...     dot={"shape": "ridge"},
    ...     press={"indentation_mm": 0.1, "load_steps": 2},
    ...     mesh={"mesher": "layered", "element_size_mm": 0.5},
    ... )
    >>> [part.label for part in case.parts]
    ['effector', 'medium1', 'film', 'medium2', 'case', 'dot']
    >>> pressed = case.press()
    >>> pressed.converged, pressed.indentation_mm.tolist()
    (True, [0.0, 0.05, 0.1])
    >>> list(pressed.to_dataframe())
    ['time_s', 'indentation_mm', 'reaction_force_N', 'charge_pC_film', 'voltage_V_film', 'solved']
    """

    def __init__(self, config: Config | None = None, **tables: Any) -> None:
        """A configuration, or its tables as keyword arguments: Case(press={"indentation_mm": 0.2}).

        What the tables leave out comes from the default design, as in a file. InputError.
        """
        if config is not None and tables:
            raise TypeError("give either a configuration or its tables")
        super().__init__(config if config is not None else config_from(with_default_design(tables)))

    def __repr__(self) -> str:
        """Size, layers from below and dot in a line.

        >>> Case(press={"indentation_mm": 0.2})
        Case(2.5 x 2.5 mm; medium2 2 mm vnr-soft, film 28 um pvdf, medium1 0.5 mm vnr, effector 1 mm rubber; cap)
        """
        segment, dot = self.config.segment, self.config.dot
        made = [
            f"{one.name} {1e3 * one.thickness_mm:.4g} um {one.material}"
            if one.name == "film"
            else f"{one.name} {one.thickness_mm:.4g} mm {one.material}"
            for one in layers(segment)
        ]
        array = (
            "" if self.config.array is None else f"array of {self.config.array.rows} x {self.config.array.columns}, "
        )
        return f"Case({array}{segment.length_mm:g} x {segment.width_mm:g} mm; {', '.join(made)}; {dot.shape})"

    @classmethod
    def load(cls, path: Path | str | None = None, settings: Sequence[str] = ()) -> "Case":
        """Load a case from a TOML file, or the default design; settings : 'dotted.key=value' after the file.
        InputError.

        >>> Case.load(settings=["press.indentation_mm=0.2"]).config.press.indentation_mm
        0.2
        """
        return cls(load_config(path, settings))

    @cached_property
    def model(self) -> Model:
        """Model of the solver, mechanisms switched on. InputError; of an array take over or by_cell."""
        refuse_array(self.config)
        return super().model

    def over(self, segment: str) -> PreparedPress:
        """The press of an array by one dot over a segment, such as "r1c2". InputError."""
        places = {place.label.removeprefix("segment-"): place for place in self._array.layout.places}
        if segment not in places:
            raise InputError(f"segment '{segment}': is none of {', '.join(places)}")
        return self._array.press_over(places[segment])

    def by_cell(self) -> PreparedPress:
        """The press of an array by all dots of dot.cell, dot 1 over r1c1. InputError."""
        return self._array.press_by_cell()

    @cached_property
    def _array(self) -> "ArrayCase":
        """The presses of an array that can be built. InputError, also where the configuration states no array."""
        from softdot.arrays.case import ArrayCase

        found = ArrayCase(self.config)
        _ = found.design_warnings
        return found

    @property
    def warnings(self) -> list[str]:
        """Warnings before the solution, of an array about all its presses. InputError."""
        return super().warnings if self.config.array is None else self._array.warnings

    @property
    def cost(self) -> "Cost":
        """Expected cost of a run, of an array that of its presses over each segment. InputError."""
        return super().cost if self.config.array is None else self._array.cost

    @cached_property
    def sized_config(self) -> Config:
        """The configuration with the element sizes that mesh.accuracy_percent asks for. InputError."""
        from softdot.tolerances.accuracy import with_sizes_for_accuracy

        return with_sizes_for_accuracy(self.config)

    def uncertainty(self, summary: dict[str, Any]) -> dict[str, Any]:
        """Uncertainty of the last force and voltage of a summary."""
        from softdot.tolerances.uncertainty import uncertainty

        return uncertainty(self.sized_config, summary)

    def derivatives(self, keys: Sequence[str]) -> "list[Derivative]":
        """Derivatives of force, charge and voltage along the press by keys such as "segment.film.thickness_um".
        InputError.
        """
        from softdot.differentiation import derivatives_of_press

        return derivatives_of_press(self.config, keys, self.solved_mesh)

    def kit(self, folder: Path | str) -> dict[str, Any]:
        """Write the fabrication kit into a folder, as `softdot kit` does; returns kit.json. InputError."""
        from softdot.kit.folder import make_kit

        return make_kit(self.config, Path(folder))

    def save(self, folder: Path | str) -> dict[str, Any]:
        """Write all files of `softdot run` into a folder; returns summary.json. InputError."""
        from softdot.run_folder import run_case

        return run_case(self, Path(folder))
