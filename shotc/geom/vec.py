"""Vectors of plain numbers: on the map, and in space. Plain Python, so that `check` can use it."""

Vec2 = tuple[float, float]
Vec3 = tuple[float, float, float]


def plus(a: Vec3, b: Vec3) -> Vec3:
    """Return the sum of two vectors."""
    return (a[0] + b[0], a[1] + b[1], a[2] + b[2])


def minus(a: Vec3, b: Vec3) -> Vec3:
    """Return the vector from b to a."""
    return (a[0] - b[0], a[1] - b[1], a[2] - b[2])
