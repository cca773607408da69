"""Where the oracle's atoms start and how fast, in plain Python; imports nothing of the package."""

from __future__ import annotations

import math
from typing import Any

Vector = tuple[float, float, float]
Data = dict[str, Any]


def place(group: Data) -> tuple[list[Vector], list[Vector]]:
    """Return the initial positions and velocities of a group's atoms, copy after copy."""
    position, velocity = _place_first(group)
    for copies in group["copies"]:
        moved = [_copy(position, velocity, copies, number) for number in range(copies["count"])]
        position = [place for places, _ in moved for place in places]
        velocity = [speed for _, speeds in moved for speed in speeds]
    return position, velocity


def _copy(
    position: list[Vector], velocity: list[Vector], copies: Data, number: int
) -> tuple[list[Vector], list[Vector]]:
    """Return where the atoms of a copy start and how fast; number 0 is the group as it was."""
    if number == 0:
        return position, velocity
    if copies["step"] is not None:
        return [add(place, _times(number, copies["step"])) for place in position], velocity
    origin = copies["through"] or (0.0, 0.0, 0.0)
    each = 360.0 / copies["count"] if copies["degrees"] is None else copies["degrees"]
    degrees = number * each
    turned = [add(origin, _rotated(sub(place, origin), copies["axis"], degrees)) for place in position]
    return turned, [_rotated(speed, copies["axis"], degrees) for speed in velocity]


def _place_first(group: Data) -> tuple[list[Vector], list[Vector]]:
    if group["shape"] == "string":
        group = _as_steps(group)
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


def _as_steps(group: Data) -> Data:
    """Say of a string where its middle is and how far its atoms are apart, however it was written."""
    count, step, first, last = group["count"], group["step"], group["from_"], group["to"]
    if count is None:
        count = 1 + max(1, round(math.sqrt(square(sub(last, first))) / group["spacing"]))
    if step is None:
        x, y, z = sub(last, first)
        step = (x / (count - 1), y / (count - 1), z / (count - 1))
    centre = group["centre"] or (0.0, 0.0, 0.0)
    if first is not None:
        centre = add(first, _times((count - 1) / 2, step))
    return {**group, "count": count, "step": step, "centre": centre}


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
        case "ball":
            return _ball(group)
        case "atoms":
            middle = _centroid(list(group["positions"]))
            return [sub(position, middle) for position in group["positions"]]
    raise ValueError(group["shape"])


def _on_circle(i: int, group: Data) -> Vector:
    angle = 2.0 * math.pi * i / group["count"]
    one, other = quantise(group["radius"] * math.cos(angle)), quantise(group["radius"] * math.sin(angle))
    return {"x": (0.0, one, other), "y": (one, 0.0, other), "z": (one, other, 0.0)}[group["axis"]]


def _ball(group: Data) -> list[Vector]:
    """A point, and spheres around it; a sphere is circles from its south pole to its north pole."""
    radius, spacing = group["radius"], group["spacing"]
    n_spheres = max(1, round(radius / spacing))
    atoms = [] if group["hollow"] else [(0.0, 0.0, 0.0)]
    for sphere in range(1, n_spheres + 1):
        if group["hollow"] and sphere < n_spheres:
            continue
        size = radius * (sphere / n_spheres)
        last = max(2, round(math.pi * (size / spacing)))
        for circle in range(last + 1):
            latitude = math.pi * circle / last
            if circle in (0, last):
                atoms.append((0.0, 0.0, size if circle else -size))
                continue
            wide, high = quantise(size * math.sin(latitude)), quantise(-size * math.cos(latitude))
            on_circle = max(3, round(2.0 * math.pi * (wide / spacing)))
            for i in range(on_circle):
                turn = 2.0 * math.pi * i / on_circle
                atoms.append((quantise(wide * math.cos(turn)), quantise(wide * math.sin(turn)), high))
    return atoms


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
