/* The outputs where the bit is, in the plane. */
#ifndef BOREPROP_PLANE_OUTPUTS_H
#define BOREPROP_PLANE_OUTPUTS_H

#include "drilling.h"

/* What the outputs are computed from: the state where the bit is. */
typedef struct {
    double l1, F_star, theta, Y, Theta, psi, F_0, F[MAX_PLACES], x, z, earlier; /* earlier: Θ one ℓ₁ ago */
    double body_force, body_place, wall_distance; /* the largest force on the body and where it acts; the least gap */
    Sensed sensed[MAX_SENSORS];
    double told[MAX_SENSORS][DIRECTIONS];
    ScaledInputs inputs;
    Loads loads;
    const Mode *mode;
} Present;

/* What the wall does to the body of the BHA, with the bit in the state `x`. */
static inline void find_body(Integrator *p, const double x[COMPONENTS], Present *at) {
    Pull pull[DIRECTIONS];
    at->body_force = at->body_place = 0.0, at->wall_distance = INFINITY;
    if (!p->scaled.points) return;
    for (int i = p->scaled.n; i < at->loads.count; i++)
        if (fabs(at->F[i]) > fabs(at->body_force)) at->body_force = at->F[i], at->body_place = p->now.places.s[i];
    pull_under(p, at->mode, &at->loads, pull);
    at->wall_distance = wall_distance(p, p->now.xi, x, pull);
}

/* Find all that. */
static inline void find_present(Drilling *d, Present *at) {
    Integrator *p = &d->integrator;
    const State *now = &p->now;
    double state[COMPONENTS], path[AXES];
    at->l1 = length_scale(&d->system), at->F_star = force_scale(&d->system);
    at->earlier = earlier_inclination(p, now->xi - 1.0);
    step_state(&now->step, now->xi, state);
    at->theta = state[ANGLE], at->Y = state[LATERAL];
    find_present_loads(p, state, &at->loads);
    at->mode = settle(&p->modes, &at->loads, &now->regime.contact);
    at->F_0 = row_value(&at->mode->F_0, &at->loads);
    contact_forces(at->mode, &at->loads, at->F);
    at->inputs = inputs_here(now);
    at->psi = bit_tilt(at->F_0, at->inputs.eta_pi, at->inputs.psi_star);
    at->Theta = at->theta - at->psi;
    position(now, path);
    at->x = path[0], at->z = path[1];
    find_body(p, state, at);
    if (!p->scaled.sensors) return;
    Bending bending;
    find_bending(at->mode, &at->loads, &p->scaled, &bending);
    find_sensed(p, state, &bending, at->sensed, at->told);
}

/* One output, the value with this index if it has several. If an output of the table were missing, it would not compile. */
static inline double output(const Drilling *d, const Present *at, Output which, int i) {
    const Scaled *scaled = &d->integrator.scaled;
    const ScaledInputs *inputs = &at->inputs;
    const Loads *loads = &at->loads;
    double l1 = at->l1, F_star = at->F_star;
    switch (which) {
        case OUT_DRILLED_LENGTH: return d->drilled_length;
        case OUT_BIT_INCLINATION: return at->theta;
        case OUT_BOREHOLE_INCLINATION: return at->Theta;
        case OUT_BIT_TILT: return at->psi;
        case OUT_AVERAGE_INCLINATION: /* λ_i (⟨Θ⟩_i − θ) = e_i − e_{i−1} */
            return at->theta + (loads->e[i] - (i ? loads->e[i - 1] : 0.0)) / lambda_(scaled, i);
        case OUT_STABILIZER_DEFLECTION: return row_value(&at->mode->delta[i], loads) * l1;
        case OUT_STABILIZER_FORCE: return at->F[i] * F_star;
        case OUT_STABILIZER_CONTACT: return wall(at->F[i]);
        case OUT_BIT_TILT_SATURATION:
            return side_beyond(at->F_0 / inputs->eta_pi, -inputs->psi_star, inputs->psi_star, ROUNDING);
        case OUT_BIT_LATERAL_FORCE: return at->F_0 * F_star;
        case OUT_BIT_MOMENT: return -row_value(&at->mode->M, loads) * F_star * l1;
        case OUT_BOREHOLE_CURVATURE: return (at->Theta - at->earlier) / l1;
        case OUT_BODY_CONTACT_FORCE: return at->body_force * F_star;
        case OUT_BODY_CONTACT_POSITION: return at->body_place * l1;
        case OUT_WALL_DISTANCE: return at->wall_distance * l1;
        case OUT_SENSOR_INCLINATION: return at->told[i][INCLINATION];
        case OUT_SENSOR_BENDING_MOMENT: return at->sensed[i].moment[0] * F_star * l1;
        case OUT_SENSOR_CLEARANCE: return (scaled->sensor[i].clearance - fabs(at->sensed[i].offset[0])) * l1;
        case OUT_DISPLACEMENT: return at->x * l1;
        case OUT_TRUE_VERTICAL_DEPTH: return at->z * l1;
        case OUT_ETA_PI: return inputs->eta_pi;
        case OUT_FORMATION: return d->integrator.now.layer;
        /* in space only */
        case OUT_BIT_AZIMUTH:
        case OUT_BOREHOLE_AZIMUTH:
        case OUT_BIT_TILT_HIGH:
        case OUT_BIT_TILT_RIGHT:
        case OUT_BIT_LATERAL_FORCE_HIGH:
        case OUT_BIT_LATERAL_FORCE_RIGHT:
        case OUT_STABILIZER_FORCE_HIGH:
        case OUT_STABILIZER_FORCE_RIGHT:
        case OUT_STABILIZER_DEFLECTION_HIGH:
        case OUT_STABILIZER_DEFLECTION_RIGHT:
        case OUT_BODY_CONTACT_FORCE_HIGH:
        case OUT_BODY_CONTACT_FORCE_RIGHT:
        case OUT_SENSOR_AZIMUTH:
        case OUT_SENSOR_BENDING_MOMENT_HIGH:
        case OUT_SENSOR_BENDING_MOMENT_RIGHT:
        case OUT_NORTH:
        case OUT_EAST: break;
    }
    return NAN;
}

#endif
