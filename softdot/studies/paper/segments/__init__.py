"""Part 3 of the study: the simulations of one segment, in two readings of the paper."""
