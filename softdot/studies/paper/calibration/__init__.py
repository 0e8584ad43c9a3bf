"""Part 2 of the study: the calibration rig, and what its factor of 337 is made of."""
