"""Points per minute of a sweep on one worker and on more: python -m benchmarks.sweep JSON [POINTS] [WORKERS…].

POINTS : 64 if not given; WORKERS : 1 and the number of cores. Solid segments on the layered mesher, so that every run
solves the same meshes, 5 740 unknowns each; load steps, contact and film as in any press. Each run is a process of
its own with an empty cache; its rate counts the start of the workers too, `seconds` is the whole command. Rows
that the file has are not measured again.
"""

import json
import os
import subprocess
import sys
import tempfile
import time
from pathlib import Path

from benchmarks.timing import Table

SPACE = """
[segment.effector]
height_mm = 1.0
[segment.medium1]
thickness_mm = 0.5
[segment.film]
thickness_um = 28.0
[segment.medium2]
thickness_mm = 2.0
material = "vnr-soft"
[press]
indentation_mm = 0.2
load_steps = 4
[mesh]
mesher = "layered"
element_size_mm = 1.0
contact_element_size_mm = 0.5
[sweep]
sampling = "latin-hypercube"
points = {points}
workers = {workers}
[[sweep.axes]]
key = "segment.medium1.thickness_mm"
low = 0.4
high = 0.8
[[sweep.axes]]
key = "segment.medium2.thickness_mm"
low = 1.6
high = 2.4
[[sweep.axes]]
key = "materials.vnr.youngs_modulus_MPa"
low = 1.0
high = 10.0
scale = "log"
"""


def measure(points: int, workers: int) -> dict:
    """One sweep from the command line, in an empty folder with an empty cache."""
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        (folder / "space.toml").write_text(SPACE.format(points=points, workers=workers), "utf-8")
        command = [sys.executable, "-m", "softdot.cli", "sweep", str(folder / "space.toml"), "-o", str(folder / "out")]
        environment = {**os.environ, "SOFTDOT_CACHE": str(folder / "cache")}
        start = time.perf_counter()
        done = subprocess.run([*command, "--json"], check=True, capture_output=True, env=environment)
        seconds = time.perf_counter() - start
        summary = json.loads(done.stdout)
        stored = [json.loads(path.read_text(encoding="utf-8")) for path in (folder / "out" / "points").iterdir()]
        sizes = {point["mesh"]["unknowns"] for point in stored}
    if summary["ended"]["solved"] != points:
        raise SystemExit(f"not every point was solved: {summary['ended']}")
    return {
        "points": points,
        "workers": workers,
        "unknowns": sorted(sizes),
        "seconds": seconds,
        "start_seconds": summary["timing_s"]["start"],
        "points_per_minute": summary["points_per_minute"],
    }


def show(rows: list[dict]) -> None:
    """Rates, and the share of so many times the rate of one worker."""
    alone = {row["points"]: row["points_per_minute"] for row in rows if row["workers"] == 1}
    for row in rows:
        rate, workers = row["points_per_minute"], row["workers"]
        share = f", efficiency {100 * rate / workers / alone[row['points']]:.0f} %" if row["points"] in alone else ""
        whole = f"{row['seconds']:.0f} s with {row['start_seconds']:.0f} s of start"
        print(f"{row['points']} points on {workers} workers: {rate:.1f} per minute{share}; {whole}")


def main(path: Path, points: int, workers: list[int]) -> None:
    """Measure what is missing."""
    table = Table(path, "sweep")
    for count in workers:
        if not table.has(points=points, workers=count):
            table.add(measure(points, count))
    show(table.rows)


if __name__ == "__main__":
    given = [int(word) for word in sys.argv[2:]]
    main(Path(sys.argv[1]), given[0] if given else 64, given[1:] or [1, os.cpu_count() or 1])
