"""Ground: samples in columns, segments, and the bundle on disk with its checks."""
