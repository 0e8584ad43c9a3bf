"""softdot verify: the named verification problems on this machine, as a table, a page and verify.json."""

import platform
import sys
from argparse import Namespace
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from export.page import page_environment
from softdot.console import GOOD, NOT_CONVERGED, complain, only_the_summary_on_stdout
from softdot.json_files import json_text, plain, write_json
from softdot.output import Product, staged_folder
from softdot.progress import Logged, Progress, progress_of
from softdot.verify.catalogue import chosen_problems
from softdot.verify.problem import Problem
from softdot.version import installed_version

VERIFY = Product("softdot-verify/1", "verify.json", frozenset({"verify.json", "verify.html"}))
HEADS = ("problem", "reference", "value", "unit", "deviation", "bound", "")


def command(chosen: Namespace) -> int:
    """Run the chosen problems into chosen.output; 0, or 3 where one fails. InputError."""
    problems = chosen_problems(chosen.only)
    with only_the_summary_on_stdout(), progress_of(chosen) as progress:
        summary = run_verification(problems, Path(chosen.output), progress)
    if chosen.json:
        sys.stdout.write(json_text(summary))
    elif not chosen.quiet:
        _print_table(summary["problems"])
    failed = [problem["name"] for problem in summary["problems"] if not problem["passed"]]
    if not failed:
        return GOOD
    complain(
        f"{len(failed)} of {len(problems)} problems failed: {', '.join(failed)}; see '{chosen.output}/verify.html'"
    )
    return NOT_CONVERGED


def run_verification(problems: Sequence[Problem], out: Path, progress: Progress | None = None) -> dict[str, Any]:
    """Solve problems, write verify.json and verify.html into the folder out and return the content of verify.json.

    InputError before any work when out cannot be written.
    """
    shown = progress or Logged()
    with staged_folder(out, VERIFY) as folder:
        shown.stage("verify")
        outcomes = []
        for number, problem in enumerate(problems, start=1):
            outcomes.append(problem.outcome())
            shown.step(number, len(problems), f"{problem.name} {verdict_word(outcomes[-1])}")
        summary: dict[str, Any] = plain(
            {
                "format": VERIFY.format,
                "softdot_version": installed_version(),
                "python": platform.python_version(),
                "machine": f"{platform.system()} {platform.machine()}",
                "passed": all(outcome["passed"] for outcome in outcomes),
                "problems": outcomes,
            }
        )
        _write_page(summary, folder / "verify.html")
        write_json(folder / VERIFY.summary, summary)
    return summary


def verdict_word(outcome: dict[str, Any]) -> str:
    """The verdict on an outcome in one word: passed or failed."""
    return "passed" if outcome["passed"] else "failed"


def table_row(outcome: dict[str, Any]) -> tuple[str, ...]:
    """The texts of one row of the table, in the order of HEADS."""
    deviation = "no solution" if outcome["deviation_percent"] is None else f"{outcome['deviation_percent']:+.2g} %"
    value = "-" if outcome["value"] is None else f"{outcome['value']:.6g}"
    bound = f"{outcome['bound_percent']:g} %"
    unit = "" if outcome["unit"] == "1" else outcome["unit"]
    return outcome["name"], f"{outcome['reference']:.6g}", value, unit, deviation, bound, verdict_word(outcome)


def _print_table(outcomes: list[dict[str, Any]]) -> None:
    """Print a row for each outcome, in colour on a terminal, in a pipe as plain columns."""
    rows = [table_row(outcome) for outcome in outcomes]
    if not sys.stdout.isatty():
        widths = [max(len(row[column]) for row in [HEADS, *rows]) for column in range(len(HEADS))]
        for row in [HEADS, *rows]:
            print("  ".join(cell.ljust(width) for cell, width in zip(row, widths, strict=True)).rstrip())
        return
    from rich.console import Console
    from rich.table import Table

    table = Table(*HEADS)
    for row, outcome in zip(rows, outcomes, strict=True):
        table.add_row(*row, style="green" if outcome["passed"] else "bold red")
    Console().print(table)


def _write_page(summary: dict[str, Any], path: Path) -> None:
    environment = page_environment(Path(__file__).parent)
    rows = [(outcome, table_row(outcome)) for outcome in summary["problems"]]
    page = environment.get_template("verify.html").render(summary=summary, rows=rows)
    path.write_text(page, "utf-8")
