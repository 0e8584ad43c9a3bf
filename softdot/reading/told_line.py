"""What a reading says of a line besides its text: direction, speed, hum, channels, lost track, doubts in sentences."""

from typing import Any

import numpy as np

from softdot.reading.decoders.hand import HandTrack
from softdot.reading.decoders.model import DecodedCells
from softdot.reading.line_filter.line_reader import CERTAIN

SCALES = (0.65, 1.5)
"""Charges over those of the kernel that a sensor of its design, worn dots and a lighter touch explain (assumed)."""


def line_content(track: HandTrack) -> dict[str, Any]:
    """What reading.json says of the line that a track was found on."""
    report = track.report
    return {
        "speed_mm_per_s": track.speed_mm_per_s,
        "offset_mm": report.offset_mm,
        "yaw_deg": report.yaw_deg,
        "direction": "leftward" if report.leftward else "rightward",
        "begin_s": report.begin_s,
        "hum_Hz": report.hum_Hz,
        "gain": report.gain,
        "width": report.width,
        "dead_channels": list(report.dead),
        "noise_mV": 1e3 * report.noise_V,
        "resting_mV": 1e3 * report.resting_V,
        "lost_track": report.lost,
        "cells_beside_the_line": report.beside,
        "cells_without_contact": int((track.cells < 0).sum()),
    }


def cell_content(found: DecodedCells) -> list[dict[str, Any]]:
    """Each cell with its likely one, probability and time."""
    if found.likely is None or found.probability is None:
        return []
    rows = zip(found.likely, found.probability, found.passed_s, strict=True)
    return [
        {"cell": int(cell), "probability": round(float(share), 6), "time_s": round(float(at), 6)}
        for cell, share, at in rows
    ]


def track_warnings(track: HandTrack, labels: list[str]) -> list[str]:
    """Sentences about all that a user should know of the line and its channels."""
    report, told = track.report, []
    if report.dead:
        names = ", ".join(labels[number - 1] for number in report.dead)
        told.append(f"dead channels: {names} gave no signal where others did; the line was read without them")
    if report.beside:
        told.append(
            f"path: at {report.beside} cells the array was more than {report.reach_mm:.1f} mm beside the line, where "
            "no segment feels one of its rows of dots; move it along the middle of the line"
        )
    scale = float(np.median(np.abs(report.gain)))
    if not SCALES[0] <= scale <= SCALES[1]:
        told.append(
            f"gain: the charges are {scale:.2g} of the kernel's, {SCALES[0]:g} to {SCALES[1]:g} is usual; another gain "
            "or array, or a touch of another depth: check the read-out, or calibrate by --calibrate"
        )
    turned = report.gain < 0.0
    if turned.all():
        told.append("polarity: all channels are turned against the kernel; the line was read with the other sign")
    elif turned.any():
        names = ", ".join(labels[k] for k in np.flatnonzero(turned) if k < len(labels))
        told.append(f"polarity: {names} is turned against the others; it was read with the other sign")
    if not track.is_braille:
        share = 100.0 * float(np.mean(track.probability >= CERTAIN))
        told.append(
            f"voltages: only {share:.0f} % of the cells are certain; this is no line of Braille, or the leads are in "
            "another order, or the array is another one than that of the kernel"
        )
    elif track.exchanged is not None:
        told.append(
            f"leads: the cells are far more usual with {track.exchanged}; connect the leads in the order of the "
            "kernel, or find their order by --calibrate"
        )
    elif track.silent_rows:
        rows = ", ".join(str(row) for row in track.silent_rows)
        told.append(f"leads: no cell has a dot in row {rows}; its channels are dead, or this is no text")
    elif report.lost:
        count = int((track.probability < CERTAIN).sum())
        told.append(f"the track was lost {report.lost} times and looked for anew; {count} cells are uncertain ('?')")
    return told
