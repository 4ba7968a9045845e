/* For fuzz_native.c: an instance of the FMU as it is seen from outside. */
#ifndef FUZZ_INSTANCE_H
#define FUZZ_INSTANCE_H

#include "fuzz.h"

static const double FARTHEST = 4.0; /* ℓ₁ that one step is asked to drill: the work grows with it */
static int tampered;                /* whether a state that no run has saved was taken */

static double good_number(double usual) { return usual * between(0.7, 1.4); }

static fmi2Component born(int logging) {
    fmi2Component c = fmi2Instantiate("one", fmi2CoSimulation, packed.guid, resources, &callbacks, 0, logging);
    must(c != NULL, "fmi2Instantiate must give an instance");
    return c;
}

/* What can be seen of an instance: every number. */
typedef struct {
    fmi2Status status;
    double value[MOST_VARIABLES];
} Sight;

static Sight look(fmi2Component c) {
    Sight sight = {fmi2OK, {0}};
    for (unsigned i = 0; i < (unsigned)packed.variables.count; i++) {
        const Variable *variable = &packed.variables.at[i];
        int whole = 0;
        fmi2Status status = fmi2OK;
        if (variable->kind == REAL) status = fmi2GetReal(c, &i, 1, &sight.value[i]);
        if (variable->kind == INTEGER) status = fmi2GetInteger(c, &i, 1, &whole), sight.value[i] = whole;
        must(status == fmi2OK || status == fmi2Error, "a value must be OK or an error");
        if (status != fmi2OK) sight.status = status;
        if (variable->role == OUTPUT && status == fmi2OK) must(isfinite(sight.value[i]), "an output must be finite");
        must(status == fmi2OK || variable->role == OUTPUT, "an input or a parameter must have a value");
    }
    return sight;
}

static void must_be_same(Sight a, Sight b, const char *what) {
    must(a.status == b.status && !memcmp(a.value, b.value, sizeof a.value), what);
}

/* A state as bytes. */
typedef struct {
    fmi2Byte *bytes;
    size_t size;
} Content;

static Content serialized(fmi2Component c) {
    fmi2FMUstate state = NULL;
    Content content = {NULL, 0};
    must(fmi2GetFMUstate(c, &state) == fmi2OK, "a state must be got");
    must(fmi2SerializedFMUstateSize(c, state, &content.size) == fmi2OK, "a state must have a size");
    content.bytes = malloc(content.size);
    must(fmi2SerializeFMUstate(c, state, content.bytes, content.size) == fmi2OK, "a state must be serialized");
    must(fmi2FreeFMUstate(c, &state) == fmi2OK && !state, "a state must be freed");
    return content;
}

static int is_same(Content a, Content b) { return a.size == b.size && !memcmp(a.bytes, b.bytes, a.size); }

/* Whether the instance takes these bytes as its state; if not nothing has moved. */
static int takes(fmi2Component c, Content content) {
    fmi2FMUstate state = NULL;
    fmi2Status status = CALL(fmi2DeSerializeFMUstate(c, content.bytes, content.size, &state));
    must((status == fmi2OK) == (state != NULL), "a state must be there if it is OK");
    if (status != fmi2OK) return 0;
    status = CALL(fmi2SetFMUstate(c, state));
    fmi2FreeFMUstate(c, &state);
    return status == fmi2OK;
}

#endif
