/* The borehole as an FMI 2.0 co-simulation FMU: the kernel behind the functions of fmi2Functions.h.

   A call that cannot do what it was asked logs one line and gives one of two statuses. The instance goes on after both.
   An error is logged whether the host wants debug logging or not, a discard only if it does; else the first goes to
   stderr. That the BHA has left the hole, where the model ends, is logged like an error, as a warning, once.
   - fmi2Discard, from fmi2DoStep: an input or the step is bad, or the integrator fails. Nothing has moved, and the next
     step with good values works.
   - fmi2Error: the call itself is wrong; the parameters make no drilling system (then every step gives this, until
     fmi2Reset or a good state); outputs cannot be computed (they are NaN, and the line is logged once); a state is not
     one of this FMU's (the instance keeps its own).

   First derivatives of inputs act over the next step that is completed, and are zero after it: FMI 2.0 sets inputs and
   their derivatives with respect to the beginning of a communication step. Over the step the rate of penetration is
   linear in time; the force and the active weight on bit are linear in the drilled length, between the values that they
   have at its two ends in time. After the step an input has the value that it had at the end.

   There are no globals but constants: any number of instances may live in any threads. */
#if defined _MSC_VER && !defined _CRT_SECURE_NO_WARNINGS
#define _CRT_SECURE_NO_WARNINGS
#endif
#ifdef __clang__
#pragma STDC FP_CONTRACT OFF
#endif
#include "sensitivity.h"
#include "states.h"
#include "steps.h"

/* Inquiry, logging, life */

const char *fmi2GetTypesPlatform(void) { return fmi2TypesPlatform; }

const char *fmi2GetVersion(void) { return fmi2Version; }

fmi2Status fmi2SetDebugLogging(fmi2Component instance, fmi2Boolean on, size_t count, const fmi2String categories[]) {
    Component *c = called(instance, "fmi2SetDebugLogging", ANY);
    int discards = !count, warnings = !count;
    char why[LINE], shown[SHOWN];
    if (!c || !has(c, "fmi2SetDebugLogging", count, categories, categories)) return fmi2Error;
    for (size_t i = 0; i < count; i++) {
        const char *category = categories[i] ? categories[i] : "";
        if (!strcmp(category, DISCARDS) || !strcmp(category, "logAll")) discards = 1;
        if (!strcmp(category, WARNINGS) || !strcmp(category, "logAll")) warnings = 1;
        else if (strcmp(category, ERRORS) && strcmp(category, DISCARDS)) {
            explain(why, "category: must be %s, %s or %s, got %s", ERRORS, DISCARDS, WARNINGS, quoted(category, shown));
            return fail(c, fmi2Error, why);
        }
    }
    c->logs_discards = on && discards, c->logs_warnings = on && warnings;
    return fmi2OK;
}

fmi2Component fmi2Instantiate(
    fmi2String name, fmi2Type type, fmi2String guid, fmi2String resources, const fmi2CallbackFunctions *callbacks,
    fmi2Boolean visible, fmi2Boolean logging
) {
    char why[LINE] = "instance: must fit into the memory", shown[SHOWN];
    (void)visible;
    if (!callbacks) return NULL;
    Component *c = calloc(1, sizeof *c);
    if (c && type != fmi2CoSimulation) explain(why, "fmuType: must be fmi2CoSimulation, got %d", (int)type);
    else if (c && read_case(resources, &c->packed, why)) {
        c->callbacks = *callbacks, c->logs_discards = c->logs_warnings = logging != fmi2False;
        c->name = copy(name ? name : "");
        if (!guid || strcmp(guid, c->packed.guid))
            explain(why, "fmuGUID: must be '%s', got %s", c->packed.guid, quoted(guid ? guid : "", shown));
        else if (c->name && start_over(c)) return c;
    }
    log_line(callbacks, name ? name : "", fmi2Error, why);
    fmi2FreeInstance(c);
    return NULL;
}

