"""Whatever the questions accept gives a case file that is read back."""

from pathlib import Path

from hypothesis import assume, given
from hypothesis import strategies as st

from boreprop.case.file import parse_case
from boreprop.case.template import Answer, template
from boreprop.cli.questions import QUESTIONS
from boreprop.errors import InputError


@given(data=st.data())
def test_accepted_answers_give_a_case(data: st.DataObject) -> None:
    answers: dict[str, Answer] = {}
    for question in QUESTIONS:
        amounts = st.one_of(
            st.sampled_from([question.at_least, question.at_most]), st.floats(question.at_least, question.at_most)
        )
        if question.name in ("hole_size", "collar_outer", "collar_inner", "rss_position", "under_gauge"):
            amounts = st.one_of(amounts, st.floats(question.at_least, question.at_least + 0.3 * question.at_most))
        values = data.draw(st.lists(amounts, min_size=1, max_size=6 if question.several else 1))
        text = ", ".join(map(repr, sorted(values)))
        try:
            answers[question.name] = question.check(question.read(text), answers)
        except InputError:
            assume(question.name in ("collar_outer", "collar_inner", "stabilizers", "under_gauge", "rss_position"))
            usual = question.offered(answers)
            try:
                answers[question.name] = question.check(question.read(usual), answers)
            except InputError:
                assume(False)
    case = parse_case(template(answers), Path("my.toml"))
    assert case.bha.flexural_stiffness > 0.0
    assert case.survey.measured_depth[-1] <= answers["measured_depth"].value * (1 + 1e-8)
