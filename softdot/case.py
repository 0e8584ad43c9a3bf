"""A case: one configuration, and what follows from it, each made when it is first asked for and then kept.

    case = Case.load("mine.toml")
    case.press().plot()

Heavy libraries are imported inside the methods, so that a configuration that is refused is refused at once.

A press as people read it: arrays with units in their names, tables, plots and ParaView's meshes.
"""

from collections.abc import Callable, Sequence
from dataclasses import replace
from functools import cached_property
from html import escape
from io import BytesIO
from pathlib import Path
from typing import TYPE_CHECKING, Any
from warnings import warn

import numpy as np

from foundation.arrays import Floats
from geometry.dot import DotShape
from mesh.types import Planes, TetMesh
from softdot.config.default_design import completed
from softdot.config.hashes import input_hash
from softdot.config.loading import config_from, load_config
from softdot.config.model import model_of
from softdot.config.schema import Config
from softdot.summary import course_columns, course_part, history
from solve.model import Model
from solve.result import PressResult, Step

if TYPE_CHECKING:
    import pandas as pd
    import pyvista as pv
    from matplotlib.figure import Figure

    from geometry.solids import Part
    from softdot.differentiation import Derivative
    from solve.readout.course import PressCourse

OnStep = Callable[[Step, int, int], None]


class ResultWarning(UserWarning):
    """A number of a press is to be doubted; the sentence stands in Pressed.doubts too."""


class ConvergenceWarning(ResultWarning):
    """A press ended before the depth or force that was asked for: its last numbers are those of less."""


class Case:
    """One press of one configuration.

    config : as stated, with all defaults. Everything else is derived from it; what cannot be built or solved is refused
    by an InputError with one sentence where it is first needed.

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
        self.config = config if config is not None else config_from(completed(tables))

    @classmethod
    def load(cls, path: Path | str | None = None, settings: Sequence[str] = ()) -> "Case":
        """From a TOML file, or the default design; settings : 'dotted.key=value' after the file. InputError.

        >>> Case.load(settings=["press.indentation_mm=0.2"]).config.press.indentation_mm
        0.2
        """
        return cls(load_config(path, settings))

    @cached_property
    def model(self) -> Model:
        """What the solver is told, mechanisms switched on. InputError."""
        return model_of(self.config)

    @cached_property
    def checked(self) -> tuple[DotShape, list[str]]:
        """The dot at rest and what a user should know about this design. InputError for what cannot be solved."""
        from softdot.checks import check_case

        return check_case(self.model, self.config.mesh)

    @property
    def dot(self) -> DotShape:
        """The dot at rest. InputError."""
        return self.checked[0]

    @cached_property
    def parts(self) -> "Sequence[Part]":
        """The labelled solids of the segment, its case and the dot (build123d). InputError."""
        from geometry.assembly import build_parts

        return build_parts(self.model.segment, self.dot)

    @cached_property
    def mesh(self) -> TetMesh:
        """The conforming mesh of the whole segment. InputError, MeshingError."""
        from mesh.symmetry import unfolded

        return unfolded(self.solved_mesh).tet_mesh

    @cached_property
    def solved_mesh(self) -> TetMesh:
        """What is solved: the mesh of a half or a quarter where all is symmetric. InputError, MeshingError."""
        import mesh

        touching = self.dot.origin_mm - [0.0, 0.0, self.model.dot.gap_mm]  # a gap is not another mesh
        return mesh.build(self.model.segment, replace(self.dot, origin_mm=touching), self.sized.mesh, self.planes)

    @cached_property
    def sized(self) -> Config:
        """The configuration with the element sizes that mesh.accuracy_percent asks for. InputError."""
        from softdot.tolerances.accuracy import sized

        return sized(self.config)

    @property
    def planes(self) -> Planes:
        """Mirror planes at which the mesh ends: axes, 0 for x = 0 and 1 for y = 0. InputError."""
        from solve.symmetry import meshed_planes

        return meshed_planes(self.model, self.dot, self.config.mesh)

    @property
    def mesh_quality(self) -> dict[str, Any]:
        """Numbers about the mesh that is solved, as in summary.json."""
        from mesh.quality import measure

        sizes = {} if self.config.mesh.file is not None else self.sized.mesh.sizes_mm
        return {**measure(self.solved_mesh, self.model.segment).as_dict(), **sizes}

    def press(self, on_step: OnStep | None = None) -> "Pressed":
        """The press, as far as it converged: .converged says whether, .failure why not. InputError, MeshingError.

        A press that ended early warns by ConvergenceWarning, what else is to be doubted by ResultWarning.
        """
        if "_pressed" not in self.__dict__:
            pressed = self.__dict__["_pressed"] = Pressed(self, self.solve(on_step))
            if not pressed.converged:
                warn(f"not converged, {pressed.failure}", ConvergenceWarning, stacklevel=2)
            for sentence in pressed.doubts:
                warn(sentence, ResultWarning, stacklevel=2)
        return self.__dict__["_pressed"]  # type: ignore[no-any-return]

    def solve(self, on_step: OnStep | None = None, tet_mesh: TetMesh | None = None) -> PressResult:
        """The solver's own result in SI units; tet_mesh : another one of the same segment. A killed solve goes on."""
        from foundation.cache import folder
        from solve.press import press_segment
        from solve.solution.checkpoint import Checkpoint

        on_mesh = self.solved_mesh if tet_mesh is None else tet_mesh
        key = press_key(self, on_mesh)
        kept, asked = Checkpoint(folder() / f"press-{key}.npz", key), self.config.mesh.accuracy_percent
        return press_segment(self.model, on_mesh, on_step, kept, self.dot, asked)

    @property
    def is_amplified(self) -> bool:
        """Whether something stands between the film and what is read."""
        return self.model.amplifier is not None

    def course(self, result: PressResult) -> "PressCourse":
        """The course of a result in time: drive, force, charges, voltages, and what each amplifier gives."""
        from solve.readout.course import course

        return course(result, self.model.press, self.model.amplifier, self.model.physics)

    def uncertainty(self, summary: dict[str, Any]) -> dict[str, Any]:
        """How far the last force and voltage of a summary can be trusted."""
        from softdot.tolerances.uncertainty import uncertainty

        return uncertainty(self.sized, summary)

    def derivatives(self, keys: Sequence[str]) -> "list[Derivative]":
        """Of force, charge and voltage along the press by keys such as "segment.film.thickness_um". InputError."""
        from softdot.differentiation import derivatives

        return derivatives(self.config, keys)

    def kit(self, folder: Path | str) -> dict[str, Any]:
        """The fabrication kit in a folder, as `softdot kit` writes it; returns kit.json. InputError."""
        from softdot.kit.folder import make_kit

        return make_kit(self.config, Path(folder))

    def save(self, folder: Path | str) -> dict[str, Any]:
        """All files of `softdot run` in a folder; returns summary.json. InputError."""
        from softdot.commands.run import run_case

        return run_case(self, Path(folder))


