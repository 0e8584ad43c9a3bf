"""The paper's simulations of one segment, pressed again in two readings."""
