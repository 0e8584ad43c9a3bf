"""A printable Braille plate from a text."""
