/* A communication step of an instance. */
#ifndef BOREPROP_STEPS_H
#define BOREPROP_STEPS_H

#include "instance.h"

#define MOST_STAIRS 1000.0

/* Drill to a length while the inputs go from their present values to those at its end. The force is linear in the
   length. The kernel keeps the active weight on bit constant over a stretch, so it goes up or down in stairs of equal
   length, each by a thousandth of its larger value at most. If one stair fails, nothing has moved. */
static int drill_on(Component *c, double to, const double end[INPUT_COUNT], char why[LINE]) {
    Drilling *drilling = &c->run->drilling;
    double from = drilling_length(drilling), force = c->value[IN_RSS_FORCE], weight = c->value[IN_ACTIVE_WEIGHT_ON_BIT];
    double slope = to > from ? (end[IN_RSS_FORCE] - force) / (to - from) : 0.0,
           rise = end[IN_ACTIVE_WEIGHT_ON_BIT] - weight;
    int stairs = to > from ? (int)ceil(MOST_STAIRS * (fabs(rise) / larger(weight, weight + rise))) : 1;
    int stair = 0, done = 1;
    double *before = NULL, accepted = drilling->integrator.now.accepted, last = c->weight;
    Problem problem;
    if (!check_finite(Q_RSS_FORCE_SLOPE, 0, slope, &problem)) return tell(&problem, why);
    if (stairs <= 1) stairs = 1;
    else if (!(before = kept_state(drilling, why))) return 0;
    for (; done && stair < stairs; stair++) {
        double at = drilling_length(drilling);
        Inputs inputs = {force + slope * (at - from), slope, weight + rise * (stair + 0.5) / stairs};
        if (to > from) last = inputs.active_weight_on_bit;
        double next = stair + 1 < stairs ? from + (to - from) * (stair + 1) / stairs : to;
        done = run_advance(c->run, next, inputs, &problem) == DONE;
        if (done && drilling->integrator.now.accepted - accepted > USUAL_OPTIONS.most_steps)
            done = too_many(&drilling->integrator, &problem) == DONE;
    }
    if (!done) tell(&problem, why);
    if (!done && before) drilling_return(drilling, before);
    free(before);
    if (done) c->weight = last, c->run_has_inputs = rise == 0.0 && (to > from || end[IN_RSS_FORCE] == force);
    return done;
}

/* Whether a step may be taken to these inputs at its end, before the run is looked at. */
static fmi2Status check_step(
    const Component *c, double time, double size, const double end[INPUT_COUNT], char why[LINE]
) {
    double late = c->stop + 1e-9 * larger(fabs(c->stop), size); /* a host may add up rounding errors */
    Problem problem;
    if (!check_finite(Q_CURRENT_TIME, 0, time, &problem) || !check_positive(Q_STEP_SIZE, size, &problem)) {
        tell(&problem, why);
        return fmi2Discard;
    }
    if (fabs(time - c->time) > larger(1e-14 * larger(fabs(time), fabs(c->time)), 1e-9 * size)) { /* hosts add up */
        char ended[32], got[32];
        represent(c->time, ended), represent(time, got);
        explain(why, "current_time: must be %s, where the last step ended, got %s", ended, got);
        return fmi2Error;
    }
    if (time + size > late) {
        wrong(&problem, TOO_LARGE, Q_STEP_END, 0, time + size, c->stop);
        tell(&problem, why);
        return fmi2Error;
    }
    int now_good = check_given(c->value, why);
    if (now_good && check_given(end, why)) return fmi2OK;
    if (now_good) strcat(why, " at the end of the step");
    return fmi2Discard;
}

/* Say, once, where the axis of the BHA has left the hole. The farther it is from the wall, the more of the hole is
   drilled until it is looked at again. States know nothing of that: a host that goes back and forth hears it once. */
static void look_at_body(Component *c) {
    Drilling *drilling = &c->run->drilling;
    double length = drilling_length(drilling), reach = drilling->system.stabilizer_position[drilling->system.n - 1];
    double radius = c->packed.hole_radius;
    char line[MESSAGE];
    Sag sag = run_sag(c->run);
    c->next_look = length + reach * larger(1 - fabs(sag.offset) / radius, OFTEN);
    if (!(fabs(sag.offset) > radius)) return;
    c->next_look = INFINITY;
    log_line(&c->callbacks, c->name, fmi2Warning, say_outside(sag, radius, length, line));
}

/* One communication step. The length counts from an anchor, so that rounding does not add up from step to step. */
static fmi2Status step(Component *c, double time, double size, char why[LINE]) {
    double end[INPUT_COUNT], *value = c->value, start_rate = value[IN_RATE_OF_PENETRATION];
    double since = c->since, from = c->from;
    Problem problem;
    for (int i = 0; i < INPUT_COUNT; i++) end[i] = value[i] + c->derivative[i] * size;
    static const int NOT_NEGATIVE[] = {IN_ACTIVE_WEIGHT_ON_BIT, IN_RATE_OF_PENETRATION};
    for (int k = 0; k < 2; k++) { /* what rounding leaves where they end at 0 */
        int i = NOT_NEGATIVE[k];
        if (fabs(end[i]) < 1e-12 * value[i]) end[i] = 0.0;
    }
    double end_rate = end[IN_RATE_OF_PENETRATION];
    fmi2Status status = check_step(c, time, size, end, why);
    if (status != fmi2OK) return status;
    if (!ready(c, why)) return fmi2Error;
    double here = drilling_length(&c->run->drilling);
    if (start_rate != c->rate || end_rate != start_rate) since = time, from = here;
    double length = from + start_rate * (time + size - since) + (end_rate - start_rate) * size / 2;
    int bounded = check_finite(Q_DRILLED_LENGTH, 0, length, &problem);
    if (bounded && length - here > MOST_DRILLED)
        bounded = wrong(&problem, TOO_LARGE, Q_STEP_LENGTH, 0, length - here, MOST_DRILLED);
    if (!bounded) {
        tell(&problem, why);
        return fmi2Discard;
    }
    int stands = length <= here && (value[IN_ACTIVE_WEIGHT_ON_BIT] == 0.0 || end[IN_ACTIVE_WEIGHT_ON_BIT] == 0.0);
    if (!stands && !drill_on(c, larger(length, here), end, why)) return fmi2Discard;
    c->time = time + size, c->since = since, c->from = from;
    c->rate = end_rate == start_rate ? start_rate : -1.0; /* a ramp is no anchor */
    if (!stands || memcmp(value, end, sizeof end)) c->outputs = STALE;
    memcpy(value, end, sizeof end);
    memset(c->derivative, 0, sizeof c->derivative);
    if (drilling_length(&c->run->drilling) >= c->next_look) look_at_body(c);
    return fmi2OK;
}

#endif
