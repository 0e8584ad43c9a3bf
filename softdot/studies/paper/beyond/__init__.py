"""Part 4 of the study: between free and clamped, what softness predicts, and a better design."""
