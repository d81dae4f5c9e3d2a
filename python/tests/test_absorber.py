"""Absorbers: designs in letters and in numbers."""

import math

import pytest

import lindstedt as ls


def formulas(absorber, design):
    [own] = [each for each in absorber.designs if each.name == design]
    return {each.name: each for each in own.formulas}


def test_designs_are_formulas_in_letters():
    equal = formulas(ls.absorber("tuned"), "equal-peaks")
    assert equal["tuning"].formula == "1/(1 + mu)"
    assert equal["height"].value is None


def test_numbers_stand_beside_the_truth():
    damper = ls.absorber("tuned", mu="1/20")
    height = formulas(damper, "equal-peaks")["height"]
    assert math.isclose(height.value, math.sqrt(41)) and math.isclose(height.truth, height.value)
    assert damper.verdict == "pass"
    sink = ls.absorber("impact-sink", r=0.65, b=1, at={"mu": 0.01})
    least = formulas(sink, "threshold")["amplitude"]
    assert math.isclose(least.value, 0.1338258497, rel_tol=1e-9)
    assert sink.motion.largest_distance < 0.1


def test_what_an_absorber_cannot_be_is_refused():
    with pytest.raises(ls.Refused, match="the mass ratio is positive"):
        ls.absorber("tuned", mu=-1)
    with pytest.raises(ls.UsageError):
        ls.absorber("tunde")


def test_similar_springs_keep_the_peaks_equal():
    springs = formulas(ls.absorber("nonlinear", mu="1/20", alpha3=1, F="1/100"), "similar-springs")
    assert math.isclose(springs["cubic"].value, springs["cubic"].truth, rel_tol=0.01)
    lower, upper = springs["lower_height"].truth, springs["upper_height"].truth
    assert math.isclose(lower, upper, rel_tol=1e-3)
