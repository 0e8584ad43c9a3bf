"""The rooms as the pipeline calls them. Heavy libraries are imported here, inside the functions."""

from collections.abc import Callable, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

from geometry.arrays import Floats
from geometry.dot import DotShape, resolve_dot
from geometry.solids import Part
from mesh.types import TetMesh
from softdot.config import Config, input_hash
from solve.model import Physics
from solve.result import PressResult, Step

OnStep = Callable[[Step, int, int], None]


def check(config: Config) -> tuple[DotShape, list[str]]:
    """Refuse what cannot be built or solved, before any work. InputError.

    Returns the dot at rest and what a user should know about this design.
    """
    from geometry.cache import check_folder
    from geometry.checks import check_press_depth, check_pushed_dot, check_segment, press_warnings
    from softdot.cost import refuse_huge_mesh
    from softdot.warnings import held_rim_warnings

    check_folder()
    _check_waveform(config)
    warnings = check_segment(config.segment)
    depth = config.press.indentation_mm
    if depth is not None:
        check_press_depth(config.segment, depth)
    else:
        check_pushed_dot(config.dot, config.segment, config.press.path_xy_mm)
    dot_shape = resolve_dot(config.dot, config.segment)
    refuse_huge_mesh(config.segment, dot_shape, config.mesh)
    if depth is not None:
        warnings += press_warnings(dot_shape, config.segment, depth)
        warnings += held_rim_warnings(config.segment, dot_shape, depth)
    return dot_shape, warnings


def _check_waveform(config: Config) -> None:
    """Refuse what the read-out would refuse only after the solve."""
    from solve.solution.schedule import duration_s

    waveform = config.press.waveform
    if waveform is None:
        return
    duration_s(waveform)  # reads the file of shape = "file"


def build_parts(config: Config, dot_shape: DotShape) -> Sequence[Part]:
    """The labelled solids of the segment, its case and the dot."""
    from geometry.assembly import build_parts as build

    return build(config.segment, dot_shape)


def write_cad(parts: Sequence[Part], folder: Path) -> None:
    """STEP, 3MF and STL files."""
    from export.cad import write_cad as write

    write(parts, folder)


def build_mesh(config: Config, dot_shape: DotShape) -> TetMesh:
    """The conforming mesh. MeshingError when there is none."""
    import mesh

    touching = replace(dot_shape, origin_mm=dot_shape.origin_mm - [0.0, 0.0, config.dot.gap_mm])  # not another mesh
    return mesh.build(config.segment, touching, config.mesh)


def write_mesh(tet_mesh: TetMesh, formats: Sequence[str], folder: Path) -> None:
    """The mesh for other codes, in each format."""
    from mesh.formats import write_mesh as write

    write(tet_mesh, formats, folder)


def mesh_quality(config: Config, tet_mesh: TetMesh) -> dict[str, Any]:
    """Numbers about the mesh."""
    from mesh.quality import measure

    return measure(tet_mesh, config.segment).as_dict()


def press(config: Config, physics: Physics, dot_shape: DotShape, tet_mesh: TetMesh, on_step: OnStep) -> PressResult:
    """The solved press, as far as it converged."""
    from geometry.cache import folder
    from solve.press import press_segment
    from solve.solution.checkpoint import Checkpoint

    key = press_key(config, physics, tet_mesh)
    return press_segment(
        config.segment,
        config.layer_materials(),
        dot_shape,
        config.press,
        tet_mesh,
        on_step,
        physics,
        config.readout,
        Checkpoint(folder() / f"press-{key}.npz", key),
    )


def press_key(config: Config, physics: Physics, tet_mesh: TetMesh) -> str:
    """Hash of all that a press depends on: configuration, the files it names, physics, mesh and version."""
    from geometry.cache import data_hash
    from mesh.types import mesh_hash
    from softdot.numbers import installed_version

    return data_hash([installed_version(), input_hash(config), str(physics), mesh_hash(tet_mesh)])


def is_amplified(config: Config, physics: Physics) -> bool:
    """Whether something stands between the film and what is read."""
    return bool(config.readout or physics.low_pass or physics.hum or physics.saturation or physics.crosstalk)


def readout_voltage(config: Config, physics: Physics, result: PressResult) -> tuple[Floats, Floats] | None:
    """Voltage behind the amplifier at each step: electrodes in parallel (s,), each alone (e, s); None without one."""
    if not is_amplified(config, physics):
        return None
    from solve.parameters import Readout
    from solve.readout.recording import channel_voltages
    from solve.readout.recording import readout_voltage as behind_amplifier

    told = (result, config.press, config.readout or Readout())
    return behind_amplifier(*told, physics), channel_voltages(*told, physics)


def uncertainty(config: Config, summary: dict[str, Any]) -> dict[str, Any]:
    """How far the last force and voltage of a summary can be trusted."""
    from softdot.uncertainty import uncertainty as estimate

    return estimate(config, summary["reaction_force_N"][-1], summary["open_circuit_voltage_V"][-1])


def write_results(tet_mesh: TetMesh, result: PressResult, dot_shape: DotShape, folder: Path) -> None:
    """ParaView files of every step that converged."""
    from export.vtu import write_results as write

    write(tet_mesh, result, dot_shape, folder)


def write_pictures(
    tet_mesh: TetMesh,
    result: PressResult,
    dot_shape: DotShape,
    folder: Path,
    readout_voltage_V: Floats | None,
) -> dict[str, Path]:
    """Pictures of the segment and plots of its history, by name."""
    from export.pictures import write_pictures as write

    return write(tet_mesh, result, dot_shape, folder, readout_voltage_V)


def write_report(
    summary: dict[str, Any],
    pictures: dict[str, Path],
    tet_mesh: TetMesh,
    result: PressResult,
    dot_shape: DotShape,
    path: Path,
) -> None:
    """One page that opens offline, with a 3D view."""
    from export.report import write_report as write
    from export.viewer_data import viewer_data

    write(summary, pictures, viewer_data(tet_mesh, result, dot_shape), path)