def press_key(case: Case, tet_mesh: TetMesh) -> str:
    """Hash of all that a press depends on: configuration, the file of its waveform, mesh and program."""
    from foundation.cache import data_hash
    from foundation.source_hash import source_hash
    from mesh.types import mesh_hash

    return data_hash([source_hash("solve.press"), input_hash(case.config), mesh_hash(tet_mesh)])


LAST = -1
FIGURE_SIZE_IN, SCREEN_DPI = (8.0, 3.2), 100


class Pressed:
    """What Case.press gives. All arrays have one value for each reported step (s,); index 0 is the unloaded state.

    result : the solver's own result with its fields, in SI units. Electrodes are taken in parallel.

    >>> coarse = {"mesher": "layered", "element_size_mm": 0.8}
    >>> soft = Case(segment={"section": "plane-strain"}, dot={"shape": "ridge"}, press={"load_steps": 1}, mesh=coarse)
    >>> pressed = soft.press()
    >>> bool(pressed.reaction_force_N[-1] > 0.0), pressed.failure
    (True, None)
    >>> pressed.to_pyvista().point_data["displacement_mm"].shape[1]
    3
    """

    def __init__(self, case: "Case", result: PressResult) -> None:
        self.case, self.result = case, result
        past = history(result)
        self.indentation_mm, self.reaction_force_N = past.indentation_mm, past.reaction_force_N
        self.film_charge_pC, self.open_circuit_voltage_V = past.film_charge_pC, past.open_circuit_voltage_V
        self.time_s: Floats = np.array([step.time_s for step in result.steps])
        """When the waveform first comes to each step."""

    @property
    def converged(self) -> bool:
        """Whether the last asked depth or force was reached."""
        return self.result.converged

    @property
    def failure(self) -> str | None:
        """Where and why the press stopped short; None where it did not."""
        return self.result.failure

    @property
    def warnings(self) -> list[str]:
        """What a user should know, before and after the solution."""
        from softdot.checks import design_warnings

        return [*self.case.checked[1], *design_warnings(self.case.model), *self.doubts]

    @cached_property
    def doubts(self) -> list[str]:
        """Why numbers of this solution should be doubted, a sentence each."""
        from softdot.checks import course_warnings, result_warnings

        model = self.case.model
        told = result_warnings(model, self.case.dot, self.result)
        return [*told, *course_warnings(model, self.result, self.course)]

    @cached_property
    def course(self) -> "PressCourse":
        """The whole press in time, SI units: what comes between the steps, a hold and the way back included."""
        return self.case.course(self.result)

    @property
    def readout_voltage_V(self) -> Floats | None:
        """Behind the amplifier (s,); None without one."""
        found = self.course.together_V
        return None if found is None else found[self.course.solved]

    @property
    def channel_voltages_V(self) -> Floats | None:
        """Of each electrode behind an amplifier of its own, (e, s); None without one."""
        found = self.course.channels_V
        return None if found is None else found[self.course.solved].T

    @property
    def film_capacitance_pF(self) -> float:
        """Of the undeformed film under all electrodes."""
        return 1e12 * float(self.result.capacitance_F.sum())

    @property
    def max_film_strain(self) -> float:
        """Largest principal strain of the film, a mean through its thickness, away from held rims."""
        return self.result.film_peak.strain

    def to_dataframe(self) -> "pd.DataFrame":
        """The course, one row a time; electrodes and channels by name, as charge_pC_film; solved : of the steps."""
        import pandas as pd

        table = pd.DataFrame(course_columns(course_part(self.case.model, self.result, self.course)))
        table["solved"] = table.index.isin(self.course.solved)
        return table

    def _columns(self) -> dict[str, Floats]:
        columns = {
            "time_s": self.time_s,
            "indentation_mm": self.indentation_mm,
            "reaction_force_N": self.reaction_force_N,
            "film_charge_pC": self.film_charge_pC,
            "open_circuit_voltage_V": self.open_circuit_voltage_V,
        }
        if self.readout_voltage_V is not None:
            columns["readout_voltage_V"] = self.readout_voltage_V
        return columns

    def to_pyvista(self, step: int = LAST) -> "pv.UnstructuredGrid":
        """The undeformed mesh in mm with what the files of a step hold; film arrays are NaN elsewhere.

        warp_by_vector("displacement_mm") deforms it. Quadratic tetrahedra (VTK type 24). Units stand in the names of
        the arrays.
        """
        import pyvista as pv

        fields, tet_mesh = self.result.steps[step].fields, self.result.tet_mesh
        grid = pv.UnstructuredGrid({pv.CellType.QUADRATIC_TETRA: tet_mesh.tets}, tet_mesh.points_mm)
        grid.point_data["displacement_mm"] = 1e3 * fields.displacement_m
        grid.cell_data["region"] = tet_mesh.region
        grid.cell_data["cauchy_stress_MPa"] = 1e-6 * fields.cauchy_stress_Pa
        grid.cell_data["von_mises_MPa"] = 1e-6 * fields.von_mises_Pa
        grid.cell_data["pressure_MPa"] = 1e-6 * fields.pressure_Pa
        grid.cell_data["max_stretch"] = fields.max_stretch
        film = {
            "film_strain": fields.film_strain,
            "film_stress_MPa": 1e-6 * fields.film_stress_Pa,
            "charge_density_pC_per_mm2": 1e6 * fields.charge_density_C_per_m2,
        }
        for name, values in film.items():
            everywhere = np.full((len(tet_mesh.tets), *values.shape[1:]), np.nan)
            everywhere[fields.film_tets] = values
            grid.cell_data[name] = everywhere
        return grid

    def plot(self) -> "Figure":
        """Force and voltage against depth; with a waveform or an amplifier the whole course over time."""
        from matplotlib.figure import Figure

        from export.course_figure import course_figure

        if self.case.is_amplified or self.result.follows_time or self.case.model.press.waveform is not None:
            return _shown(course_figure(self.course, self.result.electrode_names))
        figure = Figure(figsize=FIGURE_SIZE_IN, layout="constrained")
        shown = {"reaction force (N)": self.reaction_force_N, "open-circuit voltage (V)": self.open_circuit_voltage_V}
        for axes, (name, values) in zip(figure.subplots(1, 2), shown.items(), strict=True):
            axes.plot(self.indentation_mm, values, "o-", markersize=3)
            axes.set(xlabel="indentation (mm)", ylabel=name)
            axes.grid(alpha=0.3)
        return _shown(figure)

    def plot_film(self) -> "Figure":
        """Strain and charge density of the film at the deepest step, as in film.png of `softdot run`."""
        from export.film_maps import film_figure
        from export.pictures import deepest

        return _shown(film_figure(self.result.tet_mesh, deepest(self.result), self.result.film_peak))

    def _repr_html_(self) -> str:
        """For notebooks: how it ended, and a table of the steps."""
        columns = self._columns()
        head = "".join(f"<th>{escape(name)}</th>" for name in columns)
        rows = "".join(
            "<tr>" + "".join(f"<td>{value:.4g}</td>" for value in row) + "</tr>"
            for row in zip(*columns.values(), strict=True)
        )
        ended = "converged" if self.converged else f"not converged: {escape(str(self.failure))}"
        return f"<p>Press, {ended}.</p><table><tr>{head}</tr>{rows}</table>"

    def __repr__(self) -> str:
        """The deepest step in a line."""
        state = "" if self.converged else f", not converged: {self.failure}"
        values: dict[str, Any] = {name: array[LAST] for name, array in self._columns().items()}
        return "Pressed(" + ", ".join(f"{name}={value:.4g}" for name, value in values.items()) + f"{state})"


def _shown(figure: "Figure") -> "Figure":
    """The figure, which a notebook shows as a picture also where pyplot has not been imported."""

    def png() -> bytes:
        buffer = BytesIO()
        figure.savefig(buffer, format="png", dpi=SCREEN_DPI)
        return buffer.getvalue()

    figure.set_dpi(SCREEN_DPI)
    figure._repr_png_ = png  # type: ignore[attr-defined]
    return figure
