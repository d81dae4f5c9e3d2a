"""Every command in process: the document is that of the program, errors are exceptions."""

import functools
import json
import os
import pickle
import signal
import subprocess
import sys
import threading
import time
from fractions import Fraction
from pathlib import Path

import lindstedt as ls
import pytest
from lindstedt import _lindstedt, errors
from lindstedt._call import Call, answer
from lindstedt.documents import KINDS

EXAMPLES = Path(__file__).resolve().parents[2] / "examples"

#: A call of every command that has a document, and of every kind of document.
CALLS = {
    "derive": lambda: ls.derive("pendulum", A="3/2"),
    "damped": lambda: ls.derive("damped-pendulum"),
    "driven": lambda: ls.derive("forced-duffing"),
    "cycle": lambda: ls.derive("van-der-pol"),
    "balance": lambda: ls.derive("duffing", "harmonic-balance", order=2),
    "modes": lambda: ls.modes("x'' + 2*x - y + x^3/2 = 0; y'' + 2*y - x = 0", a="1/2"),
    "one-harmonic": lambda: ls.derive(
        "x'' + 2*x - y + x^3/2 = 0; y'' + 2*y - x = 0", "harmonic-balance", A="1/2"
    ),
    "slow-equations": lambda: ls.slow_equations(EXAMPLES / "slow" / "exchange.toml"),
    "compare": lambda: ls.compare("pendulum", A=1),
    "impact": lambda: ls.impact(EXAMPLES / "impact-paper.toml"),
    "impact-comparison": lambda: ls.impact(compare=True),
    "impact-certificate": lambda: ls.impact(certify=True),
    "simulation": lambda: ls.simulate(),
    "chain": lambda: ls.simulate(chain=True),
    "sweep": lambda: ls.simulate(sweep={"zeta": (0.01, 0.03, 3)}),
    "motion": lambda: ls.simulate("duffing", x=1, eps=0.1, until=5),
    "motion-sweep": lambda: ls.simulate("duffing", x=1, until=5, sweep={"eps": [0.1, 0.2]}),
    "response": lambda: ls.response(
        "x'' + x'/10 + x + x^3/10 = F*cos(W*t)", vary={"W": (0.8, 1.2)}, F="1/10"
    ),
    "response with events": lambda: ls.response(
        "x'' + x'/5 + x = 0", event=["sin(w*t) > 0: x' = x' + 1/2"], vary={"w": (0.9, 1.1)}
    ),
    "basins": lambda: ls.simulate(
        "x'' + x'/2 - x + x^3 = 0",
        sweep={"x": [-1.5, 0.5, 1.5], "x'": [-1, 1]}, until=80, after=60, every=1,
    ),
    "absorber": lambda: ls.absorber("tuned", mu="1/20"),
    "orbits": lambda: ls.orbits(EXAMPLES / "orbits" / "driven-beam.toml"),
    "certified orbit": lambda: ls.orbits(EXAMPLES / "orbits" / "driven-beam.toml", certify=True),
    "shortest": lambda: ls.shortest("pendulum", range={"A": (0, 2.8)}, longest=6, error=0.01),
    "certified law": lambda: ls.shortest(
        "pendulum", range={"A": (0, 2.8)}, longest=6, error=0.01, certificate=True
    ),
    "law of contacts": lambda: ls.shortest(
        "x'' + k*x^(3/2)*(1 + lambda*x') = 0", quantity="contact-time", range={"e": (0.4, 1)}, longest=6
    ),
    "fit": lambda: ls.fit(EXAMPLES / "fit" / "impacts.csv", data="impacts"),
    "friction": lambda: ls.friction(),
    "stability": lambda: ls.stability("x'' + (delta + eps*cos(t))*x = 0"),
    "certify": lambda: ls.certify("pendulum", A=1),
    "certified cycle": lambda: ls.certify("van-der-pol", mu="1/10"),
    "certified range": lambda: ls.certify("pendulum", A=1, range=("1/10", 3), tolerance=0.01),
    "paper": lambda: ls.paper(),
    "materials": lambda: ls.materials(),
    "lagrange": lambda: ls.lagrange(EXAMPLES / "lagrange" / "pendulum.toml"),
    "optimize": lambda: ls.optimize(runs=2, budget=2000, seed=7),
    "primary": lambda: ls.simulate(EXAMPLES / "primary" / "stick-slip.toml"),
    "primary sweep": lambda: ls.simulate(
        EXAMPLES / "primary" / "stick-slip.toml", sweep={"displacement": [0.01, 0.0163]}
    ),
    "catalog": lambda: answer(Call(("catalog",))),
}


