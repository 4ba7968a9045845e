"""Which files belong together: those that are read with a file, and the case that is written beside a run.

A command writes to no file that it reads, and replaces no case beside a run but one that it has written itself.
"""

from pathlib import Path

from ..case.file import dump_case, files_named, parse_case, read_run
from ..errors import BorepropError, InputError

MARK = "# boreprop wrote this file with the result file beside it, and will replace it when it writes that again.\n"


def case_path(run: Path) -> Path:
    """The file with the case of a CSV file: run.case.toml beside run.csv."""
    return run.with_suffix(".case.toml")


def files_read(*sources: Path | None) -> list[Path]:
    """The files that are read for any of these: itself, the case beside a result file, and what a case names."""
    files = [source for source in sources if source is not None]
    files += [case_path(run) for run in files if run.suffix == ".csv"]
    return files + [named for case in files if case.suffix == ".toml" for named in files_named(case)]


def check_case_beside(run: Path) -> None:
    """Raise `InputError` if a case that boreprop has not written lies where the case of a CSV file goes."""
    path = case_path(run)
    if run.suffix != ".csv" or not path.exists():
        return
    text = path.read_text(encoding="utf-8", errors="replace") if path.is_file() else ""
    # before it wrote the mark, boreprop wrote nothing but numbers
    if not text.startswith(MARK) and not (run.exists() and _is_as_dumped(text)):
        raise InputError(
            f"{path}: must be a case that boreprop wrote with {run.name} or not be there, got another file: "
            "move it, or choose another output"
        )


def _is_as_dumped(text: str) -> bool:
    """Whether a text is, to the letter, what `dump_case` makes of its case."""
    try:
        return dump_case(parse_case(text, ""), **read_run(text)) == text
    except BorepropError:
        return False
