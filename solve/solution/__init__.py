"""How the discrete problem is solved: Newton, linear solver, load steps, sensitivities, checkpoints."""
