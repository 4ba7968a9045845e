"""Docstrings of the public names: their sections are there, and their examples give what they show."""

import doctest
from importlib import import_module
from inspect import getdoc, isclass, signature

import pytest

import boreprop
from places import ROOT
from public_names import EXPLAINED, PUBLIC

MODEL = ROOT / "model"
WITH_EXAMPLES = [path for path in sorted(MODEL.rglob("*.py")) if ">>> " in path.read_text(encoding="utf-8")]
MODULES = [".".join(path.relative_to(MODEL).with_suffix("").parts) for path in WITH_EXAMPLES]


@pytest.mark.parametrize("module", MODULES)
def test_examples_give_what_they_show(module: str) -> None:
    outcome = doctest.testmod(import_module(module))
    assert outcome.attempted > 0
    assert outcome.failed == 0


@pytest.mark.parametrize("name", EXPLAINED)
def test_the_main_names_have_an_example(name: str) -> None:
    assert ">>> " in str(getdoc(getattr(boreprop, name))).partition("\nExamples\n--------\n")[2]


@pytest.mark.parametrize("name", [name for name in PUBLIC if name != "BorepropError"])
def test_a_docstring_has_its_sections(name: str) -> None:
    """Numpydoc sections for parameters, and for what a function returns."""
    thing = getattr(boreprop, name)
    text, takes = str(getdoc(thing)), signature(thing).parameters
    if takes:
        assert "\nParameters\n----------\n" in text
        described = text.partition("\nParameters\n")[2].replace(",", "\n").split()
        assert set(takes) <= set(described)
    if takes and not isclass(thing) and signature(thing).return_annotation is not None:
        assert "\nReturns\n-------\n" in text
