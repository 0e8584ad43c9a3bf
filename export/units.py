"""From the solver's SI units to the units that results are shown in."""

MM_PER_M = 1e3
MPA_PER_PA = 1e-6
PC_PER_MM2_PER_C_PER_M2 = 1e6
"""1 C/m^2 = 1e12 pC / 1e6 mm^2."""
