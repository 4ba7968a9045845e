/* What the drilling system answers where the bit is, with the contacts found that hold there, in space. */
#ifndef BOREPROP_SPACE_RESPONSE_H
#define BOREPROP_SPACE_RESPONSE_H

#include "bit.h"

/* The regime in the state `x`, and the direction of the hole there. */
typedef struct {
    Regime regime;
    double Theta[DIRECTIONS], F_0[DIRECTIONS];
    Frame frame;
    Reply at; /* with F and v by place */
    double delta[MAX_PLACES][DIRECTIONS], e[MAX_PLACES][DIRECTIONS];
} Response;

/* What it answers with the bit at `xi` in a step, in the state `x`, among the supports that have places. */
static inline Response respond_at(
    Integrator *p, const Step *step, double xi, const double x[COMPONENTS], ScaledInputs inputs
) {
    const State *now = &p->now;
    const Scaled *scaled = &p->scaled;
    const Beam *beam = &p->modes.beam;
    int n = scaled->n, places = now->places.count;
    double delayed[MAX_PLACES][DIRECTIONS];
    Law law;
    Behind behind;
    Regime free = {now->regime.contact, 0};
    Response response = {0};
    Reply *at = &response.at;
    memset(free.contact.of, 0, sizeof free.contact.of);
    make_law(&law, scaled, &now->places, &p->modes, free, inputs, xi);
    hole_at_places(&now->hole, &now->places, xi, delayed);
    look_behind(&law, &delayed[0][0], DIRECTIONS, 1, &behind);
    response.frame = turned_along(&step->frame, step->x, (xi - step->xi) / step->h);
    View view = {{0}, {0}};
    memcpy(view.down, response.frame.row[DOWN], sizeof view.down);
    memcpy(view.north, response.frame.row[NORTH], sizeof view.north);
    law_here(&law, x, 0.0, &view, &behind, delayed[0], 0, at);
    memcpy(response.delta, at->q, sizeof at->q);
    response.regime.contact = settle_discs(&p->modes, at->q, at->v, now->regime.contact);
    for (int j = 0; j < places; j++) {
        int support = support_at(&free.contact, n, j);
        double beyond[2], slope[2][2];
        if (!response.regime.contact.of[j]) continue;
        beyond_disc(at->v[j], p->modes.y_star[support], beyond, slope);
        for (int d = 0; d < DIRECTIONS; d++) {
            double F = at->F[j][d] = -beyond[d] / compliance(beam, support, support);
            at->M[d] += beam->M_F[support] * F, at->F_0[d] += beam->F0_F[support] * F;
            for (int i = 0; i < places; i++)
                if (i != n - 1) response.delta[i][d] += compliance(beam, support_at(&free.contact, n, i), support) * F;
        }
    }
    law.saturated = response.regime.saturation = length_of(at->F_0) / inputs.eta_pi > inputs.psi_star + ROUNDING;
    tilt_under(&law, inputs.eta_pi, inputs.psi_star, at->F_0, at->psi, NULL);
    for (int d = 0; d < DIRECTIONS; d++) {
        response.Theta[d] = x[ANGLE + d] - at->psi[d], response.F_0[d] = at->F_0[d];
        for (int i = 0; i < places; i++)
            response.e[i][d] = x[LATERAL + d] - delayed[i][d] - now->places.s[i] * x[ANGLE + d];
    }
    return response;
}

static inline Response respond(Integrator *p, const double x[COMPONENTS], ScaledInputs inputs) {
    return respond_at(p, &p->now.step, p->now.xi, x, inputs);
}

/* In space the answer under other inputs is never known before: sides and walk may turn F_0. */
static inline int answer_is_known(
    const Integrator *p, const double x[COMPONENTS], ScaledInputs inputs, ScaledInputs before, const Response *so_far,
    Response *answer
) {
    (void)p, (void)x, (void)inputs, (void)before, (void)so_far, (void)answer;
    return 0;
}

