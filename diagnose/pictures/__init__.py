"""Pictures of the evidence of a diagnosis."""
