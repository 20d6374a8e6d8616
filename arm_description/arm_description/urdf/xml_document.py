"""Parses XML safely: no entities, no network, bounded size; keeps line numbers.

Readers get an `XmlElement`; who changes a document gets lxml's own elements from `parse_xml`.
"""

import math
import re
from abc import ABC, abstractmethod
from collections.abc import Iterator
from typing import Generic, Self, TypeVar

import lxml.etree as etree

from arm_description.errors import XmlError

MAX_BYTES = 20_000_000

UNDECLARED = "undeclared:"
"""Start of the namespace for a prefix that the text uses without declaring it."""
MAX_PREFIXES = 50
"""How many missing prefixes are declared."""

_UNDECLARED = re.compile(r"Namespace prefix (\S+) (?:for \S+ )?on \S+ is not defined")
_FIRST_TAG = re.compile(rb"(?:\s+|<!--.*?-->|<\?.*?\?>)*<[^\s/>!?]+", re.DOTALL)
_DECLARATION = re.compile(r"\A\ufeff?\s*(<\?xml\s[^>]*\?>)?\s*")
_POSITION = re.compile(r"(, line \d+, column \d+)+\Z")


def parse_xml(text: str, source: str = "robot_description") -> etree._Element:
    """Parse XML and return its root element, or the only <robot> in a <urdf>.

    Comments and processing instructions are dropped.

    Elements without a prefix are in no namespace, even if the document declares a default one as
    urdf.xsd does. Elements with a prefix keep its namespace; an undeclared prefix, which ROS's own
    parser accepts because it does not know namespaces, gets one that begins with `UNDECLARED`.

    Args:
        text: the document. The encoding in its declaration is ignored; blanks before the
            declaration are allowed, as in a YAML file's block text.
        source: name of the text in messages.

    Raises:
        XmlError: the text is not well-formed, larger than 20 MB, or has a DOCTYPE (whose entities
            could expand without bound or read files). The message names source and line.
    """
    root = _checked(text, source)
    for element in root.iter("*"):
        if element.prefix is None:
            element.tag = etree.QName(element).localname
    etree.cleanup_namespaces(root)
    inner = list(root.iterchildren("*"))
    if root.tag != "urdf" or len(inner) != 1 or inner[0].tag != "robot":
        return root
    root.remove(inner[0])
    return inner[0]


def finite_number(word: str) -> float:
    """Return a number in decimal notation; nan if the text is not one, or not finite."""
    # float() would also accept "1_000" and digits of other scripts.
    try:
        value = float(word) if word.isascii() and "_" not in word else math.nan
    except ValueError:
        return math.nan
    return value if math.isfinite(value) else math.nan


HomeT = TypeVar("HomeT")


