"""What a controller's wish comes to."""

import pytest

from arm_control.interface_configuration import InterfaceConfiguration as Wish

EXISTING = ("j0/position", "j0/velocity", "j1/position", "tool/grip")


@pytest.mark.parametrize(
    ("wish", "names"),
    [
        (Wish.none(), ()),
        (Wish.all(), EXISTING),
        (Wish.individual(["j1/position", "x/y"]), ("j1/position", "x/y")),
        (Wish.individual_best_effort(["tool/grip", "x/y"]), ("tool/grip",)),
        (Wish.regex([r"j\d/position"]), ("j0/position", "j1/position")),
        (Wish.regex(["position"]), ()),
    ],
)
def test_names(wish: Wish, names: tuple[str, ...]) -> None:
    assert wish.resolve(EXISTING) == names
