/* How outputs change in time, and with the inputs. */
#ifndef BOREPROP_SENSITIVITY_H
#define BOREPROP_SENSITIVITY_H

#include "calls.h"
#ifdef SPACE
#include "space_derivatives.h"
#else
#include "derivatives.h"
#endif

/* Whether a variable is a Real of this role; a line in the log if not. */
static int is_real(const Component *c, fmi2ValueReference reference, Role role) {
    static const char *const CALLED[] = {"an input", "an output", "a parameter"};
    char why[LINE];
    if (!is_of_kind(c, reference, REAL)) return 0;
    const Variable *variable = variable_at(c, reference);
    if (variable->role == role) return 1;
    explain(why, "%s: must be %s here, got %s", variable->name, CALLED[role], CALLED[variable->role]);
    fail(c, fmi2Error, why);
    return 0;
}

/* Change of an output per second; NaN, and a line in the log, if it may jump. */
static double change_in_time(Component *c, const Present *at, fmi2ValueReference reference) {
    const Variable *output = variable_at(c, reference);
    char why[LINE];
    double slope = output_slope(&c->run->drilling, at, (Output)output->quantity, output->index);
    if (isnan(slope)) {
        explain(why, "%s: must be an output that cannot jump to have a derivative", output->name);
        fail(c, fmi2Error, why);
    }
    return slope * c->value[IN_RATE_OF_PENETRATION];
}

/* First derivatives of outputs in time. */
static fmi2Status derivatives_in_time(
    Component *c, const fmi2ValueReference vr[], size_t count, const fmi2Integer order[], fmi2Real value[]
) {
    double *before;
    char why[LINE];
    fmi2Status status = fmi2OK;
    for (size_t i = 0; i < count; i++) value[i] = (double)NAN;
    for (size_t i = 0; i < count; i++) {
        if (!is_real(c, vr[i], OUTPUT)) return fmi2Error;
        if (order[i] == 1) continue;
        explain(why, "%s: order of the derivative: must be 1, got %d", variable_at(c, vr[i])->name, order[i]);
        return fail(c, fmi2Error, why);
    }
    if (!take_inputs(c, &before, why)) return fail(c, fmi2Error, why);
    Present at;
    find_present(&c->run->drilling, &at);
    for (size_t i = 0; i < count; i++) {
        value[i] = change_in_time(c, &at, vr[i]);
        if (isnan(value[i])) status = fmi2Error;
    }
    give_back(c, before);
    return status;
}

#ifdef SPACE
#define SMALL_CHANGE 1e-6 /* of the scale of an input: over twice that the change of an output is taken */

/* The outputs under present inputs of which one is another, where the bit is; 0 if it cannot be, and nothing has moved. */
static int outputs_with(Component *c, int given, double value, double outputs[MOST_OUTPUTS]) {
    Drilling *drilling = &c->run->drilling;
    double own = c->value[given], *before;
    char why[LINE];
    if (!(before = kept_state(drilling, why))) return 0;
    c->value[given] = value;
    int done = check_given(c, c->value, why) && advance(c, drilling_length(drilling), present_inputs(c), why);
    if (done) drilling_outputs(drilling, outputs, 1);
    c->value[given] = own;
    give_back(c, before);
    return done;
}

/* Changes of outputs under a change of one input, added to what others make of them. */
static void add_changes(
    Component *c, const Present *at, const fmi2ValueReference unknown[], size_t unknowns, fmi2ValueReference given,
    double change, double value[]
) {
    double there[2][MOST_OUTPUTS], own = c->value[given], scale = 1.0;
    int number = variable_at(c, given)->quantity, first = c->packed.variables.first_output, sides[2];
    if (number == IN_RATE_OF_PENETRATION ||
        (c->value[IN_ACTIVE_WEIGHT_ON_BIT] == 0.0 && given == IN_ACTIVE_WEIGHT_ON_BIT))
        return;
    if (number == IN_RSS_FORCE) scale = at->F_star;
    else if (number != IN_BIT_WALK_ANGLE && number != IN_RSS_TOOLFACE) scale = fabs(own);
    double way = SMALL_CHANGE * scale;
    for (int side = 0; side < 2; side++)
        sides[side] = outputs_with(c, (int)given, side ? own + way : own - way, there[side]);
    for (int side = 0; side < 2; side++)
        if (!sides[side] && !outputs_with(c, (int)given, own, there[side])) return;
    double apart = way * (sides[0] + sides[1]);
    for (size_t i = 0; i < unknowns && apart > 0; i++) {
        int output = (int)unknown[i] - first;
        value[i] += change * (there[1][output] - there[0][output]) / apart;
    }
}
#else
/* Change of an output per change of an input. Off bottom no weight has a say until it drills, and ηΠ is zero. */
static double change_with(
    const Component *c, const Present *at, fmi2ValueReference reference, fmi2ValueReference given
) {
    const Variable *output = variable_at(c, reference);
    int off_bottom = c->value[IN_ACTIVE_WEIGHT_ON_BIT] == 0.0;
    if (off_bottom && (given == IN_ACTIVE_WEIGHT_ON_BIT || output->quantity == OUT_ETA_PI)) return 0.0;
    const Drilling *drilling = &c->run->drilling;
    if (is_layers_own(c, (int)given, c->value[given])) return 0.0;
    double eta = drilling->acting.lateral_steering_resistance; /* in the layer where the bit is */
    return output_gain(drilling, at, (Output)output->quantity, output->index, (Input)given, eta);
}

static void add_changes(
    Component *c, const Present *at, const fmi2ValueReference unknown[], size_t unknowns, fmi2ValueReference given,
    double change, double value[]
) {
    for (size_t i = 0; i < unknowns; i++) value[i] += change_with(c, at, unknown[i], given) * change;
}
#endif

/* Changes of outputs under changes of inputs, in the regime where the bit is. */
static fmi2Status directional_derivatives(
    Component *c, const fmi2ValueReference unknown[], size_t unknowns, const fmi2ValueReference given[], size_t givens,
    const fmi2Real change[], fmi2Real value[]
) {
    double *before;
    char why[LINE];
    for (size_t i = 0; i < unknowns; i++) value[i] = 0.0;
    for (size_t i = 0; i < unknowns; i++)
        if (!is_real(c, unknown[i], OUTPUT)) return fmi2Error;
    for (size_t k = 0; k < givens; k++) {
        if (!is_real(c, given[k], INPUT)) return fmi2Error;
        if (variable_at(c, given[k])->quantity != IN_WEIGHT_ON_BIT) continue;
        explain(why, "weight_on_bit: must not be given here: derivatives by the load along the BHA are not known");
        return fail(c, fmi2Error, why);
    }
    if (!take_inputs(c, &before, why)) return fail(c, fmi2Error, why);
    Present at;
    find_present(&c->run->drilling, &at);
    for (size_t k = 0; k < givens; k++) add_changes(c, &at, unknown, unknowns, given[k], change[k], value);
    give_back(c, before);
    return fmi2OK;
}

#endif
