"""Ground: samples in columns, segments, and the bundle on disk with its checks.

What other rooms use: ``read.read_bundle``, ``write.BundleWriter``, ``archive.pack``, ``archive.unpack``, and
the types in ``samples``, ``segment``, ``orientation`` and ``finding``.
"""
