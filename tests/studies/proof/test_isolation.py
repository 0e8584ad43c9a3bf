"""The diagnosis can read the recording and nothing else, and nobody can change the truth afterwards."""

import ast
import json
import os
import subprocess
import sys
from pathlib import Path

import pytest

from foundation.thread_pools import ONE_THREAD_VARIABLES
from softdot.studies.proof import isolation
from softdot.studies.proof.commitment import digest_of, matches_digest, seal
from softdot.studies.proof.guard import PACKAGES, allowed_roots
from tests.cases import for_each

ROOT = Path(__file__).resolve().parents[3]
HOLDERS = {"softdot", "softdot.foreign_packages", "softdot.public_names", "softdot.studies"}
"""What is imported with any module of the proof."""
ENVIRONMENT = {"foundation", "foundation.kernel_folder", "foundation.thread_pools"}  # before NumPy is loaded


def run_guarded(where, code):
    """Python code in a process whose hook is on."""
    begin = (
        "from pathlib import Path; from softdot.studies.proof.guard import watch; watch(Path('folder'), Path('cache'));"
    )
    return subprocess.run(
        [sys.executable, "-c", begin + code],
        cwd=where,
        env=isolation.environment(where / "folder", where / "cache"),
        capture_output=True,
        encoding="utf-8",
        check=False,
    )


@pytest.fixture
def house(tmp_path):
    """A folder with a recording, and the truth beside it."""
    for name in ("folder", "cache", "proof"):
        (tmp_path / name).mkdir()
    (tmp_path / "folder" / "press.csv").write_text("time_s\n", "utf-8")
    (tmp_path / "proof" / "truth.json").write_text("{}", "utf-8")
    return tmp_path


def test_the_recording_can_be_read(house):
    assert run_guarded(house, "print(open('folder/press.csv').read())").stdout.strip() == "time_s"


@for_each(
    "code",
    [
        "open('proof/truth.json')",
        "Path('proof/truth.json').read_text()",
        "import os; os.listdir('proof')",
        "list(Path('proof').iterdir())",
        "open('folder/../proof/truth.json')",
        "import os; os.symlink('../proof', 'folder/way'); open('folder/way/truth.json')",
        "import numpy; numpy.loadtxt('proof/truth.json')",
    ],
)
def test_nothing_beside_the_folder_can_be_read(house, code):
    ended = run_guarded(house, code)
    assert ended.returncode != 0
    assert "outside the isolated folder" in ended.stderr


def test_the_folder_is_not_within_reach_of_the_presses_of_the_generator(house, monkeypatch):
    from softdot.studies.proof.world.march import store

    monkeypatch.delenv("SOFTDOT_PROOF_CACHE", raising=False)
    roots = allowed_roots(house / "folder", house / "cache")
    assert not any(store().resolve().is_relative_to(root) for root in roots)


def test_no_variable_gives_a_hint(house, monkeypatch):
    monkeypatch.delenv("NUMBA_CACHE_DIR", raising=False)
    for name in ("SOFTDOT_PROOF_CACHE", "SOFTDOT_RECORDINGS", "CASE", "SEED", "PYTHONSTARTUP"):
        monkeypatch.setenv(name, "charge-leakage")
    given = isolation.environment(house / "folder", house / "cache")
    assert "charge-leakage" not in given.values()
    assert set(given) <= {
        *isolation.KEPT,
        *ONE_THREAD_VARIABLES,
        "HOME",
        "TMPDIR",
        "PYTHONPATH",
        "SOFTDOT_CACHE",
        "MPLCONFIGDIR",
    }


def test_the_process_gets_a_folder_with_the_recording_alone(monkeypatch, tmp_path):
    seen = {}

    def watched(command, cwd, **_):
        seen["files"] = sorted(str(p.relative_to(cwd)) for p in Path(cwd).rglob("*"))
        seen["words"] = " ".join(map(str, command))
        return subprocess.CompletedProcess(command, 2, "", "softdot: no")

    monkeypatch.setattr(isolation.subprocess, "run", watched)
    heard = isolation.diagnose_isolated({"rig.toml": "", "press-01.csv": ""}, tmp_path, 10.0)
    assert seen["files"] == ["recording", "recording/press-01.csv", "recording/rig.toml", "tmp"]
    assert "case" not in seen["words"]
    assert heard.verdict is None
    assert heard.reason == "exit 2: softdot: no"


