"""How the case stands: the 24 orientations whose axes point along east, north, up and back.

An orientation is written as three letters, where x, y, z of the case point, of ``E N U W S D``:
``"UEN"`` is x up, y east, z north (JJF 1536, table 2).
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from itertools import permutations
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from ahrs_lab.errors import InputError

Axis = Literal["x", "y", "z"]
AXES: tuple[Axis, ...] = ("x", "y", "z")

_DIRECTIONS: dict[str, tuple[int, int, int]] = {
    "E": (1, 0, 0),
    "N": (0, 1, 0),
    "U": (0, 0, 1),
    "W": (-1, 0, 0),
    "S": (0, -1, 0),
    "D": (0, 0, -1),
}
_LETTER = {vector: letter for letter, vector in _DIRECTIONS.items()}
_COUNTERCLOCKWISE = "ENWS"


@dataclass(frozen=True)
class Orientation:
    """Three letters, right-handed; raises :class:`InputError` for anything else."""

    letters: str

    def __post_init__(self) -> None:
        known = len(self.letters) == 3 and all(letter in _DIRECTIONS for letter in self.letters)
        if not known or round(float(np.linalg.det(self._matrix()))) != 1:
            raise InputError(
                "“{letters}” is not an orientation: write where x, y and z of the case point, "
                "as a right-handed triple of E N U W S D, for example UEN.",
                letters=self.letters,
            )

    def _matrix(self) -> NDArray[np.float64]:
        return np.array([_DIRECTIONS[letter] for letter in self.letters], dtype=np.float64).T

    @cached_property
    def matrix(self) -> NDArray[np.float64]:
        """3×3, case to east-north-up: column i is where case axis i points."""
        return self._matrix()

    @property
    def up_axis(self) -> Axis:
        """The case axis along the vertical."""
        return AXES[next(i for i, letter in enumerate(self.letters) if letter in "UD")]

    @property
    def up_sign(self) -> int:
        """+1 where that axis points up, −1 where it points down."""
        return 1 if "U" in self.letters else -1

    @property
    def face(self) -> str:
        """The mounting it belongs to: ``"x+"`` is x up, ``"x-"`` x down; the table reaches the other
        three orientations of the same face by turning."""
        return self.up_axis + ("+" if self.up_sign > 0 else "-")

    def turned(self, quarter_turns: int) -> Orientation:
        """After ``quarter_turns`` × 90° about up, positive by the right hand (east goes to north)."""
        ring = _COUNTERCLOCKWISE
        return Orientation(
            "".join(
                letter if letter in "UD" else ring[(ring.index(letter) + quarter_turns) % 4]
                for letter in self.letters
            )
        )

    def azimuth_from(self, reference: Orientation) -> float:
        """Table angle in degrees, 0 ≤ a < 360, that turns ``reference`` into this orientation."""
        for quarter in range(4):
            if reference.turned(quarter) == self:
                return 90.0 * quarter
        raise InputError(
            "{target} cannot be reached from {reference} by turning the table: "
            "the case has to be re-mounted.",
            target=self.letters,
            reference=reference.letters,
        )

    def gravity_unit(self) -> NDArray[np.float64]:
        """Shape (3,): direction of specific force at rest (up) in case axes."""
        return np.asarray(self.matrix.T @ np.array([0.0, 0.0, 1.0]), dtype=np.float64)

    def __str__(self) -> str:
        return self.letters


def all_orientations() -> tuple[Orientation, ...]:
    """The 24, in a fixed order."""
    found = []
    for x, y in permutations("ENUWSD", 2):
        cross = np.cross(_DIRECTIONS[x], _DIRECTIONS[y])
        letter = _LETTER.get((int(cross[0]), int(cross[1]), int(cross[2])))
        if letter is not None:
            found.append(Orientation(x + y + letter))
    return tuple(found)
