"""Put the measured tables into the page: python -m benchmarks.document docs/speed.json docs/speed.md.

Each table stands between <!-- name --> and <!-- /name -->, and only that is rewritten. Sections that have no table are
for the text beside them.
"""

import json
import re
from pathlib import Path

from benchmarks.error_bars import counted
from benchmarks.growth import UP_TO, efficiency, exponents, of_precision
from benchmarks.press import CODES, errors, of_code, seconds_at
from benchmarks.timing import file_argument


def _table(head: tuple[str, ...], body: list[list[str]]) -> str:
    """A Markdown table."""
    first, *others = (f"| {' | '.join(line)} |" for line in (head, *body))
    return "\n".join([first, f"|{'---|' * len(head)}", *others])


def newton_step(rows: list[dict]) -> str:
    """Seconds and ratios, code by code, of the smallest and the largest problem."""
    ours = {(row["size"], row["law"]): row["seconds"] for row in rows if row["code"] == "softdot"}
    ends = {min(row["size"] for row in rows), max(row["size"] for row in rows)}
    body = []
    for row in (row for row in rows if row["size"] in ends):
        seconds, own = row["seconds"], ours[row["size"], row["law"]]
        times = [f"{seconds[name]:.3f}" for name in ("assemble", "factorise", "solve", "total")]
        ratios = [f"{own[name] / seconds[name]:.2f}" for name in ("assemble", "total")]
        body.append([str(row["unknowns"]), row["law"], row["code"], *times, *ratios])
    head = ("unknowns", "element", "code", "assembly s", "factorisation s", "solution s", "step s")
    return _table((*head, "ours/theirs, assembly", "ours/theirs, step"), body)


def growth(rows: list[dict]) -> str:
    """Seconds of the phases, memory, and the share of what the machine can do, of some sizes in both precisions."""
    phases, body = ("assemble", "factorise", "back substitute", "gmres", "to 1e-10"), []
    for precision in UP_TO:
        own = of_precision(rows, precision)
        for row in own[4::4]:
            flops, read = efficiency(row)
            times = [f"{row['seconds'][name]:.3f}" for name in phases]
            shares = [f"{100 * flops:.0f} %", f"{100 * read:.0f} %"]
            size = [precision, str(row["unknowns"])]
            body.append([*size, *times, f"{row['peak_GB']:.2f}", f"{row['factor_gflop']:.1f}", *shares])
        slope = exponents(own)
        if slope:
            fitted = [f"{slope[name]:.2f}" for name in (*phases, "peak_GB", "factor_gflop")]
            body.append([precision, "exponent", *fitted, "", ""])
    head = ("factor", "unknowns", "assembly s", "factorisation s", "back substitution s", "GMRES s", "to 1e-10 s")
    return _table((*head, "peak GB", "GFlop", "of the dense product's speed", "of the memory's speed"), body)


def press(rows: list[dict]) -> str:
    """Answers, error and time of each mesh, and the ratio of times at the error of ours."""
    body = []
    for code in CODES:
        for row, error in zip(of_code(rows, code), errors(rows, code), strict=True):
            ratio = seconds_at(rows, "softdot", error) / seconds_at(rows, "NGSolve", error)
            answers = [f"{row['force_N']:.5f}", f"{row['voltage_V']:.4f}", f"{100 * error:.2f}"]
            mesh = [code, f"{row['factor']:g}", str(row["unknowns"])]
            body.append([*mesh, *answers, f"{row['seconds']:.1f}", f"{ratio:.2f}"])
    head = ("code", "size factor", "unknowns", "force N", "voltage V", "error %", "seconds")
    return _table((*head, "ours/theirs at this error"), body)


def diagnosis(rows: list[dict]) -> str:
    """Seconds and memory of the first and a further diagnosis."""
    body = [
        [row["rig"], f"{row['first_seconds']:.0f}", f"{row['further_seconds']:.0f}", f"{row['first/further']:.1f}",
         f"{row['first_GB']:.1f}", f"{row['further_GB']:.1f}"]
        for row in rows
    ]  # fmt: skip
    return _table(("rig", "first s", "further s", "first/further", "first GB", "further GB"), body)


def whole_commands(rows: list[dict]) -> str:
    """Seconds of whole commands, of each the row that was measured last."""
    last = {(row["case"], row["part"]): row["now_s"] for row in rows}
    body = [[case, part, f"{taken:.1f}"] for (case, part), taken in last.items()]
    return _table(("command", "part", "s"), body)


def error_bars(rows: list[dict]) -> str:
    """How often the stated error covers the true one."""
    body = []
    for section in ("solid", "plane-strain"):
        for mesher in ("pytetwild", "layered"):
            own = [row for row in rows if (row["section"], row["mesher"]) == (section, mesher)]
            if own:
                body.append([section, mesher, str(len(own)), *(f"{value:g}" for value in counted(own).values())])
    body.append(["all", "", str(len(rows)), *(f"{value:g}" for value in counted(rows).values())])
    head = ("section", "mesher", "designs", "forces and voltages", "covered %", "median of stated over true")
    return _table(head, body)


def machine(section: dict) -> str:
    """One line on what it ran."""
    on = section["measured_on"]
    return f"{on['cpu']}, {on['cores']} cores, {on['memory_GB']} GB, load {on['load_before']} before the run."


TABLES = {
    "newton_step": newton_step, "growth": growth, "press": press, "diagnosis": diagnosis,
    "against itself": whole_commands, "error bars": error_bars,
}  # fmt: skip


def main(table: Path, page: Path) -> None:
    """Rewrite the tables of the sections that the file has."""
    text = page.read_text("utf-8")
    sections = json.loads(table.read_text(encoding="utf-8"))
    for name, section in ((name, section) for name, section in sections.items() if name in TABLES):
        content = f"{TABLES[name](section['rows'])}\n\n{machine(section)}"
        pattern = rf"(<!-- {name} -->\n).*?(<!-- /{name} -->)"
        text = re.sub(pattern, lambda found, content=content: f"{found[1]}{content}\n{found[2]}", text, flags=re.DOTALL)
    page.write_text(text, "utf-8")


if __name__ == "__main__":
    main(file_argument(), file_argument(2))
