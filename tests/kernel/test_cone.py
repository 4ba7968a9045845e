"""Contacts in space, and the frame of the bit: functions of the kernel's headers, in a library of their own."""

import ctypes
from math import cos, sin
from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray

from boreprop.kernel.compiler import FOLDER, NoCompilerError, compile_library
from reference.spatial import Beam, contact_forces
from reference.spatial import System as Reference

SOURCE = """
#define SPACE
#include "state.h"

static Modes modes;

void forces_of(int n, const double *s, const double *y_star, double q[6][2], double v[6][2], double F[6][2]) {
    Scaled scaled = {.n = n};
    Axial unloaded = {0.0, 0.0};
    Contact nothing = {{0}, 0, {0}};
    memcpy(scaled.s, s, (size_t)n * sizeof *s), memcpy(modes.y_star, y_star, (size_t)(n - 1) * sizeof *s);
    load_beam(&modes, &scaled, unloaded);
    Contact found = settle_discs(&modes, q, v, nothing);
    for (int i = 0; i < n - 1; i++) {
        double beyond[2], slope[2][2];
        beyond_disc(v[i], y_star[i], beyond, slope);
        for (int d = 0; d < 2; d++) F[i][d] = found.of[i] ? -beyond[d] / compliance(&modes.beam, i, i) : 0.0;
    }
}

void approached(int m, const double *K_inv, const double *y_star, double q[][2], double F[][2]) {
    double v[MAX_PLACES][2], slope[2][2];
    Touching of = {.touching = m};
    for (int a = 0; a < m; a++) {
        of.y[a] = y_star[a], of.k[a] = K_inv[a * m + a];
        memcpy(of.K_inv[a], &K_inv[a * m], (size_t)m * sizeof *K_inv);
    }
    approach(&of, q, v);
    for (int a = 0; a < m; a++) {
        F[a][0] = F[a][1] = 0.0;
        if (!is_beyond(v[a], y_star[a])) continue;
        beyond_disc(v[a], y_star[a], F[a], slope);
        for (int d = 0; d < 2; d++) F[a][d] /= -of.k[a];
    }
}

void turned_frame(const double theta[2][S + 1], double t, double rows[3][3]) {
    Frame start = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
    start = turned_along(&start, theta, t);
    memcpy(rows, start.row, sizeof start.row);
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


def pointer(values: NDArray[np.float64]) -> ctypes.c_void_p:
    return values.ctypes.data_as(ctypes.c_void_p)


def test_contact_forces_are_those_of_the_short_program_wherever_they_are_sought_from(rooms: ctypes.CDLL) -> None:
    random = np.random.default_rng(4)
    for _ in range(300):
        n = int(random.integers(2, 7))
        s = np.cumsum(np.append(1.0, random.uniform(0.3, 2.0, n - 1)))
        y_star = random.uniform(0.0, 3e-3, n - 1) * random.integers(0, 2, n - 1)
        q = np.zeros((6, 2))
        q[: n - 1] = random.normal(size=(n - 1, 2)) * 10.0 ** random.uniform(-4, -1)
        v, F = random.normal(size=(6, 2)) * random.choice([1e-4, 1.0]), np.zeros((6, 2))
        rooms.forces_of(n, pointer(s), pointer(y_star), pointer(q), pointer(v), pointer(F))
        K_inv = Beam(Reference(tuple(s), (), 0.2, 0.0, 1, 1, 1, 0.0, np.zeros(1), np.zeros((1, 2)), np.eye(3))).K_inv
        expected = contact_forces(K_inv, q[: n - 1], y_star.tolist(), np.zeros((n - 1, 2)))
        assert F[: n - 1] == pytest.approx(expected, abs=1e-9 * abs(expected).max() + 1e-15)


def test_contacts_of_stabilizers_close_together_keep_to_their_discs(rooms: ctypes.CDLL) -> None:
    """What the short program's sweeps do not end at: a centimetre between stabilizers, clearances of any size."""
    random = np.random.default_rng(5)
    for _ in range(300):
        n = int(random.integers(3, 7))
        spans = 10.0 ** np.where(random.random(n - 1) < 0.3, random.uniform(-2.5, -1.0, n - 1), 0.0)
        s, y_star = np.cumsum(np.append(1.0, spans)), 10.0 ** random.uniform(-9.0, -2.0, n - 1)
        q, F = np.zeros((6, 2)), np.zeros((6, 2))
        q[: n - 1] = np.outer(s[:-1] ** 2, random.normal(size=2)) * 1e-3 + random.normal(size=(n - 1, 2)) * 1e-6
        v = q.copy()
        rooms.forces_of(n, pointer(s), pointer(y_star), pointer(q), pointer(v), pointer(F))
        K_inv = Beam(Reference(tuple(s), (), 0.2, 0.0, 1, 1, 1, 0.0, np.zeros(1), np.zeros((1, 2)), np.eye(3))).K_inv
        F, delta = F[: n - 1], K_inv @ F[: n - 1] + q[: n - 1]
        size = np.hypot(*F.T)
        rounding = 1e-10 * (abs(K_inv) @ size).max() + 1e-16
        assert (np.hypot(*delta.T) <= y_star + rounding).all()
        assert (abs(np.sum(delta * F, axis=1) + y_star * size) <= 2 * rounding * size + 1e-20).all()


