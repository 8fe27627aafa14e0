"""Correlation matrices: put together from single coefficients, and refused where no quantities can be so
correlated."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import combinations

import numpy as np
from numpy.typing import NDArray

from ahrs_lab.errors import InputError
from ahrs_lab.metrology.result import Correlation

Array = NDArray[np.float64]

SEMI_DEFINITE = 1e-10
"""An eigenvalue this little below 0 is rounding: coefficients are quoted with a few digits, sums have
sixteen."""


def correlation_matrix(names: Sequence[str], correlations: Sequence[Correlation]) -> Array:
    """Shape (n, n) with ones on the diagonal, for quantities called ``names``.

    Raises InputError, naming the quantities, for a coefficient beyond ±1, of a quantity with itself, given
    twice, or with one that is not there; and where the matrix is not positive semi-definite.
    """
    matrix = np.eye(len(names))
    seen: set[tuple[int, int]] = set()
    for entry in correlations:
        pair = min(entry.first, entry.second), max(entry.first, entry.second)
        if not 0 <= pair[0] < pair[1] < len(names) or pair in seen:
            raise InputError(
                "The correlation of rows {first} and {second} cannot be: each pair of different rows of the "
                "budget has one coefficient.",
                first=entry.first + 1,
                second=entry.second + 1,
            )
        seen.add(pair)
        matrix[pair] = matrix[pair[::-1]] = entry.coefficient
    check_correlation(matrix, names)
    return matrix


def check_correlation(matrix: Array, names: Sequence[str]) -> None:
    """Raises InputError where ``matrix``, shape (n, n), is no correlation matrix."""
    for i, j in combinations(range(len(names)), 2):
        if not abs(matrix[i, j]) <= 1.0:
            raise InputError(
                "The correlation coefficient of {first} and {second} is {coefficient}: it has to lie between "
                "−1 and 1.",
                first=names[i],
                second=names[j],
                coefficient=float(matrix[i, j]),
            )
    correlated = [i for i in range(len(names)) if np.any(np.delete(matrix[i], i) != 0.0)]
    if not correlated:
        return
    least = float(np.linalg.eigvalsh(matrix[np.ix_(correlated, correlated)])[0])
    if least < -SEMI_DEFINITE:
        raise InputError(
            "The correlations of {names} contradict each other: no quantities can be so correlated (the "
            "matrix has the negative eigenvalue {eigenvalue}). Correct the coefficients.",
            names=", ".join(names[i] for i in correlated),
            eigenvalue=f"{least:.3g}",
        )


def square_root(covariance: Array) -> Array:
    """A with A·Aᵀ = ``covariance``, shape (n, n), which may be singular: by eigenvalues, where Cholesky's
    method would stop."""
    values, vectors = np.linalg.eigh(covariance)
    return np.asarray(vectors * np.sqrt(np.maximum(values, 0.0)), dtype=np.float64)
