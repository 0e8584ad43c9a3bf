"""The verdict of a diagnosis: numbers for programs, sentences for people, and the proof by the full model."""
