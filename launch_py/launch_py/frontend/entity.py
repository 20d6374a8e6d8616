"""Parses an XML or YAML launch file into a tree of elements."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any
from xml.parsers import expat

from launch_py.conditions import Condition, IfCondition, UnlessCondition
from launch_py.errors import LaunchFileError, SubstitutionError
from launch_py.near_names import describe_known
from launch_py.ros.substitution_parser import parse_substitutions
from launch_py.substitution import LaunchScope, Substitution, perform_text

if TYPE_CHECKING:
    import yaml

ROOT = "launch"
MAX_CHARACTERS = 5_000_000
MAX_DEPTH = 64
"""How deep elements may be nested."""


class FileText(Substitution):
    """A text of a launch file, which may contain substitutions such as $(var name)."""

    def __init__(self, text: object, where: str) -> None:
        self.text = _as_word(text)
        try:
            self.parts = parse_substitutions(self.text)
        except SubstitutionError as error:
            raise LaunchFileError(f"{where}: {error}") from None

    def perform(self, context: LaunchScope) -> str:
        """Return the text with its substitutions performed."""
        return perform_text(context, self.parts)

    def describe(self) -> str:
        """Return the text as the file writes it."""
        return self.text


@dataclass(slots=True)
class Entity:
    """An element of a launch file: its name, place, attributes and children.

    Values are texts in XML. In YAML they are YAML's scalars, or lists of scalars.
    """

    tag: str
    where: str
    attributes: dict[str, Any] = field(default_factory=dict[str, Any])
    children: list[Entity] = field(default_factory=list["Entity"])

    def refuse_unknown(self, needed: tuple[str, ...], optional: tuple[str, ...]) -> None:
        """Check the names of the attributes.

        Raises:
            LaunchFileError: an attribute is unknown, or a needed one is missing.
        """
        known = (*needed, *optional)
        for name in self.attributes:
            if name not in known:
                hint = describe_known(name, known, "it takes")
                raise LaunchFileError(f"{self.where}: {self.tag} does not take {name!r}; {hint}")
        for name in needed:
            if name not in self.attributes:
                raise LaunchFileError(f"{self.where}: {self.tag} lacks {name!r}")

    def word(self, name: str, default: str = "") -> str:
        """Return an attribute as it is written, without parsing substitutions."""
        return _as_word(self.attributes.get(name, default))

    def text(self, name: str) -> FileText:
        """Return an attribute with its substitutions parsed."""
        return FileText(self.attributes[name], self.where)

    def text_or_none(self, name: str) -> FileText | None:
        """Return an attribute with its substitutions parsed, or None if it is not given."""
        return self.text(name) if name in self.attributes else None

    def boolean(self, name: str, default: bool) -> bool:
        """Return an attribute that is true or false.

        Raises:
            LaunchFileError: the attribute is neither.
        """
        word = _as_word(self.attributes.get(name, default)).lower()
        if word not in ("true", "false"):
            raise LaunchFileError(f"{self.where}: {name}={word!r} is neither true nor false")
        return word == "true"

    def words(self, name: str) -> list[FileText]:
        """Return the words of a command line; spaces in quotes or in $(...) do not separate words.

        Raises:
            LaunchFileError: a quotation mark is not closed.
        """
        text = self.word(name)
        words: list[str] = [""]
        quote, depth = "", 0
        for at, character in enumerate(text):
            if text.startswith("$(", at):
                depth += 1
            elif character == ")" and depth:
                depth -= 1
            if not depth and (character == quote or (not quote and character in "'\"")):
                quote = "" if quote else character
                continue
            if character.isspace() and not quote and not depth:
                words.append("")
            else:
                words[-1] += character
        if quote:
            raise LaunchFileError(f"{self.where}: {text!r} has an open quotation mark")
        return [FileText(word, self.where) for word in words if word]

    def condition(self) -> Condition | None:
        """Return the condition in the attribute `if` or `unless`.

        Raises:
            LaunchFileError: the element has both.
        """
        if {"if", "unless"} <= self.attributes.keys():
            raise LaunchFileError(f"{self.where}: {self.tag} has both 'if' and 'unless'")
        if "if" in self.attributes:
            return IfCondition(self.text("if"))
        return UnlessCondition(self.text("unless")) if "unless" in self.attributes else None

    def children_named(self, *tags: str) -> list[Entity]:
        """Return the children with one of these names."""
        return [child for child in self.children if child.tag in tags]


def read_entities(path: Path) -> Entity:
    """Return the root of an XML or YAML launch file; the file's ending tells its format.

    Raises:
        LaunchFileError: the file cannot be read, or its root is not `launch`.
    """
    try:
        with path.open(encoding="utf-8") as file:
            text = file.read(MAX_CHARACTERS + 1)
    except OSError as error:
        raise LaunchFileError(f"{path} cannot be read: {error}") from error
    except UnicodeDecodeError as error:
        byte = error.object[error.start]
        raise LaunchFileError(
            f"{path} cannot be read: it is not UTF-8, as the byte 0x{byte:02x} tells"
        ) from error
    if len(text) > MAX_CHARACTERS:
        raise LaunchFileError(f"{path} has more than {MAX_CHARACTERS} characters")
    is_yaml = path.suffix in (".yaml", ".yml")
    root = _read_yaml(text, path) if is_yaml else _read_xml(text, path)
    if root.tag != ROOT:
        raise LaunchFileError(f"{root.where}: the root must be {ROOT!r}, not {root.tag!r}")
    return root


def _as_word(value: object) -> str:
    if isinstance(value, bool):
        return "true" if value else "false"
    return "" if value is None else str(value)


def _read_xml(text: str, path: Path) -> Entity:
    above: list[Entity] = [Entity("", str(path))]
    parser = expat.ParserCreate()

    def where() -> str:
        return f"{path}, line {parser.CurrentLineNumber}"

    def start(tag: str, attributes: dict[str, str]) -> None:
        entity = Entity(tag, where(), attributes)
        above[-1].children.append(entity)
        above.append(entity)
        if len(above) > MAX_DEPTH:
            raise LaunchFileError(f"{where()}: elements are nested more than {MAX_DEPTH} deep")

    def characters(text: str) -> None:
        if text.strip():
            raise LaunchFileError(f"{where()}: {text.strip()!r} is outside an attribute")

    parser.StartElementHandler = start
    parser.EndElementHandler = lambda _tag: above.pop()
    parser.CharacterDataHandler = characters
    try:
        parser.Parse(text, True)
    except expat.ExpatError as error:
        reason = expat.errors.messages[error.code]
        raise LaunchFileError(f"{path}, line {error.lineno}: not XML: {reason}") from error
    return above[0].children[0]


def _read_yaml(text: str, path: Path) -> Entity:
    import yaml  # Imported late, because the import takes as long as starting a process.

    try:
        node = yaml.compose(text, Loader=yaml.SafeLoader)
    except RecursionError as error:
        raise LaunchFileError(f"{path} is not YAML: its values are nested too deep") from error
    except yaml.YAMLError as error:
        reason = str(error).replace("\n", " ")
        raise LaunchFileError(f"{path} is not YAML: {reason}") from error
    if not isinstance(node, yaml.MappingNode) or len(node.value) != 1:
        raise LaunchFileError(f"{path}: a YAML launch file is a list of actions below '{ROOT}:'")
    return _single(node, path, 0)


def _single(node: yaml.Node, path: Path, depth: int) -> Entity:
    """Return the entity of a mapping {tag: content}."""
    import yaml

    where = f"{path}, line {node.start_mark.line + 1}"
    if depth > MAX_DEPTH:
        raise LaunchFileError(f"{where}: elements are nested more than {MAX_DEPTH} deep")
    if not isinstance(node, yaml.MappingNode) or len(node.value) != 1:
        raise LaunchFileError(f"{where}: an action must be one name with a colon, such as 'node:'")
    key, value = node.value[0]
    return _filled(Entity(_name(key, path), where), value, path, depth)


def _filled(entity: Entity, body: yaml.Node, path: Path, depth: int) -> Entity:
    import yaml

    match body:
        case yaml.SequenceNode():
            entity.children += [_single(item, path, depth + 1) for item in body.value]
        case yaml.MappingNode():
            for key, value in body.value:
                name = _name(key, path)
                if name == "children":
                    entity.children += [_single(item, path, depth + 1) for item in value.value]
                elif isinstance(value, yaml.ScalarNode) or not any(_mappings(value)):
                    entity.attributes[name] = _plain(value)
                else:
                    entity.children += [
                        _filled(_below(name, item, path), item, path, depth + 1)
                        for item in _mappings(value)
                    ]
        case _ if body.value:
            raise LaunchFileError(
                f"{entity.where}: {entity.tag} takes names and values, not a text"
            )
    return entity


def _name(key: yaml.Node, path: Path) -> str:
    import yaml

    if not isinstance(key, yaml.ScalarNode):
        raise LaunchFileError(
            f"{path}, line {key.start_mark.line + 1}: a name must stand before the colon, not a "
            "list or a mapping"
        )
    return str(key.value)


def _below(name: str, node: yaml.Node, path: Path) -> Entity:
    return Entity(name, f"{path}, line {node.start_mark.line + 1}")


def _mappings(node: yaml.Node) -> Iterator[yaml.Node]:
    """Yield the mappings in a list, or the node itself if it is a mapping."""
    import yaml

    if isinstance(node, yaml.MappingNode):
        yield node
    elif isinstance(node, yaml.SequenceNode):
        yield from (item for item in node.value if isinstance(item, yaml.MappingNode))


def _plain(node: yaml.Node) -> Any:
    import yaml

    constructor = yaml.constructor.SafeConstructor()
    return constructor.construct_object(node, deep=True)
