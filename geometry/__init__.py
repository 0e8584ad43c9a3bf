"""Parameters, Braille standards, the exact dot and the solids of a segment. Lengths in millimetres."""

from pathlib import Path

from geometry.environment import keep_kernels_apart, quiet_pools

quiet_pools()
keep_kernels_apart(Path(__file__).parent)
