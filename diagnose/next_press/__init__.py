"""Which press to make next, so that the explanations that are left part most clearly."""
