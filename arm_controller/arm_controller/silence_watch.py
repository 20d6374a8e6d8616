"""Notices that a topic has fallen silent, once each time."""

PATIENCE_S = 5.0


class SilenceWatch:
    """Times are of any steady clock (s).

    Args:
        now_s: the present time, from which the first message is awaited.
    """

    def __init__(self, now_s: float) -> None:
        self._since_s = now_s
        self._noticed = False

    def hear(self, now_s: float) -> None:
        """Take note of a message."""
        self._since_s = now_s
        self._noticed = False

    def notices(self, now_s: float) -> bool:
        """Return True once in each silence, when it has become too long."""
        if self._noticed or now_s - self._since_s < PATIENCE_S:
            return False
        self._noticed = True
        return True
