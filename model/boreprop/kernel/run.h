/* A drilling run that owns its memory. It takes more where inputs change so often that the hole has many pieces. */
#ifndef BOREPROP_RUN_H
#define BOREPROP_RUN_H

#ifndef SPACE
#include "sag.h"
#endif
#include "outputs.h"
#include "state.h"

typedef struct {
    Drilling drilling;
    void *memory;
    double *ground; /* numbers of its own; NULL if others keep them */
} Run;

static inline void run_end(Run *run) {
    if (run) free(run->memory), free(run->ground);
    free(run);
}

/* Take memory of a capacity, with all that the run has in its memory so far. */
static inline Status grow(Run *run, Count capacity, Problem *problem) {
    void *memory = capacity <= MOST_PIECES ? malloc(drilling_memory(capacity)) : NULL;
    if (!memory) return met(problem, NO_MEMORY, MOST_PIECES, 0.0);
    if (run->memory) drilling_move(&run->drilling, memory, capacity);
    free(run->memory);
    run->memory = memory;
    return DONE;
}

/* Prepare a drilling system, to be followed by `run_start` or `run_restore`. */
static inline Status run_prepare(Run *run, const System *system, Ground ground, Options options, Problem *problem) {
    if (grow(run, LEAST_CAPACITY, problem) != DONE) return FAILED;
    return drilling_prepare(&run->drilling, system, ground, options, run->memory, LEAST_CAPACITY, problem);
}

static inline Status run_start(Run *run, const Survey *survey, Inputs inputs, Problem *problem) {
    if (!check_survey(survey, problem)) return FAILED;
    Count capacity = drilling_capacity(&run->drilling.system, survey);
    if (capacity > LEAST_CAPACITY && grow(run, capacity, problem) != DONE) return FAILED;
    return drilling_start(&run->drilling, survey, inputs, problem);
}

/* Take twice the memory, so that a call can go on. Where that cannot be had the call fails, for it takes too many steps,
   and the bit goes back to where it was. */
static inline Status grow_on_the_way(Run *run, Problem *problem) {
    Drilling *drilling = &run->drilling;
    if (grow(run, 2 * drilling->integrator.now.hole.capacity, problem) == DONE) return DONE;
    drilling_cancel(drilling);
    return too_many(&drilling->integrator, problem);
}

static inline Status run_advance(Run *run, double drilled_length, Inputs inputs, Problem *problem) {
    Status status;
    while ((status = drilling_advance(&run->drilling, drilled_length, inputs, problem)) == FULL)
        if (grow_on_the_way(run, problem) != DONE) return FAILED;
    return status;
}

/* Let the stabilizers have other clearances, m, from where the bit is. */
static inline Status run_change_clearances(Run *run, const double *clearances, Problem *problem) {
    Status status;
    while ((status = drilling_change_clearances(&run->drilling, clearances, problem)) == FULL)
        if (grow_on_the_way(run, problem) != DONE) return FAILED;
    return status;
}

/* Drill on to the end of the integrator's next step. */
static inline Status run_step(Run *run, Problem *problem) {
    Status status;
    while ((status = drilling_step(&run->drilling, problem)) == FULL)
        if (grow_on_the_way(run, problem) != DONE) return FAILED;
    return status;
}

static inline Status run_restore(Run *run, const double *state, Count count, Problem *problem) {
    Count wanted;
    Status status = drilling_restore(&run->drilling, state, count, &wanted, problem);
    if (status != FULL) return status;
    if (grow(run, wanted, problem) != DONE) return FAILED;
    return drilling_restore(&run->drilling, state, count, &wanted, problem);
}

#endif
