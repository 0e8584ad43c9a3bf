"""A press as people read it: arrays with units in their names, tables, plots and ParaView's meshes."""

from functools import cached_property
from html import escape
from io import BytesIO
from typing import TYPE_CHECKING, Any

import numpy as np

from foundation.arrays import Floats
from softdot.summary import course_columns, course_part, history
from solve.result import PressResult

if TYPE_CHECKING:
    import pandas as pd
    import pyvista as pv
    from matplotlib.figure import Figure

    from softdot.prepared_press import PreparedPress
    from solve.readout.course import PressCourse


class ResultWarning(UserWarning):
    """A number of a press is to be doubted; the sentence stands in Pressed.doubts too."""


class ConvergenceWarning(ResultWarning):
    """A press ended before the depth or force that was asked for: its last numbers are those of less."""


LAST = -1
FIGURE_SIZE_IN, SCREEN_DPI = (8.0, 3.2), 100


class Pressed:
    """Result of Case.press. All arrays have one value for each reported step (s,); index 0 is the unloaded state.

    result : the solver's own result with its fields, in SI units. Where electrodes have no names they are taken in
    parallel. What is pressed may be a segment or an array, whose electrodes are its segments.

    >>> from softdot import Case
    >>> coarse = {"mesher": "layered", "element_size_mm": 0.8}
    >>> soft = Case(segment={"section": "plane-strain"}, dot={"shape": "ridge"}, press={"load_steps": 1}, mesh=coarse)
    >>> pressed = soft.press()
    >>> bool(pressed.reaction_force_N[-1] > 0.0), pressed.failure
    (True, None)
    >>> pressed.to_pyvista().point_data["displacement_mm"].shape[1]
    3
    """

    def __init__(self, case: "PreparedPress", result: PressResult) -> None:
        self.case, self.result = case, result
        past = history(result)
        self.indentation_mm, self.reaction_force_N = past.indentation_mm, past.reaction_force_N
        self.film_charge_pC, self.open_circuit_voltage_V = past.film_charge_pC, past.open_circuit_voltage_V
        self.charges_pC = self._by_electrode(1e12 * np.array([step.film_charge_C for step in result.steps]))
        self.voltages_V = self._by_electrode(np.array([step.open_circuit_voltage_V for step in result.steps]))
        """Of each electrode by its name: short-circuit charge, and voltage of its open circuit."""
        self.time_s: Floats = np.array([step.time_s for step in result.steps])
        """When the waveform first comes to each step."""

    def _by_electrode(self, values: Floats) -> dict[str, Floats]:
        """Values (s, e) as one array (s,) for each electrode, by its name."""
        return dict(zip(self.result.electrode_names, values.T, strict=True))

    @property
    def converged(self) -> bool:
        """Whether the last asked depth or force was reached."""
        return self.result.converged

    @property
    def failure(self) -> str | None:
        """Place and reason where the press stopped short; None where it did not."""
        return self.result.failure

    @property
    def warnings(self) -> list[str]:
        """Warnings from before and after the solution."""
        return [*self.case.warnings, *self.doubts]

    @cached_property
    def doubts(self) -> list[str]:
        """Doubts about numbers of this solution, a sentence each."""
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
        """Voltage (s,) behind the amplifier; None without one."""
        found = self.course.together_V
        return None if found is None else found[self.course.solved]

    @property
    def channel_voltages_V(self) -> Floats | None:
        """Voltage (e, s) of each electrode behind an amplifier of its own; None without one."""
        found = self.course.channels_V
        return None if found is None else found[self.course.solved].T

    @property
    def signals_V(self) -> dict[str, Floats]:
        """Voltages that are read, by the names of the electrodes: behind an amplifier of each, without one at open
        circuit.
        """
        behind = self.channel_voltages_V
        return self.voltages_V if behind is None else self._by_electrode(behind.T)

    @property
    def film_capacitance_pF(self) -> float:
        """Capacitance of the undeformed film under all electrodes."""
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
        """Arrays (s,) of the steps; all electrodes together, then each of several."""
        columns = {
            "time_s": self.time_s,
            "indentation_mm": self.indentation_mm,
            "reaction_force_N": self.reaction_force_N,
            "film_charge_pC": self.film_charge_pC,
            "open_circuit_voltage_V": self.open_circuit_voltage_V,
        }
        if self.readout_voltage_V is not None:
            columns["readout_voltage_V"] = self.readout_voltage_V
        if len(self.charges_pC) > 1:
            columns |= {f"charge_pC_{name}": values for name, values in self.charges_pC.items()}
            columns |= {f"voltage_V_{name}": values for name, values in self.voltages_V.items()}
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
            return _as_notebook_picture(course_figure(self.course, self.result.electrode_names))
        figure = Figure(figsize=FIGURE_SIZE_IN, layout="constrained")
        force, voltage = figure.subplots(1, 2)
        force.plot(self.indentation_mm, self.reaction_force_N, "o-", markersize=3)
        force.set(xlabel="indentation (mm)", ylabel="reaction force (N)")
        for name, values in self.voltages_V.items():
            voltage.plot(self.indentation_mm, values, "o-", markersize=3, label=name)
        voltage.set(xlabel="indentation (mm)", ylabel="open-circuit voltage (V)")
        if len(self.voltages_V) > 1:
            voltage.legend(frameon=False)
        for axes in (force, voltage):
            axes.grid(alpha=0.3)
        return _as_notebook_picture(figure)

    def plot_film(self) -> "Figure":
        """Strain and charge density of the film at the deepest step, as in film.png of `softdot run`."""
        from export.film_maps import film_figure
        from export.pictures import deepest

        shown = self.result.tet_mesh, deepest(self.result), self.result.film_peak
        return _as_notebook_picture(film_figure(*shown, self.case.model.segment.film.electrodes))

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


def _as_notebook_picture(figure: "Figure") -> "Figure":
    """The figure, which a notebook then shows as a picture also where pyplot has not been imported."""

    def png() -> bytes:
        buffer = BytesIO()
        figure.savefig(buffer, format="png", dpi=SCREEN_DPI)
        return buffer.getvalue()

    figure.set_dpi(SCREEN_DPI)
    figure._repr_png_ = png  # type: ignore[attr-defined]
    return figure
