"""From a folder of recordings to a verdict, its evidence and an improved model."""
