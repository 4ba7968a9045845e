/* The borehole propagation, dimensionless: the bit at the front of its hole. `drill` and `drill_step` move it, other
   functions tell where it is. */
#ifndef BOREPROP_PROPAGATION_H
#define BOREPROP_PROPAGATION_H

#include "integrator.h"

/* Take over inputs where the bit is, in the state `x`: find the regime under them, by the answer if that is known, which else
   is found, and mark the jump of the direction of the hole, which was Θ so far. */
static inline Status restart(
    Integrator *p, ScaledInputs inputs, const double x[COMPONENTS], const double Theta[DIRECTIONS], int known,
    Response *answer, Problem *problem
) {
    State *now = &p->now;
    double jump = 0.0;
    now->inputs = inputs, now->inputs_xi = now->xi;
    now->step = standstill(&now->step, now->xi, x);
    p->exit_known = 0;
    bear(p, inputs.W);
    if (lands(p) && touch_down(p, now->xi, x, 0, problem) != DONE) return FAILED;
    if (!known) *answer = respond(p, x, inputs);
    for (int d = 0; d < DIRECTIONS; d++) {
        if (!isfinite(answer->Theta[d]) || !isfinite(answer->F_0[d])) return failed(p, NOT_FINITE, now->xi, problem);
        jump = larger(jump, fabs(answer->Theta[d] - Theta[d]));
    }
    change_regime(p, answer->regime);
    add_kink(&now->kinks, p->scaled.n, now->xi, 1, jump);
    if (p->scaled.points) {
        clear_around(p);
        forget_seen(p);
        find_body_at(p, &now->step, now->xi, p->around.body);
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
    Response so_far = respond(p, x, before), answer;
    int known = answer_is_known(p, x, inputs, before, &so_far, &answer);
    now->kinks.many |= now->xi > 0 && changes_law(&inputs, &before);
    Status status = restart(p, inputs, x, so_far.Theta, known, &answer, problem);
    if (status != DONE) return status;
    double bent = curvature_jump(p, x, before, inputs, &answer);
    if (!isfinite(bent)) return failed(p, NOT_FINITE, now->xi, problem);
    if (bent != 0) add_kink(&now->kinks, p->scaled.n, now->xi, 2, bent);
    return DONE;
}

/* Whether other inputs than those along the next `way` act from where the bit is. */
static inline int are_others(const State *now, ScaledInputs inputs, double way) {
    int changed = inputs.F_rss != now->inputs.F_rss || inputs.eta_pi != now->inputs.eta_pi ||
                  inputs.chi_pi != now->inputs.chi_pi || inputs.psi_star != now->inputs.psi_star;
    if (are_ramps(&inputs) || are_ramps(&now->inputs)) {
        ScaledInputs here = inputs_here(now);
        changed = !same_ramps(&here, &inputs, way > 0 ? way : 1.0);
    }
    return changed || inputs.W != now->inputs.W || aims_anew(&inputs, &now->inputs);
}

/* Drill on to `xi` under inputs that act from where the bit is. After FULL the same call goes on in larger rings. */
static inline Status drill(Integrator *p, double xi, ScaledInputs inputs, Problem *problem) {
    State *now = &p->now;
    int changed = are_others(now, inputs, xi - now->xi);
    if (changed || xi > now->step.end) {
        if (!set_out(p)) return FULL;
        Status status = changed ? steer(p, inputs, problem) : DONE;
        if (status == DONE) status = integrate(p, xi, problem);
        if (status == FAILED) go_back(p);
        if (status != DONE) return status;
        p->under_way = 0;
    }
    now->xi = xi;
    read_sensors(p, xi);
    return DONE;
}

/* Let the stabilizers have other clearances from where the bit is. After FULL the same call goes on. */
static inline Status change_clearances(Integrator *p, const double *y_star, Problem *problem) {
    State *now = &p->now;
    double x[COMPONENTS];
    if (!set_out(p) || !has_room(p)) return FULL;
    ScaledInputs inputs = inputs_here(now);
    step_state(&now->step, now->xi, x);
    Response so_far = respond(p, x, inputs), answer;
    memcpy(now->y_star, y_star, (size_t)(p->scaled.n - 1) * sizeof *y_star);
    now->cleared = now->xi, now->kinks.many |= now->xi > 0;
    clear(p);
    Status status = restart(p, inputs, x, so_far.Theta, 0, &answer, problem);
    if (status != DONE) go_back(p);
    p->under_way = 0;
    return status;
}

/* Take steps up to `end`, but no farther than where the bit leaves its layer of the ground: `left` says whether it did.
   After FULL the same call goes on. */
static inline Status drill_in_layer(Integrator *p, const Ground *ground, double end, int *left, Problem *problem) {
    State *now = &p->now;
    double last = p->before.accepted + p->options.most_steps, l1 = p->length_scale;
    double top = layer_top(ground, now->layer) / l1, bottom = layer_bottom(ground, now->layer) / l1;
    for (;;) {
        double begin = larger(now->step.xi, now->stay);
        if (!p->exit_known)
            p->exit_side = first_exit(&now->step, now->step.path[AXES - 1], top, bottom, begin, &p->exit);
        p->exit_known = 1;
        *left = p->exit <= end ? p->exit_side : 0;
        if (*left) break;
        if (end <= now->step.end) return DONE;
        if (end - now->xi > p->options.most_steps * p->options.largest_step || now->accepted >= last)
            return too_many(p, problem);
        Status status = take_step(p, problem);
        if (status != DONE) return status;
    }
    int stayed = p->exit == larger(now->step.xi, now->stay);
    now->xi = p->exit, now->layer += *left;
    if (stayed) { /* the bit is not at the bound, but beyond, maybe through thin layers */
        double path[AXES], z;
        position(now, path);
        z = path[AXES - 1] * l1;
        while (*left > 0 ? z - layer_bottom(ground, now->layer) > AT_TOP : layer_top(ground, now->layer) - z > AT_TOP)
            now->layer += *left;
    }
    now->stay = now->xi + STAY / l1;
    p->exit_known = 0;
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
    read_sensors(p, p->now.xi);
    return DONE;
}

/* Set what does not evolve, to be followed by `begin` or by a state that is restored. */
static inline void prepare(
    Integrator *p, const Scaled *scaled, double length_scale, double force_scale, Options options
) {
    Axial unloaded = {0.0, 0.0};
    memset(&p->now, 0, sizeof p->now);
    p->now.kinks.many = DIRECTIONS > 1;
    p->law.changes = p->law_known = p->exit_known = p->under_way = 0;
    p->scaled = *scaled;
    load_beam(&p->modes, scaled, unloaded);
    memcpy(p->modes.y_star, scaled->y_star, sizeof p->modes.y_star);
    memcpy(p->now.y_star, scaled->y_star, sizeof p->now.y_star);
    p->length_scale = length_scale, p->force_scale = force_scale, p->options = options;
}

/* Start at the end of a survey; the rings must have room for it. */
static inline Status begin(Integrator *p, const Survey *survey, ScaledInputs inputs, Problem *problem) {
    State *now = &p->now;
    double reach = LOOK_BACK + p->scaled.s[p->scaled.n - 1], x[COMPONENTS] = {0};
    Response answer;
    Heading heading = take_survey(&now->hole, survey, p->length_scale, reach);
    take_kinks(&now->hole, &now->kinks);
    memcpy(x, heading.angle, sizeof heading.angle);
    face(&now->step, &heading);
    for (Count k = 0; k < now->hole.end; k++)
        if (!check_finite(Q_STATION_RATE, 0, piece(&now->hole, k)->rate, problem)) return FAILED;
    find_places(now, &p->scaled, now->xi);
    if (p->scaled.points) start_noting(now);
    if (restart(p, inputs, x, heading.angle, 0, &answer, problem) != DONE) {
        if (problem->code == NOT_FINITE) wrong(problem, NO_START, Q_PARAMETERS, 0, NAN, NAN);
        return FAILED;
    }
    read_sensors(p, now->xi);
    return DONE;
}

#endif
