"""Reads CSV files as spreadsheets, loggers and our own commands write them.

Values stand between commas, semicolons or tabs, with decimal points or commas, in any of the usual encodings. What a
file is, is decided by its header: the separator is the one with which the columns that are looked for are found. How
numbers are written is decided by all the numbers that are read. What can be read in two ways is refused.
"""

import codecs
import csv
import re
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property
from io import StringIO
from math import isfinite, nan
from pathlib import Path

from ..core.columns import regular
from ..errors import InputError, shown

SEPARATORS = (",", ";", "\t")
NO_CSV = {  # how files begin that are taken for CSV files
    b"PK\x03\x04": "a workbook: save its sheet as CSV",  # Excel since 2007, LibreOffice
    b"\xd0\xcf\x11\xe0": "a workbook: save its sheet as CSV",  # Excel until 2003
    b"PAR1": "a Parquet file",
    b"\x1f\x8b": "a compressed file: unpack it",
}
MARKED = (  # byte-order mark → encoding; the mark of UTF-16 is also the beginning of that of UTF-32
    (codecs.BOM_UTF8, "utf-8-sig"),
    (codecs.BOM_UTF32_LE, "utf-32"),
    (codecs.BOM_UTF32_BE, "utf-32"),
    (codecs.BOM_UTF16_LE, "utf-16"),
    (codecs.BOM_UTF16_BE, "utf-16"),
)
LONGEST_HEADER = 1 << 20  # characters, with what is empty above it


@dataclass(frozen=True)
class Style:
    """A way to write numbers: the decimal mark, and the characters of which one may stand between thousands."""

    mark: str
    between: str = ""

    @cached_property
    def pattern(self) -> re.Pattern[str]:
        """What a number looks like."""
        mark, digits = re.escape(self.mark), "[0-9]"
        whole = rf"[1-9]{digits}{{,2}}(?:(?P<between>[{self.between}]){digits}{{3}})(?:(?P=between){digits}{{3}})*"
        grouped = rf"|{whole}(?:{mark}{digits}*)?" if self.between else ""
        return re.compile(
            rf"[+\-−]?(?:(?:{digits}+{mark}?{digits}*|{mark}{digits}+)(?:[eE][+\-−]?{digits}+)?{grouped})"
        )

    def reads(self, cells: Sequence[str]) -> int:
        """How many of the cells are numbers in this style."""
        return sum(self.pattern.fullmatch(cell.strip()) is not None for cell in cells)

    def number(self, cell: str) -> float:
        """The number in a cell; NaN if it is none in this style."""
        cell = cell.strip()
        if not self.pattern.fullmatch(cell):
            return nan
        for character in self.between:
            cell = cell.replace(character, "")
        return float(cell.replace(self.mark, ".").replace("−", "-"))


SPACES = " \u00a0\u202f'’"  # between thousands, whatever the decimal mark
POINT, COMMA = Style("."), Style(",")
POINT_AND_THOUSANDS, COMMA_AND_THOUSANDS = Style(".", "," + SPACES), Style(",", "." + SPACES)


@dataclass(frozen=True)
class Sheet:
    """The cells of a CSV file.

    Parameters
    ----------
    path
        The file.
    separator
        What stands between its values.
    headings
        The cells of its first row, without spaces around them.
    rows
        The other rows, each at least as long as the header; rows of empty cells are left out.
    lines
        The number of the line in which each row ends.
    """

    path: Path
    separator: str
    headings: list[str]
    rows: list[list[str]]
    lines: list[int]

    def numbers(self, headings: Sequence[str]) -> list[list[float]]:
        """The numbers in these columns.

        Raises
        ------
        InputError
            If two columns have the same of these headings, a value is not a finite number, or the numbers can be read
            in two ways. The message names file, line and value.
        """
        for heading in headings:
            if self.headings.count(heading) > 1:
                count = self.headings.count(heading)
                raise InputError(f"{self.path}: must have a single column {heading!r}, got {count}")
        positions = [self.headings.index(heading) for heading in headings]
        cells = [[row[position] for row in self.rows] for position in positions]
        try:
            columns = [list(map(float, column)) for column in cells]
        except ValueError:
            columns = self._in_a_style(cells)
        if not all(all(map(isfinite, column)) for column in columns) or any("_" in "".join(c) for c in cells):
            self._refuse(headings, cells)
        return columns

    def _in_a_style(self, cells: list[list[str]]) -> list[list[float]]:
        """The numbers in the style that reads most of the cells; NaN for what is none."""
        every = [cell for column in cells for cell in column]
        plain = (POINT,) if self.separator == "," else (POINT, COMMA)
        style = max((*plain, POINT_AND_THOUSANDS, COMMA_AND_THOUSANDS), key=lambda style: style.reads(every))
        columns = [list(map(style.number, column)) for column in cells]
        if style is POINT_AND_THOUSANDS:
            for cell in every:
                other = COMMA_AND_THOUSANDS.number(cell)
                if other != style.number(cell) and COMMA_AND_THOUSANDS.reads(every) == len(every):
                    constraint = "must have numbers without separators between thousands"
                    raise InputError(f"{self.path}: {constraint}, got {cell!r}: {style.number(cell):g} or {other:g}?")
        return columns

    def _refuse(self, headings: Sequence[str], cells: list[list[str]]) -> None:
        """Raise `InputError` for the first value that is not a finite number."""
        style_columns = self._in_a_style(cells)
        for row, line in enumerate(self.lines):
            for heading, column, numbers in zip(headings, cells, style_columns, strict=True):
                if not isfinite(numbers[row]):
                    constraint = f"{heading}: must be a finite number"
                    raise InputError(f"{self.path}:{line}: {constraint}, got {shown(column[row])}")

    def missing(self, *wanted: str) -> InputError:
        """The error that says that none of these columns is there, each given with its unit."""
        return InputError(f"{self.path}: must have a column {' or '.join(wanted)}, got {shown(self.headings)}")