void fmi2FreeInstance(fmi2Component instance) {
    Component *c = instance;
    if (!c) return;
    run_end(c->run);
    free(c->survey_file);
    free(c->packed.stations);
    free(c->packed.layers);
    free(c->name);
    free(c);
}

fmi2Status fmi2Reset(fmi2Component instance) {
    Component *c = called(instance, "fmi2Reset", ANY);
    if (!c) return fmi2Error;
    return start_over(c) ? fmi2OK : fail(c, fmi2Error, "instance: must fit into the memory");
}

fmi2Status fmi2SetupExperiment(
    fmi2Component instance, fmi2Boolean tolerance_defined, fmi2Real tolerance, fmi2Real start, fmi2Boolean stop_defined,
    fmi2Real stop
) {
    Component *c = called(instance, "fmi2SetupExperiment", INSTANTIATED);
    return c ? set_up(c, tolerance_defined ? &tolerance : NULL, start, stop_defined ? stop : (double)INFINITY)
             : fmi2Error;
}

fmi2Status fmi2EnterInitializationMode(fmi2Component instance) {
    Component *c = called(instance, "fmi2EnterInitializationMode", INSTANTIATED);
    if (!c) return fmi2Error;
    c->phase = INITIALIZATION;
    return fmi2OK;
}

fmi2Status fmi2ExitInitializationMode(fmi2Component instance) {
    Component *c = called(instance, "fmi2ExitInitializationMode", INITIALIZATION);
    if (!c) return fmi2Error;
    c->phase = STEPPING;
    if (c->outputs == MISSING) c->outputs = STALE; /* logged again: it is here that the host asks */
    return refreshed(c) ? fmi2OK : fmi2Error;
}

fmi2Status fmi2Terminate(fmi2Component instance) {
    Component *c = called(instance, "fmi2Terminate", STEPPING);
    if (!c) return fmi2Error;
    c->phase = TERMINATED;
    return fmi2OK;
}

/* Values: getting may be done at any time */

fmi2Status fmi2GetReal(fmi2Component instance, const fmi2ValueReference vr[], size_t count, fmi2Real value[]) {
    Component *c = called(instance, "fmi2GetReal", ANY);
    fmi2Status status = fmi2OK;
    if (!c || !has(c, "fmi2GetReal", count, vr, value)) return fmi2Error;
    for (size_t i = 0; i < count; i++) {
        int there = has_value(c, vr[i], REAL);
        value[i] = there ? c->value[vr[i]] : (double)NAN;
        if (!there) status = fmi2Error;
    }
    return status;
}

fmi2Status fmi2GetInteger(fmi2Component instance, const fmi2ValueReference vr[], size_t count, fmi2Integer value[]) {
    Component *c = called(instance, "fmi2GetInteger", ANY);
    fmi2Status status = fmi2OK;
    if (!c || !has(c, "fmi2GetInteger", count, vr, value)) return fmi2Error;
    for (size_t i = 0; i < count; i++) {
        int there = has_value(c, vr[i], INTEGER);
        value[i] = there ? (int)c->value[vr[i]] : 0;
        if (!there) status = fmi2Error;
    }
    return status;
}

fmi2Status fmi2GetBoolean(fmi2Component instance, const fmi2ValueReference vr[], size_t count, fmi2Boolean value[]) {
    Component *c = called(instance, "fmi2GetBoolean", ANY);
    if (!c || !has(c, "fmi2GetBoolean", count, vr, value)) return fmi2Error;
    for (size_t i = 0; i < count; i++) value[i] = is_of_kind(c, vr[i], BOOLEAN); /* there are none */
    return count ? fmi2Error : fmi2OK;
}

/* The text is valid until it is set again, or the instance reset, put into another state or freed. */
fmi2Status fmi2GetString(fmi2Component instance, const fmi2ValueReference vr[], size_t count, fmi2String value[]) {
    Component *c = called(instance, "fmi2GetString", ANY);
    fmi2Status status = fmi2OK;
    if (!c || !has(c, "fmi2GetString", count, vr, value)) return fmi2Error;
    for (size_t i = 0; i < count; i++) {
        int there = has_value(c, vr[i], STRING);
        value[i] = there ? c->survey_file : "";
        if (!there) status = fmi2Error;
    }
    return status;
}

