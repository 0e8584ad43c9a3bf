"""Decoder "model": the dots that make the voltages most likely, without training.

It knows the kernel, the nominal standard, the read-out and the voltages; speed, place, offset, yaw and gain it finds.
The amplitudes of all possible dots of a line are one banded least-squares problem (softdot.reading.decoders.fitted). A
dot is raised where its amplitude is above a place between none and the gain that follows from their spreads. That dots
feel each other is put right: the line that was read, nominal, goes through the kernel as a whole, and what this adds to
the sum of single dots is subtracted from the voltages before the amplitudes are found again.
"""

from dataclasses import dataclass, replace

import numpy as np
from scipy.linalg import solveh_banded

from foundation.arrays import Bools, Floats, Ints
from softdot.reading.cells import DOTS
from softdot.reading.conditions import USUAL_SHARE_OF_DEPTH
from softdot.reading.decoders.fitted import RIDGE, CellFit, Track
from softdot.reading.decoders.pressing import PressedCells, most_likely
from softdot.reading.decoders.templates import SAMPLE_MM
from softdot.reading.line import cells_from, nominal_line
from softdot.reading.motion import ArrayPath
from softdot.reading.voltages import Reader, Voltages, alone_pC, averaged_voltages, charges_pC

CORRECTIONS = 3
BAND_CELLS = 4
LARGE, SMALL, LOWEST = 0.98, 0.3, 0.2
"""Share of the dots below the large amplitudes; of the gain, what counts as small, and what no dot is below."""
SPREAD_OF_MEDIAN = 1.4826  # standard deviation of a normal distribution over its median absolute deviation


@dataclass(frozen=True)
class DecodedCells:
    """cells (c,) and when the array's middle has passed each, passed_s (c,); blanks at both ends are left out."""

    cells: Ints
    passed_s: Floats


def decode(reader: Reader, seen: Track | PressedCells) -> DecodedCells:
    """Cells of a slide that was tracked, or of presses."""
    if isinstance(seen, PressedCells):
        return trimmed(most_likely(reader, seen), seen.passed_s)
    return trimmed(cells_from(settled(reader, seen)), seen.passed_s)


def trimmed(cells: Ints, passed_s: Floats) -> DecodedCells:
    """Without blanks at both ends."""
    there = np.flatnonzero(cells)
    span = slice(there[0], there[-1] + 1) if len(there) else slice(0, 0)
    return DecodedCells(cells[span], passed_s[span])


def settled(reader: Reader, track: Track) -> Bools:
    """Dots (c, 6) of tracked voltages, corrected until they stay."""
    products = track.fit.products(track.passed_s)
    dots, gain = raised_dots(amplitudes(track.fit, products))
    for _ in range(CORRECTIONS):
        before = dots
        beside = _line_voltages(reader, track, dots, beside_alone=True)
        extra = replace(track.fit, matched=track.fit.templates.matched(beside)).products(track.passed_s)
        dots, gain = raised_dots(amplitudes(track.fit, products - gain * extra))
        if (dots == before).all():
            break
    return dots


def left_over(reader: Reader, track: Track) -> tuple[Bools, float]:
    """Dots (c, 6), and the part of the voltages' squares that they leave, with the gain that leaves least."""
    dots = settled(reader, track)
    expected = _line_voltages(reader, track, dots, beside_alone=False).voltage_V
    heard = track.heard.voltage_V
    square = max(float((expected**2).sum()), 1e-300)
    along = max(float((expected * heard).sum()), 0.0)
    return dots, 1.0 - along**2 / square / max(float((heard**2).sum()), 1e-300)


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
    large = np.quantile(amplitude, LARGE)
    gain = float(np.median(amplitude[amplitude > 0.5 * large])) if large > 0.0 else 1.0
    share = amplitude / gain
    return np.asarray(share > _place_between(share)), gain


def _place_between(share: Floats) -> float:
    """As many standard deviations above none as below the gain, for the spreads that both sides show.

    That of none is the larger one of the negative amplitudes, which noise makes, and of the small ones.
    """
    small, high = np.abs(share[share < SMALL]), share[share > 0.5]
    negative = share[share < 0.0]
    none = max(SPREAD_OF_MEDIAN * float(np.median(small)) if len(small) else 0.0,
               float(np.sqrt(np.mean(negative**2))) if len(negative) else 0.0)  # fmt: skip
    full = SPREAD_OF_MEDIAN * float(np.median(np.abs(high - 1.0))) if len(high) else 0.0
    return float(np.clip(none / max(none + full, 1e-12), LOWEST, 0.5))


def _line_voltages(reader: Reader, track: Track, dots: Bools, beside_alone: bool) -> Voltages:
    """Voltages of the nominal line, or only what it has beside the sum of its dots alone, averaged as the track's."""
    line = nominal_line(cells_from(dots), reader.standard)
    heard, posture = track.heard, track.posture
    step = SAMPLE_MM / posture.speed_mm_per_s
    time = np.arange(heard.time_s[0], heard.time_s[-1] + step, step)
    depth = USUAL_SHARE_OF_DEPTH * reader.kernel.depth_mm[-1]
    path = ArrayPath(
        time, track.place_mm(time), np.full(len(time), posture.offset_mm), np.full(len(time), depth),
        posture.yaw_deg, np.zeros(0),
    )  # fmt: skip
    charge = charges_pC(reader.kernel, line, path)
    if beside_alone:
        charge -= alone_pC(reader.kernel, line, path)
    return averaged_voltages(reader, time, charge, heard, track.many)
