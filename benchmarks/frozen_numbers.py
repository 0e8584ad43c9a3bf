"""Numbers that a restructuring must not move: what the commands wrote before, against what they write after.

    python -m benchmarks.frozen_numbers record before [--recordings FOLDER ...]
    python -m benchmarks.frozen_numbers compare before after

`record` calls the command line alone, so that it runs at any commit. Meshes are layered: pytetwild makes another mesh
each time; recordings of a segment state so in rig.toml. `compare` prints a table and exits with 1 where a number moved
by more than 1e-9.
"""

import argparse
import hashlib
import json
import math
import os
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

EXAMPLES = Path("examples")
LAYERED = "mesh.mesher=layered"
SOLID = (LAYERED, "mesh.element_size_mm=0.6", "mesh.contact_element_size_mm=0.3", "press.load_steps=3")
RUNS: dict[str, tuple[str, ...]] = {
    "slice-clamped": ("paper-final-clamped.toml",),
    "slice-free": ("paper-final-free.toml",),
    "circuit": ("readout.toml",),
    "solid": ("true-segment.toml", *SOLID),
    "bonds": ("mechanisms/adhesive-compliance.toml",),
    "solid-offset": ("true-segment.toml", *SOLID, "dot.offset_mm=[0.2, 0.1]", "segment.film.draw_angle_deg=30"),
    "electrodes": ("mechanisms/crosstalk.toml",),
    "viscoelasticity": ("mechanisms/viscoelasticity.toml",),
    "stress-softening": ("mechanisms/stress-softening.toml",),
    "film-yield": ("mechanisms/film-yield.toml",),
    "friction": ("mechanisms/friction.toml",),
    "delamination": ("mechanisms/delamination.toml",),
    "hyperfoam": ("mechanisms/hyperfoam.toml",),
    "inertia": ("mechanisms/inertia.toml",),
    "heat": ("mechanisms/pyroelectric-drift.toml",),
    "touch-charge": ("mechanisms/contact-electrification.toml",),
    "rig": ("mechanisms/rig-compliance.toml",),
    "saturation": ("mechanisms/saturation.toml",),
}
KITS: dict[str, tuple[str, ...]] = {
    "kit-solid": ("true-segment.toml", *SOLID),
    "kit-dome": ("dome.toml", *SOLID),
    "kit-free": ("true-segment.toml", *SOLID, "segment.boundary=free"),
}
NOT_NUMBERS = ("timing_s", "softdot_version", "config_hash", "seconds", "created", "wall", "memory", "threads")
"""Keys of what depends on the clock or on the commit."""
ROUND_OFF = ("max_relative_residual", "newton_iterations", "mesh_error")
"""Keys of what is made of rounding: residuals, the iterations that reach them, differences near zero."""
DRAWN = (".json", ".stl", ".dxf", ".svg", ".csv", ".toml")
"""Endings of files whose bytes are compared; STEP, 3MF and pictures carry dates."""


def main() -> int:
    """Exit status: 0, or 1 where a number moved."""
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    commands = parser.add_subparsers(dest="command", required=True)
    record_parser = commands.add_parser("record")
    record_parser.add_argument("folder", type=Path)
    record_parser.add_argument("--recordings", type=Path, nargs="*", default=[])
    record_parser.add_argument("--only", nargs="*", help="names to make; default: all")
    compare_parser = commands.add_parser("compare")
    compare_parser.add_argument("before", type=Path)
    compare_parser.add_argument("after", type=Path)
    arguments = parser.parse_args()
    if arguments.command == "record":
        record(arguments.folder, arguments.recordings, arguments.only)
        return 0
    return compare(arguments.before, arguments.after)


def record(folder: Path, recordings: list[Path], only: list[str] | None) -> None:
    """One JSON file for each configuration, kit and recording: all numbers and the digests of all files written."""
    folder.mkdir(parents=True, exist_ok=True)
    work = {name: ("run", str(EXAMPLES / words[0]), *_set((*words[1:], LAYERED))) for name, words in RUNS.items()}
    work |= {name: ("kit", str(EXAMPLES / words[0]), *_set(words[1:])) for name, words in KITS.items()}
    work |= {f"verdict-{path.name}": ("diagnose", str(path)) for path in recordings}
    with tempfile.TemporaryDirectory() as cache:
        for name, words in work.items():
            if only and name not in only:
                continue
            begun = time.monotonic()
            found = _made(words, Path(cache))
            (folder / f"{name}.json").write_text(json.dumps(found, indent=1, sort_keys=True), "utf-8")
            print(f"{name}: exit {found['exit']}, {time.monotonic() - begun:.0f} s", flush=True)


