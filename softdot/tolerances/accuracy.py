"""Element sizes for an asked accuracy (mesh.accuracy_percent), instead of stated ones.

All sizes of [mesh] are scaled together until the error of force and of every voltage at full load, as
softdot.tolerances.discretisation estimates it, is at most what is asked. A press whose path matters is judged by its
elastic baseline, without mechanisms and slides: what the mesh resolves, the contact and the film, is the same there.
"""

from foundation.errors import InputError
from foundation.source_hash import source_hash
from mesh.options import MeshOptions
from mesh.types import MeshingError
from softdot.checks import refuse_huge_mesh
from softdot.config.schema import Config
from softdot.prepared_press import PreparedPress
from softdot.tolerances.discretisation import (
    SIZE_RATIOS,
    answers_on_larger_elements,
    discretisation_error,
    follows_path,
)
from softdot.tolerances.questions import kept_on_disk
from solve.solution.full_load import StoppedShortError
from solve.solution.linear import LinearSolveError

CONVERGENCE_ORDER = 1.5
"""Power of the element size by which the error is expected to fall: between 1, at a singular stress, and 2."""
TARGET_SHARE = 0.8
"""Share of the asked error at which the next sizes aim."""
LARGEST_FACTOR, LEAST_GAIN_FACTOR = 2.0, 1.2
"""Largest factor on the sizes, and the least that is worth another mesh."""
LEAST_FACTOR = 0.4
"""Least factor from one mesh to the next."""
MOST_MESHES = 4
"""Most meshes that are tried after the first."""


def with_sizes_for_accuracy(config: Config) -> Config:
    """The configuration with the element sizes that its accuracy asks for, kept on disk; itself where it states sizes.

    InputError where the accuracy needs too many elements; MeshingError where it is not reached, or a press fails.
    """
    asked = config.mesh.accuracy_percent
    if asked is None:
        return config
    what = f"sizes for an accuracy, as {source_hash(__name__)} finds them"
    factor: float = kept_on_disk(config, what, lambda: _size_factor(_elastic_baseline(config), asked))
    return config.model_copy(update={"mesh": config.mesh.scale_sizes(factor)})


def _elastic_baseline(config: Config) -> Config:
    """The configuration without mechanisms, slides and waveform where its path matters, else unchanged."""
    if not follows_path(config):
        return config
    press = config.press.model_copy(update={"path_xy_mm": (), "waveform": None})
    return config.model_copy(update={"mechanisms": (), "press": press, "readout": None})


def _size_factor(config: Config, asked: float) -> float:
    """The factor on the stated sizes at which the error is at most the asked percentage. InputError, MeshingError."""
    factor = 1.0
    found = _error_percent(config, factor)
    if found <= asked:
        larger = min(float((TARGET_SHARE * asked / max(found, 1e-9)) ** (1.0 / CONVERGENCE_ORDER)), LARGEST_FACTOR)
        return larger if larger > LEAST_GAIN_FACTOR and _error_percent(config, larger) <= asked else factor
    for _ in range(MOST_MESHES):
        factor *= max((TARGET_SHARE * asked / found) ** (1.0 / CONVERGENCE_ORDER), LEAST_FACTOR)
        found = _error_percent(config, factor)
        if found <= asked:
            return float(factor)
    under_dot = factor * config.mesh.contact_element_size_mm
    raise MeshingError(
        f"mesh.accuracy_percent = {asked:g}: force and voltages are still {found:.2g} % off on elements of "
        f"{under_dot:.2g} mm under the dot; ask for less, or state the sizes"
    )


def _error_percent(config: Config, factor: float) -> float:
    """The largest error of the force, unless it is given, and of the voltages, on sizes times a factor. InputError."""
    options = config.mesh.scale_sizes(factor)
    _refuse_too_many_elements(config, options)
    own = config.model_copy(update={"mesh": options})
    try:
        loads = {ratio: answers_on_larger_elements(own, ratio) for ratio in (1.0, *SIZE_RATIOS)}
    except (LinearSolveError, StoppedShortError) as error:
        asked = config.mesh.accuracy_percent
        raise MeshingError(f"mesh.accuracy_percent = {asked:g}: a press to choose the sizes failed: {error}") from None
    off = discretisation_error(loads.pop(1.0), loads)
    found = [off.voltage_percent, *map(float, off.electrodes_percent)]
    return max(found if config.press.force_N is not None else [off.force_percent, *found])


def _refuse_too_many_elements(config: Config, options: MeshOptions) -> None:
    """InputError where the sizes mean more elements than are allowed, or than fit into memory."""
    case = PreparedPress(config)
    try:
        refuse_huge_mesh(case.model.segment, case.dot, options, case.planes)
    except InputError as error:
        raise InputError(f"mesh.accuracy_percent = {config.mesh.accuracy_percent:g}: {error}") from None
