"""The page Instruments: add, identify, configure, look at and move what a bench of real instruments is made
of."""
