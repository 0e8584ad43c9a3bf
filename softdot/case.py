"""A case: one configuration, and what follows from it, each made when it is first asked for and then kept.
Heavy libraries are imported inside the methods, so that a configuration that is refused is refused at once.

    case = Case.load("mine.toml")
    case.press().plot()
"""

from collections.abc import Callable, Sequence
from dataclasses import replace
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any
from warnings import warn

from geometry.dot import DotShape
from mesh.types import Planes, TetMesh
from softdot.config.default_design import completed
from softdot.config.hashes import input_hash
from softdot.config.loading import config_from, load_config
from softdot.config.model import model_of
from softdot.config.schema import Config
from softdot.pressed import ConvergenceWarning, Pressed, ResultWarning
from solve.model import Model
from solve.result import PressResult, Step

if TYPE_CHECKING:
    from geometry.solids import Part
    from softdot.differentiation import Derivative
    from solve.readout.course import PressCourse

OnStep = Callable[[Step, int, int], None]


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
