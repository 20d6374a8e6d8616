"""Changes small valid files as nobody would: structure first, then text, then bytes."""

import copy
import random
import re
from collections.abc import Callable

import lxml.etree as etree

NUMBERS = (
    *("0", "-0", "-1", "1", "2", "7", "1e-320", "1e308", "-1e308", "1e400", "nan", "inf", "-inf"),
    *("999999999999", "2147483648", "-2147483649", "0x10", "1_0", "٣", "1,5", "1 2", "1 2 3 4"),
    *("0 0 0", "1e300 1e300 1e300", "nan nan nan", "", " ", "3" * 400, "20000", "100000"),
)
WORDS = (
    *("", "world", "base", "arm", "a" * 3000, "ä", "../../x", "/dev/zero", "/dev/null", "true"),
    *("package://a/b", "model://a", "file:///", "${1/0}", "$(find x)", "$(arg x)", "$(env HOME)"),
    *("*a", "&a", "{", "[", "]", "}", "- ", ": ", "!!int", "!!bool x", "null", "~", "#", "'", '"'),
    *("<", ">", "&lt;", "&e;", "<!--", "]]>", "\x00", "\x1b[31m", "\n", "\t", "%s", "\ufeff", "😀"),
    *(
        "joint",
        "mesh",
        "plane",
        "hfield",
        "sdf",
        "free",
        "ball",
        "continuous",
        "planar",
        "floating",
    ),
)
TOKEN = re.compile(r"""[\w.+-]+|[^\w\s]|\s+""")


def mutant(seeds: tuple[bytes, ...], chance: random.Random, is_xml: bool) -> bytes:
    """Return one of the seeds with a few changes.

    Args:
        seeds: valid files.
        chance: decides everything.
        is_xml: whether elements can be told from text.
    """
    data = chance.choice(seeds)
    for _ in range(chance.choice((1, 1, 2, 3, 6))):
        kind = chance.random()
        if is_xml and kind < 0.7:
            data = _xml(data, chance)
        elif kind < 0.9:
            data = _text(data, chance)
        else:
            data = _bytes(data, chance)
    return data


def mutant_of_bytes(seeds: tuple[bytes, ...], chance: random.Random) -> bytes:
    """Return one of the seeds with a few bytes changed, for formats without words."""
    data = chance.choice(seeds)
    for _ in range(chance.choice((1, 1, 2, 4))):
        data = _bytes(data, chance)
    return data


def _xml(data: bytes, chance: random.Random) -> bytes:
    try:
        root = etree.fromstring(data, etree.XMLParser(resolve_entities=False, huge_tree=True))
    except (etree.XMLSyntaxError, ValueError):
        return _text(data, chance)
    elements = list(root.iter("*"))
    chosen = chance.choice(elements)
    try:
        chance.choice(XML_CHANGES)(elements, chosen, chance)
    except ValueError:
        return data  # XML itself cannot hold it.
    return etree.tostring(root)


def _drop(_: list[etree._Element], chosen: etree._Element, __: random.Random) -> None:
    if chosen.getparent() is not None:
        chosen.getparent().remove(chosen)


def _duplicate(_: list[etree._Element], chosen: etree._Element, chance: random.Random) -> None:
    for _ in range(chance.choice((1, 1, 2, 30))):
        if chosen.getparent() is not None:
            chosen.getparent().append(_copy(chosen))


def _nest(elements: list[etree._Element], chosen: etree._Element, chance: random.Random) -> None:
    chance.choice(elements).append(_copy(chosen))


def _deepen(_: list[etree._Element], chosen: etree._Element, chance: random.Random) -> None:
    inner = chosen
    for _ in range(chance.choice((1, 5, 300))):
        inner = etree.SubElement(inner, chosen.tag, dict(chosen.attrib))


def _swap(elements: list[etree._Element], chosen: etree._Element, chance: random.Random) -> None:
    other = chance.choice(elements)
    chosen.tag, other.tag = other.tag, chosen.tag


def _attribute(_: list[etree._Element], chosen: etree._Element, chance: random.Random) -> None:
    key = chance.choice([*chosen.attrib, "name"])
    chosen.set(key, chance.choice(NUMBERS if chance.random() < 0.6 else WORDS))


def _lose(_: list[etree._Element], chosen: etree._Element, chance: random.Random) -> None:
    if chosen.attrib:
        del chosen.attrib[chance.choice(list(chosen.attrib))]


def _steal(elements: list[etree._Element], chosen: etree._Element, chance: random.Random) -> None:
    chosen.attrib.update(dict(chance.choice(elements).attrib))


def _say(_: list[etree._Element], chosen: etree._Element, chance: random.Random) -> None:
    chosen.text = chance.choice(NUMBERS if chance.random() < 0.7 else WORDS)


XML_CHANGES: tuple[Callable[[list[etree._Element], etree._Element, random.Random], None], ...] = (
    *(_drop, _duplicate, _nest, _deepen, _swap, _attribute, _attribute, _attribute),
    *(_lose, _steal, _say, _say),
)


def _copy(element: etree._Element) -> etree._Element:
    return copy.deepcopy(element)


def _text(data: bytes, chance: random.Random) -> bytes:
    tokens = TOKEN.findall(data.decode("utf-8", "surrogateescape")) or [""]
    place = chance.randrange(len(tokens))
    other = chance.randrange(len(tokens))
    start, end = sorted((place, other))
    change = chance.randrange(7)
    if change == 0:
        del tokens[place]
    elif change == 1:
        tokens[place], tokens[other] = tokens[other], tokens[place]
    elif change == 2:
        tokens[start:start] = tokens[start:end][:200]
    elif change == 3:
        tokens[place] = chance.choice(NUMBERS)
    elif change == 4:
        tokens.insert(place, chance.choice(WORDS))
    elif change == 5:
        del tokens[start : start + chance.randrange(1, 20)]
    else:
        tokens[place] = tokens[place] * chance.choice((2, 10, 1000))
    return "".join(tokens).encode("utf-8", "surrogateescape")


def _bytes(data: bytes, chance: random.Random) -> bytes:
    content = bytearray(data or b"\x00")
    place = chance.randrange(len(content))
    change = chance.randrange(6)
    if change == 0:
        content[place] = chance.randrange(256)
    elif change == 1:
        del content[place : place + chance.choice((1, 4, 50))]
    elif change == 2:
        content[place:place] = chance.randbytes(chance.choice((1, 4, 8)))
    elif change == 3:
        content[place : place + 4] = chance.choice(
            (b"\xff\xff\xff\xff", b"\xff\xff\xff\x7f", b"\x00\x00\x00\x00", b"\x00\x00\x00\x80")
        )
    elif change == 4:
        del content[place:]
    else:
        content[place:place] = content[place : place + chance.choice((8, 64))]
    return bytes(content)