def test_the_truth_is_not_on_disk_while_a_case_is_diagnosed(monkeypatch, tmp_path):
    from softdot.studies.proof import proof_folder as store
    from softdot.studies.proof import run as work
    from softdot.studies.proof import trial
    from softdot.studies.proof.world.cases import Case, Truth

    place = store.check(tmp_path / "out")
    store.begin(place)
    truth = Truth(
        Case(1, 0, "single", "ridge-clamped", ("leakage",), 5.0),
        {"leakage": 0.123456789},
        {"leakage": {}},
        {},
        5.0,
        600.0,
    )
    monkeypatch.setattr(trial, "conceal", lambda _case: (truth, []))
    monkeypatch.setattr(trial, "files", lambda _bench, _runs: {})
    monkeypatch.setattr(trial.rivals, "opinions", lambda _bench, _runs: {})
    written = {}

    def diagnosed(*_):
        written.update({p: p.read_text(encoding="utf-8") for p in tmp_path.rglob("*") if p.is_file()})
        return isolation.Heard(None, "stopped", 0.0)

    monkeypatch.setattr(trial, "diagnose_isolated", diagnosed)
    record = work.prove_case(truth.case, trial.Terms(tmp_path / "cache"), place, "program")
    assert "0.123456789" not in "".join(written.values())
    assert record["digest"] in (place / "commitments" / "case-0001.json").read_text(encoding="utf-8")
    assert record["digest"] in "".join(written.values())  # committed before
    assert "0.123456789" in (place / "cases" / "case-0001.json").read_text(encoding="utf-8")  # revealed after


def test_a_changed_truth_is_noticed():
    sealed = seal({"mechanisms": ["charge-leakage"], "size": 5.0})
    assert matches_digest(sealed.truth, sealed.salt, sealed.digest)
    assert not matches_digest({**sealed.truth, "size": 5.1}, sealed.salt, sealed.digest)
    assert not matches_digest(sealed.truth, sealed.salt[::-1], sealed.digest)


def test_a_commitment_survives_json_and_hides_a_truth_that_could_be_guessed():
    truth = {"b": 0.1 + 0.2, "a": [1, "x"]}
    sealed = seal(truth)
    assert digest_of(json.loads(json.dumps(truth)), sealed.salt) == sealed.digest
    assert seal(truth).digest != sealed.digest


def test_a_record_whose_truth_was_changed_is_not_kept(tmp_path):
    from dataclasses import asdict

    from softdot.studies.proof import proof_folder as store
    from softdot.studies.proof.world.cases import Case

    place, case = store.check(tmp_path / "out"), Case(1, 0, "none", "ridge-free")
    store.begin(place)
    sealed = seal({"kind": "none", "whitened_rms": 1.0 / 3.0})
    store.commit(place, case.name, sealed.digest)
    record = {"case": asdict(case), "program": "p", "status": "scored", "truth": sealed.truth, "salt": sealed.salt}
    store.keep(place, case.name, record)
    assert store.recall_record(place, case, "p") is not None
    assert store.recall_record(place, case, "another program") is None
    store.keep(place, case.name, {**record, "truth": {"kind": "single"}})
    assert store.recall_record(place, case, "p") is None


def test_a_record_with_a_changed_digit_is_told_of_and_not_used(tmp_path, caplog):
    from dataclasses import asdict

    from softdot.studies.proof import proof_folder as store
    from softdot.studies.proof.world.cases import Case

    place, case = store.check(tmp_path / "out"), Case(1, 0, "none", "ridge-free")
    store.begin(place)
    sealed = seal({"kind": "none"})
    store.commit(place, case.name, sealed.digest)
    record = {"case": asdict(case), "program": "p", "status": "scored", "truth": sealed.truth, "salt": sealed.salt,
              "held_out": 1.25}  # fmt: skip
    store.keep(place, case.name, record)
    assert store.recall_record(place, case, "p") == json.loads(json.dumps(record)) == next(store.records(place))
    path = place / "cases" / "case-0001.json"
    path.write_text(path.read_text(encoding="utf-8").replace("1.25", "7.25"), "utf-8")
    assert store.recall_record(place, case, "p") is None
    assert list(store.records(place)) == []
    assert "damaged" in caplog.text


@pytest.mark.process
def test_the_generator_shares_no_code_with_what_it_tests():
    text = (
        "import sys, softdot.studies.proof.world.cases, softdot.studies.proof.recording_folder;"
        f"print(*(n for n in sys.modules if n.split('.')[0] in {PACKAGES!r}"
        " and not n.startswith('softdot.studies.proof')))"
    )
    environment = {**os.environ, "PYTHONPATH": str(ROOT)}
    command = [sys.executable, "-c", text]
    found = subprocess.run(command, env=environment, capture_output=True, encoding="utf-8", check=True)
    assert set(found.stdout.split()) == HOLDERS | ENVIRONMENT


def test_the_hidden_world_imports_nothing_of_this_program_but_itself():
    """In functions too."""
    for path in (ROOT / "softdot" / "studies" / "proof" / "world").glob("*.py"):
        for node in ast.walk(ast.parse(path.read_text("utf-8"))):
            names = [one.name for one in node.names] if isinstance(node, ast.Import) else []
            names += [node.module] if isinstance(node, ast.ImportFrom) else []
            ours = [name for name in names if name.split(".")[0] in PACKAGES]
            assert [name for name in ours if not name.startswith("softdot.studies.proof.world")] == [], path.name


def test_nothing_imports_the_proof_but_its_command():
    """In functions too."""
    users = set()
    for path in (path for package in PACKAGES for path in (ROOT / package).rglob("*.py")):
        if not path.is_relative_to(ROOT / "softdot" / "studies" / "proof") and "studies.proof" in path.read_text(
            "utf-8"
        ):
            users.add(path.relative_to(ROOT).as_posix())
    assert users == {"softdot/commands/prove.py"}
