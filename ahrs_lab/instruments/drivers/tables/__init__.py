"""Rate tables: the ACUTROL 3000, experimental ones, any that speaks a short ASCII language, and one that a
person turns."""
