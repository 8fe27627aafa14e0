"""The page Results: every number with its uncertainty, and the plot, budget and raw data behind it."""
