"""softdot export spice: film and amplifier as a netlist, beside the voltages that softdot calculates of them."""

import json
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from foundation.errors import InputError
from softdot.config.loading import config_from, load_config
from softdot.config.model import model_of
from softdot.config.schema import Config
from softdot.json_files import write_json
from softdot.output import RUN, Product, staged_folder

SPICE = Product("softdot-spice/1", "spice.json", frozenset({"spice.json", "sensor.cir", "expected.csv"}))


def write_spice(source: Path, out: Path, settings: Sequence[str] = ()) -> dict[str, Any]:
    """Write the netlist of a press into the folder out; the content of spice.json.

    source : the folder of a run, or a configuration, which is pressed. settings : for a configuration. InputError.
    Where the press did not converge the key failure says why and nothing is written.
    """
    config, numbers = _stored_press(source, settings) if source.is_dir() else _new_press(source, settings)
    if not numbers["solver"]["converged"]:
        return {"format": SPICE.format, "failure": numbers["solver"]["failure"]}
    from export.netlist import netlist
    from solve.model import Readout

    model, course = model_of(config), numbers["course"]
    time_s = np.array(course["time_s"])
    charge_C = {name: 1e-12 * np.array(one) for name, one in course["charge_pC"].items()}
    capacitance_F = {one["name"]: 1e-12 * one["capacitance_pF"] for one in numbers["electrodes"]}
    text = netlist(time_s, charge_C, capacitance_F, model.amplifier or Readout(), model.physics)
    summary = {
        "format": SPICE.format, "config": config.model_dump(mode="json"), "electrodes": list(charge_C),
        "nodes": {name: f"recorded_{number}" for number, name in enumerate(charge_C, start=1)},
    }  # fmt: skip
    with staged_folder(out, SPICE) as folder:
        (folder / "sensor.cir").write_text(text, "utf-8")
        _write_expected(course, list(charge_C), folder / "expected.csv")
        write_json(folder / SPICE.summary, summary)
    return summary


def _new_press(source: Path, settings: Sequence[str]) -> tuple[Config, Mapping[str, Any]]:
    """A configuration and the numbers of its press."""
    from softdot.outcome import outcome

    config = load_config(source, settings)
    model_of(config)
    return config, outcome(config)


def _stored_press(folder: Path, settings: Sequence[str]) -> tuple[Config, Mapping[str, Any]]:
    """The configuration and the numbers of a run. InputError."""
    if settings:
        raise InputError(f"--set {settings[0]}: '{folder}' is a run that is done; give its configuration to change it")
    try:
        found = json.loads((folder / RUN.summary).read_text("utf-8"))
    except (OSError, ValueError):
        raise InputError(f"'{folder}': holds no {RUN.summary}; name the folder of softdot run") from None
    if not isinstance(found, dict) or found.get("format") != RUN.format:
        raise InputError(f"'{folder}/{RUN.summary}': is not of softdot run")
    return config_from(found["config"]), found


def _write_expected(course: Mapping[str, Any], names: Sequence[str], path: Path) -> None:
    """What softdot calculates: time and the recorded voltage of each electrode."""
    read = course["readout_V"] or course["voltage_V"]
    time = np.array(course["time_s"])
    table = np.column_stack([time - time[0], *(read[name] for name in names)])
    heads = ",".join(["time_s", *(f"recorded_{number}_V" for number in range(1, len(names) + 1))])
    np.savetxt(path, table, fmt="%.10g", delimiter=",", header=heads, comments="")
