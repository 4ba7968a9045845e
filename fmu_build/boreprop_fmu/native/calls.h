/* What every function of FMI asks before it does anything: may it be called now, with these references and addresses? */
#ifndef BOREPROP_CALLS_H
#define BOREPROP_CALLS_H

#include "instance.h"

/* The instance; NULL, and a line in the log, if the function may not be called in its present phase. */
static Component *called(fmi2Component instance, const char *function, int phases) {
    Component *c = instance;
    char why[LINE];
    if (!c || (int)c->phase & phases) return c;
    explain(
        why, "%s: must be called in another phase, got %s", function,
        c->phase == INSTANTIATED     ? "instantiated"
        : c->phase == INITIALIZATION ? "initialization"
        : c->phase == STEPPING       ? "stepping"
                                     : "terminated"
    );
    fail(c, fmi2Error, why);
    return NULL;
}

/* Whether both addresses may be used for `count` values; a line in the log if one is NULL. */
static int has(const Component *c, const char *function, size_t count, const void *first, const void *second) {
    char why[LINE];
    if (!count || (first && second)) return 1;
    explain(why, "%s: must be given addresses to read from and write to, got NULL", function);
    fail(c, fmi2Error, why);
    return 0;
}

/* Whether the value reference is that of a variable of this kind; a line in the log if not. */
static int is_of_kind(const Component *c, fmi2ValueReference reference, Kind kind) {
    char why[LINE];
    const Variables *all = &c->packed.variables;
    const Variable *variable = &all->at[reference < (unsigned)all->count ? reference : 0];
    if (reference >= (unsigned)all->count)
        explain(why, "value reference: must be 0 to %d, got %lu", all->count - 1, (unsigned long)reference);
    else if (variable->kind != kind)
        explain(why, "%s: must be used as %s, got '%s'", variable->name, KIND[variable->kind], KIND[kind]);
    else return 1;
    fail(c, fmi2Error, why);
    return 0;
}

static const Variable *variable_at(const Component *c, fmi2ValueReference reference) {
    return &c->packed.variables.at[reference];
}

/* Whether a variable of this kind has a value now: outputs are computed if need be. */
static int has_value(Component *c, fmi2ValueReference reference, Kind kind) {
    return is_of_kind(c, reference, kind) && (variable_at(c, reference)->role != OUTPUT || refreshed(c));
}

/* Whether a variable may be set to another value now; a line in the log if not. `got` is that value as text. */
static int settable(const Component *c, fmi2ValueReference reference, const char *got) {
    char why[LINE];
    const Variable *variable = variable_at(c, reference);
    if (variable->role == OUTPUT) explain(why, "%s: must not be set, it is an output, got %s", variable->name, got);
    else if (variable->role == PARAMETER && c->phase == STEPPING && !is_tunable(variable))
        explain(why, "%s: must not change after initialization, got %s", variable->name, got);
    else return 1;
    fail(c, fmi2Error, why);
    return 0;
}

/* The answer to a question for a status that this FMU does not have. */
static fmi2Status unanswered(fmi2Component instance, const char *function, fmi2StatusKind kind) {
    Component *c = called(instance, function, ANY);
    char why[LINE];
    if (!c) return fmi2Error;
    explain(why, "%s: must be asked for a status that this FMU has, got fmi2StatusKind %d", function, (int)kind);
    return fail(c, fmi2Discard, why);
}

#endif
