"""What a bench is made of: small interfaces, links, protocols, drivers."""
