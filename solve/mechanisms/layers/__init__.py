"""Mechanisms of the layers: how media and film answer to strain."""
