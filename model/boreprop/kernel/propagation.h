/* The borehole propagation, dimensionless: the bit at the front of its hole. `drill` and `drill_step` move it, other
   functions tell where it is. */
#ifndef BOREPROP_PROPAGATION_H
#define BOREPROP_PROPAGATION_H

#ifdef SPACE
#include "space_response.h"
#else
#include "response.h"
#endif

/* Take over inputs where the bit is, in the state `x`: find the regime under them, and mark the jump of the direction of
   the hole, which was Θ so far. */
static inline Status restart(
    Integrator *p, ScaledInputs inputs, const double x[COMPONENTS], const double Theta[DIRECTIONS], Problem *problem
) {
    State *now = &p->now;
    double jump = 0.0;
    now->inputs = inputs, now->inputs_xi = now->xi;
    now->step = standstill(&now->step, now->xi, x);
    bear(p, inputs.W);
    if (p->scaled.points && touch_down(p, now->xi, x, problem) != DONE) return FAILED;
    Response at = respond(p, x, inputs);
    for (int d = 0; d < DIRECTIONS; d++) {
        if (!isfinite(at.Theta[d]) || !isfinite(at.F_0[d])) return failed(p, NOT_FINITE, now->xi, problem);
        jump = larger(jump, fabs(at.Theta[d] - Theta[d]));
    }
    change_regime(p, at.regime);
    add_kink(&now->kinks, p->scaled.n, now->xi, 1, jump);
    if (p->scaled.points) {
        memset(p->around.change, 0, sizeof p->around.change);
        find_gaps(p, &now->step, now->xi, p->scaled.points, p->around.gap);
    }
    return DONE;
}

/* Take over inputs on the way: the path up to the bit, and the jump of curvature where a slope
   or ε changes, count too. */
static inline Status steer(Integrator *p, ScaledInputs inputs, Problem *problem) {
    State *now = &p->now;
    ScaledInputs before = inputs_here(now);
    double x[COMPONENTS];
    step_state(&now->step, now->xi, x);
    Response so_far = respond(p, x, before);
    move_path(now, now->xi);
    Status status = restart(p, inputs, x, so_far.Theta, problem);
    if (status != DONE) return status;
    double bent = curvature_jump(p, x, before, inputs);
    if (!isfinite(bent)) return failed(p, NOT_FINITE, now->xi, problem);
    if (bent != 0) add_kink(&now->kinks, p->scaled.n, now->xi, 2, bent);
    return DONE;
}

/* Drill on to `xi` under inputs that act from where the bit is. After FULL the same call goes on in larger rings. */
static inline Status drill(Integrator *p, double xi, ScaledInputs inputs, Problem *problem) {
    State *now = &p->now;
    int changed = inputs.F_rss != now->inputs.F_rss || inputs.eta_pi != now->inputs.eta_pi;
    if (are_ramps(&inputs) || are_ramps(&now->inputs))
        changed = !same_ramps(inputs_here(now), inputs, xi > now->xi ? xi - now->xi : 1.0);
    changed |= inputs.epsilon != now->inputs.epsilon || inputs.psi_star != now->inputs.psi_star;
    changed |= inputs.W != now->inputs.W || aims_anew(&inputs, &now->inputs);
    if (changed || xi > now->step.end) {
        if (!set_out(p)) return FULL;
        Status status = changed ? steer(p, inputs, problem) : DONE;
        if (status == DONE) status = integrate(p, xi, problem);
        if (status == FAILED) go_back(p);
        if (status != DONE) return status;
        p->under_way = 0;
    }
    now->xi = xi;
    return DONE;
}

/* Drill on to the end of the next step, under the inputs as they are. After FULL the same call goes on. */
static inline Status drill_step(Integrator *p, Problem *problem) {
    if (!set_out(p)) return FULL;
    Status status = take_step(p, problem);
    if (status == FAILED) go_back(p);
    if (status != DONE) return status;
    p->under_way = 0;
    p->now.xi = p->now.step.end;
    return DONE;
}

/* Set what does not evolve, to be followed by `begin` or by a state that is restored. */
static inline void prepare(Integrator *p, const Scaled *scaled, double length_scale, Options options) {
    Axial unloaded = {0.0, 0.0};
    memset(&p->now, 0, sizeof p->now);
    p->law_known = p->under_way = 0;
    p->scaled = *scaled;
    load_beam(&p->modes, scaled, unloaded);
    memcpy(p->modes.y_star, scaled->y_star, sizeof p->modes.y_star);
    p->length_scale = length_scale, p->options = options;
}

/* Start at the end of a survey; the rings must have room for it. */
static inline Status begin(Integrator *p, const Survey *survey, ScaledInputs inputs, Problem *problem) {
    State *now = &p->now;
    double reach = LOOK_BACK + p->scaled.s[p->scaled.n - 1], x[COMPONENTS] = {0};
    Heading heading = take_survey(&now->hole, survey, p->length_scale, reach);
    take_kinks(&now->hole, &now->kinks);
    memcpy(x, heading.angle, sizeof heading.angle);
    face(&now->step, &heading);
    for (Count k = 0; k < now->hole.end; k++)
        if (!check_finite(Q_STATION_RATE, 0, piece(&now->hole, k)->rate, problem)) return FAILED;
    find_places(now, &p->scaled, now->xi);
    if (restart(p, inputs, x, heading.angle, problem) == DONE) return DONE;
    wrong(problem, NO_START, Q_PARAMETERS, 0, NAN, NAN);
    return FAILED;
}

#endif