/* Take a number over. */
static void take(Component *c, fmi2ValueReference reference, double value) {
    if (value == c->value[reference]) return;
    c->value[reference] = value;
    changed(c);
}

/* Inputs and parameters are taken as they are, all of them or none, and checked when they are used. */
fmi2Status fmi2SetReal(fmi2Component instance, const fmi2ValueReference vr[], size_t count, const fmi2Real value[]) {
    Component *c = called(instance, "fmi2SetReal", INSTANTIATED | INITIALIZATION | STEPPING);
    char got[32];
    if (!c || !has(c, "fmi2SetReal", count, vr, value)) return fmi2Error;
    for (size_t i = 0; i < count; i++) {
        if (!is_of_kind(c, vr[i], REAL)) return fmi2Error;
        int other = variable_at(c, vr[i])->role == OUTPUT || value[i] != c->value[vr[i]];
        if (other && !settable(c, vr[i], represent(value[i], got))) return fmi2Error;
    }
    for (size_t i = 0; i < count; i++) {
        if ((int)vr[i] == c->packed.variables.relative_tolerance) c->has_tolerance = 1;
        take(c, vr[i], value[i]);
    }
    return fmi2OK;
}

fmi2Status fmi2SetInteger(
    fmi2Component instance, const fmi2ValueReference vr[], size_t count, const fmi2Integer value[]
) {
    Component *c = called(instance, "fmi2SetInteger", INSTANTIATED | INITIALIZATION | STEPPING);
    char got[32];
    if (!c || !has(c, "fmi2SetInteger", count, vr, value)) return fmi2Error;
    for (size_t i = 0; i < count; i++) {
        if (!is_of_kind(c, vr[i], INTEGER)) return fmi2Error;
        snprintf(got, sizeof got, "%d", value[i]);
        int other = variable_at(c, vr[i])->role == OUTPUT || value[i] != c->value[vr[i]];
        if (other && !settable(c, vr[i], got)) return fmi2Error;
    }
    for (size_t i = 0; i < count; i++) take(c, vr[i], value[i]);
    return fmi2OK;
}

fmi2Status fmi2SetBoolean(
    fmi2Component instance, const fmi2ValueReference vr[], size_t count, const fmi2Boolean value[]
) {
    Component *c = called(instance, "fmi2SetBoolean", INSTANTIATED | INITIALIZATION | STEPPING);
    if (!c || !has(c, "fmi2SetBoolean", count, vr, value)) return fmi2Error;
    return count && !is_of_kind(c, vr[0], BOOLEAN) ? fmi2Error : fmi2OK; /* there are none */
}

fmi2Status fmi2SetString(
    fmi2Component instance, const fmi2ValueReference vr[], size_t count, const fmi2String value[]
) {
    Component *c = called(instance, "fmi2SetString", INSTANTIATED | INITIALIZATION | STEPPING);
    char shown[SHOWN], why[LINE];
    if (!c || !has(c, "fmi2SetString", count, vr, value)) return fmi2Error;
    for (size_t i = 0; i < count; i++) { /* there is one, survey_file */
        if (!is_of_kind(c, vr[i], STRING)) return fmi2Error;
        if (!value[i] || !is_utf8(value[i])) {
            explain(why, "survey_file: must be UTF-8 text, got %s", value[i] ? "other bytes" : "NULL");
            return fail(c, fmi2Error, why);
        }
        if (strcmp(value[i], c->survey_file) && !settable(c, vr[i], quoted(value[i], shown))) return fmi2Error;
    }
    if (!count || !strcmp(value[count - 1], c->survey_file)) return fmi2OK;
    char *own = copy(value[count - 1]);
    if (!own) return fail(c, fmi2Error, "survey_file: must fit into the memory");
    free(c->survey_file);
    c->survey_file = own;
    changed(c);
    return fmi2OK;
}

