"""A case: one configuration, and what follows from it, each made when it is first asked for and then kept.

    case = Case.load("mine.toml")
    case.press().plot()

Heavy libraries are imported inside the methods, so that a configuration that is refused is refused at once.
"""

from collections.abc import Callable, Sequence
from dataclasses import replace
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any

from geometry.arrays import Floats
from geometry.dot import DotShape
from mesh.types import TetMesh
from softdot.config import Config, config_from, input_hash, load_config
from softdot.config.defaults import completed
from softdot.config.model import model_of
from solve.model import Model
from solve.result import PressResult, Step

if TYPE_CHECKING:
    from geometry.solids import Part
    from softdot.differentiate import Derivative
    from softdot.pressed import Pressed

OnStep = Callable[[Step, int, int], None]


class Case:
    """One press of one configuration.

    config : as stated, with all defaults. Everything else is derived from it; what cannot be built or solved is refused
    by an InputError with one sentence where it is first needed.
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
        """From a TOML file, or the default design; settings : 'dotted.key=value' after the file. InputError."""
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
        """The conforming mesh. InputError, MeshingError."""
        import mesh

        touching = self.dot.origin_mm - [0.0, 0.0, self.model.dot.gap_mm]  # a gap is not another mesh
        return mesh.build(self.model.segment, replace(self.dot, origin_mm=touching), self.config.mesh)

    @property
    def mesh_quality(self) -> dict[str, Any]:
        """Numbers about the mesh, as in summary.json."""
        from mesh.quality import measure

        return measure(self.mesh, self.model.segment).as_dict()

    def press(self, on_step: OnStep | None = None) -> "Pressed":
        """The press, as far as it converged: .converged says whether, .failure why not. InputError, MeshingError."""
        from softdot.pressed import Pressed

        if "_pressed" not in self.__dict__:
            self.__dict__["_pressed"] = Pressed(self, self.solve(on_step))
        return self.__dict__["_pressed"]  # type: ignore[no-any-return]

    def solve(self, on_step: OnStep | None = None, tet_mesh: TetMesh | None = None) -> PressResult:
        """The solver's own result in SI units; tet_mesh : another one of the same segment. A killed solve goes on."""
        from geometry.cache import folder
        from solve.press import press_segment
        from solve.solution.checkpoint import Checkpoint

        on_mesh = self.mesh if tet_mesh is None else tet_mesh
        key = press_key(self, on_mesh)
        return press_segment(self.model, on_mesh, on_step, Checkpoint(folder() / f"press-{key}.npz", key), self.dot)

    @property
    def is_amplified(self) -> bool:
        """Whether something stands between the film and what is read."""
        return bool(self.model.readout or self.model.physics.electronics or self.model.physics.crosstalk)

    def amplified(self, result: PressResult) -> tuple[Floats, Floats] | None:
        """Voltage in V at each step: electrodes in parallel (s,), each alone (e, s); None without an amplifier."""
        if not self.is_amplified:
            return None
        from solve.parameters import Readout
        from solve.readout.recording import channel_voltages, readout_voltage

        told = (result, self.model.press, self.model.readout or Readout(), self.model.physics)
        return readout_voltage(*told), channel_voltages(*told)

    def uncertainty(self, summary: dict[str, Any]) -> dict[str, Any]:
        """How far the last force and voltage of a summary can be trusted."""
        from softdot.uncertainty import uncertainty

        return uncertainty(self.config, summary["reaction_force_N"][-1], summary["open_circuit_voltage_V"][-1])

    def derivatives(self, keys: Sequence[str]) -> "list[Derivative]":
        """Of force, charge and voltage along the press by keys such as "segment.film.thickness_um". InputError."""
        from softdot.differentiate import derivatives

        return derivatives(self.config, keys)

    def kit(self, folder: Path | str) -> dict[str, Any]:
        """The fabrication kit in a folder, as `softdot kit` writes it; returns kit.json. InputError."""
        from softdot.commands.kit import make_kit

        return make_kit(self.config, Path(folder))

    def save(self, folder: Path | str) -> dict[str, Any]:
        """All files of `softdot run` in a folder; returns summary.json. InputError."""
        from softdot.commands.run import run_case

        return run_case(self, Path(folder))


def press_key(case: Case, tet_mesh: TetMesh) -> str:
    """Hash of all that a press depends on: configuration, the file of its waveform, mesh and program."""
    from geometry.cache import data_hash, source_hash
    from mesh.types import mesh_hash

    return data_hash([source_hash("solve.press"), input_hash(case.config), mesh_hash(tet_mesh)])
