"""What any right program has, whatever its numbers: drawn over the schema, no result of our own among them."""
