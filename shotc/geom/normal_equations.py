"""A least-squares step with few unknowns. Plain Python, because `check` uses it."""


def damped_step(normal: list[list[float]], gradient: list[float], damping: float) -> list[float]:
    """Solve damped normal equations (Marquardt) by Gaussian elimination with pivoting; return the n unknowns.

    normal : J^T J, n rows of n; gradient : right-hand side, n values; damping : share added to the diagonal
    """
    n = len(gradient)
    rows = [[*normal[i], gradient[i]] for i in range(n)]
    for i in range(n):
        rows[i][i] += damping * max(normal[i][i], 1e-9)
    for i in range(n):
        best = max(range(i, n), key=lambda k: abs(rows[k][i]))
        rows[i], rows[best] = rows[best], rows[i]
        pivot = rows[i][i] or 1e-300
        for k in range(i + 1, n):
            share = rows[k][i] / pivot
            rows[k] = [a - share * b for a, b in zip(rows[k], rows[i], strict=True)]
    step = [0.0] * n
    for i in reversed(range(n)):
        rest = rows[i][n] - sum(rows[i][k] * step[k] for k in range(i + 1, n))
        step[i] = rest / (rows[i][i] or 1e-300)
    return step
