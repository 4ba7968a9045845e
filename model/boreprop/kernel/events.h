/* Events: where a trial step first meets a bound of its regime. */
#ifndef BOREPROP_EVENTS_H
#define BOREPROP_EVENTS_H

#include "hole.h"
#ifdef SPACE
#include "space_law.h"
#else
#include "law.h"
#endif

/* How far beyond its values at the points of a step a value may lie between them, over the range of these: a bound
   farther away is not searched for. A parabola lies beyond them by an eighth of the range at most. */
#define NEAR 0.3
#define CLOSE 1e-12                  /* ℓ₁: an event is located when the places on both sides of it are this close, … */
#define CLOSE_ENOUGH (ROUNDING / 10) /* … or the value lies this near to its bound, which is rounding */
#define MOST_TRIES 60                /* to locate an event: plain bisection of the longest step would need 40 */

/* A bound that is watched along a trial step. */
typedef struct {
    const Places *places;
    const Hole *hole;
    const Law *law;
    const Trial *trial;
    const Bound *bound;
} Watch;

/* A value along a step, at `xi`, of what there is to know for it. */
typedef double ValueAlong(const void *what, double xi);

/* The bounded value of a Watch at `xi`. */
static inline double watched_value(const void *what, double xi) {
    const Watch *watch = what;
    double x[COMPONENTS], delayed[MAX_PLACES][DIRECTIONS];
    step_state(&watch->trial->step, xi, x);
    hole_at_places(watch->hole, watch->places, xi, delayed);
    return law_at(watch->law, watch->bound, watch->trial, xi, x, delayed);
}

/* Where in [a, b] a value passes `limit` on `side`, by regula falsi with the weights of Anderson and Björck; f_a and f_b
   say how far beyond it is at a and b. */
static inline double crossing(
    ValueAlong *value, const void *what, double limit, int side, double a, double b, double f_a, double f_b
) {
    double c = b;
    if (f_a >= 0) return a;
    for (int k = 0; k < MOST_TRIES; k++) {
        c = (a * f_b - b * f_a) / (f_b - f_a);
        double f_c = side * (value(what, c) - limit);
        if (isnan(f_c)) f_c = larger(f_a, f_b); /* a regime that has no answer is beyond its bounds */
        if (fabs(f_c) < CLOSE_ENOUGH || fabs(b - a) < CLOSE) break;
        if ((f_c > 0) == (f_b > 0)) {
            double weight = 1 - f_c / f_b;
            f_a *= weight > 0 ? weight : 0.5;
        } else a = b, f_a = f_b;
        b = c, f_b = f_c;
    }
    return c;
}

typedef struct {
    double xi, value;
} Sample;

/* Where a smooth function through samples in order has extremes, by a parabola through each three; returns how many. */
static inline int extremes(const Sample *samples, int count, double *found) {
    int number = 0;
    for (int k = 0; k + 2 < count; k++) {
        Sample a = samples[k], b = samples[k + 1], c = samples[k + 2];
        double slope = (b.value - a.value) / (b.xi - a.xi), later = (c.value - b.value) / (c.xi - b.xi);
        if (slope * later <= 0 && slope != later)
            found[number++] = (a.xi + b.xi) / 2 - slope * (c.xi - a.xi) / 2 / (later - slope);
    }
    return number;
}

/* Add a sample, in order. */
static inline void insert(Sample *samples, int *count, Sample added) {
    int place = (*count)++;
    for (; samples[place - 1].xi > added.xi; place--) samples[place] = samples[place - 1];
    samples[place] = added;
}

/* Where the step first meets the bound, given the values at the points; returns on which side, or 0 if it does not. */
static inline int meet(const Watch *watch, double slack, const double values[POINTS], double *where) {
    const Step *step = &watch->trial->step;
    const Bound *bound = watch->bound;
    Sample samples[2 * POINTS], start = {step->xi, watched_value(watch, step->xi)};
    double found[POINTS];
    int count = 1;
    samples[0] = start;
    for (int k = 0; k < POINTS; k++) {
        Sample at_point = {step->xi + POINT[k] * step->h, values[k]};
        samples[count++] = at_point;
    }
    int number = extremes(samples, count, found);
    double first_point = samples[1].xi;
    for (int k = 0; k < number; k++) { /* it may leave and come back between two points */
        Sample between = {found[k], 0.0};
        if (!(found[k] > first_point)) continue;
        between.value = watched_value(watch, found[k]);
        insert(samples, &count, between);
    }
    for (int k = 1; k < count; k++) { /* by rounding the start may lie beyond the bound that it has just come from */
        int side = side_beyond(samples[k].value, bound->lower, bound->upper, slack);
        double limit = side > 0 ? bound->upper : bound->lower;
        if (!side) continue;
        double before = samples[k - 1].xi, f_a = side * (watched_value(watch, before) - limit);
        double f_b = side * (samples[k].value - limit);
        *where = crossing(watched_value, watch, limit, side, before, samples[k].xi, f_a, f_b);
        return side;
    }
    return 0;
}

/* End a trial step where it first meets a bound of its regime. A bound is met if the value lies beyond it by more than
   `slack` at a point of the step or an extreme between points. */
static inline void cut_at_event(const Places *places, const Hole *hole, const Law *law, double slack, Trial *trial) {
    Step *step = &trial->step;
    for (int b = 0; b < law->bound_count; b++) {
        Watch watch = {places, hole, law, trial, &law->bounds[b]};
        double values[POINTS], where = 0.0;
        law_along(law, watch.bound, trial, values);
        double low = values[0], high = values[0];
        for (int k = 1; k < POINTS; k++) low = smaller(low, values[k]), high = larger(high, values[k]);
        double near = NEAR * (high - low);
        if (low - near >= watch.bound->lower && high + near <= watch.bound->upper) continue;
        int side = meet(&watch, slack, values, &where);
        if (side && where < step->end) step->end = where, step->event = watch.bound->part, step->side = side;
    }
}

#endif
