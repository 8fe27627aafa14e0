"""The virtual bench behind real wires: pseudo-terminals and TCP ports, the instruments' own protocols, their
own timing. Any program can be pointed at it."""
