"""Part 1 of the study: the formulas of the paper, checked against its tables, and what they leave out."""
