"""Wires: serial ports and TCP connections, the thread that reads them, and what can go wrong with them."""
