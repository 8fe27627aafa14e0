"""Ground: Earth, rotation, sensors; arrays in, arrays out (numpy, scipy)."""
