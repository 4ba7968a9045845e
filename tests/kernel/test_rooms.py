"""Rooms of the kernel by themselves: functions of its headers, in a library of their own."""

import ctypes
from collections.abc import Sequence
from math import cos, sin
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from boreprop.core.events import extremes
from boreprop.core.inputs import Inputs
from boreprop.core.law import Laws
from boreprop.core.modes import Modes
from boreprop.core.system import Scaled
from boreprop.kernel.compiler import FOLDER, NoCompilerError, compile_library

SOURCE = """
#include "state.h"

int extremes_of(int count, const double *xi, const double *values, double *found) {
    Sample samples[8] = {{0}};
    for (int k = 0; k < count; k++) samples[k].xi = xi[k], samples[k].value = values[k];
    return extremes(samples, count, found);
}

void inverse_of(int size, const double matrix[SIZE][SIZE], double result[SIZE][SIZE]) { inverse(size, matrix, result); }

void turned_from(double turn, double angle, double *sine_cosine) {
    turn_by(turn, sin(angle), cos(angle), &sine_cosine[0], &sine_cosine[1]);
}

int lowest_kink(int n, const double *s, int count, const double *places, const int *orders, double xi) {
    Kink ring[8];
    Kinks kinks = {ring, 8, 0, {0}};
    Places behind = {.count = n};
    for (int i = 0; i < n; i++) behind.s[i] = s[i];
    for (int k = 0; k < count; k++) add_kink(&kinks, n, places[k], orders[k], 0.1);
    return kink_here(&kinks, &behind, xi, MERGE);
}

int joined(double Y_at_the_end, double Y_of_the_next) {
    Piece piece = {.rate = 1.0};
    double next[COMPONENTS][S + 1] = {{0}};
    piece.x[LATERAL][1] = Y_at_the_end, next[LATERAL][0] = Y_of_the_next;
    return is_joined(&piece, 1.0, next);
}

void gains_of(int n, const double *s, const double *y_star, double w, double epsilon, double eta_pi, double *gains) {
    static Integrator p;
    Scaled scaled = {.n = n, .w = w};
    ScaledInputs inputs = {.eta_pi = eta_pi, .chi_pi = epsilon * eta_pi, .psi_star = 0.03};
    memcpy(scaled.s, s, (size_t)n * sizeof *s), memcpy(scaled.y_star, y_star, (size_t)(n - 1) * sizeof *s);
    prepare(&p, &scaled, 1.0, 1.0, USUAL_OPTIONS);
    find_places(&p.now, &p.scaled, 0.0);
    p.now.inputs = inputs;
    for (int i = 0; i < n; i++) gains[i] = present_law(&p)->gains[i].Theta;
}

double origin_moved(double Y) {
    static State now;
    double x[COMPONENTS + 1] = {0};
    x[LATERAL] = Y, x[COMPONENTS] = 1e9; /* which is no component */
    keep_origin_near(&now, x);
    return Y - x[LATERAL];
}
"""


@pytest.fixture(scope="module")
def rooms(tmp_path_factory: pytest.TempPathFactory) -> ctypes.CDLL:
    folder: Path = tmp_path_factory.mktemp("rooms")
    (folder / "rooms.c").write_text(SOURCE, encoding="utf-8")
    try:
        return ctypes.CDLL(str(compile_library(folder / "rooms.c", folder / "rooms.so", include=[FOLDER])))
    except NoCompilerError as error:
        pytest.skip(str(error))


def doubles(values: Sequence[float]) -> ctypes.Array[ctypes.c_double]:
    return (ctypes.c_double * len(values))(*values)


@given(st.lists(st.floats(-1.0, 1.0), min_size=3, max_size=8))
def test_extremes_are_those_of_the_core(rooms: ctypes.CDLL, values: list[float]) -> None:
    places, found = [0.1 * k * k for k in range(len(values))], doubles([0.0] * 8)
    count = rooms.extremes_of(len(values), doubles(places), doubles(values), found)
    assert list(found[:count]) == pytest.approx(extremes(list(zip(places, values, strict=True))), rel=1e-12)


@pytest.mark.parametrize("matrix", [[[1.0, 2.0, 0.0], [-2.0, 1.0, 1.0], [1e-20, 3.0, 1.0]], [[0.0, 1.0], [1.0, 0.0]]])
def test_an_inverse_pivots_on_the_largest_number_of_either_sign(rooms: ctypes.CDLL, matrix: list[list[float]]) -> None:
    size, padded, result = len(matrix), np.zeros((64, 64)), np.empty((64, 64))
    padded[:size, :size] = matrix
    rooms.inverse_of(size, padded.ctypes, result.ctypes)
    assert result[:size, :size] @ matrix == pytest.approx(np.eye(size), abs=1e-14)


@given(st.floats(-0.05, 0.05), st.floats(-3.0, 3.0))
def test_the_series_for_a_small_turn_are_exact_to_rounding(rooms: ctypes.CDLL, turn: float, angle: float) -> None:
    found = doubles([0.0, 0.0])
    rooms.turned_from(ctypes.c_double(turn), ctypes.c_double(angle), found)
    assert list(found) == pytest.approx([sin(angle + turn), cos(angle + turn)], abs=1.5e-15)


@pytest.mark.parametrize(("orders", "lowest"), [((2, 1), 2), ((1, 2), 2), ((1, 1), 2), ((2, 3), 3), ((3, 2), 3)])
def test_the_lowest_derivative_of_the_kinks_at_one_place_counts(
    rooms: ctypes.CDLL, orders: tuple[int, int], lowest: int
) -> None:
    """At ξ = 3 the second stabilizer passes a kink at 1 and the first one a kink at 2."""
    kinks = 2, doubles([1.0, 2.0]), (ctypes.c_int * 2)(*orders)
    assert rooms.lowest_kink(2, doubles([1.0, 2.0]), *kinks, ctypes.c_double(3.0)) == lowest


@pytest.mark.parametrize(("step", "whole"), [(0.0, 1), (1e-6, 0), (-1e-6, 0)])
def test_a_hole_that_jumps_to_either_side_is_not_in_one_piece(rooms: ctypes.CDLL, step: float, whole: int) -> None:
    assert rooms.joined(ctypes.c_double(0.3), ctypes.c_double(0.3 + step)) == whole


@pytest.mark.parametrize(("Y", "moved"), [(7.9, 0.0), (-7.9, 0.0), (8.1, 8.1), (-8.1, -8.1)])
def test_the_origin_moves_to_the_bit_where_that_is_far_and_not_before(
    rooms: ctypes.CDLL, Y: float, moved: float
) -> None:
    rooms.origin_moved.restype = ctypes.c_double
    assert rooms.origin_moved(ctypes.c_double(Y)) == moved


def test_a_jump_at_a_stabilizer_counts_as_much_as_in_the_core(rooms: ctypes.CDLL) -> None:
    """Also where weight makes sin⟨Θ⟩_1, and with it the first stabilizer, count most."""
    scaled = Scaled((1.0, 1.7, 2.9), (1e-3, 2e-3), 0.0, 5.0, 0.1, 0.03)
    modes, gains = Modes(scaled), doubles([0.0] * 3)
    inputs = Inputs(0.0, 0.05, scaled.epsilon * 0.05, scaled.psi_star)
    numbers = map(ctypes.c_double, (scaled.w, scaled.epsilon, 0.05))
    rooms.gains_of(3, doubles(scaled.s), doubles(scaled.y_star), *numbers, gains)
    assert list(gains) == pytest.approx(Laws(modes, inputs, 0.0)[modes.free()].gains, rel=1e-12)
