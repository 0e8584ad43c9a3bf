"""The results of a search for designs: summary, tables, picture, page, and the best design as a configuration."""

from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from foundation.files import write_whole_text
from softdot.config.hashes import config_hash
from softdot.json_files import plain, write_json
from softdot.reading.cells import cells_of, text_of
from softdot.reading.designs.design_file import DesignRequest, TriedDesign, tables_with_values
from softdot.reading.designs.operating import COARSE_KERNEL
from softdot.reading.designs.search import pareto
from softdot.sweeps.sampling import sampling_warnings
from softdot.version import installed_version

if TYPE_CHECKING:
    from softdot.reading.designs.run import AskedReading, DesignRecords

FORMAT = "softdot-designs/1"
AIM_KEYS = ("mean_force_N", "crosstalk_percent", "error")
"""Keys of a reading whose values are to be small."""


def write_results(place: Path, request: DesignRequest, asked: "AskedReading", found: "DesignRecords") -> dict[str, Any]:
    """Write all results into the folder place, the summary last, and return its content."""
    from export.array.designs import draw_designs, write_designs_page
    from softdot.sweeps.report import write_csv
    from softdot.sweeps.table import write_table

    summary: dict[str, Any] = plain(summary_of(request, asked, found))
    designs = summary["designs"]
    rows = [design_row(one) for one in designs]
    write_table(place / "designs.parquet", rows)
    write_csv(place / "designs.csv", rows)
    write_csv(place / "readings.csv", reading_rows(designs))
    draw_designs(designs, summary["accuracy"], place / "pareto.png")
    write_designs_page(place / "report.html", summary, place / "pareto.png")
    write_whole_text(place / "designs.toml", request.text)
    best = place / "best.toml"
    if found.best is None:
        best.unlink(missing_ok=True)
    else:
        write_whole_text(best, best_text(request, found.best, summary["best"]["least"]))
    write_json(place / "design.json", summary)
    return summary


def summary_of(request: DesignRequest, asked: "AskedReading", found: "DesignRecords") -> dict[str, Any]:
    """The content of design.json."""
    search, sweep = request.search, request.space.sweep
    length = len(text_of(cells_of(asked.text, asked.table), asked.table))
    designs = [_design_content(one, request, found) for one in found.designs]
    for design, on_front in zip(designs, pareto_front(designs), strict=True):
        design["front"] = on_front
    best = next((one for one in designs if one["best"]), None)
    return {
        "format": FORMAT,
        "complete": True,
        "softdot_version": installed_version(),
        "text": asked.text,
        "table": asked.table,
        "decoder": asked.decoder,
        "characters": length * search.repeats,
        "repeats": search.repeats,
        "accuracy": search.accuracy,
        "conditions": asked.conditions.as_dict(),
        "kernel": vars(COARSE_KERNEL),
        "sampling": sweep.sampling,
        "seed": sweep.seed,
        "rounds": search.rounds,
        "best": best,
        "designs": designs,
        "warnings": [*sampling_warnings(sweep), *_warnings(designs)],
    }


def _design_content(design: TriedDesign, request: DesignRequest, found: "DesignRecords") -> dict[str, Any]:
    """A design as design.json holds it."""
    record = found.records[design.name]
    return {
        "name": design.name,
        "compared": design in request.compared,
        "best": design is found.best,
        "values": dict(design.values),
        "config_hash": None if design.config is None else config_hash(design.config),
        **{key: value for key, value in record.items() if key not in ("name", "values")},
    }


def _warnings(designs: list[dict[str, Any]]) -> list[str]:
    return [f"{one['name']}: {one['status']}, {one['reason']}" for one in designs if one["status"] != "solved"]


def pareto_front(designs: list[dict[str, Any]]) -> list[bool]:
    """Whether each design is one that no other beats in both force and crosstalk, where it just reads."""
    read = [k for k, one in enumerate(designs) if one["least"] is not None]
    found = [False] * len(designs)
    values = [[designs[k]["least"][name] for name in AIM_KEYS[:2]] for k in read]
    if read:
        for k, on_front in zip(read, pareto(np.array(values)), strict=True):
            found[k] = bool(on_front)
    return found


def design_row(design: dict[str, Any]) -> dict[str, Any]:
    """A row of designs.csv: name, values and status of a design, and its reading with the least force."""
    told = ("status", "reason", "compared", "best", "front", "seconds", "config_hash")
    return {"name": design["name"], **design["values"], **{key: design[key] for key in told}, **(design["least"] or {})}


def reading_rows(designs: list[dict[str, Any]]) -> list[dict[str, Any]]:
    """A row for each design and depth; pareto : whether no other one has less force, crosstalk and error."""
    rows = [
        {"name": design["name"], **reading, "error": 1.0 - reading["accuracy"]}
        for design in designs
        for reading in design["readings"]
        if reading["mean_force_N"] is not None
    ]
    best = pareto(np.array([[row[name] for name in AIM_KEYS] for row in rows]).reshape(-1, len(AIM_KEYS)))
    return [{**row, "pareto": bool(on_front)} for row, on_front in zip(rows, best, strict=True)]


def best_text(request: DesignRequest, design: TriedDesign, least: dict[str, Any]) -> str:
    """The configuration of a design as TOML, for softdot array."""
    import tomlkit

    said = (
        f"# {design.name}: {100.0 * least['accuracy']:.2f} % of {least['of']} characters with "
        f"{1e3 * least['mean_force_N']:.3g} mN on average, {least['depth_mm']:.3g} mm deep, by a coarse kernel.\n\n"
    )
    return said + tomlkit.dumps(tables_with_values(request.base, design.values))
