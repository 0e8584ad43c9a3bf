"""The study of the paper: its formulas, its simulations, its calibration factor, and what lies beyond it."""
