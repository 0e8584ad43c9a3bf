"""The build sheet: one printable page that leads from an empty bench to a finished segment."""