/* Steps */

fmi2Status fmi2DoStep(fmi2Component instance, fmi2Real time, fmi2Real size, fmi2Boolean no_way_back) {
    Component *c = called(instance, "fmi2DoStep", STEPPING);
    char why[LINE];
    (void)no_way_back;
    if (!c) return fmi2Error;
    fmi2Status status = step(c, time, size, why);
    c->discarded = status == fmi2Discard;
    if (c->discarded && !c->logs_discards) warn(c, why);
    if (status != fmi2OK) return fail(c, status, why);
    if (c->callbacks.stepFinished) c->callbacks.stepFinished(c->callbacks.componentEnvironment, fmi2OK);
    return fmi2OK;
}

fmi2Status fmi2SetRealInputDerivatives(
    fmi2Component instance, const fmi2ValueReference vr[], size_t count, const fmi2Integer order[],
    const fmi2Real value[]
) {
    Component *c = called(instance, "fmi2SetRealInputDerivatives", INSTANTIATED | INITIALIZATION | STEPPING);
    char why[LINE], got[32];
    if (!c || !has(c, "fmi2SetRealInputDerivatives", count, vr, value) ||
        !has(c, "fmi2SetRealInputDerivatives", count, order, value))
        return fmi2Error;
    for (size_t i = 0; i < count; i++) {
        if (!is_of_kind(c, vr[i], REAL)) return fmi2Error;
        const Variable *variable = variable_at(c, vr[i]);
        if (variable->role != INPUT) explain(why, "%s: must be an input to have a derivative", variable->name);
        else if (order[i] != 1)
            explain(why, "%s: order of the derivative: must be 1, got %d", variable->name, order[i]);
        else if (!isfinite(value[i]))
            explain(why, "%s: derivative: must be a finite number, got %s", variable->name, represent(value[i], got));
        else continue;
        return fail(c, fmi2Error, why);
    }
    for (size_t i = 0; i < count; i++) c->derivative[vr[i]] = value[i];
    return fmi2OK;
}

fmi2Status fmi2GetRealOutputDerivatives(
    fmi2Component instance, const fmi2ValueReference vr[], size_t count, const fmi2Integer order[], fmi2Real value[]
) {
    Component *c = called(instance, "fmi2GetRealOutputDerivatives", ANY);
    if (!c || !has(c, "fmi2GetRealOutputDerivatives", count, vr, value) ||
        !has(c, "fmi2GetRealOutputDerivatives", count, order, value))
        return fmi2Error;
    return derivatives_in_time(c, vr, count, order, value);
}

fmi2Status fmi2GetDirectionalDerivative(
    fmi2Component instance, const fmi2ValueReference unknown[], size_t unknowns, const fmi2ValueReference given[],
    size_t givens, const fmi2Real change[], fmi2Real value[]
) {
    Component *c = called(instance, "fmi2GetDirectionalDerivative", INITIALIZATION | STEPPING | TERMINATED);
    if (!c || !has(c, "fmi2GetDirectionalDerivative", unknowns, unknown, value) ||
        !has(c, "fmi2GetDirectionalDerivative", givens, given, change))
        return fmi2Error;
    return directional_derivatives(c, unknown, unknowns, given, givens, change, value);
}

fmi2Status fmi2CancelStep(fmi2Component instance) {
    Component *c = called(instance, "fmi2CancelStep", ANY);
    return c ? fail(c, fmi2Error, "fmi2CancelStep: must not be called, no step is ever pending") : fmi2Error;
}

/* What may be asked of a step that is over: where the last good one ended, and whether the simulation ends here, as it
   does for a host that has no better step than one that was discarded. */

fmi2Status fmi2GetStatus(fmi2Component instance, const fmi2StatusKind kind, fmi2Status *value) {
    (void)value;
    return unanswered(instance, "fmi2GetStatus", kind);
}

