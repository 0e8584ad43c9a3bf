"""softdot convert: logs of instruments, joined into a recording that softdot diagnose reads."""

import re
from argparse import Namespace
from pathlib import Path

from diagnose.signals.columns import COLUMN_NAMES, NUMBERED_VOLTAGE
from foundation.errors import InputError
from foundation.files import read_text
from softdot.config.rig import load_rig
from softdot.config.toml import parse_toml
from softdot.console import GOOD
from softdot.convert.files import read_log
from softdot.convert.join import NamedLog, join_logs
from softdot.convert.recording import write_recording
from softdot.log import warn


def command(chosen: Namespace) -> int:
    """Join chosen.logs into the recording chosen.output, which chosen.rig describes. InputError."""
    rig = read_text(Path(chosen.rig), f"--rig '{chosen.rig}'")
    file = _file_of_only_run(rig, chosen.rig)
    logs = [NamedLog(Path(name), read_log(name)) for name in chosen.logs]
    run = join_logs(logs, _columns_by_channel(chosen.column), [_seconds(text) for text in chosen.offset], chosen.align)
    write_recording(chosen.output, rig, {file: run.columns})
    warn([*run.warnings, *load_rig(chosen.output).recording.warnings])
    if not chosen.quiet:
        print("\n".join([*run.remarks, f"{len(run.columns['time_s'])} samples in {Path(chosen.output) / file}"]))
    return GOOD


def _file_of_only_run(rig: str, name: str) -> str:
    """The file of the only table [[runs]]. InputError where there is none, or several."""
    runs = parse_toml(rig, name).get("runs")
    if not isinstance(runs, list) or len(runs) != 1 or not isinstance(runs[0], dict):
        raise InputError(f"--rig '{name}': must hold one table [[runs]], of the run that these logs are of")
    file = runs[0].get("file")
    if not isinstance(file, str):
        raise InputError(f"--rig '{name}': runs[0].file is missing: the CSV file to write")
    return file


def _columns_by_channel(texts: list[str]) -> dict[str, str]:
    """Channel -> column, of texts CHANNEL=COLUMN. InputError."""
    found: dict[str, str] = {}
    for text in texts:
        channel, _, column = (part.strip() for part in text.rpartition("="))
        if not channel or (column not in COLUMN_NAMES[1:] and not NUMBERED_VOLTAGE.fullmatch(column)):
            raise InputError(
                f"--column '{text}': must be CHANNEL=COLUMN with a column of {', '.join(COLUMN_NAMES[1:])}"
            )
        if channel in found or column in found.values():
            raise InputError(f"--column '{text}': this channel or column is named twice")
        found[channel] = column
    return found


def _seconds(text: str) -> float:
    """The number of seconds that a text states. InputError where it is no finite number."""
    if not re.fullmatch(r"[+-]?(\d+\.?\d*|\.\d+)([eE][+-]?\d+)?", text, re.ASCII):
        raise InputError(f"--offset '{text}': must be a number of seconds")
    return float(text)
