"""softdot prove: many concealed cases on all cores, resumed after a stop, counted in one table."""
