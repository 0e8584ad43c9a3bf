"""The press to make next, by which the explanations that are left differ most clearly."""
