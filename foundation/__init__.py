"""What every package stands on and what has nothing of this field in it: errors, arrays, files, caches, processes."""

from pathlib import Path

from foundation.kernel_folder import keep_kernels_apart
from foundation.thread_pools import quiet_pools

quiet_pools()  # before NumPy is loaded
keep_kernels_apart(Path(__file__).parent)
