/* What the drilling system answers where the bit is, with the contacts found that hold there, in space. */
#ifndef BOREPROP_SPACE_RESPONSE_H
#define BOREPROP_SPACE_RESPONSE_H

#include "integrator.h"

/* The regime in the state `x`, and the direction of the hole there. */
typedef struct {
    Regime regime;
    double Theta[DIRECTIONS], F_0[DIRECTIONS];
    Frame frame;
    Reply at; /* with F and v by stabilizer */
    double delta[MAX_STABILIZERS][DIRECTIONS], e[MAX_STABILIZERS][DIRECTIONS];
} Response;

static inline Response respond(Integrator *p, const double x[COMPONENTS], ScaledInputs inputs) {
    const State *now = &p->now;
    const Scaled *scaled = &p->scaled;
    const Beam *beam = &p->modes.beam;
    double delayed[MAX_PLACES][DIRECTIONS], by[2][2];
    Law law;
    Behind behind;
    Regime free = {{{0}, 0, {0}}, 0};
    Response response = {0};
    Reply *at = &response.at;
    make_law(&law, scaled, &now->places, &p->modes, free, inputs, now->xi);
    hole_at_places(&now->hole, &now->places, now->xi, delayed);
    look_behind(&law, &delayed[0][0], DIRECTIONS, 1, &behind);
    response.frame = turned_along(&now->step.frame, now->step.x, (now->xi - now->step.xi) / now->step.h);
    View view = {{0}, {0}};
    memcpy(view.down, response.frame.row[DOWN], sizeof view.down);
    memcpy(view.north, response.frame.row[NORTH], sizeof view.north);
    law_here(&law, x, 0.0, &view, &behind, delayed[0], law.s_1, 0, at);
    for (int i = 0; i < scaled->n - 1; i++) memcpy(at->v[i], at->q[i], sizeof at->v[i]);
    response.regime.contact = settle_discs(&p->modes, at->q, at->v, free.contact);
    for (int i = 0; i < scaled->n - 1; i++) memcpy(response.delta[i], at->q[i], sizeof at->q[i]);
    for (int j = 0; j < scaled->n - 1; j++) {
        double beyond[2], slope[2][2];
        if (!response.regime.contact.of[j]) continue;
        beyond_disc(at->v[j], p->modes.y_star[j], beyond, slope);
        for (int d = 0; d < DIRECTIONS; d++) {
            double F = at->F[j][d] = -beyond[d] / compliance(beam, j, j);
            at->M[d] += beam->M_F[j] * F, at->F_0[d] += beam->F0_F[j] * F;
            for (int i = 0; i < scaled->n - 1; i++) response.delta[i][d] += compliance(beam, i, j) * F;
        }
    }
    law.saturated = response.regime.saturation = size_of(at->F_0) / inputs.eta_pi > inputs.psi_star + ROUNDING;
    tilt_under(&law, inputs.eta_pi, inputs.psi_star, at->F_0, at->psi, by);
    for (int d = 0; d < DIRECTIONS; d++) {
        response.Theta[d] = x[ANGLE + d] - at->psi[d], response.F_0[d] = at->F_0[d];
        for (int i = 0; i < scaled->n; i++)
            response.e[i][d] = x[LATERAL + d] - delayed[i][d] - scaled->s[i] * x[ANGLE + d];
    }
    return response;
}

#define A_LITTLE 1e-6 /* ℓ₁: over which the slope of Θ under ramps is taken */

/* Θ − θ in the present regime under inputs that were taken over here, a length ahead of it, and its change by θ. */
static inline void slope_of_hole(
    Integrator *p, const double x[COMPONENTS], ScaledInputs inputs, double ahead, Reply *at
) {
    const State *now = &p->now;
    double delayed[MAX_PLACES][DIRECTIONS];
    Law law;
    Behind behind;
    View view;
    make_law(&law, &p->scaled, &now->places, &p->modes, now->regime, inputs, now->xi);
    hole_at_places(&now->hole, &now->places, now->xi, delayed);
    look_behind(&law, &delayed[0][0], DIRECTIONS, 1, &behind);
    memcpy(view.down, now->step.frame.row[DOWN], sizeof view.down);
    memcpy(view.north, now->step.frame.row[NORTH], sizeof view.north);
    law_here(&law, x, ahead, &view, &behind, delayed[0], law.s_1, 1, at);
}

/* The jump of Θ⃗' where ε, or the slope of an input, changes in the present regime. */
static inline double curvature_jump(
    Integrator *p, const double x[COMPONENTS], ScaledInputs before, ScaledInputs inputs
) {
    int on_ramp = inputs.F_rss_slope != before.F_rss_slope || inputs.eta_pi_slope != before.eta_pi_slope ||
                  inputs.psi_star_slope != before.psi_star_slope;
    double bent = 0.0, turn = turns_anew(&inputs, &before) ? 1 - epsilon(&inputs) / epsilon(&before) : 0.0;
    if (!on_ramp && turn == 0.0) return 0.0;
    Response here = respond(p, x, inputs);
    Reply now = here.at, soon = here.at, would = here.at;
    ScaledInputs other = inputs;
    other.F_rss_slope = before.F_rss_slope, other.eta_pi_slope = before.eta_pi_slope;
    other.psi_star_slope = before.psi_star_slope;
    slope_of_hole(p, x, inputs, 0.0, &now);
    slope_of_hole(p, x, inputs, A_LITTLE, &soon);
    slope_of_hole(p, x, other, A_LITTLE, &would);
    for (int d = 0; d < DIRECTIONS; d++) {
        double jump = (soon.rate[LATERAL + d] - would.rate[LATERAL + d]) / A_LITTLE;
        for (int c = 0; c < DIRECTIONS; c++) jump += now.by[LATERAL + d][ANGLE + c] * now.rate[ANGLE + c] * turn;
        bent = larger(bent, fabs(jump));
    }
    return bent;
}

#endif
