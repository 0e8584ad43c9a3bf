"""softdot read: a line of Braille under an array of segments, from text to voltages and back to text."""
