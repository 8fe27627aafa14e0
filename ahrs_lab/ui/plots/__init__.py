"""Plots: rings that keep what a screen can show of a stream, and the widgets that draw them."""
