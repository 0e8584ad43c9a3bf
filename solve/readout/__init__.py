"""From the charge of the film to the voltage that an amplifier records."""
