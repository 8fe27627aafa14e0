"""How instruments speak: codecs without sockets, clocks or threads.

A decoder takes bytes as they come, in any split, and gives frames; an encoder gives the bytes of a command or
of a device's own frame. Drivers and the simulator's servers share them; captures of real devices check them.

:mod:`.catalogue` names the decoders of AHRS streams. What every decoder promises stands in :mod:`.frames`.
"""
