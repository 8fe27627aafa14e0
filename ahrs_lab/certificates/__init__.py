"""What is issued: content, layout, signing and verification of certificates."""
