"""The paper's calibration rig, and its factor p predicted piece by piece."""
