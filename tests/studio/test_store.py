"""The page's store and the frames that it unpacks, by the test runner of node."""

import shutil
import subprocess
from pathlib import Path

import pytest

TESTS = Path(__file__).with_name("store.test.mjs")


@pytest.mark.skipif(shutil.which("node") is None, reason="node is not installed")
def test_the_store_of_the_page():
    done = subprocess.run(["node", "--test", str(TESTS)], capture_output=True, encoding="utf-8", timeout=60)
    assert done.returncode == 0, done.stdout
