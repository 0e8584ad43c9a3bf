"""Ground floor of all packages, with nothing of this field in it: errors, arrays, files, caches and processes."""

from pathlib import Path

from foundation.kernel_folder import set_kernel_folder
from foundation.thread_pools import quiet_pools

quiet_pools()  # before NumPy is loaded
set_kernel_folder(Path(__file__).parent)
