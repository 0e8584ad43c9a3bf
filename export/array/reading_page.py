"""Page of a Braille reading that opens offline: the line under the array, its voltages, the text, the tables.

The voltages of a long reading are too many for a page. They are cut into bins of equally many samples, of which the
smallest and the largest voltage are kept: no peak is lost.
"""

import base64
import hashlib
import json
from collections.abc import Mapping
from dataclasses import dataclass
from difflib import SequenceMatcher
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from export.page import page_environment, script_safe
from export.report import number
from foundation.arrays import Floats
from foundation.errors import InputError
from foundation.files import write_whole_text

HERE = Path(__file__).parent
MOST_VALUES = 800_000
"""Voltages in the page; as 16-bit numbers in base64 they take 2.1 MB."""
MOST_BINS = 80_000
"""Times and positions, 32-bit numbers in base64: 0.9 MB."""
FULL_SCALE = 32767
MOST_CONFUSED = 24
SIGNALS_OF_EQUAL_LENGTH = {
    "t": ("time_s", "position_mm"),
    "c": ("cell_x_mm", "cell_true", "cell_read", "cell_likely", "cell_probability", "read_time_s"),
    "m": ("dot_x_mm", "dot_y_mm", "dot_height_mm"),
}
"""Signals that are as long as each other."""


def write_reading_page(path: Path, reading: Mapping[str, Any], signals: Mapping[str, NDArray[Any]]) -> None:
    """Write the page of a reading, whole or not at all.

    reading : the content of reading.json. Numbers may be None where there is none; without a true text there are no
    rates.
    signals : time_s (t,), ascending; voltage_V (t, n) of the segments in the order of reading["kernel"]["labels"];
    position_mm (t,) of the middle of the array along the line; cell_x_mm (c,) of the middles of the cells; cell_true
    and cell_read (c,), strings, a question mark for one that is not certain; cell_likely and cell_probability (c,), the
    most likely one and how likely it is, empty and -1 where that is not known; read_time_s (c,), when each was decided,
    ascending; dot_x_mm, dot_y_mm, dot_height_mm (m,) of all dots, y counting down the rows from the middle of the
    array, as the rows of the array do.
    InputError for signals that are missing, not finite, or of another shape.
    """
    _check_signals(reading, signals)
    is_known, read = reading["text_true"] is not None, str(reading["text_read"])
    environment = page_environment(HERE)
    environment.filters.update(key_text=key_text, number=number, visible_text=_visible_text)
    script = (HERE / "reading.js").read_text("utf-8")
    page = environment.get_template("reading.html").render(
        r=reading,
        confused=_frequent_confusions(reading),
        most=MOST_CONFUSED,
        cells=_cell_texts(signals),
        texts=text_differences(str(reading["text_true"]) if is_known else read, read),
        is_known=is_known,
        data=script_safe(json.dumps(player_data(reading, signals), allow_nan=False)),
        script=script,
        script_hash=base64.b64encode(hashlib.sha256(script.encode()).digest()).decode("ascii"),
    )
    write_whole_text(path, page)


def _check_signals(reading: Mapping[str, Any], signals: Mapping[str, NDArray[Any]]) -> None:
    """Raise InputError for signals that are missing, not finite, or of another shape."""
    for name in ["voltage_V", *(name for names in SIGNALS_OF_EQUAL_LENGTH.values() for name in names)]:
        if name not in signals:
            raise InputError(f"signals of a reading: {name} is missing")
        numbers = np.asarray(signals[name])
        if numbers.dtype.kind == "f" and not np.isfinite(numbers).all():
            raise InputError(f"signals of a reading: {name} must be finite")
    for first, *others in SIGNALS_OF_EQUAL_LENGTH.values():
        expected = np.shape(signals[first])
        for name in others:
            if np.shape(signals[name]) != expected or len(expected) != 1:
                raise InputError(
                    f"signals of a reading: {name} {np.shape(signals[name])}: must be as {first} {expected}"
                )
    shape = (len(signals["time_s"]), len(reading["kernel"]["labels"]))
    if np.shape(signals["voltage_V"]) != shape or shape[0] < 2:
        raise InputError(f"signals of a reading: voltage_V {np.shape(signals['voltage_V'])}: must be {shape}")


@dataclass(frozen=True)
class BinnedVoltages:
    """Voltages of n segments in b bins.

    time_s (b,) and position_mm (b,) at the middle of each bin; low_V and high_V (b, n); high_V is None where every
    sample is kept.
    """

    time_s: Floats
    position_mm: Floats
    low_V: Floats
    high_V: Floats | None


