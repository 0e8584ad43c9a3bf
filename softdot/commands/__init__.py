"""The commands: what each does, prints and exits with."""
