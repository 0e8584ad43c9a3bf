"""A SPICE netlist of film and amplifier: the charge of a press as a PWL source, the circuit of the read-out behind it.

An electrode is its open-circuit voltage Q / C_f behind its capacitance. Filters are sections of order one and two, each
an RC or RLC behind a buffer (Zverev, Handbook of Filter Synthesis, 1967, section 2), so that any SPICE reads them.
"""

from collections.abc import Iterator, Mapping, Sequence
from itertools import count

import numpy as np
from scipy.interpolate import PchipInterpolator

from foundation.arrays import Floats
from foundation.errors import InputError
from solve.model import Readout
from solve.physics import Physics
from solve.readout.amplifier import stages
from solve.readout.channel_parts import ChannelLeak, ChannelPart, MutualCapacitance
from solve.readout.filters import Filter
from solve.readout.stages import Gain, Hum, Saturation, Stage

BETWEEN, MOST_POINTS = 8, 6000
"""Points of a charge between two times of its course, and of all at most."""
BLEEDER_OHM, OPEN_LOOP_GAIN, SECTION_F, LINE_OHM = 1e16, 1e9, 1e-9, 50.0
"""Of inputs without a resistance; of the ideal amplifier; of the capacitors in filters; of a line that delays."""
TIME_STEPS = 4000


def netlist(
    time_s: Floats,
    charge_C: Mapping[str, Floats],
    capacitance_F: Mapping[str, float],
    readout: Readout,
    physics: Physics,
) -> str:
    """Text of the netlist of a press: an amplifier for each electrode, by name, with charges (t,) at times (t,).

    What electrode NAME records is the voltage of node recorded_NAME. InputError for a mechanism that it cannot hold.
    """
    own = [part for part in physics.channels if isinstance(part, ChannelLeak | MutualCapacitance)]
    _refuse_channel_parts([part for part in physics.channels if part not in own])
    lines = ["* film and amplifier of softdot: one volt of a node charge_NAME is one pC"]
    for number, name in enumerate(charge_C, start=1):
        lines += _electrode(number, time_s, charge_C[name], capacitance_F[name])
        lines += _input(number, readout)
        lines += _stages(number, stages(readout, physics), readout)
    for part in own if readout.mode == "voltage" else ():
        lines += _between(part, len(charge_C))
    end = float(time_s[-1] - time_s[0])
    recorded = " ".join(f"v(recorded_{number})" for number in range(1, len(charge_C) + 1))
    nodes = ", ".join(f"{number} = '{name}'" for number, name in enumerate(charge_C, start=1))
    return "\n".join([
        lines[0], f"* electrodes: {nodes}", *lines[1:], ".options reltol=1e-6 vntol=1e-9 abstol=1e-18 chgtol=1e-18",
        f".tran {end / TIME_STEPS:.9g} {end:.9g} 0 {end / TIME_STEPS:.9g} uic", f".save {recorded}",
        f".print tran {recorded}", ".end", "",
    ])  # fmt: skip


def _electrode(number: int, time_s: Floats, charge_C: Floats, capacitance_F: float) -> list[str]:
    """The source of one electrode: its charge, its open-circuit voltage, its capacitance."""
    time, charge = smooth_course(time_s, 1e12 * charge_C)
    pairs = [f"+ {t:.10g} {q:.9g}" for t, q in zip(time - time[0], charge, strict=True)]
    return [
        f"Vcharge{number} charge_{number} 0 PWL(", *pairs, "+ )",
        f"Efilm{number} open_{number} 0 charge_{number} 0 {1e-12 / capacitance_F:.9g}",
        f"Cfilm{number} open_{number} in_{number} {capacitance_F:.9g}",
    ]  # fmt: skip


