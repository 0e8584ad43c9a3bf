"""Designs to start from: what each states beyond the default design; its first comment says what it is."""
