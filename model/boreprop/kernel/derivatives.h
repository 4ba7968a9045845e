/* Derivatives of the outputs: of the smooth ones along the hole, of those that follow an input at once by that input. */
#ifndef BOREPROP_DERIVATIVES_H
#define BOREPROP_DERIVATIVES_H

#include "outputs.h"

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
        case OUT_BIT_INCLINATION: /* χΠ θ' = M */
            return row_value(&at->mode->M, &at->loads) / (at->inputs.chi_pi * at->l1);
        case OUT_AVERAGE_INCLINATION: /* λ_i ⟨Θ⟩_i' = Θ(ξ − s_{i−1}) − Θ(ξ − s_i) */
            return ((i ? inclination_at(d, i - 1) : at->Theta) - inclination_at(d, i)) / (lambda_(scaled, i) * at->l1);
        case OUT_DISPLACEMENT: return sin(at->Theta);
        case OUT_TRUE_VERTICAL_DEPTH: return cos(at->Theta);
        default: return NAN;
    }
}

/* Change of what a sensor shows per unit of F_RSS, in the regime where the bit is; all is dimensionless. */
static inline Sensed sensed_gain(const Drilling *d, const Present *at, int i) {
    const Integrator *p = &d->integrator;
    const Mode *mode = at->mode;
    const Sensor *sensor = &p->scaled.sensor[i];
    Bending bending = {.F_rss = 1.0, .M = mode->M.rss, .F_0 = mode->F_0.rss};
    double line[PARTS];
    for (int k = 0; k < at->loads.count; k++) bending.F[support_at(&mode->contact, p->scaled.n, k)] = mode->F[k].rss;
    line_at(&p->modes.beam, &p->scaled, &bending, sensor->s, line);
    Sensed gain = {{sensor->interval > 0 ? 0.0 : -line[SLOPE_OF_BEAM]}, {line[DEFLECTION]}, {line[MOMENT]}};
    return gain;
}

/* Change of an output, or of the one with this index, per change of an input, in the regime where the bit is; `eta` is the
   lateral steering resistance. */
static inline double output_gain(const Drilling *d, const Present *at, Output which, int i, Input input, double eta) {
    double by_force = input == IN_RSS_FORCE ? 1 / at->F_star : 0.0; /* of F_RSS */
    double of_eta_pi = input == IN_ACTIVE_WEIGHT_ON_BIT          ? eta_pi(&d->system, eta, 1.0)
                       : input == IN_LATERAL_STEERING_RESISTANCE ? at->inputs.eta_pi / eta
                                                                 : 0.0;
    double F_0 = at->mode->F_0.rss * by_force, psi = 0.0; /* changes */
    double stiffness = at->inputs.eta_pi;
    if (fabs(at->F_0 / stiffness) <= at->inputs.psi_star) psi = (F_0 - at->psi * of_eta_pi) / stiffness;
    else if (input == IN_BIT_TILT_LIMIT) psi = at->psi > 0 ? 1.0 : -1.0;
    switch (which) {
        case OUT_BOREHOLE_INCLINATION: return -psi;
        case OUT_BIT_TILT: return psi;
        case OUT_STABILIZER_DEFLECTION: return at->mode->delta[i].rss * by_force * at->l1;
        case OUT_STABILIZER_FORCE: return at->mode->F[i].rss * by_force * at->F_star;
        case OUT_BIT_LATERAL_FORCE: return F_0 * at->F_star;
        case OUT_BIT_MOMENT: return -at->mode->M.rss * by_force * at->F_star * at->l1;
        case OUT_BOREHOLE_CURVATURE: return -psi / at->l1;
        case OUT_SENSOR_INCLINATION: return sensed_gain(d, at, i).turn[0] * by_force;
        case OUT_SENSOR_BENDING_MOMENT: return sensed_gain(d, at, i).moment[0] * by_force * at->F_star * at->l1;
        case OUT_SENSOR_CLEARANCE:
            return (at->sensed[i].offset[0] > 0 ? -1 : 1) * sensed_gain(d, at, i).offset[0] * by_force * at->l1;
        case OUT_ETA_PI: return of_eta_pi;
        default: return 0.0; /* those that only drilling changes */
    }
}

#endif
