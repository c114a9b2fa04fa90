"""Keys of caches by identity."""

from __future__ import annotations

from shotc.geom.same import Same


def test_a_key_is_that_of_one_object_and_of_no_equal_one() -> None:
    one, equal = [1.0, 2.0], [1.0, 2.0]
    assert Same(one) == Same(one)
    assert Same(one) != Same(equal)
    assert Same(one) != one
    assert {Same(one): "kept"}.get(Same(one)) == "kept"
