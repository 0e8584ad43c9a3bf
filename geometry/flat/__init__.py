"""Flat patterns that are cut from film, adhesive and sheet. Lengths in millimetres, seen from the dot's side."""