/* How the BHA is bent, in either direction, where the drilling system answers so. */
static inline void bend_under(const Integrator *p, const Response *is, Bending bending[DIRECTIONS]) {
    const Contact *contact = &is->regime.contact;
    for (int d = 0; d < DIRECTIONS; d++) {
        Bending nothing = {.F_rss = is->at.F_rss[d], .g = is->at.G[d], .M = is->at.M[d], .F_0 = is->at.F_0[d]};
        bending[d] = nothing;
        for (int i = 0; i < place_count(*contact, p->scaled.n); i++)
            if (contact->of[i]) bending[d].F[support_at(contact, p->scaled.n, i)] = is->at.F[i][d];
    }
}

/* The same with the bit at `xi` in the state `x`, in the present step. */
static inline void bend(Integrator *p, double xi, const double x[COMPONENTS], Bending bending[DIRECTIONS]) {
    Response is = respond_at(p, &p->now.step, xi, x, inputs_at(&p->now, xi));
    bend_under(p, &is, bending);
}

/* What bends it where the drilling system answers so. */
static inline void pull_under(const Integrator *p, const Response *is, Pull pull[DIRECTIONS]) {
    Vector high = side_of(is->frame.row[DOWN], -1.0);
    for (int d = 0; d < DIRECTIONS; d++) {
        pull[d].count = place_count(is->regime.contact, p->scaled.n);
        for (int i = 0; i < pull[d].count; i++) pull[d].F[i] = is->at.F[i][d];
        pull[d].end = is->e[p->scaled.n - 1][d] - p->modes.beam.end * high.value[d];
        pull[d].F_rss = is->at.F_rss[d], pull[d].g = is->at.G[d];
    }
}

/* The same with the bit at `xi` in the state `x`, in a step. */
static inline void pull_at(
    Integrator *p, const Step *step, double xi, const double x[COMPONENTS], Pull pull[DIRECTIONS]
) {
    Response is = respond_at(p, step, xi, x, inputs_at(&p->now, xi));
    pull_under(p, &is, pull);
}

/* The same where a step ends that is being tried, in the state `x`. */
static inline void pull_after(Integrator *p, const Trial *trial, const double x[COMPONENTS], Pull pull[DIRECTIONS]) {
    const Step *step = &trial->step;
    const Places *places = &p->now.places;
    const Touching *touching = &present_law(p)->touching;
    const Reply *end = &trial->at[POINTS - 1]; /* the last point is at the end */
    int last = p->scaled.n - 1;
    if (step->event != NONE) {
        pull_at(p, step, step->end, x, pull);
        return;
    }
    Frame frame = turned_along(&step->frame, step->x, 1.0);
    Vector high = side_of(frame.row[DOWN], -1.0);
    memset(pull, 0, DIRECTIONS * sizeof *pull);
    for (int d = 0; d < DIRECTIONS; d++) {
        double e_n = x[LATERAL + d] - trial->delayed[last][d][POINTS - 1] - places->s[last] * x[ANGLE + d];
        pull[d].count = places->count, pull[d].F_rss = end->F_rss[d], pull[d].g = end->G[d];
        pull[d].end = e_n - p->modes.beam.end * high.value[d];
        for (int k = 0; k < touching->touching; k++) pull[d].F[touching->C[k]] = end->F[k][d];
    }
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
    law_here(&law, x, ahead, &view, &behind, delayed[0], 1, at);
}

/* The jump of Θ⃗' where ε, or the slope of an input, changes in the present regime, which answers so. */
static inline double curvature_jump(
    Integrator *p, const double x[COMPONENTS], ScaledInputs before, ScaledInputs inputs, const Response *answer
) {
    int on_ramp = inputs.F_rss_slope != before.F_rss_slope || inputs.eta_pi_slope != before.eta_pi_slope ||
                  inputs.psi_star_slope != before.psi_star_slope;
    double bent = 0.0, turn = turns_anew(&inputs, &before) ? 1 - epsilon(&inputs) / epsilon(&before) : 0.0;
    if (!on_ramp && turn == 0.0) return 0.0;
    Reply now = answer->at, soon = answer->at, would = answer->at;
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
