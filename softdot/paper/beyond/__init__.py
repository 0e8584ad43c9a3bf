"""Beyond the paper: between free and clamped, what softness really predicts, and a better design."""
