"""The numbers that a topic's publishers give to their messages, 1, 2, 3 ..., each for itself."""

from collections.abc import Callable


class WriterNumbers:
    """Finds out how many messages of a topic are missing.

    Which publisher sent a message is not known, so a number belongs to whoever it fits best. With
    one publisher, or several whose numbers are far apart, the count is exact; where numbers of
    several overlap it is an estimate. What a publisher sent before the first message that came, or
    after the last one, is not missing.
    """

    def __init__(self, count_publishers: Callable[[], int]) -> None:
        """Begin.

        Args:
            count_publishers: how many there are now; asked where a number is out of turn.
        """
        self._count_publishers = count_publishers
        self._latest: list[int] = []

    def missing_before(self, number: int) -> int:
        """Take the number of a message; return how many before it did not come."""
        latest = self._latest
        if number - 1 in latest:
            latest.remove(number - 1)
            latest.append(number)
            return 0
        before = [other for other in latest if other < number]
        if not before or len(latest) < self._count_publishers():
            # The first that comes from a publisher; one that starts anew counts from 1 again.
            latest.append(number)
            return 0
        last = max(before)
        latest.remove(last)
        latest.append(number)
        return number - last - 1