@functools.cache
def result_of(name):
    return CALLS[name]()


def test_every_kind_of_document_is_among_them():
    of_lines = {"lindstedt/study/1", "lindstedt/point/1"}
    assert {result_of(name).schema for name in CALLS} == set(KINDS) - of_lines


@pytest.mark.parametrize("name", CALLS)
def test_a_document_comes_back_whole(name):
    result = result_of(name)
    text = json.loads(result.json())
    assert result.to_json() == text
    assert pickle.loads(pickle.dumps(result)) == result
    assert result.text() and result.html().startswith("<!")
    assert repr(result).startswith("<")
    bundle = result._repr_mimebundle_()
    assert "text/plain" in bundle and "iframe" in bundle["text/html"]


@pytest.mark.parametrize("name", ["derive", "compare", "motion", "response"])
def test_the_document_is_that_of_the_program(name):
    result = result_of(name)
    words = result.call.worded("json", "--quiet")
    program = subprocess.run(
        [sys.executable, "-m", "lindstedt", *words], capture_output=True, text=True, check=True
    )
    assert program.stdout == result.json()


def test_the_program_comes_with_the_package():
    program = [sys.executable, "-m", "lindstedt"]
    derived = subprocess.run([*program, "derive", "pendulum"], capture_output=True, text=True)
    assert derived.returncode == 0 and "omega^2 = 1 - A^2/8" in derived.stdout
    wrong = subprocess.run([*program, "derive"], capture_output=True, text=True)
    assert wrong.returncode == 2 and "Usage" in wrong.stderr


def test_a_refusal_names_the_term_and_a_way_forward():
    with pytest.raises(ls.Refused) as caught:
        ls.derive("x'' + 2*zeta*x' + sin(x) = 0", "lindstedt-poincare")
    why = caught.value
    assert (why.kind, why.term) == ("refusal", "2*zeta*x'")
    assert 'method="averaging"' in why.help and "help:" not in why.message
    copy = pickle.loads(pickle.dumps(why))
    assert (copy.term, copy.help, str(copy)) == (why.term, why.help, str(why))
    with pytest.raises(ls.Refused) as caught:
        ls.Oscillator("x'' + sin(x")
    assert caught.value.kind == "oscillator"


def test_wrong_options_are_usage_errors():
    with pytest.raises(ls.UsageError) as caught:
        ls.derive("pendulum", "lindstet-poincare")
    assert "lindstedt-poincare" in caught.value.help
    with pytest.raises(ls.UsageError):
        ls.derive("pendulum", A="3/")
    with pytest.raises(TypeError):
        ls.friction(unheard_of=1)


