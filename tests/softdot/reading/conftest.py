"""One made-up kernel and its folder for all tests of reading."""

import pytest

from tests.softdot.reading.made_kernel import made_kernel


@pytest.fixture(scope="session")
def kernel():
    return made_kernel()


@pytest.fixture(scope="session")
def kernel_folder(kernel, tmp_path_factory):
    folder = tmp_path_factory.mktemp("kernel")
    kernel.save(folder)
    return folder
