"""A virtual world with its own clock, and instruments that look into it through the interfaces of a real
bench.

The world holds the truth; procedures see only :class:`~ahrs_lab.instruments.interfaces.Bench`. Same settings,
same seed and same commands give the same numbers, bit for bit.
"""
