"""Drivers of attitude and heading reference systems.

Each protocol adds to :mod:`.streaming` what it says to its device; what happens to samples, time and a lost
link is the same for all.
"""
