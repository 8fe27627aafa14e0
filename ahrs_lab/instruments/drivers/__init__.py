"""Drivers: instruments behind the small interfaces, each over a link and a codec."""
