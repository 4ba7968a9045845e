/* How outputs change in time, and with the inputs. */
#ifndef BOREPROP_SENSITIVITY_H
#define BOREPROP_SENSITIVITY_H

#include "calls.h"
#include "derivatives.h"

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

/* Change of an output per change of an input. Off bottom no weight has a say until it drills, and ηΠ is zero. */
static double change_with(
    const Component *c, const Present *at, fmi2ValueReference reference, fmi2ValueReference given
) {
    const Variable *output = variable_at(c, reference);
    int off_bottom = c->value[IN_ACTIVE_WEIGHT_ON_BIT] == 0.0;
    if (off_bottom && (given == IN_ACTIVE_WEIGHT_ON_BIT || output->quantity == OUT_ETA_PI)) return 0.0;
    const Drilling *drilling = &c->run->drilling;
    int rock = (int)given - IN_LATERAL_STEERING_RESISTANCE, layer = drilling->integrator.now.layer;
    if (rock >= 0 && rock < ROCK && stands_in(&drilling->ground, layer, rock, c->value[given])) return 0.0;
    double eta = drilling->given.lateral_steering_resistance; /* in the layer where the bit is */
    return output_gain(drilling, at, (Output)output->quantity, output->index, (Input)given, eta);
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
    Present at = present(&c->run->drilling);
    for (size_t i = 0; i < count; i++) {
        value[i] = change_in_time(c, &at, vr[i]);
        if (isnan(value[i])) status = fmi2Error;
    }
    give_back(c, before);
    return status;
}

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
        if (given[k] != IN_WEIGHT_ON_BIT) continue;
        explain(why, "weight_on_bit: must not be given here: derivatives by the load along the BHA are not known");
        return fail(c, fmi2Error, why);
    }
    if (!take_inputs(c, &before, why)) return fail(c, fmi2Error, why);
    Present at = present(&c->run->drilling);
    for (size_t i = 0; i < unknowns; i++)
        for (size_t k = 0; k < givens; k++) value[i] += change_with(c, &at, unknown[i], given[k]) * change[k];
    give_back(c, before);
    return fmi2OK;
}

#endif
