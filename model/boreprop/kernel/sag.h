/* How far the axis of the BHA is from that of the hole, and what is said where it leaves the hole. */
#ifndef BOREPROP_SAG_H
#define BOREPROP_SAG_H

#include "drilling.h"
#include "sentence.h"

/* Where the axis of the BHA is farthest from that of the hole: its distance, positive to the high side, and the place,
   from the bit, m. */
typedef struct {
    double offset, position;
} Sag;

/* The deflections of the BHA at places along it from the axis of the bit, under unit loads: e_n, F_1 … F_{n−1}, F_RSS,
   sin⟨Θ⟩_1. Lengths are in ℓ₁. The places are evenly spaced, from the last stabilizer to the bit. */
enum { LOADS = MAX_STABILIZERS + 2 };
typedef struct {
    int count; /* of loads; 0: not made yet */
    double s[POINTS_ALONG_BHA], shape[POINTS_ALONG_BHA][LOADS];
} Body;

static inline void make_body(Body *body, const Scaled *scaled) {
    int n = scaled->n;
    double lambda_ = scaled->s[n - 1];
    body->count = n + 2;
    for (int k = 0; k < POINTS_ALONG_BHA; k++) {
        double s = body->s[k] = lambda_ * (POINTS_ALONG_BHA - 1 - k) / (POINTS_ALONG_BHA - 1), *shape = body->shape[k];
        shape[0] = end_offset_deflection(s, lambda_);
        for (int j = 1; j < n; j++) shape[j] = flexibility(s, scaled->s[j - 1], lambda_);
        shape[n] = flexibility(s, scaled->Delta, lambda_);
        shape[n + 1] = weight_deflection(s, scaled->w, lambda_);
    }
}

/* What bends the BHA where the bit is, in the order of a body. */
static inline void bending_loads(const Drilling *d, const Present *at, double loads[LOADS]) {
    int n = d->integrator.scaled.n;
    loads[0] = at->loads.e[n - 1], loads[n] = at->loads.F_rss, loads[n + 1] = at->loads.sin_Theta_1;
    for (int j = 1; j < n; j++) loads[j] = at->F[j - 1];
}

/* Distance of the axis of the BHA from that of the hole at a place: eq. (5) anywhere, e(s) and the deflection from the
   axis of the bit. The search for the piece of hole there begins at `from`, and leaves it there. */
static inline double offset_at(
    const Drilling *d, const Present *at, const Body *body, const double loads[LOADS], int place, Count *from
) {
    const Hole *hole = &d->integrator.now.hole;
    double s = body->s[place], xi = d->integrator.now.xi - s;
    *from = find_from(hole, *from, xi);
    const Piece *own = piece(hole, *from);
    double e = at->Y - polynomial(own->x[LATERAL], (xi - own->start) * own->rate) - s * at->theta;
    return e + dot(body->count, body->shape[place], loads);
}

/* The sag with the bit where it is. */
static inline Sag present_sag(Drilling *d, const Body *body) {
    Present at = present(d);
    Count from = 0;
    double loads[LOADS], largest = 0.0;
    int found = 0;
    bending_loads(d, &at, loads);
    for (int place = 0; place < POINTS_ALONG_BHA; place++) {
        double offset = offset_at(d, &at, body, loads, place, &from);
        if (fabs(offset) > fabs(largest)) largest = offset, found = place;
    }
    Sag sag = {largest * at.l1, body->s[found] * at.l1};
    return sag;
}

/* What is said of an axis outside a hole of this radius, m, after this drilled length, m. */
static inline const char *say_outside(Sag sag, double radius, double drilled_length, char line[MESSAGE]) {
    char position[32], offset[32], length[32], beyond[32];
    spell(sag.position, 'f', 1, position), spell(drilled_length, 'f', 1, length);
    decimal(1e3 * fabs(sag.offset), 3, offset), decimal(1e3 * (fabs(sag.offset) - radius), 3, beyond);
    snprintf(line, MESSAGE, OUTSIDE, position, offset, sag.offset < 0.0 ? "below" : "above", length, beyond);
    return line;
}

#endif
