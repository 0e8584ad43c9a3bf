"""The press of one configuration, prepared: the solver's model, the dot, the parts, the mesh, and the press itself.
Heavy libraries are imported inside the methods, so that a refused configuration is refused at once.
"""

from collections.abc import Callable, Sequence
from dataclasses import replace
from functools import cached_property
from typing import TYPE_CHECKING, Any
from warnings import warn

from foundation.errors import InputError
from geometry.array.layout import ArrayLayout, array_layout
from geometry.dot import DotShape
from geometry.dot_at_rest import resolve_dot
from mesh.types import Planes, TetMesh
from softdot.config.hashes import input_hash
from softdot.config.model import as_segment, model_of
from softdot.config.schema import Config
from softdot.pressed import ConvergenceWarning, Pressed, ResultWarning
from solve.model import Model
from solve.result import PressResult, Step

if TYPE_CHECKING:
    from geometry.solids import Part
    from softdot.checks import Cost
    from solve.readout.course import PressCourse

OnStep = Callable[[Step, int, int], None]


class PreparedPress:
    """One press of one configuration on element sizes as they are stated, each part made when it is first asked for.

    config : with all defaults. Everything else is derived from it; what cannot be built or solved is refused by an
    InputError with one sentence where it is first needed. With a table [array] several segments are pressed, and the
    table [dot] says where its dots stand in the frame of the array.
    """

    def __init__(self, config: Config) -> None:
        self.config = config

    @cached_property
    def layout(self) -> ArrayLayout | None:
        """Layout of the segments of an array, None for one segment. InputError for a pitch that no standard states."""
        config = self.config
        return None if config.array is None else array_layout(config.array, config.segment, config.dot)

    @cached_property
    def model(self) -> Model:
        """Model of the solver with mechanisms switched on; of an array, that of one wide segment. InputError."""
        if self.layout is None:
            return model_of(self.config)
        stated = as_segment(self.config, self.layout)
        return array_model(model_of(stated), stated)

    @cached_property
    def checked_design(self) -> tuple[DotShape, list[str]]:
        """The dot at rest, and warnings about the design. InputError for a press that cannot be solved."""
        from softdot.checks import check_case

        return check_case(self.model, self.config.mesh, self.layout)

    @property
    def warnings(self) -> list[str]:
        """Warnings that need no solution. InputError for a press that cannot be solved."""
        from softdot.checks import design_warnings

        return [*self.checked_design[1], *design_warnings(self.model)]

    @property
    def elements(self) -> float:
        """Expected number of elements of the mesh. InputError."""
        from softdot.checks import expected_tetrahedra

        return expected_tetrahedra(self.model.segment, self.dot, self.config.mesh, self.planes, self.layout)

    @property
    def cost(self) -> "Cost":
        """Expected cost of a run. InputError."""
        from softdot.checks import cost_of

        return cost_of(self.elements, self.config)

    @cached_property
    def dot(self) -> DotShape:
        """The dot at rest. InputError; presses of an array are checked together, and some of a kernel are beyond it."""
        return self.checked_design[0] if self.layout is None else resolve_dot(self.model.dot, self.model.segment)

    @cached_property
    def parts(self) -> "Sequence[Part]":
        """The labelled solids of the segment or of the array, its case and the dot (build123d). InputError."""
        from geometry.array.parts import array_parts
        from geometry.assembly import build_parts

        if self.layout is not None:
            return array_parts(self.layout, self.dot)
        return build_parts(self.model.segment, self.dot)

    @cached_property
    def mesh(self) -> TetMesh:
        """The conforming mesh of everything that is pressed. InputError, MeshingError."""
        from mesh.symmetry import mirrored_mesh

        return mirrored_mesh(self.solved_mesh).tet_mesh

    @cached_property
    def solved_mesh(self) -> TetMesh:
        """The mesh that is solved: of a half or a quarter where all is symmetric. InputError, MeshingError."""
        import mesh
        from mesh.array.mesh import array_mesh

        at_rest = self.dot.origin_mm - [0.0, 0.0, self.model.dot.gap_mm]  # a gap is not another mesh
        touching = replace(self.dot, origin_mm=at_rest)
        if self.layout is not None:
            return array_mesh(self.layout, touching, self.sized_config.mesh, self.planes)
        return mesh.build(self.model.segment, touching, self.sized_config.mesh, self.planes)

    @property
    def sized_config(self) -> Config:
        """The configuration with the element sizes that are meshed."""
        return self.config

    @property
    def planes(self) -> Planes:
        """Mirror planes at which the mesh ends: axes, 0 for x = 0 and 1 for y = 0. InputError."""
        from solve.symmetry import meshed_planes

        return meshed_planes(self.model, self.dot, self.config.mesh)

    @property
    def mesh_quality(self) -> dict[str, Any]:
        """Numbers on the solved mesh, as in summary.json."""
        from mesh.quality import measure_quality

        sizes = {} if self.config.mesh.file is not None else self.sized_config.mesh.sizes_mm
        found = {**measure_quality(self.solved_mesh, self.model.segment).as_dict(), **sizes}
        unknown = () if self.layout is None else ("region_volume_error", "straight_edges")
        return {name: value for name, value in found.items() if name not in unknown}

    def press(self, on_step: OnStep | None = None) -> Pressed:
        """The press, as far as it converged; its .converged says whether, .failure why not. InputError,
        MeshingError.
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
        from foundation.cache import cache_folder
        from solve.press import press_segment
        from solve.solution.checkpoint import Checkpoint

        on_mesh = self.solved_mesh if tet_mesh is None else tet_mesh
        key = press_key(self, on_mesh)
        kept, asked = Checkpoint(cache_folder() / f"press-{key}.npz", key), self.config.mesh.accuracy_percent
        return press_segment(self.model, on_mesh, on_step, kept, self.dot, asked)

    @property
    def is_amplified(self) -> bool:
        """Whether an amplifier stands between the film and the reading."""
        return self.model.amplifier is not None

    def course(self, result: PressResult) -> "PressCourse":
        """The course of a result in time: drive, force, charges, voltages, and the voltage of each amplifier."""
        from solve.readout.course import course

        return course(result, self.model.press, self.model.amplifier, self.model.physics)


def array_model(model: Model, stated: Config) -> Model:
    """The model of an array, with an amplifier for each segment; stated : the array as one segment.

    InputError for a mechanism that changes what an array is made of.
    """
    changed = model.segment != stated.segment or model.dot != stated.dot
    if changed or model.physics.bonds or model.physics.delaminations:
        names = ", ".join(f"'{one.name}'" for one in stated.mechanisms)
        raise InputError(
            f"mechanisms: {names}: one of them changes the segment, the dot or a bond, which an array does not take; "
            "leave it out"
        )
    return replace(model, separate_channels=True)


def press_key(prepared: PreparedPress, tet_mesh: TetMesh) -> str:
    """The hash of everything that a press depends on: configuration, the file of its waveform, mesh and program."""
    from foundation.cache import data_hash
    from foundation.source_hash import source_hash
    from mesh.types import mesh_hash

    return data_hash([source_hash("solve.press"), input_hash(prepared.config), mesh_hash(tet_mesh)])
