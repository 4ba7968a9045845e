"""Writes docs/licenses.md: under which license each package is that boreprop brings along, or is developed with.

python docs/make_licenses.py

All extras must be installed. Of what the tools of development bring along themselves nothing is said.
"""

import json
import re
import subprocess
import sys
from collections.abc import Iterable, Iterator, Sequence
from importlib.metadata import PackageNotFoundError, requires
from pathlib import Path

from packaging.requirements import Requirement
from packaging.utils import canonicalize_name

PAGE = Path(__file__).parent / "licenses.md"
INSTALLED = ("plot", "fmu", "viz", "study", "query")  # extras for users, each after what it builds on
DEVELOPED = ("docs", "dev", "bench")
NOT_SAID = {"fmpy": "BSD-2-Clause"}  # in its metadata, but in the license that it is installed with

HEAD = """\
# Licenses

boreprop is under the [MIT license](../LICENSE). What the compiler links into its libraries besides boreprop's own code
is named in [THIRD_PARTY.txt](../model/boreprop/kernel/THIRD_PARTY.txt), which every wheel and every native FMU has in
it; a Python FMU has the license of pythonfmu. Everything else is installed as packages of their own, under their own
licenses.

This page is made by `python docs/make_licenses.py` from what the packages say of themselves, as they are installed on
Linux with Python 3.11; other systems and versions bring a few others.
"""


def write() -> None:
    """Write the page."""
    licenses = read_licenses()
    seen: set[str] = set()
    text = HEAD
    for extra in ("", *INSTALLED):
        new = sorted(set(closure([Requirement(f"boreprop[{extra}]")])) - seen - {"boreprop"})
        seen |= set(new)
        title = f"What `boreprop[{extra}]` adds" if extra else "What `boreprop` brings along"
        text += section(title, new, licenses)
    for extra in DEVELOPED:
        new = sorted({canonicalize_name(wanted.name) for wanted in direct("boreprop", {extra})} - seen - {"boreprop"})
        seen |= set(new)
        text += section(f"What `boreprop[{extra}]` names besides", new, licenses)
    PAGE.write_text(text, encoding="utf-8")


def section(title: str, names: Sequence[str], licenses: dict[str, str]) -> str:
    """A table of packages; nothing if there are none."""
    if not names:
        return ""
    rows = "".join(f"| {name} | {licenses[name]} |\n" for name in names)
    return f"\n## {title}\n\n| package | license |\n|---|---|\n{rows}"


def closure(wanted: Iterable[Requirement]) -> Iterator[str]:
    """The names of packages, and of all that they need here."""
    asked: set[tuple[str, str]] = set()
    waiting = list(wanted)
    while waiting:
        requirement = waiting.pop()
        name = canonicalize_name(requirement.name)
        for extra in {"", *requirement.extras}:
            if (name, extra) not in asked:
                asked.add((name, extra))
                yield name
                waiting += direct(name, {extra})


def direct(name: str, extras: set[str]) -> list[Requirement]:
    """What an installed package itself needs here, with some of its extras or "" for without."""
    try:
        wanted = [Requirement(line) for line in requires(name) or []]
    except PackageNotFoundError as error:
        raise SystemExit(f"{name}: must be installed: pip install -e '.[bench,docs]'") from error
    return [
        requirement
        for requirement in wanted
        if requirement.marker is None or any(requirement.marker.evaluate({"extra": extra}) for extra in extras)
    ]


def read_licenses() -> dict[str, str]:
    """What each installed package says of its license, in the words of its metadata that say most."""
    command = [sys.executable, "-m", "piplicenses", "--from=all", "--format=json", "--with-system"]
    listing = json.loads(subprocess.run(command, capture_output=True, text=True, check=True).stdout)
    return {name: words(name, found) for found in listing for name in [canonicalize_name(found["Name"])]}


def words(name: str, found: dict[str, str]) -> str:
    """The license of one."""
    said = [found[f"License-{kind}"] for kind in ("Expression", "Metadata", "Classifier")]
    short = [text for text in said if text != "UNKNOWN" and len(text) < 80 and "\n" not in text]
    license_ = (short or [NOT_SAID.get(name, "")])[0]
    if not license_:
        raise SystemExit(f"{name}: must say its license, got {said}; look it up and add it to NOT_SAID")
    return re.sub(r"\s*;\s*", ", ", license_)


if __name__ == "__main__":
    write()
