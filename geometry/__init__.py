"""Parameters, Braille standards, the exact dot and the solids of a segment. Lengths in millimetres."""

from geometry.threads import sleep_while_idle

sleep_while_idle()
