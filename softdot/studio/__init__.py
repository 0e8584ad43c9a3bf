"""softdot studio: a design in a page of this machine's browser, solved beside it in processes of their own."""
