"""Design by reading: which array reads a line of Braille with the least force."""
