"""What the HTML pages share: frame, style and the filling of templates."""
