"""What all panels share."""

import asyncio
import inspect

from arm_viewer.panels.panel import distinct, in_order


def test_a_callback_is_served_in_order_and_at_once():
    served = []
    callback = in_order(served.append)
    # viser calls what is no coroutine function in a pool of threads.
    assert inspect.iscoroutinefunction(callback)

    async def drag() -> list[int]:
        for value in range(100):
            await callback(value)
        return list(served)

    assert asyncio.run(drag()) == list(range(100))


def test_robots_with_a_link_of_one_name_give_one_option():
    assert distinct(["(none)", "world", "left_hand", "world", "right_hand"]) == (
        "(none)",
        "world",
        "left_hand",
        "right_hand",
    )
