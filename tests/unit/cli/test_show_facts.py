"""What the summary of a show says of arcs and lattices."""

from __future__ import annotations

from shotc.cli.show_facts import dense, layered


def test_arcs_and_lattices_are_told_and_nothing_else() -> None:
    stats = [
        ("fleet left arcs", 1.0),
        ("fleet right arcs", 0.0),
        ("fleet right drones", 9.0),
        ("goals shapes/2 lattice", 104.0),
        ("goals shapes/1 frames", 1.0),
    ]
    arcs, lattice = dense(stats)
    assert arcs.startswith("1 move of left on arcs")
    assert lattice.startswith("picture 2 of shapes is a lattice of 104 lights")


def test_layers_are_told_with_what_a_seat_beside_sees() -> None:
    at = "goals word/3 layers"
    stats = [(at, 3.0), (f"{at} deep m", 2.45), (f"{at} seen m", 0.87), (f"{at} aside m", 0.33)]
    (told,) = layered(stats)
    assert "2.45 m deep, in 3 layers" in told
    assert "0.87 m apart" in told
    assert "0.33 m aside" in told
