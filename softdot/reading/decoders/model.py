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
from softdot.reading.conditions import DEFAULT_SHARE_OF_DEPTH
from softdot.reading.decoders.fitted import RIDGE_SHARE, CellFit, Track
from softdot.reading.decoders.pressing import PressedCells, most_likely_cells
from softdot.reading.decoders.templates import SAMPLE_MM
from softdot.reading.line import cells_from, nominal_line
from softdot.reading.motion import ArrayPath
from softdot.reading.voltages import Reader, Voltages, averaged_voltages, charges_of_lone_dots_pC, charges_pC

MOST_CORRECTIONS = 3
"""Largest number of corrections for neighbours."""
BAND_CELLS = 4
"""Cells apart beyond which two dots do not overlap."""
LARGE_QUANTILE, SMALL_SHARE, LEAST_THRESHOLD = 0.98, 0.3, 0.2
"""Share of the dots below the large amplitudes; shares of the gain below which a dot is small, and never raised."""
SPREAD_OF_MEDIAN = 1.4826  # standard deviation of a normal distribution over its median absolute deviation


@dataclass(frozen=True)
class DecodedCells:
    """Decoded cells (c,), -1 where none is certain, and the times passed_s (c,) at which the array's middle has passed
    each; blanks at both ends are left out.

    likely, probability (c,), shares (c, 64) : the most likely cells, of uncertain ones too, their probabilities, and
    that of each kind of cell; None of a decoder that knows none.
    """

    cells: Ints
    passed_s: Floats
    likely: Ints | None = None
    probability: Floats | None = None
    shares: Floats | None = None


def decode(reader: Reader, seen: Track | PressedCells) -> DecodedCells:
    """The cells of a tracked slide, or of presses."""
    if isinstance(seen, PressedCells):
        return trim_blanks(most_likely_cells(reader, seen), seen.passed_s)
    return trim_blanks(cells_from(settle_dots(reader, seen)), seen.passed_s)


def trim_blanks(cells: Ints, passed_s: Floats) -> DecodedCells:
    """Cells without the blanks at both ends."""
    there = np.flatnonzero(cells)
    span = slice(there[0], there[-1] + 1) if len(there) else slice(0, 0)
    return DecodedCells(cells[span], passed_s[span])


def settle_dots(reader: Reader, track: Track) -> Bools:
    """Dots (c, 6) of tracked voltages, corrected for their neighbours until they stay."""
    products = track.fit.products(track.passed_s)
    dots, gain = raised_dots(amplitudes(track.fit, products))
    for _ in range(MOST_CORRECTIONS):
        before = dots
        beside = _line_voltages(reader, track, dots, beside_alone=True)
        extra = replace(track.fit, matched=track.fit.templates.match(beside)).products(track.passed_s)
        dots, gain = raised_dots(amplitudes(track.fit, products - gain * extra))
        if (dots == before).all():
            break
    return dots


def dots_and_left_share(reader: Reader, track: Track) -> tuple[Bools, float]:
    """Dots (c, 6), and the share of the voltages' squares that they leave, with the gain that leaves least."""
    dots = settle_dots(reader, track)
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
    band[0] += RIDGE_SHARE * np.mean(np.diag(blocks[0]))
    return np.asarray(solveh_banded(band, products.ravel(), lower=True).reshape(products.shape))


def raised_dots(amplitude: Floats) -> tuple[Bools, float]:
    """Whether each dot (c, 6) is raised, and the gain: the median amplitude of those above half of the larger ones."""
    large = np.quantile(amplitude, LARGE_QUANTILE)
    gain = float(np.median(amplitude[amplitude > 0.5 * large])) if large > 0.0 else 1.0
    share = amplitude / gain
    return np.asarray(share > _raised_threshold(share)), gain


def _raised_threshold(share: Floats) -> float:
    """The share of the gain as many standard deviations above none as below the gain, for the spreads of both sides.

    The spread of none is the larger one of the negative amplitudes, which noise makes, and of the small ones.
    """
    small, high = np.abs(share[share < SMALL_SHARE]), share[share > 0.5]
    negative = share[share < 0.0]
    none = max(SPREAD_OF_MEDIAN * float(np.median(small)) if len(small) else 0.0,
               float(np.sqrt(np.mean(negative**2))) if len(negative) else 0.0)  # fmt: skip
    full = SPREAD_OF_MEDIAN * float(np.median(np.abs(high - 1.0))) if len(high) else 0.0
    return float(np.clip(none / max(none + full, 1e-12), LEAST_THRESHOLD, 0.5))


def _line_voltages(reader: Reader, track: Track, dots: Bools, beside_alone: bool) -> Voltages:
    """Voltages of the nominal line, or their difference to the sum of lone dots, averaged as the track's."""
    line = nominal_line(cells_from(dots), reader.standard)
    heard, posture = track.heard, track.posture
    step = SAMPLE_MM / posture.speed_mm_per_s
    time = np.arange(heard.time_s[0], heard.time_s[-1] + step, step)
    depth = DEFAULT_SHARE_OF_DEPTH * reader.kernel.depth_mm[-1]
    path = ArrayPath(
        time, track.place_mm(time), np.full(len(time), posture.offset_mm), np.full(len(time), depth),
        posture.yaw_deg, np.zeros(0),
    )  # fmt: skip
    charge = charges_pC(reader.kernel, line, path)
    if beside_alone:
        charge -= charges_of_lone_dots_pC(reader.kernel, line, path)
    return averaged_voltages(reader, time, charge, heard, track.many)
