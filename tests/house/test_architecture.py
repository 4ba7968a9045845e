"""The list of modules in docs/architecture.md is that of the packages."""

import re
from pathlib import Path

from places import ROOT

ROOTS = ("model", "fmu_build", "viz")


def listed() -> list[Path]:
    """Every file that the list names, under the folder it is named in."""
    text = (ROOT / "docs" / "architecture.md").read_text(encoding="utf-8")
    section = text.partition("\n## Modules\n")[2].partition("\n## ")[0]
    files, folder = [], Path()
    for line in section.splitlines():
        if heading := re.fullmatch(r" {4}(\S+)/", line):
            folder = Path(heading[1])
        elif line.startswith("      "):
            files += [
                folder / name for name in re.findall(r"(?<![\w/.])\w+\.(?:py|h|c)(?![\w.])", line.partition(" – ")[0])
            ]
    return files


def there() -> list[Path]:
    """Every module and C file of the three packages, but for the modules that only name a package."""
    files = [path for root in ROOTS for path in (ROOT / root).rglob("*.*") if path.suffix in (".py", ".h", ".c")]
    return [path.relative_to(ROOT) for path in files if path.name != "__init__.py"]


def test_every_module_is_named_once_and_where_it_is() -> None:
    assert sorted(listed()) == sorted(there())
