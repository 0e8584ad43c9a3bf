"""A recording folder of a case: rig.toml with what the experimenter believes, and one CSV file per run."""

import io
from collections.abc import Iterator, Mapping, Sequence

import numpy as np

from softdot.studies.proof.world.bench import Bench
from softdot.studies.proof.world.made import Film, Layer
from softdot.studies.proof.world.reality import Signals


def files(bench: Bench, runs: Sequence[Signals]) -> Mapping[str, str]:
    """Name -> text of every file; nothing in them tells one case from another but the samples."""
    texts = {f"press-{number:02d}.csv": _csv(run) for number, run in enumerate(runs, start=1)}
    return {"rig.toml": rig_text(bench), **texts}


def rig_text(bench: Bench) -> str:
    """Text of rig.toml of a bench."""
    lines = ['format = "softdot-recording/1"', "", *_segment(bench), *_dot(bench), *_amplifier(bench), *_mesh(bench)]
    for number, run in enumerate(bench.runs, start=1):
        lines += ["[[runs]]", f'file = "press-{number:02d}.csv"', f'label = "{run.label}"', 'drive = "displacement_mm"']
        own = [] if run.resistance_MOhm is None else [f"input_resistance_MOhm = {run.resistance_MOhm:g}"]
        if run.added_pF:
            own.append(f"input_capacitance_pF = {bench.amplifier.capacitance_pF + run.added_pF:g}")
        if own:
            lines.append(f"readout = {{ {', '.join(own)} }}")
        if bench.made.electrodes:
            lines.append(f"dot_offset_mm = [{run.place_mm:g}, 0.0]")
        lines += ["[runs.nuisance]", *(f"{name} = {width:g}" for name, width in bench.floating(run)), ""]
    return "\n".join(lines)


def _segment(bench: Bench) -> list[str]:
    made = bench.made
    held = [_name(layer) for layer in made.layers if isinstance(layer, Layer | Film) and layer.held]
    lines = [
        "[segment]", f"length_mm = {made.length_mm:g}", f"width_mm = {made.width_mm:g}",
        f'section = "{"solid" if made.dot == "cap" else "plane-strain"}"',
        f'boundary = "{"clamped" if held else "free"}"',
    ]  # fmt: skip
    if held:
        lines.append(f"held_layers = {sorted(held)}".replace("'", '"'))
    lines.append("")
    for layer in made.layers:
        if isinstance(layer, Film):
            lines += ["[segment.film]", f"thickness_um = {1e3 * layer.thickness_mm:g}", 'material = "pvdf"', ""]
            lines += _electrodes(bench)
        elif isinstance(layer, Layer):
            size = "height_mm" if layer.name == "effector" else "thickness_mm"
            lines += [
                f"[segment.{layer.name}]",
                f"{size} = {layer.thickness_mm:g}",
                f'material = "as-ordered-{layer.name}"',
                "",
            ]
    for layer in made.layers:
        if isinstance(layer, Layer):
            lines += [
                f"[materials.as-ordered-{layer.name}]", 'model = "neo-hookean"',
                f"youngs_modulus_MPa = {layer.modulus_MPa:g}", f"poisson_ratio = {layer.poisson_ratio:g}",
                "density_kg_m3 = 1000.0", "",
            ]  # fmt: skip
    return lines


def _electrodes(bench: Bench) -> Iterator[str]:
    for number, (low, high) in enumerate(bench.made.electrodes, start=1):
        yield "[[segment.film.electrodes]]"
        yield f'name = "channel {number}"'
        yield f"center_mm = [{0.5 * (low + high):g}, 0.0]"
        yield f"size_mm = [{high - low:g}, {bench.made.width_mm:g}]"
        yield ""


def _name(layer: Layer | Film) -> str:
    return layer.name if isinstance(layer, Layer) else "film"


def _dot(bench: Bench) -> list[str]:
    made = bench.made
    sizes = [f"radius_mm = {made.radius_mm:g}"]
    return ["[dot]", f'shape = "{made.dot}"', *sizes, *(["height_mm = 0.5"] if made.dot == "cap" else []), ""]


def _amplifier(bench: Bench) -> list[str]:
    amplifier, own = bench.amplifier, bench.amplifier.filters[0]
    lines = ["[readout]", f"input_capacitance_pF = {amplifier.capacitance_pF:g}"]
    if amplifier.resistance_MOhm is not None:
        lines.append(f"input_resistance_MOhm = {amplifier.resistance_MOhm:g}")
    return [*lines, f"low_pass_Hz = {own.cutoff_Hz:g}", f"filter_order = {own.order}", ""]


def _mesh(bench: Bench) -> list[str]:
    if bench.mesh_mm is None:
        return []
    size, at_dot = bench.mesh_mm
    return ["[mesh]", f"element_size_mm = {size:g}", f"contact_element_size_mm = {at_dot:g}", ""]


def _csv(run: Signals) -> str:
    text = io.StringIO()
    np.savetxt(text, np.column_stack(list(run.values())), "%.7g", ",", header=",".join(run), comments="")
    return text.getvalue()
