/* The hole behind the bit: what is kept of the survey and of the drilled history, and the delayed look-up. */
#ifndef BOREPROP_HOLE_H
#define BOREPROP_HOLE_H

#include "kinks.h"
#include "step.h"
#include "survey.h"

/* From `start` to the start of the next piece the state is x[c] = Σ x[c][m] t^m with t = (ξ − start) · rate. The inputs
   are those at its start. A piece of the survey has lateral coordinates only, and its ηΠ is zero. */
typedef struct {
    double start, rate, x[COMPONENTS][S + 1];
    ScaledInputs inputs;
} Piece;

/* The borehole's lateral coordinate Y(ξ) = ∫Θ dξ. It counts from an origin that moves with the bit, so only differences
   mean anything. The pieces that are kept, oldest first, are number `first` up to the one before `end`; number k lies at
   k modulo the capacity of the ring, a power of two. A look-up at place i begins at piece cursor[i] if that piece
   lies before the place, and searches all pieces otherwise: where the cursors stand affects the speed only. */
typedef struct {
    Piece *ring;
    Count capacity, first, end, cursor[MAX_PLACES];
} Hole;

static inline Piece *piece(const Hole *hole, Count k) { return &hole->ring[k & (hole->capacity - 1)]; }

/* Take the last `reach` (in ℓ₁) of the survey; the bit is at ξ = 0, where Y = 0. Returns how the hole heads there. */
static inline Heading take_survey(Hole *hole, const Survey *survey, double length_scale, double reach) {
    Count count, first = first_station(survey, length_scale, reach, &count);
    const Heading final = last_heading(survey);
    Heading heading = final;
    double Y[DIRECTIONS] = {0}, end = station(survey, length_scale, reach, count - 1);
    hole->first = 0, hole->end = count - 1 - first;
    for (Count k = hole->end - 1; k >= 0; k--) {
        const Heading ahead = heading;
        double xi = station(survey, length_scale, reach, first + k), width = end - xi;
        head_back(survey, given_station(survey, length_scale, reach, first + k), &heading);
        Piece *own = piece(hole, k);
        memset(own, 0, sizeof *own);
        own->start = xi, own->rate = 1 / width;
        for (int d = 0; d < DIRECTIONS; d++) {
            double slope = heading.angle[d] * width, bend = (ahead.angle[d] - heading.angle[d]) * width / 2;
            double arc[S + 1] = {Y[d] -= slope + bend, slope, bend};
            memcpy(own->x[LATERAL + d], arc, sizeof arc);
        }
        end = xi;
    }
    return final;
}

/* Let a step of length zero stand at the end of the survey, where the hole heads so. */
static inline void face(Step *step, const Heading *heading) {
    memset(step, 0, sizeof *step);
    step->h = 1.0;
#ifdef SPACE
    step->frame = heading->frame;
#else
    (void)heading;
#endif
}

/* Take the kinks at the pieces of the survey: jumps of the curvature. */
static inline void take_kinks(const Hole *hole, Kinks *kinks) {
    double curvature[DIRECTIONS] = {0};
    kinks->end = 0;
    for (Count k = 0; k < hole->end; k++) {
        const Piece *own = piece(hole, k);
        Kink passed = {own->start, 0.0, 2.0};
        for (int d = 0; d < DIRECTIONS; d++) {
            double before = curvature[d];
            curvature[d] = 2 * own->x[LATERAL + d][2] * own->rate * own->rate;
            passed.jump += fabs(curvature[d] - before);
        }
        if (k > 0) *kink(kinks, kinks->end++) = passed;
    }
}

/* Add the piece that was drilled last, `ahead` of where these inputs were taken over; the piece before ends where it
   starts. */
static inline void append(Hole *hole, const Step *step, const ScaledInputs *inputs, double ahead) {
    Piece *drilled = piece(hole, hole->end++);
    drilled->start = step->xi, drilled->rate = 1 / step->h, drilled->inputs = *inputs;
    go_ahead(&drilled->inputs, ahead);
    memcpy(drilled->x, step->x, sizeof drilled->x);
}

/* Lateral coordinates of a piece at `xi`. */
static inline void piece_at(const Piece *own, double xi, double Y[DIRECTIONS]) {
    double t = (xi - own->start) * own->rate;
    for (int d = 0; d < DIRECTIONS; d++) Y[d] = polynomial(own->x[LATERAL + d], t);
}

