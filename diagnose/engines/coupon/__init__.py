"""A coupon as a forward model of a diagnosis: the solver's laws at one material point."""
