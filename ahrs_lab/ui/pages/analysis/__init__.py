"""The page Analysis: the systems beside the standard, on recordings, with their tables and charts."""