#: Calls that are refused, with the words that say so: keywords, where the program has options.
WRONG = {
    "values": (lambda: ls.derive("duffing", A=1), "verification", "eps=VALUE"),
    "no values": (lambda: ls.compare("duffing"), "verification", "add eps=VALUE,A=VALUE"),
    "a value": (lambda: ls.derive("duffing", A="3/"), "usage", "A=3/: something is missing"),
    "an order": (lambda: ls.derive("duffing", order=-1), "usage", "for `order`: `-1` is negative"),
    "a high order": (lambda: ls.derive("duffing", order=9999), "refusal", "or `omega_only`, whose"),
    "a start": (lambda: ls.simulate("pendulum"), "command", 'from_="x=1.5" for a release'),
    "a range": (
        lambda: ls.response("x'' + x'/10 + x^3 = F*cos(W*t)"), "command", 'vary="F=FROM:TO"'
    ),
    "two at once": (
        lambda: ls.impact(certify=True, compare=True), "usage", "`compare` cannot be used with"
    ),
    "a term": (lambda: ls.stability("duffing"), "hill", "the term `eps*x^3` is not linear"),
    "no material": (lambda: ls.materials(only_own=True), "materials", "leave out `only_own`"),
    "a claim": (lambda: ls.audit({"claim": [{"id": "a"}]}), "problem", "has no quantity"),
    "a key": (lambda: ls.derive({"equatoin": "x'' + x = 0"}), "problem", "equatoin"),
    "a name": (lambda: ls.derive("pendulm"), "command", "did you mean `pendulum`?"),
}


@pytest.mark.parametrize("name", WRONG)
def test_errors_have_a_kind_and_speak_of_keywords(name):
    call, kind, words = WRONG[name]
    with pytest.raises(ls.LindstedtError) as caught:
        call()
    assert caught.value.kind == kind and words in str(caught.value)
    assert "--" not in str(caught.value)


def test_the_term_of_a_linear_equation_is_named():
    with pytest.raises(ls.Refused) as caught:
        ls.stability("duffing")
    assert caught.value.term == "eps*x^3"


def test_a_time_limit():
    with pytest.raises(ls.TimeLimit):
        ls.audit(EXAMPLES / "audit" / "paper.toml", timeout=1e-9)


def test_tables_of_a_file():
    tables = {"equation": "x'' + x + eps*x^3 = 0", "order": 2, "values": {"A": 1, "eps": "1/10"}}
    law = ls.derive(tables)
    assert law.verification.passed and law.order == 2
    assert ls.Oscillator(tables).parameters == ("eps",)


def test_progress_is_told_and_may_end_the_work():
    told = []

    def watch(done, all_parts):
        told.append((done, all_parts))
        if len(told) == 3:
            raise RuntimeError("enough")

    with pytest.raises(RuntimeError, match="enough"):
        ls.derive("x'' + x + eps*x^3 = 0", order=2000, omega_only=True, progress=watch)
    assert len(told) == 3


#: Work that takes half a minute and more where it is not stopped, and nothing else is running.
LONG = {
    "derive": lambda watch: ls.derive("duffing", "hermite-pade", order=(40, 40, 40), progress=watch),
    "simulate": lambda watch: ls.simulate(
        "x'' + x + x^3 = 0", x=1, until=1e7, step_limit=10**7, progress=watch
    ),
    "response": lambda watch: ls.response(
        "x'' + x'/1000 + sin(x) = F*cos(W*t)", vary={"W": (0.1, 3)}, F=1, progress=watch
    ),
    "optimize": lambda watch: ls.optimize(runs=10000, progress=watch),
    "audit": lambda watch: ls.audit({"claim": MANY_CLAIMS}, progress=watch),
}
MANY_CLAIMS = [
    {
        "id": str(number), "where": "a page", "says": "a law", "quantity": "law", "printed": "1",
        "equation": "x'' + x + eps*x^3 = 0", "order": 150,
    }
    for number in range(1000)
]


@pytest.mark.parametrize("name", LONG)
def test_work_that_is_stopped_leaves_the_processor(name):
    told = []

    def watch(done, all_parts):
        told.append((done, all_parts))
        if len(told) == 10:
            raise InterruptedError

    with pytest.raises(InterruptedError):
        LONG[name](watch)
    # Far more processor time than what was begun needs, and far less than all of it.
    began = time.process_time()
    while time.process_time() - began < 15:
        before = time.process_time()
        time.sleep(0.3)
        if time.process_time() - before < 0.02:
            return
    pytest.fail("the work goes on")


