/* A drilling run that owns its memory, and takes more where inputs change so often that the hole has many pieces. */
#ifndef BOREPROP_GROWING_H
#define BOREPROP_GROWING_H

#include "drilling.h"

enum { MOST_PIECES = 1 << 19, MOST_STEPS = MOST_PIECES / 2 }; /* in one step of a host: some thousands of ℓ₁ */

typedef struct {
    Drilling drilling;
    void *memory;
} Run;

static inline Status too_long(char why[MESSAGE]) {
    snprintf(why, MESSAGE, "step: must take at most %d steps of the integrator, got more", MOST_STEPS);
    return FAILED;
}

/* Take memory of a capacity; what the run held stays. */
static inline Status grow(Run *run, Count capacity, int started, char why[MESSAGE]) {
    void *memory = capacity <= MOST_PIECES ? malloc(drilling_memory(capacity)) : NULL;
    if (!memory) return too_long(why);
    if (started) drilling_move(&run->drilling, memory, capacity);
    free(run->memory);
    run->memory = memory;
    return DONE;
}

/* A drilling system that has not begun: `run_start` or `run_restore` is next. */
static inline Status run_prepare(Run *run, const System *system, char why[MESSAGE]) {
    if (grow(run, LEAST_CAPACITY, 0, why) != DONE) return FAILED;
    return drilling_prepare(&run->drilling, system, run->memory, LEAST_CAPACITY, why);
}

static inline Status run_start(Run *run, const Survey *survey, Inputs inputs, char why[MESSAGE]) {
    if (!check_survey(survey, why)) return FAILED;
    Count capacity = drilling_capacity(&run->drilling.system, survey);
    if (capacity > LEAST_CAPACITY && grow(run, capacity, 1, why) != DONE) return FAILED;
    return drilling_start(&run->drilling, survey, inputs, why);
}

static inline Status run_advance(Run *run, double drilled_length, Inputs inputs, char why[MESSAGE]) {
    Status status;
    double way = (drilled_length - drilling_length(&run->drilling)) / length_scale(&run->drilling.system);
    if (isfinite(way) && way > (double)MOST_STEPS * LARGEST_STEP) return too_long(why);
    while ((status = drilling_advance(&run->drilling, drilled_length, inputs, why)) == FULL)
        if (grow(run, 2 * run->drilling.propagation.hole.capacity, 1, why) != DONE) {
            drilling_cancel(&run->drilling);
            return FAILED;
        }
    return status;
}

static inline Status run_restore(Run *run, const double *state, Count count, char why[MESSAGE]) {
    Status status = drilling_restore(&run->drilling, state, count, why);
    if (status != FULL) return status;
    if (grow(run, drilling_state_capacity(state, count), 1, why) != DONE) return FAILED;
    return drilling_restore(&run->drilling, state, count, why);
}

#endif
