"""What the summary of a show says of arcs and lattices."""

from __future__ import annotations

from shotc.cli.show_facts import beside, dense, layered


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


def test_what_flies_otherwise_for_another_s_sake_is_told() -> None:
    stats = [("fleet swarm/ring home later", 2.0), ("fleet swarm arcs", 1.0), ("fleet a led round", 0.5)]
    assert list(beside(stats)) == [
        "swarm/ring flies home 2.0 s later than it could: another one is in its way",
        "a flies round others, 0.5 s longer: another one is in its way",
    ]
