"""Merge the many small generated files into a few that compile fast.

A generated file has a hundred lines and includes ten thousand lines of headers. Fifteen of them in
one translation unit compile almost as fast as one; the whole build takes a third of the time.
"""

import math
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

from rosidl_pycommon import convert_camel_case_to_lower_case_underscore as snake_case

from interface_build.interface_package import InterfacePackage
from interface_build.toolchain import Toolchain
from interface_build.work_folder import WorkFolder

_MAX_BATCH = 20
# Each description has its own static text under this name.
_OWN_TEXT = "toplevel_type_raw_source"


@dataclass(frozen=True, slots=True)
class CodeKind:
    """One kind of generated file.

    Attributes:
        name: name of the kind, for progress lines and object names.
        pattern: file name, with ``{}`` for the interface in snake case.
        in_introspection: whether the introspection generator writes it.
        repeats: whether the files define the same static texts, such as the names of the types that
            they use, so that only the first definition may stay.
        optimisation: compiler flag; data and code that runs once need none.
    """

    name: str
    pattern: str
    in_introspection: bool = False
    repeats: bool = False
    optimisation: str = "-O0"


CODE_KINDS = (
    CodeKind("serialisation", "detail/{}__type_support_c.cpp", optimisation="-O1"),
    CodeKind("functions", "detail/{}__functions.c", optimisation="-O1"),
    CodeKind("conversion", "_{}_s.c", optimisation="-O1"),
    CodeKind("descriptions", "detail/{}__description.c", repeats=True),
    CodeKind("introspection", "detail/{}__type_support.c", in_introspection=True),
    CodeKind("handles", "detail/{}__type_support.c"),
    CodeKind("dispatch", "{}__type_support.cpp"),
)


@dataclass(frozen=True, slots=True)
class TranslationUnit:
    """Generated files that are compiled in one step.

    Attributes:
        kind: kind of the files.
        sources: paths as in includes, ``<package>/msg/...``.
        source_folder: folder that these paths are relative to.
        objects: folder for the object files.
        name: unique name among the units of its kind.
    """

    kind: CodeKind
    sources: tuple[str, ...]
    source_folder: Path
    objects: Path
    name: str

    @property
    def object_file(self) -> Path:
        """The object file to link."""
        return self.objects / f"{self.name}.o"

    def compile(self, toolchain: Toolchain, includes: tuple[Path, ...]) -> None:
        """Compile the files together.

        Raises:
            CompileError: the compiler refused one of them.
        """
        merged = self.objects / f"{self.name}{Path(self.sources[0]).suffix}"
        lines = self._texts() if self.kind.repeats else self._includes()
        merged.write_text("\n".join(lines), encoding="utf-8")
        # The sources' folder comes first, because both generated folders have files with the same
        # path.
        folders = (self.source_folder, *includes)
        toolchain.compile(merged, self.object_file, folders, self.kind.optimisation)

    def _includes(self) -> Iterator[str]:
        """Yield a line for each source that includes it."""
        return (f'#include "{source}"' for source in self.sources)

    def _texts(self) -> Iterator[str]:
        """Yield the lines of all sources, but the definitions of static texts only once."""
        defined: set[str] = set()
        for index, source in enumerate(self.sources):
            yield f"#undef {_OWN_TEXT}\n#define {_OWN_TEXT} {_OWN_TEXT}_{index}"
            for line in (self.source_folder / source).read_text(encoding="utf-8").splitlines():
                if line not in defined:
                    yield line
                if line.startswith("static char ") and line.endswith(";"):
                    defined.add(line)


def find_units(package: InterfacePackage, work: WorkFolder) -> list[TranslationUnit]:
    """List all translation units of a package; the files need not exist yet."""
    return [
        TranslationUnit(
            kind=kind,
            sources=sources,
            source_folder=_folder(kind, work).parent,
            objects=work.objects,
            name=f"{kind.name}_{index}",
        )
        for kind in CODE_KINDS
        for index, sources in enumerate(_batches(kind, package))
    ]


def _folder(kind: CodeKind, work: WorkFolder) -> Path:
    """Return the generator output that holds this kind of file."""
    return work.introspection if kind.in_introspection else work.generated


def _batches(kind: CodeKind, package: InterfacePackage) -> list[tuple[str, ...]]:
    """Split the files of one kind into batches of about equal size."""
    paths = tuple(
        f"{package.name}/{interface.kind}/{kind.pattern.format(snake_case(interface.name))}"
        for interface in package.interfaces
    )
    count = math.ceil(len(paths) / _MAX_BATCH)
    size = math.ceil(len(paths) / count)
    return [paths[start : start + size] for start in range(0, len(paths), size)]
