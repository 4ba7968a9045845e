/* Derivatives of the outputs: of the smooth ones along the hole, of those that follow an input at once by that input. */
#ifndef BOREPROP_DERIVATIVES_H
#define BOREPROP_DERIVATIVES_H

#include "drilling.h"

/* Slope Θ of the hole at stabilizer `i`, counted from 0. */
static inline double inclination_at(const Drilling *d, int i) {
    const State *now = &d->integrator.now;
    double xi = now->xi - d->integrator.scaled.s[i];
    const Piece *own = piece(&now->hole, find(&now->hole, xi));
    return polynomial_slope(own->x[LATERAL], (xi - own->start) * own->rate) * own->rate;
}

/* Change of an output, or of the one with this index, per metre drilled; NaN if it may jump or bend on the way. */
static inline double output_slope(const Drilling *d, const Present *at, Output which, int i) {
    const Scaled *scaled = &d->integrator.scaled;
    switch (which) {
        case OUT_DRILLED_LENGTH: return 1.0;
        case OUT_BIT_INCLINATION: /* εηΠ θ' = M */
            return row_value(&at->mode->M, &at->loads) / (scaled->epsilon * at->eta_pi * at->l1);
        case OUT_AVERAGE_INCLINATION: /* λ_i ⟨Θ⟩_i' = Θ(ξ − s_{i−1}) − Θ(ξ − s_i) */
            return ((i ? inclination_at(d, i - 1) : at->Theta) - inclination_at(d, i)) / (lambda_(scaled, i) * at->l1);
        case OUT_DISPLACEMENT: return sin(at->Theta);
        case OUT_TRUE_VERTICAL_DEPTH: return cos(at->Theta);
        default: return NAN;
    }
}

/* Change of an output, or of the one with this index, per change of an input, in the regime where the bit is. */
static inline double output_gain(const Drilling *d, const Present *at, Output which, int i, Input input) {
    double by_force = input == IN_RSS_FORCE ? 1 / at->F_star : 0.0;                      /* of F_RSS */
    double by_weight = input == IN_ACTIVE_WEIGHT_ON_BIT ? eta_pi(&d->system, 1.0) : 0.0; /* of ηΠ */
    double F_0 = at->mode->F_0.rss * by_force, psi = 0.0;                                /* changes */
    if (fabs(at->F_0 / at->eta_pi) <= d->integrator.scaled.psi_star) psi = (F_0 - at->psi * by_weight) / at->eta_pi;
    switch (which) {
        case OUT_BOREHOLE_INCLINATION: return -psi;
        case OUT_BIT_TILT: return psi;
        case OUT_STABILIZER_DEFLECTION: return at->mode->delta[i].rss * by_force * at->l1;
        case OUT_STABILIZER_FORCE: return at->mode->F[i].rss * by_force * at->F_star;
        case OUT_BIT_LATERAL_FORCE: return F_0 * at->F_star;
        case OUT_BIT_MOMENT: return -at->mode->M.rss * by_force * at->F_star * at->l1;
        case OUT_BOREHOLE_CURVATURE: return -psi / at->l1;
        case OUT_ETA_PI: return by_weight;
        default: return 0.0; /* those that only drilling changes */
    }
}

#endif
