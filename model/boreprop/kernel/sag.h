/* How far the axis of the BHA is from that of the hole, and what is said where it leaves the hole. */
#ifndef BOREPROP_SAG_H
#define BOREPROP_SAG_H

#include "plane_outputs.h"
#include "sentence.h"

/* Where the axis of the BHA is farthest from that of the hole: its distance, positive to the high side, and the place,
   from the bit, m. */
typedef struct {
    double offset, position;
} Sag;

/* How far the beam is from the bit's axis at increasing places s, in ℓ₁. */
static inline void present_shape(const Drilling *d, const Present *at, const double s[POINTS_ALONG_BHA], double *v) {
    const Integrator *p = &d->integrator;
    const Beam *beam = &p->modes.beam;
    int n = p->scaled.n;
    double e_n = at->loads.e[n - 1], lambda_ = p->scaled.s[n - 1];
    if (beam->stepped) {
        Bending bending;
        find_bending(at->mode, &at->loads, &p->scaled, &bending);
        beam_shape(beam, &bending, n + p->scaled.points, 1.0, POINTS_ALONG_BHA, s, v);
        return;
    }
    for (int k = 0; k < POINTS_ALONG_BHA; k++) {
        v[k] = end_offset_deflection(s[k], lambda_) * e_n +
               flexibility(s[k], p->scaled.Delta, lambda_) * at->loads.F_rss +
               weight_deflection(s[k], p->scaled.w, lambda_) * at->loads.g;
        for (int i = 0; i < n - 1; i++) v[k] += flexibility(s[k], p->scaled.s[i], lambda_) * at->F[i];
    }
}

/* The sag with the bit where it is. The distance is eq. (5) at any place along the BHA: e(s) plus the deflection from the
   axis of the bit. */
static inline Sag present_sag(Drilling *d) {
    const State *now = &d->integrator.now;
    Present at;
    find_present(d, &at);
    double s[POINTS_ALONG_BHA], v[POINTS_ALONG_BHA], largest = 0.0,
                                                     reach = d->integrator.scaled.s[d->integrator.scaled.n - 1];
    int found = 0;
    Count k = now->hole.end - 1;
    for (int place = 0; place < POINTS_ALONG_BHA; place++) s[place] = reach * place / (POINTS_ALONG_BHA - 1);
    present_shape(d, &at, s, v);
    for (int place = 0; place < POINTS_ALONG_BHA; place++) {
        double xi = now->xi - s[place];
        while (k > now->hole.first && piece(&now->hole, k)->start > xi) k--;
        const Piece *own = piece(&now->hole, k);
        double Y = polynomial(own->x[LATERAL], (xi - own->start) * own->rate);
        double offset = at.Y - Y - s[place] * at.theta + v[place];
        if (fabs(offset) > fabs(largest)) largest = offset, found = place;
    }
    Sag sag = {largest * at.l1, s[found] * at.l1};
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
