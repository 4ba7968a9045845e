/* The law in space as the integrator asks for it: a step tried, bounded values along it, and the way of the bit. */
#ifndef BOREPROP_SPACE_LAW_H
#define BOREPROP_SPACE_LAW_H

#include "newton.h"

/* A bounded value, from what the law has said. */
static inline double bounded_value(const Law *law, const Bound *bound, const Reply *at) {
    int i = bound->part;
    if (i == law->n - 1) return length_of(at->F_0) / at->eta_pi * (law->inputs.psi_star / at->psi_star);
    double delta[2] = {at->q[i][0], at->q[i][1]};
    int support = support_at(&law->contact, law->n, i);
    for (int k = 0; k < law->touching.touching; k++) {
        if (law->touching.C[k] == i) return length_of(at->v[k]) - law->y_star[i];
        for (int d = 0; d < 2; d++)
            delta[d] += compliance(&law->modes->beam, support, law->touching.support[k]) * at->F[k][d];
    }
    return length_of(delta);
}

/* A bounded value at one place of a trial step. */
static inline double law_at(
    const Law *law, const Bound *bound, const Trial *trial, double xi, const double x[COMPONENTS],
    double delayed[][DIRECTIONS]
) {
    Behind behind;
    Turning turning;
    double t = (xi - trial->step.xi) / trial->step.h;
    int point = 0;
    while (point < POINTS - 1 && POINT[point] < t) point++;
    Reply at = trial->at[point];
    look_behind(law, &delayed[0][0], DIRECTIONS, 1, &behind);
    look_along(law, &trial->step.frame, trial->step.x, &turning);
    View view = view_at(&turning, t);
    if (!law_here(law, x, xi - law->inputs_xi, &view, &behind, delayed[0], 0, &at)) return (double)NAN;
    return bounded_value(law, bound, &at);
}

/* A bounded value at the points of a trial step. */
static inline void law_along(const Law *law, const Bound *bound, const Trial *trial, double values[POINTS]) {
    for (int k = 0; k < POINTS; k++) values[k] = bounded_value(law, bound, &trial->at[k]);
}

/* Go on to `xi` on the path north, east and down: ∫ T dξ, T = Q R(−ψ⃗)(0, 0, 1)ᵀ, by Gauss's three points. */
static inline void move_turning(const Step *step, const Turning *turning, double xi, double path[AXES]) {
    double nodes[3] = {0.5 - sqrt(0.15), 0.5, 0.5 + sqrt(0.15)}, weights[3] = {5.0 / 18, 8.0 / 18, 5.0 / 18};
    double length = xi - step->xi;
    for (int k = 0; k < 3; k++) {
        double t = nodes[k] * length / step->h, turned[3], back[2];
        Frame frame = frame_at(turning, t);
        for (int d = 0; d < 2; d++)
            back[d] = polynomial_slope(step->x[LATERAL + d], t) / step->h - polynomial(step->x[ANGLE + d], t);
        for (int axis = NORTH; axis <= DOWN; axis++) {
            turned_row(frame.row[axis], back, turned);
            path[axis] += weights[k] * length * turned[AHEAD];
        }
    }
}

static inline void move_along(const Step *step, double xi, double path[AXES]) {
    Turning turning;
    if (xi == step->xi) return;
    make_turning(&step->frame, step->x, 1, &turning);
    move_turning(step, &turning, xi, path);
}

/* Let path and frame of the next step begin where the last one has led at `xi`. */
static inline void lead_on(const Step *last, double xi, Step *next) {
    Turning turning;
    make_turning(&last->frame, last->x, 1, &turning);
    memcpy(next->path, last->path, sizeof next->path);
    move_turning(last, &turning, xi, next->path);
    next->frame = frame_at(&turning, (xi - last->xi) / last->h);
}

#define RIGHT_ANGLE 1.5707963267948966

/* Whether the bit, in the state `x` at the end of a trial step, has turned over: its axis is at more than a right angle to
   the hole between it and the last stabilizer. */
static inline int turns_over(const Law *law, const Trial *trial, const double x[COMPONENTS]) {
    double turn[2];
    for (int d = 0; d < 2; d++)
        turn[d] = (x[LATERAL + d] - trial->delayed[law->n - 1][d][POINTS - 1]) / law->s_n - x[ANGLE + d];
    return !(length_of(turn) <= RIGHT_ANGLE);
}

#endif