@pytest.mark.skipif(os.name != "posix", reason="signals")
def test_an_interrupt_ends_the_work():
    began = time.monotonic()
    timer = threading.Timer(0.3, lambda: os.kill(os.getpid(), signal.SIGINT))
    timer.start()
    with pytest.raises(KeyboardInterrupt):
        ls.optimize(runs=10000)
    assert time.monotonic() - began < 60
    # What was interrupted leaves nothing behind.
    assert ls.derive("pendulum").order == 4


def test_forms_are_the_same_whether_they_were_kept_or_made_again():
    study = ls.materials()
    again = Call(study.call.words)
    for form in ("csv", "text", "html"):
        assert study.call.form(form) == again.form(form)
    pytest.importorskip("pandas")
    frame = study.to_pandas()
    assert len(frame) == len(study.materials)
    assert frame.attrs["units"]


def test_certificates_are_written_and_checked(tmp_path):
    certificate = ls.derive("pendulum").certify(A="3/2")
    certificate.save(tmp_path / "pendulum.json")
    checked = ls.check(tmp_path / "pendulum.json")
    assert checked.passed and checked == certificate
    low, high = certificate.omega_bounds
    # The exact frequency: pi/2 over the complete elliptic integral, by the mean.
    from math import cos, sqrt

    a, b = 1.0, cos(0.75)
    for _ in range(8):
        a, b = (a + b) / 2, sqrt(a * b)
    assert float(low) == pytest.approx(a, rel=1e-15) and low < high


def test_a_range_of_amplitudes_is_proved():
    found = result_of("certified range")
    assert found.end == "further" and found.from_.exact == Fraction(1, 10)
    assert found.within <= 0.01 and found.to.exact < found.beyond.exact
    assert ls.derive("pendulum").certify(A=1, range=("1/10", 3), tolerance=0.01) == found


def test_files_of_every_ending(tmp_path):
    law = ls.derive("duffing", A=1, eps="1/10")
    for ending, begin in (
        ("json", "{"), ("tex", "%"), ("html", "<!"), ("svg", "<"), ("txt", "x''"), ("py", "#"),
        ("jl", "#"), ("m", "%"), ("rs", "/"), ("c", "/"),
    ):
        law.save(tmp_path / f"law.{ending}")
        assert (tmp_path / f"law.{ending}").read_text().startswith(begin), ending


def test_the_front_of_a_search():
    front = result_of("optimize").front
    assert len(front) and front[0].design is result_of("optimize").best
    pytest.importorskip("pandas")
    assert len(front.to_pandas()) == len(front)


def test_an_audit_with_its_claims():
    audit = ls.audit(EXAMPLES / "audit" / "frequencies.toml", strict=True)
    assert audit.counts.reproduced > 0 and audit.passed is not None
    pytest.importorskip("pandas")
    assert list(audit.to_pandas()["verdict"]).count("reproduced") == audit.counts.reproduced


def test_every_exit_code_has_an_exception():
    assert isinstance(errors.from_failure(130, "interrupted", "", None), KeyboardInterrupt)
    assert isinstance(errors.from_failure(70, "internal", "", None), ls.InternalError)
    with pytest.raises(ls.UsageError):
        answer(Call(("unheard-of",)))


def test_every_command_with_a_document_is_a_function():
    commands = {command["name"] for command in json.loads(_lindstedt.commands())}
    assert commands - set(ls.__all__) == {"schema", "completions", "man"}


def test_a_missing_package_says_how_to_get_it(monkeypatch):
    monkeypatch.setitem(sys.modules, "pandas", None)
    with pytest.raises(ls.MissingPackage, match="pip install pandas") as caught:
        ls.compare("pendulum", A=1).to_pandas()
    assert caught.value.help == "pip install pandas"
