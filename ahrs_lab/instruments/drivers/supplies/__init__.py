"""DC supplies."""
