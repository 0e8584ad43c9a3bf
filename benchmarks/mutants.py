"""Whether tests notice a change of the code: python -m benchmarks.mutants OUT.jsonl [--count 300] [--seed 47]

A sample of mutants (benchmarks.mutations) of PACKAGES, each in a copy of the tree below --work. It meets those default
tests of its package that run its line, the fastest first, until one fails; its line of OUT.jsonl says which. A second
call goes on where the first ended; --survivors FIRST.jsonl meets what survived there again. Needs Unix, and coverage in
the environment; OMP_NUM_THREADS=1 keeps it to one core.
"""

import argparse
import json
import os
import random
import shutil
import subprocess
from collections.abc import Sequence
from dataclasses import asdict
from hashlib import sha256
from importlib import import_module
from importlib.util import cache_from_source
from itertools import islice
from pathlib import Path
from typing import Any

from benchmarks.mutant_tests import LIBRARIES, apart, chosen, mapped, met
from benchmarks.mutations import Mutant, mutants_of

ROOT = Path(__file__).parents[1]
SOLVE = ("solve/*.py", "relations/*.py")
ABOUT_KEYS = ("bad_configurations", "check", "default_design", "press_key", "random_configurations", "schema")
PACKAGES = {
    "solve/readout": SOLVE,
    "solve/solution/schedule.py": SOLVE,
    "softdot/convert": ("relations/*.py", "diagnose/*.py"),
    "diagnose/signals": ("relations/*.py", "diagnose/*.py"),
    "mesh/files": ("mesh/*.py", "softdot/test_mesh_files.py", "verification/test_mesh_formats.py"),
    "softdot/config": ("relations/*.py", "diagnose/*.py", *(f"softdot/test_{name}.py" for name in ABOUT_KEYS)),
}
"""What is mutated, and where below tests/ its tests are."""
SLOWEST_FILE_S, SLOWEST_MUTANT_S = 25.0, 60.0


def sources() -> dict[str, str]:
    """File -> its package in PACKAGES."""
    files = {one: sorted((ROOT / one).glob("*.py")) or [ROOT / one] for one in PACKAGES}
    return {str(file.relative_to(ROOT)): package for package, found in files.items() for file in found}


def copied(tree: Path) -> None:
    """The files of the tree as they are now, each with its time, so that what was compiled of it counts."""
    shown = ["git", "-C", str(ROOT), "ls-files", "-co", "--exclude-standard"]
    names = subprocess.run(shown, check=True, capture_output=True, text=True).stdout.splitlines()
    for name in names:
        (tree / name).parent.mkdir(parents=True, exist_ok=True)
        shutil.copy2(ROOT / name, tree / name)


def maps_of(package: str, tree: Path) -> list[dict[str, Any]]:
    """mapped of each file of its tests; kept below the tree until the file or a source changes."""
    names = sources()
    state = b"".join((ROOT / one).read_bytes() for one in names)
    imports = package.removesuffix(".py").replace("/", ".")
    found = []
    for file in sorted(one for place in PACKAGES[package] for one in (ROOT / "tests").glob(place)):
        text = file.read_text("utf-8")
        if not file.name.startswith("test_") or not (imports in text or "relations" in file.parts):
            continue
        kept = tree.parent / "maps" / f"{file.stem}-{sha256(state + text.encode()).hexdigest()[:16]}.json"
        if not kept.exists():
            told, spent = apart(mapped, (str(file.relative_to(ROOT)), list(names)), tree, SLOWEST_FILE_S)
            print(
                f"{file.name}: {spent:.0f} s", "" if told else "(left out)", (told or {}).get("failed", ""), flush=True
            )
            kept.parent.mkdir(exist_ok=True)
            kept.write_text(json.dumps(told or {"took": {}, "runs": {}}), "utf-8")
        found.append(json.loads(kept.read_text("utf-8")))
    return found


def outcome(mutant: Mutant, tests: Sequence[str], tree: Path) -> dict[str, Any]:
    """Killed by a test, late, or survived."""
    place, (killer, spent) = tree / mutant.file, ("", 0.0)
    whole, written = place.read_bytes(), place.stat()
    place.write_bytes(mutant.applied(tree))
    try:
        if tests:
            killer, spent = apart(met, (tests,), tree, SLOWEST_MUTANT_S)
    finally:
        place.write_bytes(whole)
        os.utime(place, ns=(written.st_atime_ns, written.st_mtime_ns))
        Path(cache_from_source(str(place))).unlink(missing_ok=True)  # the next one may be of its second and size
    killer = "no end" if killer is None else killer
    return {**asdict(mutant), "name": mutant.name, "killed_by": killer, "tests": len(tests), "processor_s": spent}


def drawn(tree: Path, count: int, seed: int, survivors: Path | None) -> list[Mutant]:
    """A sample of all mutants, or those that survived another time and are still there."""
    known = {one.name: one for file in sources() for one in mutants_of(tree, file)}
    if survivors is not None:
        told = [json.loads(line) for line in survivors.read_text("utf-8").splitlines()]
        return [known[one["name"]] for one in told if not one["killed_by"] and one["name"] in known]
    names = sorted(known)
    random.Random(seed).shuffle(names)
    found = (known[name] for name in names)
    return list(islice((one for one in found if one.differs(tree)), count))


def main() -> None:
    """Meet the mutants that OUT.jsonl does not have yet; the score of each package."""
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("out", type=Path)
    parser.add_argument("--count", type=int, default=300)
    parser.add_argument("--seed", type=int, default=47)
    parser.add_argument("--survivors", type=Path)
    parser.add_argument("--work", type=Path, default=Path("/tmp/softdot-mutants"))
    asked = parser.parse_args()
    for name in LIBRARIES:
        import_module(name)
    tree = asked.work / "tree"
    copied(tree)
    os.environ |= {"NUMBA_CACHE_DIR": str(asked.work / "kernels"), "SOFTDOT_CACHE": str(asked.work / "cache")}
    of, maps = sources(), {package: maps_of(package, tree) for package in PACKAGES}
    done = [json.loads(line) for line in asked.out.read_text("utf-8").splitlines()] if asked.out.exists() else []
    for mutant in drawn(tree, asked.count, asked.seed, asked.survivors):
        if mutant.name not in {one["name"] for one in done}:
            done.append(outcome(mutant, chosen(mutant.file, *mutant.lines, maps[of[mutant.file]]), tree))
            with asked.out.open("a", encoding="utf-8") as stream:
                stream.write(json.dumps(done[-1]) + "\n")
            print(f"{len(done)} {done[-1]['killed_by'] or 'SURVIVED'} {mutant.name}", flush=True)
    for package in PACKAGES:
        killed = [bool(one["killed_by"]) for one in done if of.get(one["file"]) == package]
        print(f"{package}: {sum(killed)} of {len(killed)} die, {100 * sum(killed) / max(len(killed), 1):.0f} %")
    print(f"all: {sum(bool(one['killed_by']) for one in done)} of {len(done)}")


if __name__ == "__main__":
    main()
