"""Could arm_interfaces be compiled?"""

import shlex
import sysconfig
import tempfile
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

from arm_cli.doctor.finding import Finding
from arm_cli.doctor.trial import Trial, try_command

NAME = "compiler"
FIX = "only to install arm_interfaces anew; on Debian and Ubuntu: apt install gcc g++ python3-dev"
COMPILERS = (("CC", "gcc", "part.c"), ("CXX", "g++", "part.cpp"))
SOURCE = "#include <Python.h>\n"


@dataclass(frozen=True, slots=True)
class Compiler:
    """Compiles a file that includes Python.h, as C and as C++; `CC` and `CXX` count."""

    environ: Mapping[str, str]

    def examine(self) -> Finding:
        """Try both compilers."""
        names: list[str] = []
        for variable, usual, file in COMPILERS:
            command = shlex.split(self.environ.get(variable) or usual)
            trial = self._compile(command, file)
            if not trial.worked:
                sentence = f"{command[0]} cannot compile against Python.h: {trial.complaint}"
                return Finding.warning(NAME, sentence, FIX)
            names.append(command[0])
        return Finding.ok(NAME, f"{' and '.join(names)} compile against Python.h")

    def _compile(self, command: list[str], file: str) -> Trial:
        with tempfile.TemporaryDirectory() as folder:
            source = Path(folder) / file
            source.write_text(SOURCE)
            include = f"-I{sysconfig.get_path('include')}"
            words = [*command, include, "-c", str(source), "-o", f"{source}.o"]
            return try_command(words, self.environ)
