"""Decoder "model": the dots that make the voltages most likely, without training.

The amplitudes of all possible dots of the line are one banded least-squares problem (softdot.reading.decoders.fitted).
A dot is raised where its amplitude is above the emptiest place between none and the gain. That dots feel each other is
put right: the line that was read, nominal, goes through the kernel as a whole, and what this adds to the sum of single
dots is subtracted from the voltages before the amplitudes are found again.
"""

from dataclasses import dataclass

import numpy as np
from scipy.linalg import solveh_banded

from geometry.arrays import Bools, Floats, Ints
from softdot.reading.cells import DOTS
from softdot.reading.conditions import USUAL_SHARE_OF_DEPTH
from softdot.reading.decoders.fitted import RIDGE, CellFit
from softdot.reading.decoders.pressing import PressedCells, most_likely
from softdot.reading.decoders.templates import SAMPLE_MM
from softdot.reading.decoders.track import Track
from softdot.reading.line import cells_from, nominal_line
from softdot.reading.motion import ArrayPath
from softdot.reading.voltages import Reader, Voltages, alone_pC, averaged_voltages, charges_pC

CORRECTIONS = 3
BAND_CELLS = 4
PLACES, WIDTH, USUAL = np.linspace(0.25, 0.65, 41), 0.08, 0.45
"""Where between none and the gain a dot may begin to be raised; amplitudes so near count against a place."""


@dataclass(frozen=True)
class DecodedCells:
    """cells (c,) and when the array's middle has passed each, passed_s (c,); blanks at both ends are left out."""

    cells: Ints
    passed_s: Floats


def decode(reader: Reader, seen: Track | PressedCells) -> DecodedCells:
    """Cells of a slide that was tracked, or of presses."""
    if isinstance(seen, PressedCells):
        return trimmed(most_likely(reader, seen), seen.passed_s)
    track = seen
    dots = raised_dots(amplitudes(track.fit, track.fit.products(track.passed_s)))[0]
    for _ in range(CORRECTIONS):
        before = dots
        dots = _corrected(reader, track, dots)
        if (dots == before).all():
            break
    return trimmed(cells_from(dots), track.passed_s)


def trimmed(cells: Ints, passed_s: Floats) -> DecodedCells:
    """Without blanks at both ends."""
    there = np.flatnonzero(cells)
    span = slice(there[0], there[-1] + 1) if len(there) else slice(0, 0)
    return DecodedCells(cells[span], passed_s[span])


def amplitudes(fit: CellFit, products: Floats) -> Floats:
    """Least-squares amplitudes (c, 6) of all dots for products c (c, 6): G is banded and the same for all cells."""
    blocks = fit.blocks(BAND_CELLS)
    wide = DOTS * (BAND_CELLS + 1)
    row = np.zeros((DOTS, wide))
    for distance, block in enumerate(blocks):
        row[:, DOTS * distance : DOTS * (distance + 1)] = block
    band = np.zeros((wide, products.size))
    for offset in range(wide):  # lower form: entry (i + offset, i)
        repeated = np.array([row[k, k + offset] if k + offset < wide else 0.0 for k in range(DOTS)])
        band[offset] = np.tile(repeated, len(products))
    band[0] += RIDGE * np.mean(np.diag(blocks[0]))
    return np.asarray(solveh_banded(band, products.ravel(), lower=True).reshape(products.shape))


def raised_dots(amplitude: Floats) -> tuple[Bools, float]:
    """Which dots (c, 6) are there, and the gain: the median amplitude of those above half of the larger ones."""
    large = np.quantile(amplitude, 0.98)
    gain = float(np.median(amplitude[amplitude > 0.5 * large])) if large > 0.0 else 1.0
    share = amplitude / gain
    crowd = (np.abs(share.ravel()[:, None] - PLACES) < WIDTH).sum(axis=0) / np.sqrt(max(share.size, 1))
    place = PLACES[np.argmin(crowd + 0.5 * np.abs(PLACES - USUAL))]
    return np.asarray(share > place), gain


def _corrected(reader: Reader, track: Track, dots: Bools) -> Bools:
    """Dots (c, 6) again, with what the others do to each of these taken out of the voltages."""
    gain = raised_dots(amplitudes(track.fit, track.fit.products(track.passed_s)))[1]
    together = _beside_alone(reader, track, dots)
    products = track.fit.products(track.passed_s)
    extra = CellFit(
        track.fit.templates,
        track.fit.overlap,
        track.fit.templates.matched(together),
        track.fit.lag_mm,
        track.fit.pitch_mm,
    ).products(track.passed_s)
    return raised_dots(amplitudes(track.fit, products - gain * extra))[0]


def _beside_alone(reader: Reader, track: Track, dots: Bools) -> Voltages:
    """Voltages of the nominal line beside the sum of its dots alone, as averaged as the track's."""
    line = nominal_line(cells_from(dots), reader.standard)
    heard, posture = track.heard, track.posture
    step = SAMPLE_MM / posture.speed_mm_per_s
    time = np.arange(heard.time_s[0], heard.time_s[-1] + step, step)
    depth = USUAL_SHARE_OF_DEPTH * reader.kernel.depth_mm[-1]
    path = ArrayPath(
        time, track.place_mm(time), np.full(len(time), posture.offset_mm), np.full(len(time), depth),
        posture.yaw_deg, np.zeros(0),
    )  # fmt: skip
    charge = charges_pC(reader.kernel, line, path) - alone_pC(reader.kernel, line, path)
    return averaged_voltages(reader, time, charge, heard, track.many)
