"""What Sphinx lacks for this documentation: equations as MathML, tables made from the code, cells of commands."""

import re
from types import GenericAlias
from typing import Any, get_args, get_origin

import numpy.typing
from docutils import nodes
from docutils.utils.math.latex2mathml import tex2mathml
from sphinx.application import Sphinx

import tables_of_code

MADE = re.compile(r"^<!-- made: (\w+) ?(\w*) -->$", re.MULTILINE)
COMMAND_CELL = re.compile(r"\A%%bash.*\n")


def setup(app: Sphinx) -> dict[str, Any]:
    """Register the parts."""
    app.add_html_math_renderer("mathml", (inline_math, None), (block_math, None))
    app.connect("source-read", put_tables)
    app.connect("autodoc-before-process-signature", shorten_types)
    app.connect("autodoc-process-signature", shorten_defaults)
    app.connect("doctree-read", mark_commands)
    app.connect("doctree-read", join_prints)
    return {"parallel_read_safe": True}


def inline_math(writer: Any, node: nodes.math) -> None:
    """An equation in a line, as MathML: browsers draw it themselves, without a script or a font."""
    writer.body.append(tex2mathml(node.astext(), as_block=False))
    raise nodes.SkipNode


def block_math(writer: Any, node: nodes.math_block) -> None:
    """An equation on a line of its own."""
    number = f'<span class="eqno">({node["number"]})</span>' if node["number"] else ""
    writer.body.append(f'<div class="math">{number}{tex2mathml(node.astext(), as_block=True)}</div>')
    raise nodes.SkipNode


def put_tables(_app: Sphinx, _page: str, source: list[str]) -> None:
    """Replace ``<!-- made: commands boreprop -->`` by what that function of `tables_of_code` returns."""
    source[0] = MADE.sub(lambda mark: getattr(tables_of_code, mark[1])(*filter(None, [mark[2]])), source[0])


class ArrayLike:
    """Stands for numpy's union of a dozen types, which would be spelt out."""

    __module__ = "numpy.typing"


def shorten_types(_app: Sphinx, thing: Any, _bound: bool) -> None:
    """Give a parameter that takes whatever makes an array, or a mapping to that, a type that can be read."""
    for name, kind in getattr(thing, "__annotations__", {}).items():
        if kind is numpy.typing.ArrayLike:
            thing.__annotations__[name] = ArrayLike
        elif numpy.typing.ArrayLike in get_args(kind):
            arguments = tuple(ArrayLike if part is numpy.typing.ArrayLike else part for part in get_args(kind))
            thing.__annotations__[name] = GenericAlias(get_origin(kind), arguments)


def shorten_defaults(*described: Any) -> tuple[str, str] | None:
    """Show a function that does nothing, as the default of a parameter, by three dots."""
    signature, returned = described[-2:]
    return (signature.replace("<function <lambda>>", "..."), returned) if signature else None


def mark_commands(_app: Sphinx, page: nodes.document) -> None:
    """Show cells of commands as what a reader types into a terminal."""
    for block in page.findall(nodes.literal_block):
        if COMMAND_CELL.match(block.rawsource or block.astext()):
            text = COMMAND_CELL.sub("", block.astext())
            block.replace_self(nodes.literal_block(text, text, language="bash", classes=["commands"]))


def join_prints(_app: Sphinx, page: nodes.document) -> None:
    """Make one block of what a cell printed in pieces, which may be cut within a line."""
    for block in page.findall(nodes.literal_block):
        while "stream" in block["classes"] and (more := block.next_node(descend=False, siblings=True)) is not None:
            if not isinstance(more, nodes.literal_block) or more["classes"] != block["classes"]:
                break
            text = block.astext() + more.astext()
            block.rawsource, block.children = text, []
            block += nodes.Text(text)
            more.parent.remove(more)
