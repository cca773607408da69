"""Where the oracle's atoms start and how fast, in plain Python; imports nothing of the package."""

from __future__ import annotations

import math
from typing import Any

Vector = tuple[float, float, float]
Data = dict[str, Any]


def place(group: Data) -> tuple[list[Vector], list[Vector]]:
    """Return the initial positions and velocities of a group's atoms."""
    offsets = _offsets(group)
    for turn in group["rotate"]:
        offsets = [_rotated(offset, turn["axis"], turn["degrees"]) for offset in offsets]
    if group["shape"] == "atoms" and group["centre"] is None:
        middle = _centroid(list(group["positions"]))
        position = [add(middle, offset) for offset in offsets] if group["rotate"] else list(group["positions"])
    else:
        position = [add(group["centre"], offset) for offset in offsets]
    velocity = [group["velocity"]] * len(offsets)
    if group["spin"]:
        rate, axis = group["spin"]["rate"], unit(group["spin"]["axis"])
        turning = [cross(axis, offset) for offset in offsets]
        velocity = [add(v, (rate * x, rate * y, rate * z)) for v, (x, y, z) in zip(velocity, turning, strict=True)]
    return position, velocity


def _offsets(group: Data) -> list[Vector]:
    match group["shape"]:
        case "string":
            return [_times(_middle_out(i, group["count"]), group["step"]) for i in range(group["count"])]
        case "ring":
            return [_on_circle(i, group) for i in range(group["count"])]
        case "polygon":
            return _polygon(group)
        case "plane":
            nx, ny = group["counts"]
            return [
                add(_times(_middle_out(x, nx), group["step_x"]), _times(_middle_out(y, ny), group["step_y"]))
                for y in range(ny)
                for x in range(nx)
            ]
        case "block":
            nx, ny, nz = group["counts"]
            d = group["spacing"]
            return [
                (_middle_out(x, nx) * d, _middle_out(y, ny) * d, _middle_out(z, nz) * d)
                for z in range(nz)
                for y in range(ny)
                for x in range(nx)
            ]
        case "atoms":
            middle = _centroid(list(group["positions"]))
            return [sub(position, middle) for position in group["positions"]]
    raise ValueError(group["shape"])


def _on_circle(i: int, group: Data) -> Vector:
    angle = 2.0 * math.pi * i / group["count"]
    one, other = quantise(group["radius"] * math.cos(angle)), quantise(group["radius"] * math.sin(angle))
    return {"x": (0.0, one, other), "y": (one, 0.0, other), "z": (one, other, 0.0)}[group["axis"]]


def _polygon(group: Data) -> list[Vector]:
    corners = list(group["corners"])
    points = []
    for start, stop in zip(corners, [*corners[1:], corners[0]], strict=True):
        dx, dy, dz = (end - begin for begin, end in zip(start, stop, strict=True))
        n_steps = max(1, round(math.sqrt(dx * dx + dy * dy + dz * dz) / group["spacing"]))
        points += [add(start, _times(i / n_steps, sub(stop, start))) for i in range(n_steps)]
    middle = _centroid(points)
    return [_quantised(sub(point, middle)) for point in points]


def _rotated(offset: Vector, axis: Vector, degrees: float) -> Vector:
    """Turn by Rodrigues' formula: cos·o + sin·(a × o) + (1 − cos)·(a·o)·a."""
    angle = math.radians(degrees)
    cosine, sine = math.cos(angle), math.sin(angle)
    a = unit(axis)
    along = (a[0] * offset[0] + a[1] * offset[1]) + a[2] * offset[2]
    turned = add(_times(cosine, offset), _times(sine, cross(a, offset)))
    return _quantised(add(turned, _times((1.0 - cosine) * along, a)))


def _middle_out(i: int, count: int) -> float:
    return i - (count - 1) / 2


def _centroid(points: list[Vector]) -> Vector:
    total = (0.0, 0.0, 0.0)
    for point in points:
        total = add(total, point)
    return (total[0] / len(points), total[1] / len(points), total[2] / len(points))


def _quantised(vector: Vector) -> Vector:
    return (quantise(vector[0]), quantise(vector[1]), quantise(vector[2]))


def quantise(value: float) -> float:
    """Round to a multiple of 2⁻⁴⁰."""
    return round(value * 2.0**40) / 2.0**40


def unit(axis: Vector) -> Vector:
    """Return an axis scaled to length one, by way of its largest component so that nothing overflows."""
    largest = max(abs(part) for part in axis)
    x, y, z = (part / largest for part in axis)
    length = math.sqrt((x * x + y * y) + z * z)
    return (x / length, y / length, z / length)


def add(a: Vector, b: Vector) -> Vector:
    """Return a + b."""
    return (a[0] + b[0], a[1] + b[1], a[2] + b[2])


def sub(a: Vector, b: Vector) -> Vector:
    """Return a − b."""
    return (a[0] - b[0], a[1] - b[1], a[2] - b[2])


def _times(factor: float, vector: Vector) -> Vector:
    return (factor * vector[0], factor * vector[1], factor * vector[2])


def cross(a: Vector, b: Vector) -> Vector:
    """Return a × b."""
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def square(a: Vector) -> float:
    """Return (x·x + y·y) + z·z."""
    return (a[0] * a[0] + a[1] * a[1]) + a[2] * a[2]
