"""The concealed proof: recordings with hidden effects from another finite-element code, sealed, diagnosed, scored."""
