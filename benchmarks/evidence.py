"""The tests that take longer than a landing may, with what each took: python -m benchmarks.evidence OUT.json [PATH ...]

Rates over many concealed effects, random designs by the hundred, kills at random instants, other codes at full size. A
test that is in the file already, with the same commit, is not run again. PATH : files or folders of tests/, else all.
"""

import json
import subprocess
import sys
import tempfile
import time
from pathlib import Path
from xml.etree import ElementTree

ROOT = Path(__file__).parents[1]
PYTEST = [sys.executable, "-m", "pytest", "-n", "0", "-m", "evidence"]


def commit() -> str:
    """The commit that is measured, with a plus sign where something is not committed."""
    told = subprocess.run(["git", "describe", "--always", "--dirty=+"], cwd=ROOT, capture_output=True, text=True)
    return told.stdout.strip()


def files(paths: list[str]) -> list[str]:
    """Files that hold such tests."""
    told = subprocess.run([*PYTEST, "--collect-only", *paths], cwd=ROOT, capture_output=True, text=True).stdout
    return [line.rpartition(": ")[0] for line in told.splitlines() if line.startswith("tests/")]


def outcomes(file: str) -> list[dict[str, object]]:
    """Name, seconds and outcome of each such test of a file."""
    with tempfile.TemporaryDirectory() as folder:
        report = Path(folder) / "report.xml"
        subprocess.run([*PYTEST, file, f"--junitxml={report}"], cwd=ROOT, check=False)
        cases = ElementTree.parse(report).iter("testcase")
        return [
            {
                "test": f"{file}::{case.get('name')}",
                "seconds": round(float(case.get("time", "nan")), 1),
                "outcome": next((one.tag for one in case if one.tag in ("failure", "error", "skipped")), "passed"),
            }
            for case in cases
        ]


def main(out: Path, paths: list[str]) -> int:
    """Run what is missing; exit status 1 where a test failed."""
    kept = json.loads(out.read_text("utf-8")) if out.exists() else {}
    for file in files(paths):
        if kept.get(file, {}).get("commit") != commit():
            kept[file] = {"commit": commit(), "date": time.strftime("%Y-%m-%d"), "tests": outcomes(file)}
            out.write_text(json.dumps(kept, indent=1) + "\n", "utf-8")
    told = [one for entry in kept.values() for one in entry["tests"]]
    for one in sorted(told, key=lambda one: -one["seconds"]):
        print(f"{one['seconds']:9.1f} s  {one['outcome']:8s} {one['test']}")
    return int(any(one["outcome"] in ("failure", "error") for one in told))


if __name__ == "__main__":
    sys.exit(main(Path(sys.argv[1]), sys.argv[2:]))
