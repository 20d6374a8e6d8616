"""Stand-ins for the channel between the page's panels and its browsers."""

from arm_viewer.channel import Message


class FakeBrowser:
    """Keeps what it is sent; it takes no frame unless it keeps up."""

    def __init__(self):
        self.is_connected = self.keeps_up = True
        self.sent, self.frames = [], []

    @property
    def told(self):
        return [fields for _, fields in self.sent]

    def send(self, kind, fields):
        self.sent.append((kind, fields))

    def send_bytes(self, kind, payload):
        if self.keeps_up:
            self.frames.append(payload)
        return self.keeps_up


class FakeChannel(FakeBrowser):
    """The channel, and its only browser unless a test has others.

    Attributes:
        changing: kinds of messages that a browser may not send if it may only look.
        kept: what a browser that comes later is sent, by kind.
    """

    def __init__(self):
        super().__init__()
        self.is_used = True
        self.handlers, self.kept, self.changing = {}, {}, set()

    @property
    def kinds(self):
        return [kind for kind, _ in self.sent]

    def on(self, kind, handler, *, changes=True):
        self.handlers[kind] = handler
        if changes:
            self.changing.add(kind)

    def send(self, kind, fields, *, keep=False):
        super().send(kind, fields)
        if keep:
            self.kept[kind] = fields

    def take(self, kind, browser=None, **fields):
        """Let a message come from a browser."""
        self.handlers[kind](Message(kind, fields), browser or self)