fmi2Status fmi2GetRealStatus(fmi2Component instance, const fmi2StatusKind kind, fmi2Real *value) {
    Component *c = called(instance, "fmi2GetRealStatus", ANY);
    if (!c || !has(c, "fmi2GetRealStatus", 1, value, value)) return fmi2Error;
    if (kind != fmi2LastSuccessfulTime) return unanswered(instance, "fmi2GetRealStatus", kind);
    *value = c->time;
    return fmi2OK;
}

fmi2Status fmi2GetIntegerStatus(fmi2Component instance, const fmi2StatusKind kind, fmi2Integer *value) {
    (void)value;
    return unanswered(instance, "fmi2GetIntegerStatus", kind);
}

fmi2Status fmi2GetBooleanStatus(fmi2Component instance, const fmi2StatusKind kind, fmi2Boolean *value) {
    Component *c = called(instance, "fmi2GetBooleanStatus", ANY);
    if (!c || !has(c, "fmi2GetBooleanStatus", 1, value, value)) return fmi2Error;
    if (kind != fmi2Terminated) return unanswered(instance, "fmi2GetBooleanStatus", kind);
    *value = c->discarded; /* else a host may try the same step for ever */
    return fmi2OK;
}

fmi2Status fmi2GetStringStatus(fmi2Component instance, const fmi2StatusKind kind, fmi2String *value) {
    (void)value;
    return unanswered(instance, "fmi2GetStringStatus", kind);
}

/* States */

fmi2Status fmi2GetFMUstate(fmi2Component instance, fmi2FMUstate *kept) {
    Component *c = called(instance, "fmi2GetFMUstate", ANY);
    if (!c || !has(c, "fmi2GetFMUstate", 1, kept, kept)) return fmi2Error;
    Saved *state = *kept ? *kept : calloc(1, sizeof *state);
    if (!state) return fail(c, fmi2Error, "state: must fit into the memory");
    fmi2Status status = save(c, state);
    if (status == fmi2OK) *kept = state;
    else if (!*kept) free(state);
    return status;
}

fmi2Status fmi2SetFMUstate(fmi2Component instance, fmi2FMUstate kept) {
    Component *c = called(instance, "fmi2SetFMUstate", ANY);
    char why[LINE];
    if (!c || !has(c, "fmi2SetFMUstate", 1, kept, kept)) return fmi2Error;
    return restore(c, kept, why) ? fmi2OK : fail(c, fmi2Error, why);
}

fmi2Status fmi2FreeFMUstate(fmi2Component instance, fmi2FMUstate *kept) {
    if (!called(instance, "fmi2FreeFMUstate", ANY)) return fmi2Error;
    Saved *state = kept ? *kept : NULL;
    if (state) {
        free(state->bytes);
        free(state);
        *kept = NULL;
    }
    return fmi2OK;
}

fmi2Status fmi2SerializedFMUstateSize(fmi2Component instance, fmi2FMUstate kept, size_t *size) {
    Component *c = called(instance, "fmi2SerializedFMUstateSize", ANY);
    if (!c || !has(c, "fmi2SerializedFMUstateSize", 1, kept, size)) return fmi2Error;
    *size = SEAL + ((const Saved *)kept)->size;
    return fmi2OK;
}

fmi2Status fmi2SerializeFMUstate(fmi2Component instance, fmi2FMUstate kept, fmi2Byte bytes[], size_t size) {
    Component *c = called(instance, "fmi2SerializeFMUstate", ANY);
    if (!c || !has(c, "fmi2SerializeFMUstate", 1, kept, bytes)) return fmi2Error;
    return serialize(c, kept, bytes, size);
}

fmi2Status fmi2DeSerializeFMUstate(fmi2Component instance, const fmi2Byte bytes[], size_t size, fmi2FMUstate *kept) {
    Component *c = called(instance, "fmi2DeSerializeFMUstate", ANY);
    char why[LINE];
    if (!c || !has(c, "fmi2DeSerializeFMUstate", 1, kept, bytes)) return fmi2Error;
    Saved *state = deserialize(c, bytes, size, why);
    *kept = state;
    return state ? fmi2OK : fail(c, fmi2Error, why);
}
