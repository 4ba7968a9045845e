/* A communication step of an instance. */
#ifndef BOREPROP_STEPS_H
#define BOREPROP_STEPS_H

#include "instance.h"

#define LEAST_SHARE 5e-4 /* of a weight at one end of a step, at least, is that at the other end, also where it is 0 */

/* The change per metre of an input on a way to its value at the end. */
static double slope_to(const Component *c, const double end[INPUT_COUNT], int input, double way) {
    return way > 0 ? (end[input] - c->value[input]) / way : 0.0;
}

/* Drill to a length while the inputs go from their present values to those at its end; force, active weight on bit, and
   bit and rock are linear in the length, the others are held. If that fails, nothing has moved. */
static int drill_on(Component *c, double to, const double end[INPUT_COUNT], char why[LINE]) {
    double way = to - drilling_length(&c->run->drilling), weight = c->value[IN_ACTIVE_WEIGHT_ON_BIT];
    double end_weight = end[IN_ACTIVE_WEIGHT_ON_BIT], least = LEAST_SHARE * larger(weight, end_weight);
    int axial = c->packed.variables.structure.axial, held = 1, stays = 1;
    for (int i = 0; i < c->packed.variables.first_output; i++) {
        if (i == IN_RATE_OF_PENETRATION || end[i] == c->value[i]) continue;
        stays = 0;
        if (i > IN_BIT_TILT_LIMIT || is_layers_own(c, i, end[i])) held = 0;
    }
    weight = larger(weight, least), end_weight = larger(end_weight, least);
    Inputs inputs = held_inputs(c);
    inputs.rss_force = c->value[IN_RSS_FORCE], inputs.active_weight_on_bit = weight;
    inputs.rss_force_slope = slope_to(c, end, IN_RSS_FORCE, way);
    inputs.active_weight_on_bit_slope = way > 0 ? (end_weight - weight) / way : 0.0;
    inputs.lateral_steering_resistance_slope = slope_to(c, end, IN_LATERAL_STEERING_RESISTANCE, way);
    inputs.angular_steering_resistance_slope = slope_to(c, end, IN_ANGULAR_STEERING_RESISTANCE, way);
    inputs.bit_tilt_limit_slope = slope_to(c, end, IN_BIT_TILT_LIMIT, way);
    if (!advance(c, to, inputs, why)) return 0;
    if (way > 0) c->weight = end_weight;
    c->run_has_inputs = held && (stays || (way > 0 && !axial));
    return 1;
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
    int now_good = check_given(c, c->value, why);
    if (now_good && check_given(c, end, why)) return fmi2OK;
    if (now_good) strcat(why, " at the end of the step");
    return fmi2Discard;
}

/* Say, once, where the axis of the BHA has left the hole. The farther it is from the wall, the more of the hole is
   drilled until it is looked at again. States know nothing of that: a host that goes back and forth hears it once. */
static void look_at_body(Component *c) {
#ifdef SPACE /* the sag is that of a plane */
    c->next_look = INFINITY;
#else
    Drilling *drilling = &c->run->drilling;
    double length = drilling_length(drilling),
           reach = drilling->system.stabilizer_position[drilling->system.structure.n - 1];
    double radius = c->packed.hole_radius;
    char line[MESSAGE];
    Sag sag = present_sag(drilling);
    c->next_look = length + reach * larger(1 - fabs(sag.offset) / radius, OFTEN);
    if (!(fabs(sag.offset) > radius)) return;
    c->next_look = INFINITY;
    log_line(&c->callbacks, c->name, fmi2Warning, say_outside(sag, radius, length, line));
#endif
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
