"""The noise of a channel, from samples that hold no answer of the segment."""
