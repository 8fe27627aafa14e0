"""Unit quaternions in columns: shape (4, n), scalar first, ``q ⊗ p`` rotates by p first.

A quaternion b→n rotates as its C_bn does. Columns, not rows: each component is one run of memory, and a
product is sixteen array products.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Final

import numpy as np
from numpy.typing import NDArray

from ahrs_lab.inertial.attitude import angles_of_axes_deg, attitude_matrix

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]

_SMALL_SQUARE: Final = 1e-3
"""Of the half-angle, rad²: up to it the series of sine and cosine are right to rounding."""


def product(q: Array, p: Array) -> Array:
    """Shape (4, …): q ⊗ p, the shapes broadcast."""
    a, b, c, d = q
    w, x, y, z = p
    return np.stack(
        [
            a * w - b * x - c * y - d * z,
            a * x + b * w + c * z - d * y,
            a * y - b * z + c * w + d * x,
            a * z + b * y - c * x + d * w,
        ]
    )


def conjugate(q: Array) -> Array:
    """The inverse rotation."""
    return np.stack([q[0], -q[1], -q[2], -q[3]])


def from_rotation_vector(vector: Array) -> Array:
    """Shape (4, n) of rotation vectors (3, n), rad."""
    x, y, z = vector
    square = 0.25 * (x * x + y * y + z * z)
    q = np.empty((4, vector.shape[1]))
    if np.max(square, initial=0.0) < _SMALL_SQUARE:
        q[0] = 1.0 - square * (1 / 2 - square * (1 / 24 - square * (1 / 720 - square * (1 / 40320))))
        half = 0.5 - square * (1 / 12 - square * (1 / 240 - square * (1 / 10080)))
    else:
        angle = np.sqrt(square)
        q[0], half = np.cos(angle), 0.5 * np.sinc(angle / np.pi)
    np.multiply(half, vector, out=q[1:])
    return q


def from_matrix(C: Array) -> Array:
    """Shape (4,) of a rotation matrix (3, 3); the scalar is not negative."""
    # the largest of the four squares is at least a quarter: its root divides safely
    trace = np.trace(C)
    squares = np.array([trace, *np.diag(C)])
    largest = int(np.argmax(squares))
    if largest == 0:
        q = np.array([1.0 + trace, C[2, 1] - C[1, 2], C[0, 2] - C[2, 0], C[1, 0] - C[0, 1]])
    else:
        i, j, k = largest - 1, largest % 3, (largest + 1) % 3
        q = np.empty(4)
        q[0] = C[k, j] - C[j, k]
        q[1 + i] = 1.0 + 2.0 * C[i, i] - trace
        q[1 + j], q[1 + k] = C[j, i] + C[i, j], C[k, i] + C[i, k]
    q = q / np.linalg.norm(q)
    return np.asarray(-q if q[0] < 0 else q, dtype=np.float64)


def from_angles_deg(heading: float, pitch: float, roll: float) -> Array:
    """Shape (4,): b→n of heading, pitch and roll."""
    return from_matrix(attitude_matrix(heading, pitch, roll))


def to_matrix(q: Array) -> Array:
    """Shape (n, 3, 3) of (4, n)."""
    w, x, y, z = q
    rows = [
        [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
        [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
        [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
    ]
    return np.stack([np.stack(row, axis=-1) for row in rows], axis=-2)


def angles_deg(q: Array) -> tuple[Array, Array, Array]:
    """Heading, pitch, roll, each (n,), of quaternions b→n (4, n)."""
    w, x, y, z = q
    forward = np.stack([2 * (x * y - w * z), 1 - 2 * (x * x + z * z), 2 * (y * z + w * x)])
    right = np.stack([1 - 2 * (y * y + z * z), 2 * (x * y + w * z), 2 * (x * z - w * y)])
    return angles_of_axes_deg(forward, right, 1 - 2 * (x * x + y * y))


def rotate(q: Array, vector: Array) -> Array:
    """Shape (3, n): vectors (3, n) turned by q (4, n)."""
    w, x, y, z = q
    a, b, c = vector
    # v + w·t + q×t with t = 2 q×v
    s, t, u = 2 * (y * c - z * b), 2 * (z * a - x * c), 2 * (x * b - y * a)
    return np.stack([a + w * s + y * u - z * t, b + w * t + z * s - x * u, c + w * u + x * t - y * s])


def running_product(start: Array, steps: Array) -> Array:
    """Shape (4, n + 1): start, start ⊗ s₁, start ⊗ s₁ ⊗ s₂ … for ``steps`` (4, n).

    A product is associative: rows of steps are multiplied up side by side, then each row by what came before.
    With q = α + βj (α = w + ix, β = y + iz) a product is four complex ones.
    """
    count = steps.shape[1]
    length = max(1, round(np.sqrt(count)))
    rows = -(-count // length)
    a, b = _side_by_side(steps, rows, length)
    c, d = np.conj(a), np.conj(b)
    work = np.empty((2, rows), dtype=np.complex128)
    for i in range(1, length):
        _complex_product((a[i - 1], b[i - 1]), (a[i], b[i], c[i], d[i]), work)
        a[i], b[i] = work
    before = _one_after_the_other(start, a[-1], b[-1])
    result = np.empty((4, count + 1))
    result[:, 0] = start
    # (2, rows, length): in the order of the steps again
    a, b = np.ascontiguousarray(a.T), np.ascontiguousarray(b.T)
    whole = np.empty((2, rows, length), dtype=np.complex128)
    _complex_product(before, (a, b, np.conj(a), np.conj(b)), whole)
    for pair, values in zip((result[:2], result[2:]), whole.reshape(2, -1)[:, :count], strict=True):
        pair[0, 1:], pair[1, 1:] = values.real, values.imag
    return result


def _one_after_the_other(start: Array, a: Complex, b: Complex) -> Complex:
    """Shape (2, rows, 1): what stands before each row, of the rows' whole products; of length 1 again."""
    p, q = complex(start[0], start[1]), complex(start[2], start[3])
    before = []
    for r, s in zip(a.tolist(), b.tolist(), strict=True):
        before.append((p, q))
        p, q = p * r - q * s.conjugate(), p * s + q * r.conjugate()
        length = math.hypot(p.real, p.imag, q.real, q.imag)
        p, q = p / length, q / length
    return np.array(before, dtype=np.complex128).T[..., np.newaxis]


def _side_by_side(steps: Array, rows: int, length: int) -> tuple[Complex, Complex]:
    """α and β, each (length, rows): the steps of all rows at one place in the row are one run of memory. The
    last row is filled up with no rotation."""
    padded = np.zeros((2, rows * length), dtype=np.complex128)
    padded[0] = 1.0
    count = steps.shape[1]
    padded.real[:, :count], padded.imag[:, :count] = steps[::2], steps[1::2]
    a, b = padded.reshape(2, rows, length)
    return np.ascontiguousarray(a.T), np.ascontiguousarray(b.T)


def _complex_product(
    left: Sequence[Complex] | Complex, right: tuple[Complex, Complex, Complex, Complex], out: Complex
) -> None:
    """(α, β) ⊗ (α, β, their conjugates) into ``out`` (2, …)."""
    p, q = left
    a, b, c, d = right
    np.multiply(p, a, out=out[0])
    out[0] -= q * d
    np.multiply(p, b, out=out[1])
    out[1] += q * c