def test_contacts_of_many_supports_are_approached_from_any_start(rooms: ctypes.CDLL) -> None:
    """Some without clearance, under loads of any size: the forces keep to what the contact problem asks for."""
    random = np.random.default_rng(6)
    for _ in range(150):
        n = int(random.integers(3, 32))
        spans = 10.0 ** np.where(random.random(n) < 0.3, random.uniform(-2.0, -1.0, n), 0.0)
        s, y_star = np.cumsum(spans), 10.0 ** random.uniform(-8.0, -2.0, n) * (random.random(n) < 0.8)
        q = (
            np.outer(s**2, random.normal(size=2)) * 10.0 ** random.uniform(-6.0, -1.0)
            + random.normal(size=(n, 2)) * 1e-6
        )
        K_inv = np.minimum.outer(s, s) ** 2 * (3 * np.maximum.outer(s, s) - np.minimum.outer(s, s))  # of a cantilever
        F = np.zeros((n, 2))
        rooms.approached(n, pointer(K_inv), pointer(y_star), pointer(q), pointer(F))
        delta, size = K_inv @ F + q, np.hypot(*F.T)
        rounding = 1e-10 * (K_inv @ size).max() + 1e-16
        assert (np.hypot(*delta.T) <= y_star + rounding).all()
        assert (abs(np.sum(delta * F, axis=1) + y_star * size) <= 2 * rounding * size + 1e-20).all()


def test_the_frame_is_carried_without_twist_to_rounding(rooms: ctypes.CDLL) -> None:
    """Against a product of many short turns, and exactly along an arc."""
    theta = np.array([[0.1, 0.3, -0.2, 0.5, 0.1, -0.3], [0.2, -0.4, 0.3, 0.2, -0.6, 0.2]])
    found, steps = np.empty((3, 3)), 20000
    rooms.turned_frame(pointer(theta), ctypes.c_double(1.0), pointer(found))
    frame = np.eye(3)
    for k in range(steps):
        middle = [sum(m * c * ((k + 0.5) / steps) ** (m - 1) for m, c in enumerate(row) if m) / steps for row in theta]
        angle = float(np.hypot(*middle))
        a, b = middle[0] / angle, middle[1] / angle
        axis = np.array([[0, 0, a], [0, 0, b], [-a, -b, 0]])
        frame = frame @ (np.eye(3) + sin(angle) * axis + (1 - cos(angle)) * axis @ axis)
    assert found == pytest.approx(frame, abs=1e-9)
    arc = np.array([[0.4, 0.7, 0.0, 0.0, 0.0, 0.0], [0.0] * 6])
    rooms.turned_frame(pointer(arc), ctypes.c_double(0.5), pointer(found))
    expected = [[cos(0.35), 0.0, sin(0.35)], [0.0, 1.0, 0.0], [-sin(0.35), 0.0, cos(0.35)]]
    assert found == pytest.approx(np.array(expected), abs=2e-16)
