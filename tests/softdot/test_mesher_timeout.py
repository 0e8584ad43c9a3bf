"""The real stages up to a mesher that is given no time."""

import json

import pytest

from softdot.cli import main


@pytest.mark.process
def test_a_mesher_out_of_time_keeps_the_cad_files_and_exits_3(write_config, tmp_path, capfd):
    config = write_config("[mesh]\ntimeout_s = 0.05\nelement_size_mm = 0.3137")
    assert main(["run", str(config), "-o", str(tmp_path / "out")]) == 3
    assert "timeout_s = 0.05" in capfd.readouterr().err
    summary = json.loads((tmp_path / "out/summary.json").read_text(encoding="utf-8"))
    assert summary["solver"]["converged"] is False
    assert {path.name for path in (tmp_path / "out").iterdir()} == {"cad", "log.txt", "summary.json"}
    assert (tmp_path / "out/cad/segment.step").stat().st_size > 0
