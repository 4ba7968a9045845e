/* What the drilling system answers where the bit is, with the contacts found that hold there, in the plane. */
#ifndef BOREPROP_RESPONSE_H
#define BOREPROP_RESPONSE_H

#include "bit.h"

/* What bends the beam where the bit is. */
static inline void find_present_loads(const Integrator *p, const double x[COMPONENTS], Loads *loads) {
    find_loads_at(p, p->now.xi, x, force_at(&p->now, p->now.xi), loads);
}

/* Θ under given loads, eq. (16): algebraic, so it jumps with the inputs. */
static inline double inclination_under(Integrator *p, double theta, const Loads *loads, ScaledInputs inputs) {
    const Mode *mode = settle(&p->modes, loads, &p->now.regime.contact);
    return theta - bit_tilt(row_value(&mode->F_0, loads), inputs.eta_pi, inputs.psi_star);
}

/* How the BHA is bent with the bit at `xi` in the state `x`. */
static inline void bend(Integrator *p, double xi, const double x[COMPONENTS], Bending bending[DIRECTIONS]) {
    Loads loads;
    find_loads_at(p, xi, x, force_at(&p->now, xi), &loads);
    find_bending(settle(&p->modes, &loads, &p->now.regime.contact), &loads, &p->scaled, bending);
}

/* What bends it under loads in a mode. */
static inline void pull_under(const Integrator *p, const Mode *mode, const Loads *loads, Pull pull[DIRECTIONS]) {
    contact_forces(mode, loads, pull->F);
    pull->count = loads->count, pull->F_rss = loads->F_rss, pull->g = loads->g;
    pull->end = loads->e[p->scaled.n - 1] - p->modes.beam.end;
}

/* The same in the present regime with the bit at `xi` in the state `x`, in a step. */
static inline void pull_at(
    Integrator *p, const Step *step, double xi, const double x[COMPONENTS], Pull pull[DIRECTIONS]
) {
    Loads loads;
    find_loads_at(p, xi, x, force_at(&p->now, xi), &loads);
    (void)step;
    pull_under(p, mode_of(&p->modes, &p->now.regime.contact), &loads, pull);
}

/* The same where a step ends that is being tried, in the state `x`. */
static inline void pull_after(Integrator *p, const Trial *trial, const double x[COMPONENTS], Pull pull[DIRECTIONS]) {
    const Step *step = &trial->step;
    const Places *places = &p->now.places;
    Loads loads;
    if (step->event != NONE) {
        pull_at(p, step, step->end, x, pull);
        return;
    }
    loads.count = places->count, loads.F_rss = force_at(&p->now, step->end); /* its last point is at the end */
    for (int i = 0; i < places->count; i++)
        loads.e[i] = x[LATERAL] - trial->delayed[i][0][POINTS - 1] - places->s[i] * x[ANGLE];
    loads.g = sin(p->scaled.axial ? x[ANGLE] : x[LATERAL] - trial->delayed[0][0][POINTS - 1]);
    pull_under(p, mode_of(&p->modes, &p->now.regime.contact), &loads, pull);
}

/* The regime in the state `x`, the direction of the hole there, and what acts on the bit. */
typedef struct {
    Regime regime;
    double Theta[DIRECTIONS], F_0[DIRECTIONS], M;
} Response;

/* What it answers in given rock where contacts and what acts on the bit are these. */
static inline Response respond_in(ScaledInputs inputs, double theta, Contact contact, double F_0, double M) {
    Response response = {
        {contact, side_beyond(F_0 / inputs.eta_pi, -inputs.psi_star, inputs.psi_star, ROUNDING)},
        {theta - bit_tilt(F_0, inputs.eta_pi, inputs.psi_star)},
        {F_0},
        M
    };
    return response;
}

static inline Response respond(Integrator *p, const double x[COMPONENTS], ScaledInputs inputs) {
    Loads loads;
    find_loads_at(p, p->now.xi, x, inputs.F_rss, &loads);
    const Mode *mode = settle(&p->modes, &loads, &p->now.regime.contact);
    return respond_in(inputs, x[ANGLE], mode->contact, row_value(&mode->F_0, &loads), row_value(&mode->M, &loads));
}

/* Whether it is known what it answers under other inputs than those `before`, where it did so far, and what: unless forces
   change, what acts on the bit does not. */
static inline int answer_is_known(
    const Integrator *p, const double x[COMPONENTS], ScaledInputs inputs, ScaledInputs before, const Response *so_far,
    Response *answer
) {
    *answer = respond_in(inputs, x[ANGLE], so_far->regime.contact, so_far->F_0[0], so_far->M);
    return inputs.F_rss == before.F_rss && inputs.W == before.W && !p->scaled.points;
}

/* The jump of Θ' where ε, or the slope of an input, changes in the present regime, which answers so. */
static inline double curvature_jump(
    Integrator *p, const double x[COMPONENTS], ScaledInputs before, ScaledInputs inputs, const Response *answer
) {
    double bend = inputs.F_rss_slope - before.F_rss_slope, turn = inputs.eta_pi_slope - before.eta_pi_slope;
    int saturation = p->now.regime.saturation;
    double bent = -saturation * (inputs.psi_star_slope - before.psi_star_slope); /* jump of Θ' = θ' − ψ' */
    (void)x;
    if (turns_anew(&inputs, &before)) /* θ' = M/(εηΠ) */
        bent += present_law(p)->Theta.theta * answer->M / inputs.eta_pi * (1 / epsilon(&inputs) - 1 / epsilon(&before));
    if ((bend != 0 || turn != 0) && !saturation) { /* (F_0/ηΠ)' = (F_0' − ψ ηΠ')/ηΠ */
        double psi = answer->F_0[0] / inputs.eta_pi;
        bent -= (bend * mode_of(&p->modes, &p->now.regime.contact)->F_0.rss - turn * psi) / inputs.eta_pi;
    }
    return fabs(bent);
}

/* Θ as it was when the bit was at `xi`, at most LOOK_BACK behind, where the first stabilizer is; where
   Θ jumped, its value after the jump. */
static inline double earlier_inclination(Integrator *p, double xi) {
    const Hole *hole = &p->now.hole;
    const Piece *at = piece(hole, find_from(hole, hole->cursor[0], xi + MERGE));
    if (at->inputs.eta_pi == 0 || p->scaled.points || xi + MERGE < p->now.cleared) { /* Θ is the slope of the hole */
        const Piece *own = piece(hole, find_from(hole, hole->cursor[0], xi));
        return polynomial_slope(own->x[LATERAL], (xi - own->start) * own->rate) * own->rate;
    }
    double ahead = larger(xi - at->start, 0.0), x[COMPONENTS];
    for (int c = 0; c < COMPONENTS; c++) x[c] = polynomial(at->x[c], ahead * at->rate);
    ScaledInputs inputs = inputs_ahead(&at->inputs, ahead);
    double delayed[MAX_PLACES][DIRECTIONS];
    hole_at_places_near(hole, &p->now.places, at->start + ahead, p->earlier, delayed);
    Loads loads;
    find_loads(p, delayed, x, inputs.F_rss, &loads);
    bear(p, inputs.W);
    double Theta = inclination_under(p, x[ANGLE], &loads, inputs);
    bear(p, p->now.inputs.W);
    return Theta;
}

#endif
