/* Derivatives of the outputs in space that cannot jump, along the hole. */
#ifndef BOREPROP_SPACE_DERIVATIVES_H
#define BOREPROP_SPACE_DERIVATIVES_H

#include "outputs.h"

#define A_STEP 1e-4 /* ℓ₁: over which the slope of a mean inclination is taken */

/* Where a lateral coordinate of the hole goes at a distance behind the bit, in ℓ₁, as the hole there has it. */
static inline double heading_behind(const Drilling *d, const Present *at, double s, int direction) {
    const State *now = &d->integrator.now;
    if (s == 0.0) return at->is.Theta[direction];
    const Piece *own = piece(&now->hole, find(&now->hole, now->xi - s));
    double way = (now->xi - s - own->start) * own->rate;
    return polynomial_slope(own->x[LATERAL + direction], way) * own->rate;
}

/* Change per ℓ₁ of the mean inclination of the hole between stabilizers i − 1 and i, while the bit turns at `rate`. */
static inline double mean_inclination_slope(const Drilling *d, const Present *at, const double rate[2], int i) {
    static const double nothing[2] = {0.0, 0.0};
    const Scaled *scaled = &d->integrator.scaled;
    double length = lambda_(scaled, i), reached[2];
    const double *from = i ? at->is.e[i - 1] : nothing, *to = at->is.e[i];
    for (int side = 0; side < 2; side++) {
        double way = side ? A_STEP : -A_STEP, turn[2], behind[2];
        for (int k = 0; k < 2; k++) {
            double start = heading_behind(d, at, i ? scaled->s[i - 1] : 0.0, k);
            double change = (start - heading_behind(d, at, scaled->s[i], k)) - length * rate[k];
            turn[k] = way * rate[k], behind[k] = to[k] - from[k] + way * change;
        }
        Present there = *at;
        there.is.frame = turn_frame(&at->is.frame, turn);
        reached[side] = mean_inclination(&there, nothing, behind, length);
    }
    return (reached[1] - reached[0]) / (2 * A_STEP);
}

/* Change of an output, or of the one with this index, per metre drilled; NaN if it may jump or bend on the way. */
static inline double output_slope(const Drilling *d, const Present *at, Output which, int i) {
    double rate[2], turn[AXES];
    for (int k = 0; k < 2; k++) rate[k] = at->is.at.M[k] / at->inputs.chi_pi; /* χΠ θ⃗' = M⃗ */
    for (int axis = NORTH; axis <= DOWN; axis++) {                            /* d' = e₂ θ₂' + e₃ θ₃' */
        const double *row = at->is.frame.row[axis];
        turn[axis] = row[HIGH] * rate[0] + row[RIGHT] * rate[1];
    }
    double north = at->is.frame.row[NORTH][AHEAD], east = at->is.frame.row[EAST][AHEAD], level = hypot(north, east);
    double away = hypot(at->path[NORTH], at->path[EAST]);
    switch (which) {
        case OUT_DRILLED_LENGTH: return 1.0;
        case OUT_BIT_INCLINATION: { /* the part of d' in the vertical plane of d */
            double out = level > 0 ? (north * turn[NORTH] + east * turn[EAST]) / level : hypot(turn[NORTH], turn[EAST]);
            return (at->is.frame.row[DOWN][AHEAD] * out - level * turn[DOWN]) / at->l1;
        }
        case OUT_BIT_AZIMUTH: return (north * turn[EAST] - east * turn[NORTH]) / (level * level * at->l1);
        case OUT_AVERAGE_INCLINATION: return mean_inclination_slope(d, at, rate, i) / at->l1;
        case OUT_NORTH: return at->T[NORTH];
        case OUT_EAST: return at->T[EAST];
        case OUT_DISPLACEMENT:
            if (away == 0.0) return hypot(at->T[NORTH], at->T[EAST]);
            return (at->path[NORTH] * at->T[NORTH] + at->path[EAST] * at->T[EAST]) / away;
        case OUT_TRUE_VERTICAL_DEPTH: return at->T[DOWN];
        default: return NAN;
    }
}

#endif
