"""softdot check: every mistake of a configuration at once, or what its run will cost. Nothing is solved."""

import sys
from argparse import Namespace
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from softdot.console import BAD_INPUT, GOOD, complain
from softdot.json_files import json_text, plain

FORMAT = "softdot-check/1"


def command(chosen: Namespace) -> int:
    """Check chosen.config; 0, or 2 when it has mistakes. InputError for a file that cannot be read."""
    summary = check_file(Path(chosen.config), chosen.set, chosen.kit)
    if chosen.json:
        sys.stdout.write(json_text(summary))
    elif not summary["mistakes"] and not chosen.quiet:
        print(short_text(summary))
    for mistake in summary["mistakes"]:
        complain(mistake)
    return BAD_INPUT if summary["mistakes"] else GOOD


def check_file(path: Path, settings: list[str], kit: bool = False) -> dict[str, Any]:
    """Mistakes, warnings and the expected cost of a configuration, as a table for JSON. InputError.

    kit : what cannot be made is a mistake too.
    """
    from softdot.case import Case
    from softdot.config.default_design import keys_from_default, with_default_design
    from softdot.config.loading import config_from, unused_material_warnings
    from softdot.config.mistakes import mistakes
    from softdot.config.settings import with_settings
    from softdot.config.toml import read_toml

    def check(tables: Mapping[str, Any]) -> tuple[Any, ...]:
        case = Case(config_from(with_default_design(tables)))
        made = contents_of(case.config, case.warnings).warnings if kit else case.warnings
        return case.config, [*made, *unused_material_warnings(case.config)], case.cost

    if kit:
        from softdot.kit.folder import contents_of

    stated = with_settings(read_toml(path), settings)
    found, checked = mistakes(stated, check)
    summary: dict[str, Any] = {"format": FORMAT, "config": str(path), "mistakes": found}
    if checked is None:
        return summary
    config, warnings, cost = checked
    told: dict[str, Any] = plain({"warnings": warnings, "expected": vars(cost)})
    return {**summary, **told, "from_default": list(keys_from_default(stated, config.model_dump(mode="json")))}


def short_text(summary: dict[str, Any]) -> str:
    """The answer in a few lines: expected cost, warnings, and keys that came from the default design."""
    cost = summary["expected"]
    lines = [
        f"no mistakes in '{summary['config']}'",
        f"mesh: about {cost['tetrahedra']:,} tetrahedra, {cost['unknowns']:,} unknowns",
        f"run: about {_duration(cost['time_s'])} on two cores and {cost['memory_GB']:g} GB, within a factor of two; "
        f"the first run on a machine takes up to {_duration(cost['first_run_s'])} more, to compile",
    ]
    lines += [f"warning: {warning}" for warning in summary["warnings"]]
    if summary["from_default"]:
        lines.append(f"from the default design: {', '.join(summary['from_default'])}")
    return "\n".join(lines)


def _duration(seconds: float) -> str:
    return f"{seconds:.0f} s" if seconds < 90 else f"{seconds / 60:.1f} min"
