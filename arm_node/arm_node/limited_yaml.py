"""Reads YAML from users within limits; every error is a `YamlError` with one sentence.

Ten lines of aliases to aliases can stand for millions of values, and ten thousand brackets overflow
the interpreter's stack, so the size of a text is checked before any value is created.
"""

from collections.abc import Iterator
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    import yaml

MAX_CHARACTERS = 20_000_000
MAX_VALUES = 1_000_000
"""Maximum keys, values and collections; each alias counts as everything it stands for."""
MAX_DEPTH = 64


class YamlError(ValueError):
    """The text is not YAML, or is refused; the message is one line, with the place if known."""


def load_yaml(text: str) -> Any:
    """Return the value of a YAML text, None for an empty one.

    Raises:
        YamlError: the text is not YAML, or exceeds a limit.
    """
    documents = load_yaml_documents(text)
    if len(documents) > 1:
        raise YamlError(f"it has {len(documents)} documents instead of one")
    return documents[0] if documents else None


def load_yaml_documents(text: str) -> list[Any]:
    """Return the values of all documents of a YAML text; raises like `load_yaml`."""
    return _guarded(text, lambda yaml: list(yaml.load_all(text, Loader=_loader())))


def compose_yaml_documents(text: str, loader: Any) -> "list[yaml.Node]":
    """Return the nodes of all documents of a YAML text; raises like `load_yaml`."""
    return _guarded(text, lambda yaml: list(yaml.compose_all(text, Loader=loader)))


def check_yaml(text: str) -> None:
    """Raise like `load_yaml`; for a library that loads the text itself."""
    _guarded(text, lambda yaml: None)


def _guarded(text: str, load: Any) -> Any:
    import yaml  # Imported here, because most processes read no YAML.

    try:
        _check(text)
        return load(yaml)
    except YamlError:
        raise
    except yaml.YAMLError as error:
        raise YamlError(_described(error)) from error
    except RecursionError as error:
        raise YamlError("its values are nested too deep") from error
    # Errors of constructors: `!!int ""` is an IndexError, `!!bool x` a KeyError.
    except (ArithmeticError, AttributeError, LookupError, TypeError, ValueError) as error:
        raise YamlError(f"a value does not fit its type: {' '.join(str(error).split())}") from error


def _loader() -> Any:
    import yaml

    return getattr(yaml, "CSafeLoader", yaml.SafeLoader)


def _check(text: str) -> None:
    if len(text) > MAX_CHARACTERS:
        raise YamlError(f"it has {len(text)} characters; at most {MAX_CHARACTERS} are read")
    try:
        text.encode()
    except UnicodeEncodeError as error:
        shown = f"{text[error.start]!r} at character {error.start + 1}"
        raise YamlError(f"{shown} is not valid UTF-8") from error
    measure = _Measure()
    for event in _events(text):
        measure.take(event)


def _events(text: str) -> Iterator[Any]:
    import yaml

    yield from yaml.parse(text, Loader=_loader())


class _Measure:
    """Counts the values in a stream of parser events, and how deep they are nested."""

    def __init__(self) -> None:
        self._total = 0
        # The collections that are open: anchor, values before it, levels inside it.
        self._open: list[list[Any]] = []
        self._anchors: dict[str, tuple[int, int]] = {}

    def take(self, event: Any) -> None:
        """Count one event; raise a YamlError if a limit is exceeded."""
        import yaml

        if isinstance(event, yaml.DocumentStartEvent):
            self._anchors = {}
        elif isinstance(event, yaml.AliasEvent):
            self._alias(event)
        elif isinstance(event, yaml.CollectionEndEvent):
            anchor, before, height = self._open.pop()
            self._keep(anchor, self._total - before, height + 1)
            self._rise(height + 1)
        elif isinstance(event, yaml.CollectionStartEvent):
            self._open.append([event.anchor, self._total, 0])
            self._count(event, 1, 0)
        elif isinstance(event, yaml.ScalarEvent):
            self._count(event, 1, 0)
            self._keep(event.anchor, 1, 0)

    def _alias(self, event: Any) -> None:
        if any(anchor == event.anchor for anchor, *_ in self._open):
            raise YamlError(f"{_place(event.start_mark)}: '*{event.anchor}' contains itself")
        # The loader reports an alias without an anchor.
        values, height = self._anchors.get(event.anchor, (1, 0))
        self._count(event, values, height)
        self._rise(height)

    def _keep(self, anchor: str | None, values: int, height: int) -> None:
        if anchor is not None:
            self._anchors[anchor] = (values, height)

    def _rise(self, height: int) -> None:
        if self._open:
            self._open[-1][2] = max(self._open[-1][2], height)

    def _count(self, event: Any, values: int, height: int) -> None:
        self._total += values
        if self._total > MAX_VALUES:
            raise YamlError(
                f"{_place(event.start_mark)}: it has more than {MAX_VALUES} values, "
                "including aliases"
            )
        if len(self._open) + height > MAX_DEPTH:
            raise YamlError(
                f"{_place(event.start_mark)}: its values are nested more than {MAX_DEPTH} deep"
            )


def _described(error: Exception) -> str:
    mark = getattr(error, "problem_mark", None)
    problem = getattr(error, "problem", None) or " ".join(str(error).split())
    return f"{_place(mark)}: {problem}" if mark else str(problem)


def _place(mark: Any) -> str:
    return f"line {mark.line + 1}, column {mark.column + 1}"
