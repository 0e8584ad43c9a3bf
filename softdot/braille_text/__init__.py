"""Text in Braille cells and back: uncontracted English by a table of its own, else liblouis."""
