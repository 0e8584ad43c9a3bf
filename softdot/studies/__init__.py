"""Studies: evidence about the tool and its field, apart from the product."""
