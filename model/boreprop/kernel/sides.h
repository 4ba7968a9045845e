/* What acts on the bit by its frame: the weight across it, and the force of the pads to one side. */
#ifndef BOREPROP_SIDES_H
#define BOREPROP_SIDES_H

#include "frame.h"
#include "system.h"

/* A vector that depends on the frame, with its derivatives by θ and by Y while the hole behind stays. */
typedef struct {
    double value[2], by_theta[2][2], by_Y[2][2];
} Vector;

static const Vector NO_VECTOR = {{0.0}, {{0.0}}, {{0.0}}};

/* The weight: G = −((QP)₂·down, (QP)₃·down), P = R(a), a = ⟨Θ⟩_1 − θ; where the axial load counts, P = 1. Derivatives only if
   `slopes` are asked for. */
static inline void weight_across(const double down[3], const double a[2], int axial, int slopes, Vector *G) {
    double sine = 0.0, cosine = 0.0, square = a[0] * a[0] + a[1] * a[1], along = down[HIGH] * a[0] + down[RIGHT] * a[1];
    if (!axial) turn_factors(square, &sine, &cosine);
    double turned = cosine * along + sine * down[AHEAD];
    for (int d = 0; d < 2; d++) G->value[d] = a[d] * turned - down[d];
    if (!slopes) return;
    memset(G->by_Y, 0, sizeof G->by_Y);
    for (int d = 0; d < 2; d++)
        for (int c = 0; c < 2; c++) G->by_theta[d][c] = d == c ? down[AHEAD] : 0.0;
    if (axial) return;
    double share = square < 1e-6 ? 0.0 : 1 / square; /* of (d/d|a|)/|a| of either factor */
    double sine_bend = square < 1e-6 ? -1.0 / 3 : ((1 - cosine * square) - sine) * share;
    double cosine_bend = square < 1e-6 ? -1.0 / 12 : (sine - 2 * cosine) * share;
    double bend = cosine_bend * along + sine_bend * down[AHEAD];
    for (int d = 0; d < 2; d++)
        for (int c = 0; c < 2; c++) {
            double by_a = (d == c ? turned : 0.0) + a[d] * (cosine * down[c] + bend * a[c]);
            G->by_Y[d][c] = by_a;
            G->by_theta[d][c] += a[d] * (sine * down[c] - cosine * down[AHEAD] * a[c]) - by_a;
        }
}

/* Within this of the axis that they are measured from no side is up, and none is north: there forces that go by the side
   fade out. The sine of half a degree. */
#define NO_SIDE 0.008726535498373935

/* The side, across the bit, to which `seen` points, a vector of the rock as its row of the frame has it; `sign` times it. */
static inline Vector side_of(const double seen[3], double sign) {
    double square = seen[HIGH] * seen[HIGH] + seen[RIGHT] * seen[RIGHT], w, bend;
    Vector side;
    if (square >= NO_SIDE * NO_SIDE) w = 1 / sqrt(square), bend = -w / square;
    else {
        double t = square / (NO_SIDE * NO_SIDE);
        w = (15 + t * (-10 + 3 * t)) / (8 * NO_SIDE);
        bend = (-20 + 12 * t) / (8 * NO_SIDE * NO_SIDE * NO_SIDE);
    }
    for (int d = 0; d < 2; d++) {
        side.value[d] = sign * w * seen[d];
        for (int c = 0; c < 2; c++) {
            side.by_theta[d][c] = -sign * seen[AHEAD] * ((d == c ? w : 0.0) + bend * seen[d] * seen[c]);
            side.by_Y[d][c] = 0.0;
        }
    }
    return side;
}

/* Rows of the frame at a place: down and north. */
typedef struct {
    double down[3], north[3];
} View;

static inline View view_at(const Turning *turning, double t) {
    View view = {{0}, {0}};
    series_at(&turning->of_down, t, view.down);
    if (turning->north) series_at(&turning->of_north, t, view.north);
    return view;
}

/* The same at the points of a step. */
static inline void view_at_points(const Turning *turning, View view[POINTS]) {
    double down[3][POINTS], north[3][POINTS] = {{0}};
    series_at_points(&turning->of_down, down);
    if (turning->north) series_at_points(&turning->of_north, north);
    for (int k = 0; k < POINTS; k++)
        for (int d = 0; d < 3; d++) view[k].down[d] = down[d][k], view[k].north[d] = north[d][k];
}

/* A force of the pads with these parts along and across the side from which the toolface counts: the high side, north or e₂. */
static inline Vector pad_force(double along, double across, int reference, const View *view) {
    Vector side = {{1.0, 0.0}, {{0}}, {{0}}}, force;
    if (reference == FROM_HIGH_SIDE) side = side_of(view->down, -1.0);
    if (reference == FROM_NORTH) side = side_of(view->north, 1.0);
    for (int d = 0; d < 2; d++) {
        double turn = d ? 1.0 : -1.0;
        force.value[d] = along * side.value[d] + turn * across * side.value[!d];
        for (int c = 0; c < 2; c++) {
            force.by_theta[d][c] = along * side.by_theta[d][c] + turn * across * side.by_theta[!d][c];
            force.by_Y[d][c] = 0.0;
        }
    }
    return force;
}

#endif
