/* The hole behind the bit: the survey of the existing hole, the drilled history, and the delayed look-up. */
#ifndef BOREPROP_HOLE_H
#define BOREPROP_HOLE_H

#include "law.h"

/* The existing hole: inclination (rad) at measured depths (m), linear in between, straight above the first station.
   The last station is the bit at the start of the run. */
typedef struct {
    Count count;
    const double *measured_depth, *inclination;
} Survey;

static inline int check_survey(const Survey *survey, char why[MESSAGE]) {
    if (survey->count < 1) {
        snprintf(why, MESSAGE, "measured_depth: must hold at least one station, got ()");
        return 0;
    }
    if (!check_increasing("measured_depth", survey->count, survey->measured_depth, why)) return 0;
    for (Count k = 0; k < survey->count; k++)
        if (!check_finite("inclination", survey->inclination[k], why)) return 0;
    return 1;
}

/* From `start` to the start of the next piece Y = Σ c[m] t^m with t = (ξ − start) · rate. If it was drilled, θ is a sum
   like that, and these were the inputs from its start on; ηΠ is zero if it is of the survey. */
typedef struct {
    double start, rate, c[S + 1], theta[S + 1];
    ScaledInputs inputs;
} Piece;

/* A jump in derivative `order` of Y at `xi`, that the stabilizers will pass. */
typedef struct {
    double xi, jump, order;
} Kink;

/* The rings that hold the borehole's lateral coordinate Y(ξ) = ∫Θ dξ and its kinks: number k lies at k modulo the
   capacity, a power of two. Y counts from an origin that moves with the bit, so only differences mean anything. */
typedef struct {
    Piece *pieces;
    Kink *kinks;
    Count capacity;
} Hole;

/* The pieces of the hole that are kept, oldest first: number `first` up to the one before `end`. */
typedef struct {
    Count first, end;
} Pieces;

static inline Piece *piece(const Hole *hole, Count k) { return &hole->pieces[k & (hole->capacity - 1)]; }

static inline Kink *kink(const Hole *hole, Count k) { return &hole->kinks[k & (hole->capacity - 1)]; }

/* Whether the survey begins below the reach of the BHA; then one more station stands above it. */
static inline int starts_late(const Survey *survey, double length_scale, double reach) {
    return (survey->measured_depth[0] - survey->measured_depth[survey->count - 1]) / length_scale >= -reach;
}

/* Position of station k of the survey, in ℓ₁ from the bit, and the inclination there. */
static inline double station(const Survey *survey, double length_scale, double reach, Count k, double *inclination) {
    int late = starts_late(survey, length_scale, reach);
    Count own = k - (late && k > 0);
    double xi = (survey->measured_depth[own] - survey->measured_depth[survey->count - 1]) / length_scale;
    *inclination = survey->inclination[own];
    return late && k == 0 ? smaller(xi, -reach) - 1.0 : xi;
}

/* Number of the last station before the reach of the BHA, and of all. */
static inline Count first_station(const Survey *survey, double length_scale, double reach, Count *count) {
    double inclination;
    Count first = 0;
    *count = survey->count + starts_late(survey, length_scale, reach);
    while (first + 1 < *count && station(survey, length_scale, reach, first + 1, &inclination) <= -reach) first++;
    return first;
}

/* Take the last `reach` (in ℓ₁) of the survey; the bit is at ξ = 0, where Y = 0. Gives the inclination there.
   The kinks in it become numbers 0 … count−1. */
static inline double take_survey(
    const Hole *hole, const Survey *survey, double length_scale, double reach, Pieces *pieces, Count *kinks
) {
    Count count, first = first_station(survey, length_scale, reach, &count);
    double Y = 0.0, bend = 0.0, end_inclination, final_inclination;
    double end = station(survey, length_scale, reach, count - 1, &end_inclination);
    final_inclination = end_inclination;
    pieces->first = 0, pieces->end = count - 1 - first;
    for (Count k = pieces->end - 1; k >= 0; k--) {
        double inclination, xi = station(survey, length_scale, reach, first + k, &inclination), width = end - xi;
        double slope = inclination * width, curve = (end_inclination - inclination) * width / 2;
        Piece arc = {xi, 1 / width, {Y -= slope + curve, slope, curve}, {0}, {0, 0, 0}};
        *piece(hole, k) = arc;
        end = xi, end_inclination = inclination;
    }
    *kinks = 0;
    for (Count k = 0; k < pieces->end; k++) {
        double from, to, before = bend;
        station(survey, length_scale, reach, first + k, &from);
        station(survey, length_scale, reach, first + k + 1, &to);
        bend = (to - from) * piece(hole, k)->rate;
        Kink passed = {piece(hole, k)->start, fabs(bend - before), 2.0};
        if (k > 0) *kink(hole, (*kinks)++) = passed;
    }
    return final_inclination;
}

/* Add the piece that was drilled last; the piece before ends where it starts. */
static inline void append(const Hole *hole, Pieces *pieces, const Piece *drilled) {
    *piece(hole, pieces->end++) = *drilled;
}

/* Number of the piece that covers `xi`. */
static inline Count find(const Hole *hole, Pieces pieces, double xi) {
    Count low = pieces.first, high = pieces.end; /* the first that starts beyond xi is among low … high */
    while (low < high) {
        Count middle = low + (high - low) / 2;
        if (xi < piece(hole, middle)->start) high = middle;
        else low = middle + 1;
    }
    return low > pieces.first ? low - 1 : low;
}

static inline double polynomial(const double c[S + 1], double t) {
    return c[0] + t * (c[1] + t * (c[2] + t * (c[3] + t * (c[4] + t * c[5]))));
}

static inline double polynomial_slope(const double c[S + 1], double t) {
    return c[1] + t * (2 * c[2] + t * (3 * c[3] + t * (4 * c[4] + t * 5 * c[5])));
}

/* Lateral coordinate of the hole axis at `xi`. */
static inline double hole_Y(const Hole *hole, Pieces pieces, double xi) {
    const Piece *at = piece(hole, find(hole, pieces, xi));
    return polynomial(at->c, (xi - at->start) * at->rate);
}

/* Y' at `xi`: the inclination; where the hole was drilled, but for the error of a step between its nodes. */
static inline double hole_Theta(const Hole *hole, Pieces pieces, double xi) {
    const Piece *at = piece(hole, find(hole, pieces, xi));
    return polynomial_slope(at->c, (xi - at->start) * at->rate) * at->rate;
}

/* Y at `xi` + t h for the points t of a step: one search, then a walk from piece to piece. */
static inline void look_up(const Hole *hole, Pieces pieces, double xi, double h, double values[POINTS]) {
    Count k = find(hole, pieces, xi);
    for (int i = 0; i < POINTS; i++) {
        double at = xi + POINT[i] * h;
        while (k + 1 < pieces.end && at > piece(hole, k + 1)->start) k++;
        const Piece *own = piece(hole, k);
        values[i] = polynomial(own->c, (at - own->start) * own->rate);
    }
}

/* Move the origin of the lateral coordinate by `Y`. The moved pieces are new ones: the old ones stay where they are. */
static inline void shift(const Hole *hole, Pieces *pieces, double Y) {
    for (Count k = pieces->first, count = pieces->end - k; count > 0; k++, count--) {
        Piece *moved = piece(hole, pieces->end++);
        *moved = *piece(hole, k);
        moved->c[0] -= Y;
        pieces->first = k + 1;
    }
}

#endif
