"""The fabrication kit: everything that a workshop needs to make the simulated segment."""
