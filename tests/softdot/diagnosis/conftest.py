"""The command with the toy engine in place of the 3D model."""

import json

import pytest

from softdot.cli import main
from softdot.diagnosis import folder as engines
from softdot.diagnosis import report as page
from tests.diagnose.verdict.toy import ToyEngine
from tests.softdot.complaints import complaints


@pytest.fixture
def pictures():
    """Ask for it where pictures are looked at; drawing takes a second."""


@pytest.fixture
def diagnosed(monkeypatch, tmp_path, capfd, request):
    """Call the command on a folder; returns its status, its summary and what it complained of."""
    if "pictures" not in request.fixturenames:
        monkeypatch.setattr(page, "_pictures", lambda *_: [])
    monkeypatch.setattr(engines, "engine_for", lambda rig, *_: ToyEngine(rig.recording))

    def call(folder, *more):
        status = main(["diagnose", str(folder), "-o", str(tmp_path / "out"), "--json", *more])
        said = capfd.readouterr()
        return status, json.loads(said.out) if said.out else None, complaints(said.err)

    return call