def smooth_course(time_s: Floats, values: Floats) -> tuple[Floats, Floats]:
    """A course (t,) with points between its times, on monotone cubics, so that its slope has no stairs."""
    parts = max(1, min(BETWEEN, MOST_POINTS // len(time_s)))
    share = np.arange(parts) / parts
    fine = np.append((time_s[:-1, None] + np.diff(time_s)[:, None] * share).ravel(), time_s[-1])
    return fine, PchipInterpolator(time_s, values)(fine)


def _input(number: int, readout: Readout) -> list[str]:
    """What the film drives: R and C, or the virtual ground of an ideal amplifier with its feedback."""
    shunt = 1e-12 * readout.whole_input_pF
    lines = [f"Cin{number} in_{number} 0 {shunt:.9g}"] if shunt else []
    if readout.mode == "voltage":
        ohm = min(1e6 * (readout.input_resistance_MOhm or np.inf), BLEEDER_OHM)
        return [*lines, f"Rin{number} in_{number} 0 {ohm:.9g}", f"Ebuffer{number} s0_{number} 0 in_{number} 0 1"]
    ohm = 1e6 * (readout.feedback_MOhm or np.inf)
    return [
        *lines, f"Eamplifier{number} s0_{number} 0 0 in_{number} {OPEN_LOOP_GAIN:g}",
        f"Cfeedback{number} in_{number} s0_{number} {1e-12 * (readout.feedback_pF or np.inf):.9g}",
        f"Rfeedback{number} in_{number} s0_{number} {min(ohm, BLEEDER_OHM):.9g}",
    ]  # fmt: skip


def _stages(number: int, behind: Sequence[Stage], readout: Readout) -> Iterator[str]:
    """Lines of the stages from node s0 to node recorded. InputError for one that has no such lines."""
    nodes = (f"s{place}_{number}" for place in count())
    node = next(nodes)
    for one in behind:
        for section in _sections(one):
            before, node = node, next(nodes)
            yield from (line.format(a=before, b=node, n=node) for line in section)
    yield f"Epolarity{number} recorded_{number} 0 {node} 0 {readout.polarity}"


def _sections(stage: Stage) -> list[list[str]]:
    """Lines of each section of a stage, from node {a} to node {b}, with {n} to tell names apart."""
    if isinstance(stage, Gain):
        return [[f"E{{n}} {{b}} 0 {{a}} 0 {stage.gain:.9g}"]]
    if isinstance(stage, Hum):
        omega = 2.0 * np.pi * stage.frequency_Hz
        return [[f"B{{n}} {{b}} 0 V = V({{a}}) + {stage.amplitude_V:.9g}*sin({omega:.12g}*time)"]]
    if isinstance(stage, Saturation):
        return [[_limit(stage)]]
    if isinstance(stage, Filter):
        return [*_filter_sections(stage), *([] if stage.delay_s == 0.0 else [_delay(stage.delay_s)])]
    raise InputError(f"mechanisms: a {type(stage).__name__} behind the film is not written as a netlist; leave it out")


def _limit(stage: Saturation) -> str:
    """A limit, hard or with a rounded knee."""
    most = f"{stage.limit_V:.9g}"
    if np.isinf(stage.sharpness):
        return f"B{{n}} {{b}} 0 V = min(max(V({{a}}), -{most}), {most})"
    root = f"{1.0 / stage.sharpness:.9g}"
    return f"B{{n}} {{b}} 0 V = V({{a}})/pow(1 + pow(abs(V({{a}})/{most}), {stage.sharpness:.9g}), {root})"


def _filter_sections(own: Filter) -> Iterator[list[str]]:
    """Sections of order two, and one of order one where the order is odd, with the poles of the filter."""
    corner = 2.0 * np.pi * own.corner_Hz
    poles = np.roots(own.transfer()[1] / corner ** np.arange(own.order + 1)) * corner  # scaled: orders up to 8
    for pole in poles[poles.imag > 1e-9 * np.abs(poles)]:
        natural, quality = abs(pole), -0.5 * abs(pole) / pole.real
        yield _rlc(own.kind, natural, quality)
    real = np.sort(-poles[np.abs(poles.imag) <= 1e-9 * np.abs(poles)].real)
    for pole in real:
        yield _rc(own.kind, float(pole))


def _rlc(kind: str, natural: float, quality: float) -> list[str]:
    """Series R, L and C behind a buffer; low-pass over C, high-pass over L."""
    henry = 1.0 / (natural**2 * SECTION_F)
    parts = [("L", henry), ("C", SECTION_F)] if kind == "low" else [("C", SECTION_F), ("L", henry)]
    (first, one), (last, other) = parts
    return [
        "Ebuffer{n} u_{n} 0 {a} 0 1", f"R{{n}} u_{{n}} w_{{n}} {natural * henry / quality:.12g}",
        f"{first}{{n}} w_{{n}} x_{{n}} {one:.12g}", f"{last}{{n}} x_{{n}} 0 {other:.12g}", "E{n} {b} 0 x_{n} 0 1",
    ]  # fmt: skip


def _rc(kind: str, pole: float) -> list[str]:
    """R and C behind a buffer; low-pass over C, high-pass over R."""
    ohm = 1.0 / (pole * SECTION_F)
    parts = [("R", ohm), ("C", SECTION_F)] if kind == "low" else [("C", SECTION_F), ("R", ohm)]
    (first, one), (last, other) = parts
    return [
        "Ebuffer{n} u_{n} 0 {a} 0 1", f"{first}{{n}} u_{{n}} x_{{n}} {one:.12g}",
        f"{last}{{n}} x_{{n}} 0 {other:.12g}", "E{n} {b} 0 x_{n} 0 1",
    ]  # fmt: skip


def _delay(delay_s: float) -> list[str]:
    """A line that is closed by its own resistance."""
    return [f"T{{n}} {{a}} 0 {{b}} 0 Z0={LINE_OHM:g} TD={delay_s:.9g}", f"R{{n}} {{b}} 0 {LINE_OHM:g}"]


def _between(part: ChannelPart, electrodes: int) -> Iterator[str]:
    """A leak of one input, or a capacitance between two."""
    if max(part.channels) > electrodes:
        return
    if isinstance(part, ChannelLeak):
        yield f"Rleak{part.channel} in_{part.channel} 0 {1e6 / part.leak_uS:.9g}"
    if isinstance(part, MutualCapacitance):
        yield f"Cmutual{part.one}_{part.other} in_{part.one} in_{part.other} {1e-12 * part.mutual_pF:.9g}"


def _refuse_channel_parts(parts: Sequence[ChannelPart]) -> None:
    if parts:
        raise InputError(f"mechanisms: {parts[0].words} is not written as a netlist; leave that mechanism out")
