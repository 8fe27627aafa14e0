"""Ground: reduction and uncertainty to JJF 1536-2015; arrays in, frozen results out."""
