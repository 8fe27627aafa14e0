"""Uncertainty as a budget of named rows: GUM (JCGM 100) by default, the standard's annex A where a job asks
for it."""