class XmlElement(ABC, Generic[HomeT]):
    """An element of a parsed text, for reading.

    Attributes:
        home: what belongs to the whole text.
        tag: the name as written, including a prefix: <x:link> is not a link, whatever x stands for.
        line: line in the text.
        attributes: the attributes; a key with a prefix begins with its namespace, "{...}".
        content: the text before the first child, without surrounding blanks.
        elements: the child elements, in document order.
        parent: the element that contains it; None for the outermost one.
        is_foreign: whether it has an undeclared prefix or xacro's.
    """

    __slots__ = (
        *("attributes", "content", "elements", "home", "is_foreign", "line", "parent", "tag"),
    )
    elements: tuple[Self, ...]

    def __init__(self, element: etree._Element, home: HomeT, parent: Self | None = None) -> None:
        """Copy an element of lxml's, with all that is in it."""
        tag: str = element.tag
        prefix, text, kind = "", element.text, type(self)
        self.is_foreign = False
        if tag[0] == "{":
            prefix = element.prefix or ""
            self.is_foreign = prefix == "xacro" or (
                bool(prefix) and tag.startswith(f"{{{UNDECLARED}")
            )
            tag = tag.rpartition("}")[2]
        self.home = home
        self.tag = f"{prefix}:{tag}" if prefix else tag
        self.line: int = element.sourceline or 0
        self.attributes: dict[str, str] = dict(element.items())
        self.content = text.strip() if text else ""
        self.parent = parent
        self.elements = tuple([kind(child, home, self) for child in element])

    @classmethod
    def parse(cls, text: str, source: str, home: HomeT) -> Self:
        """Parse a text as `parse_xml` does; a <robot> in a <urdf> has that as its parent."""
        root = cls(_checked(text, source), home)
        is_wrapped = root.tag == "urdf" and [inner.tag for inner in root.elements] == ["robot"]
        return root.elements[0] if is_wrapped else root

    @property
    @abstractmethod
    def name(self) -> str:
        """The name by which messages call it; "" if they call it by its tag."""

    @property
    def label(self) -> str:
        """Its name in messages: "link 'can'", or "<box> of link 'can'"."""
        if self.name:
            return f"{self.tag} '{self.name}'"
        owner = self.parent
        while owner is not None and not owner.name:
            owner = owner.parent
        return f"<{self.tag}> of {owner.label}" if owner else f"<{self.tag}>"

    @abstractmethod
    def error(self, problem: str) -> Exception:
        """Return an error that names the line, the element and its owner."""

    def get(self, attribute: str, default: str = "") -> str:
        """Return an attribute as it is written."""
        return self.attributes.get(attribute, default)

    def first(self, tag: str) -> Self | None:
        """Return the first child with this tag, or None."""
        for child in self.elements:
            if child.tag == tag:
                return child
        return None

    def find(self, path: str) -> list[Self]:
        """Return the elements at a path such as "joint/mimic", in document order."""
        found: list[Self] = [self]
        for tag in path.split("/"):
            found = [child for element in found for child in element.elements if child.tag == tag]
        return found

    def inside(self) -> Iterator[Self]:
        """Yield all elements in this one, in document order."""
        waiting = [*reversed(self.elements)]
        while waiting:
            element = waiting.pop()
            yield element
            waiting.extend(reversed(element.elements))

    def numbers_of(self, text: str, counts: tuple[int, ...], where: str = "") -> tuple[float, ...]:
        """Return the numbers of a text; `where` is "rpy=" for an attribute."""
        words = text.split()
        if len(words) in counts and text.isascii() and "_" not in text:
            try:
                numbers = tuple(map(float, words))
            except ValueError:
                numbers = (math.nan,)
            if math.isfinite(sum(numbers)):
                return numbers
        # What is wrong with them is looked for one by one.
        if len(words) not in counts:
            wanted = " or ".join(map(str, counts))
            raise self.error(f"has {where}'{' '.join(words)}': {len(words)} values, not {wanted}")
        return tuple([self.number_of(word, where) for word in words])

    def number_of(self, word: str, where: str = "") -> float:
        """Return the number that a word is."""
        value = finite_number(word)
        if value != value:  # nan
            raise self.error(f"has {where}'{word}', which is not a finite number")
        return value


def _checked(text: str, source: str) -> etree._Element:
    """Parse a text and return its outermost element, with the namespaces that it has."""
    # Remove the declaration but keep its line breaks, so that line numbers stay the same.
    body = _DECLARATION.sub(lambda match: "\n" * match.group().count("\n"), text, count=1)
    if not body.strip():
        raise XmlError(f"{source} is empty")
    try:
        data = body.encode("utf-8")
    except UnicodeEncodeError as error:
        line = 1 + body.count("\n", 0, error.start)
        raise XmlError(f"{source}, line {line}: a character that is not Unicode") from error
    if len(data) > MAX_BYTES:
        raise XmlError(f"{source} has {len(data)} bytes; at most {MAX_BYTES} are accepted")
    try:
        root = _parsed(data)
    except etree.XMLSyntaxError as error:
        problem = _POSITION.sub("", error.msg)
        raise XmlError(f"{source}, line {error.lineno or 1}: not XML: {problem}") from error
    if root.getroottree().docinfo.internalDTD is not None:
        raise XmlError(f"{source} has a DOCTYPE, which is not accepted; remove it")
    return root


def _parsed(data: bytes) -> etree._Element:
    """Parse a document, declaring its undeclared prefixes."""
    for _ in range(MAX_PREFIXES):
        try:
            return etree.fromstring(data, _parser())
        except etree.XMLSyntaxError as error:
            missing = _UNDECLARED.match(error.msg)
            first = _FIRST_TAG.match(data)
            if missing is None or first is None:
                raise
            prefix = missing.group(1)
            declaration = f' xmlns:{prefix}="{UNDECLARED}{prefix}"'.encode()
            data = data[: first.end()] + declaration + data[first.end() :]
    return etree.fromstring(data, _parser())


def _parser() -> etree.XMLParser:
    return etree.XMLParser(
        encoding="utf-8",
        resolve_entities=False,
        no_network=True,
        load_dtd=False,
        huge_tree=False,
        remove_comments=True,
        remove_pis=True,
    )