def read_sheet(path: str | Path, known: Callable[[str], bool]) -> Sheet:
    """Read the cells of a CSV file.

    Parameters
    ----------
    path
        The file.
    known
        Whether a heading is that of a column that is looked for.

    Raises
    ------
    InputError
        If the file cannot be read, is no CSV file, a row is shorter or longer than the header, or the first row, unlike
        those below it, names no column that is looked for.
    """
    path = Path(path)
    text = _text(path)
    separator = max(SEPARATORS, key=lambda separator: _found(text, separator, known))
    headings: list[str] = []
    rows, lines = [], []
    try:
        for line, row in _rows(text, separator):
            if not headings:
                headings = [heading.strip() for heading in _trimmed(row)]
                continue
            if len(row) != len(headings):
                row = _trimmed(row, len(headings))
                if not any(map(known, headings)):
                    constraint = "must have the names of its columns in its first row"
                    raise InputError(f"{path}: {constraint}, got {shown(headings)}")
                if len(row) != len(headings):
                    count = f"must have {len(headings)} values like the header, got {len(row)}"
                    raise InputError(f"{path}:{line}: {count}")
            rows.append(row)
            lines.append(line)
    except csv.Error as error:
        raise InputError(f"{path}: must be a CSV file with quotes in pairs, got: {error}") from error
    return Sheet(path, separator, headings, rows, lines)


def _text(path: Path) -> str:
    """The text of a file, whatever its encoding: those that have no mark and are not UTF-8 are taken for cp1252."""
    try:
        data = regular(path).read_bytes()
    except OSError as error:
        raise InputError(f"{path}: must be a readable CSV file, got: {error.strerror}") from error
    for beginning, what in NO_CSV.items():
        if data.startswith(beginning):
            raise InputError(f"{path}: must be a CSV file, got {what}")
    for mark, encoding in MARKED:
        if data.startswith(mark):
            return data.decode(encoding, errors="replace")
    if data[1:4:2] == b"\0\0" or data[0:4:2] == b"\0\0":  # two letters of UTF-16
        return data.decode("utf-16-be" if data[0] == 0 else "utf-16-le", errors="replace")
    try:
        return data.decode("utf-8")
    except UnicodeDecodeError:
        return data.decode("cp1252", errors="replace")


def _rows(text: str, separator: str) -> Iterator[tuple[int, list[str]]]:
    """Each row that has a cell with text in it, and the number of the line in which it ends."""
    reader = csv.reader(StringIO(text, newline=""), delimiter=separator, skipinitialspace=True, strict=True)
    filled = ((reader.line_num, row) for row in reader if any(map(str.strip, row)))
    try:
        for count, (line, row) in enumerate(filled):
            hint = count == 0 and re.fullmatch("sep=.", separator.join(row).strip(" "), re.IGNORECASE)  # for Excel
            if not hint:
                yield line, row
    except csv.Error as error:
        raise csv.Error(f"{error} in line {reader.line_num}") from error


def _found(text: str, separator: str, known: Callable[[str], bool]) -> tuple[int, int]:
    """How many known headings, and how many headings in all, are found with a separator."""
    try:
        _, header = next(_rows(text[:LONGEST_HEADER], separator), (0, []))
    except csv.Error:
        return 0, 0
    return sum(known(heading.strip()) for heading in header), len(header)


def _trimmed(row: list[str], least: int = 0) -> list[str]:
    """A row without the empty cells at its end, but not shorter than `least`."""
    end = len(row)
    while end > least and not row[end - 1].strip():
        end -= 1
    return row[:end]