/* Number of the piece that covers `xi`. */
static inline Count find(const Hole *hole, double xi) {
    Count low = hole->first, high = hole->end; /* the first that starts beyond xi is among low … high */
    while (low < high) {
        Count middle = low + (high - low) / 2;
        if (xi < piece(hole, middle)->start) high = middle;
        else low = middle + 1;
    }
    return low > hole->first ? low - 1 : low;
}

/* The same, by a walk from piece k if that lies before it. */
static inline Count find_from(const Hole *hole, Count k, double xi) {
    if (k < hole->first || k >= hole->end || piece(hole, k)->start > xi) return find(hole, xi);
    while (k + 1 < hole->end && piece(hole, k + 1)->start <= xi) k++;
    return k;
}

enum { NEAR = 16 }; /* pieces: a walk over more of them takes longer than a search among all */

/* The same, by a walk back from piece k, if it is near. */
static inline Count find_back(const Hole *hole, Count k, double xi) {
    Count least = k - NEAR > hole->first ? k - NEAR : hole->first;
    while (k > least && piece(hole, k)->start > xi) k--;
    return k > least || k == hole->first ? k : find(hole, xi);
}

/* The same, by a walk from piece k either way. */
static inline Count find_near(const Hole *hole, Count k, double xi) {
    if (k < hole->first || k >= hole->end) return find(hole, xi);
    while (k > hole->first && piece(hole, k)->start > xi) k--;
    while (k + 1 < hole->end && piece(hole, k + 1)->start <= xi) k++;
    return k;
}

/* Bring the cursors to where the places are with the bit at `xi`. */
static inline void move_cursors(Hole *hole, const Places *places, double xi) {
    for (int i = 0; i < places->count; i++) hole->cursor[i] = find_from(hole, hole->cursor[i], xi - places->s[i]);
}

/* Lateral coordinates of the hole axis at each place with the bit at `xi`. */
static inline void hole_at_places(
    const Hole *hole, const Places *places, double xi, double delayed[MAX_PLACES][DIRECTIONS]
) {
    for (int i = 0; i < places->count; i++) {
        double at = xi - places->s[i];
        piece_at(piece(hole, find_from(hole, hole->cursor[i], at)), at, delayed[i]);
    }
}

/* The same, looked for from the pieces `near` on, which become those where it is found. */
static inline void hole_at_places_near(
    const Hole *hole, const Places *places, double xi, Count near[], double delayed[MAX_PLACES][DIRECTIONS]
) {
    for (int i = 0; i < places->count; i++) {
        double at = xi - places->s[i];
        near[i] = find_near(hole, near[i], at);
        piece_at(piece(hole, near[i]), at, delayed[i]);
    }
}

/* The same at the points of a trial step: one search a place, then a walk from piece to piece. */
static inline void look_up(const Hole *hole, const Places *places, Trial *trial) {
    for (int i = 0; i < places->count; i++) {
        double from = trial->step.xi - places->s[i];
        Count k = find_from(hole, hole->cursor[i], from);
        for (int point = 0; point < POINTS; point++) {
            double at = from + POINT[point] * trial->step.h;
            while (k + 1 < hole->end && at > piece(hole, k + 1)->start) k++;
            const Piece *own = piece(hole, k);
            double t = (at - own->start) * own->rate;
            for (int d = 0; d < DIRECTIONS; d++) trial->delayed[i][d][point] = polynomial(own->x[LATERAL + d], t);
        }
    }
}

/* Drop the pieces that end before `xi`. */
static inline void forget(Hole *hole, double xi) { hole->first = find_from(hole, hole->first, xi); }

/* Move the origin of the lateral coordinates by those of `x`. The moved pieces are appended as new ones: a way back may
   still need the old ones. */
static inline void shift_origin(Hole *hole, const double x[COMPONENTS]) {
    for (Count k = hole->first, count = hole->end - k; count > 0; k++, count--) {
        Piece *moved = piece(hole, hole->end++);
        *moved = *piece(hole, k);
        for (int c = LATERAL; c < COMPONENTS; c++) moved->x[c][0] -= x[c];
        hole->first = k + 1;
    }
}

#endif
