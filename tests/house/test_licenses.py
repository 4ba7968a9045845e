"""The page of licenses names every package that a requirement of ours names, and each with a license."""

import re
import tomllib

from packaging.requirements import Requirement
from packaging.utils import canonicalize_name

from places import ROOT

PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
PAGE = (ROOT / "docs" / "licenses.md").read_text(encoding="utf-8")
ROWS = dict(re.findall(r"^\| (?!package )([a-z0-9-]+) \| (.+) \|$", PAGE, re.MULTILINE))
OPEN = "0BSD|Apache|BSD|CC0|ISC|MIT|Mozilla|MPL|PSF|Public domain|Python Software|Zlib"  # how their names begin


def test_every_requirement_of_every_extra_has_its_license_on_the_page() -> None:
    lists = [PROJECT["dependencies"], *PROJECT["optional-dependencies"].values()]
    named = {canonicalize_name(Requirement(line).name) for lines in lists for line in lines} - {"boreprop"}
    assert len(named) > 40
    assert sorted(named - set(ROWS)) == [], "run: python docs/make_licenses.py"


def test_every_license_lets_code_that_uses_the_package_have_another() -> None:
    parts = {name: re.split(r" AND | OR |, ", text) for name, text in ROWS.items()}
    assert {name: found for name, found in parts.items() if not all(re.match(OPEN, part) for part in found)} == {}


def test_the_compiler_that_is_pinned_is_the_one_that_notices_and_messages_name() -> None:
    (pinned,) = {line for line in PROJECT["optional-dependencies"]["dev"] if line.startswith("ziglang==")}
    version = pinned.partition("==")[2]
    kernel = ROOT / "model" / "boreprop" / "kernel"
    named = {path.name: path.read_text(encoding="utf-8") for path in [kernel / "THIRD_PARTY.txt", *kernel.glob("*.py")]}
    assert f"Zig {version} " in named["THIRD_PARTY.txt"]
    assert {found for text in named.values() for found in re.findall(r"ziglang==([\d.]+\d)", text)} == {version}