def bin_voltages(time_s: Floats, position_mm: Floats, voltage_V: Floats) -> BinnedVoltages:
    """Bin samples (t,) and voltages (t, n) so that they fit into the page.

    All bins have equally many samples, but for the last one, which may have fewer.
    """
    count, channels = voltage_V.shape
    if count <= MOST_BINS and count * channels <= MOST_VALUES:
        return BinnedVoltages(time_s, position_mm, voltage_V, None)
    width = -(-count // min(MOST_BINS, MOST_VALUES // (2 * channels)))
    starts = np.arange(0, count, width)
    middles = np.minimum(starts + width // 2, count - 1)
    low, high = np.minimum.reduceat(voltage_V, starts), np.maximum.reduceat(voltage_V, starts)
    return BinnedVoltages(time_s[middles], position_mm[middles], low, high)


def player_data(reading: Mapping[str, Any], signals: Mapping[str, NDArray[Any]]) -> dict[str, Any]:
    """Data of export/array/reading.js: plain numbers and base64 of little-endian arrays.

    float32: time (b,), position (b,); int16, one segment after the other: low and high (n, b), shares of top in
    32767ths. Dots are sorted by x.
    """
    kernel = reading["kernel"]
    bins = bin_voltages(*(np.asarray(signals[name], np.float64) for name in ("time_s", "position_mm", "voltage_V")))
    top = float(np.abs(signals["voltage_V"]).max()) or 1.0
    order = np.argsort(signals["dot_x_mm"], kind="stable")
    size = np.broadcast_to(np.asarray(kernel["size_mm"], np.float64), 2)
    return {
        "time": _base64_text(bins.time_s, "<f4"),
        "position": _base64_text(bins.position_mm, "<f4"),
        "low": _base64_text(np.rint(FULL_SCALE * bins.low_V.T / top), "<i2"),
        "high": None if bins.high_V is None else _base64_text(np.rint(FULL_SCALE * bins.high_V.T / top), "<i2"),
        "top": top,
        "labels": [short_label(label) for label in kernel["labels"]],
        "centres": _rounded_list(kernel["centres_mm"]),
        "size": _rounded_list(size),
        "dot": {"base": kernel["dot"]["base_diameter_mm"], "height": kernel["dot"]["height_mm"]},
        "dots": [_rounded_list(np.asarray(signals[name])[order]) for name in SIGNALS_OF_EQUAL_LENGTH["m"]],
        "cellX": _rounded_list(signals["cell_x_mm"]),
        "certain": _rounded_list(signals["cell_probability"]) if np.any(signals["cell_probability"] >= 0.0) else None,
        "readTime": _rounded_list(signals["read_time_s"]),
    }


def _base64_text(values: Floats, kind: str) -> str:
    return base64.b64encode(np.ascontiguousarray(values, dtype=kind).tobytes()).decode("ascii")


def _rounded_list(values: Any) -> Any:
    return np.round(np.asarray(values, np.float64), 4).tolist()


def _cell_texts(signals: Mapping[str, NDArray[Any]]) -> list[tuple[str, str, str]]:
    """True, read and most likely character of each cell; a blank cell as a character that can be seen."""
    rows = zip(signals["cell_true"], signals["cell_read"], signals["cell_likely"], strict=True)
    return [(_visible_text(str(true)), _visible_text(str(read)), str(likely)) for true, read, likely in rows]


def _frequent_confusions(reading: Mapping[str, Any]) -> list[Mapping[str, Any]]:
    """Rows of the confusion matrix off its diagonal, most frequent first."""
    wrong = [one for one in reading.get("confusion", []) if one["true"] != one["read"] and one["count"]]
    return sorted(wrong, key=lambda one: -one["count"])


def _visible_text(character: str) -> str:
    return {" ": "\u2423", "\u2800": "\u2423", "": "\u2013"}.get(character, character)


def text_differences(true: str, read: str) -> list[tuple[str, str]]:
    """Pieces (true, read) of the text that was read; the two are equal in a piece that was read correctly.

    >>> text_differences("one dot", "one bot")
    [('one ', 'one '), ('d', 'b'), ('ot', 'ot')]
    """
    pieces = SequenceMatcher(None, true, read, autojunk=False).get_opcodes()
    return [(true[a:b], read[c:d]) for _, a, b, c, d in pieces]


def key_text(key: str) -> str:
    """A key as text for people.

    >>> key_text("speed_mm_per_s")
    'speed mm/s'
    """
    return key.replace("_per_", "/").replace("_", " ")


def short_label(label: str) -> str:
    """A segment's name without the word that all of them share."""
    return label.removeprefix("segment-")
