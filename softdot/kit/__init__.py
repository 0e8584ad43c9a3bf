"""The fabrication kit: what a bench needs to make the segment that is simulated."""
