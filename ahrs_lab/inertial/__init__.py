"""Mathematics of inertial sensing: the Earth, rotations, sensor models. Arrays in, arrays out; knows numpy
only."""
