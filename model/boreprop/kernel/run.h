/* A drilling run that owns its memory, and takes more where inputs change so often that the hole has many pieces. */
#ifndef BOREPROP_RUN_H
#define BOREPROP_RUN_H

#include "drilling.h"
#include "state.h"

enum { MOST_STEPS = MOST_PIECES / 2 }; /* in one step of a host */

typedef struct {
    Drilling drilling;
    void *memory;
} Run;

static inline void run_end(Run *run) {
    if (run) free(run->memory);
    free(run);
}

static inline Status too_long(char why[MESSAGE]) {
    snprintf(why, MESSAGE, "step: must take at most %d steps of the integrator, got more", MOST_STEPS);
    return FAILED;
}

/* Take memory of a capacity; what the run held stays. */
static inline Status grow(Run *run, Count capacity, char why[MESSAGE]) {
    void *memory = capacity <= MOST_PIECES ? malloc(drilling_memory(capacity)) : NULL;
    if (!memory) {
        snprintf(why, MESSAGE, "memory: must have room for %lld pieces of hole, got at most %d", capacity, MOST_PIECES);
        return FAILED;
    }
    if (run->memory) drilling_move(&run->drilling, memory, capacity);
    free(run->memory);
    run->memory = memory;
    return DONE;
}

/* A drilling system that has not begun: `run_start` or `run_restore` is next. */
static inline Status run_prepare(Run *run, const System *system, char why[MESSAGE]) {
    if (grow(run, LEAST_CAPACITY, why) != DONE) return FAILED;
    return drilling_prepare(&run->drilling, system, run->memory, LEAST_CAPACITY, why);
}

static inline Status run_start(Run *run, const Survey *survey, Inputs inputs, char why[MESSAGE]) {
    if (!check_survey(survey, why)) return FAILED;
    Count capacity = drilling_capacity(&run->drilling.system, survey);
    if (capacity > LEAST_CAPACITY && grow(run, capacity, why) != DONE) return FAILED;
    return drilling_start(&run->drilling, survey, inputs, why);
}

static inline Status run_advance(Run *run, double drilled_length, Inputs inputs, char why[MESSAGE]) {
    Status status;
    double way = (drilled_length - drilling_length(&run->drilling)) / length_scale(&run->drilling.system);
    if (isfinite(drilled_length) && way > (double)MOST_STEPS * LARGEST_STEP) return too_long(why);
    while ((status = drilling_advance(&run->drilling, drilled_length, inputs, why)) == FULL)
        if (grow(run, 2 * run->drilling.integrator.now.hole.capacity, why) != DONE) {
            drilling_cancel(&run->drilling);
            return too_long(why);
        }
    return status;
}

static inline Status run_restore(Run *run, const double *state, Count count, char why[MESSAGE]) {
    Count wanted;
    Status status = drilling_restore(&run->drilling, state, count, &wanted, why);
    if (status != FULL) return status;
    if (grow(run, wanted, why) != DONE) return FAILED;
    return drilling_restore(&run->drilling, state, count, &wanted, why);
}

#endif