def _set(words: tuple[str, ...]) -> list[str]:
    return [part for word in words for part in ("--set", word)]


def _made(words: tuple[str, ...], cache: Path) -> dict[str, Any]:
    environment = {**os.environ, "SOFTDOT_CACHE": str(cache)}
    with tempfile.TemporaryDirectory() as folder:
        out = Path(folder) / "out"
        called = [sys.executable, "-m", "softdot", *words, "-o", str(out), "-q"]
        status = subprocess.run(called, env=environment, check=False).returncode
        reports = sorted(path for path in out.glob("*.json"))
        return {
            "exit": status,
            "reports": {path.name: json.loads(path.read_text(encoding="utf-8")) for path in reports},
            "files": {
                str(path.relative_to(out)): _digest(path)
                for path in sorted(out.rglob("*"))
                if path.suffix in DRAWN and path not in reports
            },
            "names": sorted(str(path.relative_to(out)) for path in out.rglob("*") if path.is_file()),
        }


def _digest(path: Path) -> str:
    content = path.read_bytes()
    if path.suffix == ".dxf":  # its header has dates and random identifiers
        content = content[content.index(b"ENTITIES") : content.index(b"OBJECTS")]
    return hashlib.sha256(content).hexdigest()


def compare(before: Path, after: Path) -> int:
    """Print a line for each frozen thing: how many numbers it has, and the largest relative change."""
    worst_of_all = 0.0
    wrong = 0
    print(f"{'name':28} {'numbers':>8} {'largest change':>15}  where; what differs otherwise")
    for path in sorted(before.glob("*.json")):
        other = after / path.name
        if not other.exists():
            print(f"{path.stem:28} {'':>8} {'':>15}  not made")
            wrong += 1
            continue
        one, two = json.loads(path.read_text(encoding="utf-8")), json.loads(other.read_text(encoding="utf-8"))
        count, largest, where, different = 0, 0.0, "", []
        for key, old, new, scale in _pairs(one, two, ""):
            if _number(old) and _number(new):
                count += 1
                change = _change(float(old), float(new), scale)
                if change > largest:
                    largest, where = change, key
            elif old != new:
                different.append(key)
        worst_of_all = max(worst_of_all, largest)
        wrong += bool(different) or largest > 1e-9
        print(f"{path.stem:28} {count:8d} {largest:15.1e}  {where}; {', '.join(different[:6])}")
    print(f"largest change of all: {worst_of_all:.1e}")
    return int(wrong > 0)


def _number(value: object) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool)


def _change(old: float, new: float, scale: float) -> float:
    """Relative to the larger one, or to the largest of its list."""
    if math.isclose(old, new, rel_tol=0.0, abs_tol=1e-15):
        return 0.0
    return abs(old - new) / max(abs(old), abs(new), scale)


def _pairs(one: object, two: object, key: str, scale: float = 0.0) -> Iterator[tuple[str, Any, Any, float]]:
    """Values of the same place in two JSON trees, and the largest number of their list.

    A place that only one has comes with the other as text.
    """
    if key.endswith("/screened"):  # candidates come in any order
        one, two = (sorted(rows, key=str) for rows in (one, two))
    if isinstance(one, dict) and isinstance(two, dict):
        for name in sorted({*one, *two}):
            if not any(word in name for word in (*NOT_NUMBERS, *ROUND_OFF)):
                yield from _pairs(one.get(name, "absent"), two.get(name, "absent"), f"{key}/{name}")
    elif isinstance(one, list) and isinstance(two, list) and len(one) == len(two):
        scale = max((abs(float(value)) for value in one if _number(value)), default=0.0)
        for number, (old, new) in enumerate(zip(one, two, strict=True)):
            yield from _pairs(old, new, f"{key}[{number}]", scale)
    else:
        yield key, one, two, scale


if __name__ == "__main__":
    raise SystemExit(main())
