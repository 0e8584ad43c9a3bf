"""The named verification problems, which a user runs on his own machine: `softdot verify`."""
