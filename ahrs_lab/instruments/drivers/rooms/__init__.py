"""Thermometers and hygrometers of the room."""
