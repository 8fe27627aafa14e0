"""A virtual world behind the instruments' interfaces."""
